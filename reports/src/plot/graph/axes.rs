//! Axes of a graph with their ticks and labels.

use maud::{Markup, html};

use super::{LABEL, Panel, TICK, px};
use crate::plot::scale::Tick;
use crate::plot::{apart, text, text_width};

/// Draws the grid, and the axes with ticks and labels. Without `x_label`, the horizontal axis has no labels.
pub(super) fn draw(panel: &Panel, y_label: &str, x_label: Option<&str>) -> Markup {
    let frame = panel.frame;
    let (x_ticks, y_ticks) = (panel.x().ticks(), panel.y().ticks());
    let across =
        |tick: &Tick| tick.label.clone().map(|label| (panel.across(tick.value), text_width(&label, TICK), label));
    let up = |tick: &Tick| tick.label.clone().map(|label| (panel.up(tick.value), TICK, label));
    let (x_labels, y_labels) = (apart(x_ticks.iter().filter_map(across)), apart(y_ticks.iter().filter_map(up)));
    let [left, right, top, bottom] = [frame.left, frame.right, frame.top, frame.bottom].map(px);
    let [mut fine, mut grid, mut marks] = [const { String::new() }; 3];
    for tick in &x_ticks {
        let (lines, length) = if tick.label.is_some() { (&mut grid, 6) } else { (&mut fine, 3) };
        let x = px(panel.across(tick.value));
        lines.push_str(&format!("M{x} {top}V{bottom}"));
        marks.push_str(&format!("M{x} {bottom}v{length}"));
    }
    for tick in &y_ticks {
        let (lines, length) = if tick.label.is_some() { (&mut grid, 6) } else { (&mut fine, 3) };
        let y = px(panel.up(tick.value));
        lines.push_str(&format!("M{left} {y}H{right}"));
        marks.push_str(&format!("M{left} {y}h-{length}"));
    }
    let place = format!("translate(20 {}) rotate(-90)", px(0.5 * (frame.top + frame.bottom)));
    // The label of a low panel may be longer than the panel, but must not reach the next label.
    let y_size = (LABEL * (frame.bottom - frame.top + 40.0) / text_width(y_label, LABEL)).min(LABEL);
    html! {
        path d=(fine) fill="none" stroke="#f0f0f0" stroke-width=".8" {}
        path d=(grid) fill="none" stroke="#ddd" stroke-width=".8" {}
        path d=(format!("M{left} {top}V{bottom}H{right}")) fill="none" stroke="#222" stroke-width="1.2" {}
        path d=(marks) fill="none" stroke="#222" {}
        g font-size=(TICK) fill="#222" {
            g text-anchor="end" {
                @for (at, label) in &y_labels {
                    text x=(px(frame.left - 10.0)) y=(px(at + 0.35 * TICK)) { (label) }
                }
            }
            @if let Some(x_label) = x_label {
                g text-anchor="middle" {
                    @for (at, label) in &x_labels { text x=(px(*at)) y=(px(frame.bottom + 21.0)) { (label) } }
                    text x=(px(0.5 * (frame.left + frame.right))) y=(px(frame.bottom + 46.0)) font-size=(LABEL) {
                        (text::svg(x_label))
                    }
                }
            }
        }
        text transform=(place) text-anchor="middle" font-size=(px(y_size)) fill="#222" {
            (text::svg(y_label))
        }
    }
}
