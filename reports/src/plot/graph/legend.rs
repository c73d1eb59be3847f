//! Legend of a graph. Labels are at the ends of their lines if there is room, otherwise one below another.

use grainbench_harness::figure::{Curve, Graph, Stroke};
use maud::{Markup, html};

use super::{CurveStyle, LEGEND_LINE, LEGEND_SAMPLE, Panel, TICK, curves, px};
use crate::plot::{text, wrap};

/// Returns the lines of text of each label; empty if all labels are empty.
pub(super) fn lines(curves: &[Curve]) -> Vec<Vec<String>> {
    if curves.iter().all(|curve| curve.label.is_empty()) {
        return Vec::new();
    }
    curves.iter().map(|curve| wrap(&curve.label, TICK, 150.0)).collect()
}

/// Draws the legend to the right of a panel.
pub(super) fn draw(graph: &Graph, looks: &[CurveStyle], legend: &[Vec<String>], panel: &Panel) -> Markup {
    // A curve has an entry if it has a label, or another style than the previous curve.
    let is_told = |curve: &Curve| !(curve.label.is_empty() && matches!(curve.stroke, Stroke::Beside | Stroke::Failed));
    let labelled: Vec<usize> = (0..legend.len()).filter(|&at| is_told(&graph.curves[at])).collect();
    let left = panel.frame.right + 18.0;
    let entries = tops(graph, legend, panel, &labelled);
    html! {
        g font-size=(TICK) fill="#222" {
            @for (at, top) in entries {
                @let (from, to) = ((left, top + 3.0), (left + LEGEND_SAMPLE - 4.0, top + 3.0));
                (curves::sample(graph.curves[at].stroke, &looks[at], from, to))
                @for (line, part) in legend[at].iter().enumerate() {
                    text x=(px(left + LEGEND_SAMPLE + 4.0)) y=(px(top + 3.0 + 0.35 * TICK + LEGEND_LINE * line as f64)) {
                        (text::svg(part))
                    }
                }
            }
        }
    }
}

/// Returns the index of the curve of each entry, and the vertical position of the entry's first line (drawing units).
fn tops(graph: &Graph, legend: &[Vec<String>], panel: &Panel, labelled: &[usize]) -> Vec<(usize, f64)> {
    let frame = panel.frame;
    let (first, last) = (frame.top + 6.0, frame.bottom + 40.0);
    let height = |at: usize| LEGEND_LINE * legend[at].len() as f64;
    let whole: f64 = labelled.iter().map(|&at| height(at)).sum();
    // If the legend is long, its entries are closer together.
    let gap = ((last - first - whole) / labelled.len().max(1) as f64).clamp(0.0, 7.0);
    let end = |at: usize| {
        let joined = matches!(graph.curves[at].stroke, Stroke::Line | Stroke::Dashed | Stroke::MarkedLine);
        let shown = graph.curves[at].points.iter().filter(|point| panel.x().shows(point.0) && panel.y().shows(point.1));
        let last = shown.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|_| joined)?;
        (panel.x().position(last.0) > 0.75).then(|| panel.up(last.1))
    };
    let ends: Option<Vec<(usize, f64)>> = labelled.iter().map(|&at| Some((at, end(at)?))).collect();
    let Some(mut ends) = ends.filter(|_| whole + 4.0 * labelled.len() as f64 <= frame.bottom - first) else {
        let mut top = first;
        let stacked = labelled.iter().map(|&at| {
            let here = top;
            top += height(at) + gap;
            (at, here)
        });
        return stacked.collect();
    };
    ends.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Entries that would overlap move down, and entries below the lower edge then move up.
    let mut free = first;
    let place = |(at, wanted): (usize, f64)| {
        let top = wanted.max(free);
        free = top + height(at) + 4.0;
        (at, top)
    };
    let mut placed: Vec<(usize, f64)> = ends.into_iter().map(place).collect();
    let mut lowest = frame.bottom + 14.0;
    for (at, top) in placed.iter_mut().rev() {
        *top = top.min(lowest - height(*at));
        lowest = *top - 4.0;
    }
    placed
}
