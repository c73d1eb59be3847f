//! Panel with the difference between measured and exact curves. It is drawn if the curves coincide in the graph.

use grainbench_harness::figure::{Curve, Graph, Stroke};

use crate::plot::scale::Scale;

/// Largest distance between curves that look the same, as a fraction of the axis.
const TOLD_APART: f64 = 0.03;

/// Differences that are plotted in a separate panel.
pub(super) struct Difference {
    pub(super) scale: Scale,
    /// Index of each curve, with the points of its difference.
    pub(super) curves: Vec<(usize, Vec<(f64, f64)>)>,
}

/// Returns the label of the axis of differences. It has the unit of the graph's vertical axis.
pub(super) fn label(y: &str) -> String {
    let unit = y.rfind(" (").filter(|_| y.ends_with(')')).map_or("", |at| &y[at..]);
    format!("difference{unit}")
}

/// Returns the differences between measured and exact curves. Returns none if an axis is logarithmic, the graph has other
/// curves, a measured curve has fewer than eight points, the curves are visibly apart, or all differences are zero.
pub(super) fn from_graph(graph: &Graph, y: &Scale) -> Option<Difference> {
    if graph.x.logarithmic || graph.y.logarithmic {
        return None;
    }
    let curves_with = |stroke: Stroke| graph.curves.iter().enumerate().filter(move |(_, curve)| curve.stroke == stroke);
    let (lines, exact): (Vec<_>, Vec<_>) =
        (curves_with(Stroke::Line).collect(), curves_with(Stroke::Dashed).map(|(_, curve)| curve).collect());
    let is_all = lines.len() + exact.len() == graph.curves.len() && !lines.is_empty();
    // All lines share one exact curve, or each line has its own.
    if !is_all || exact.is_empty() || (exact.len() != 1 && exact.len() != lines.len()) {
        return None;
    }
    let difference = |(place, (at, line)): (usize, &(usize, &Curve))| {
        let reference = exact[if exact.len() == 1 { 0 } else { place }];
        let points = line.points.iter().filter_map(|&(x, value)| Some((x, value - at_x(reference, x)?)));
        Some((*at, points.collect::<Vec<_>>())).filter(|(_, points)| points.len() >= 8)
    };
    let curves = lines.iter().enumerate().map(difference).collect::<Option<Vec<_>>>()?;
    let all = || curves.iter().flat_map(|(_, points)| points).map(|(_, off)| *off);
    let worst = all().map(|off| (y.position(off.abs()) - y.position(0.0)).abs()).fold(0.0, f64::max);
    let values: Vec<f64> = all().filter(|off| off.is_finite()).collect();
    let scale = Scale::fit(values.iter().copied().chain([0.0]), false, 0.06, 3);
    (worst < TOLD_APART && values.iter().any(|value| *value != 0.0)).then_some(Difference { scale, curves })
}

/// Returns the value of a curve at x, interpolated linearly.
fn at_x(curve: &Curve, x: f64) -> Option<f64> {
    let next = curve.points.partition_point(|point| point.0 < x);
    let after = curve.points.get(next)?;
    if after.0 == x {
        return Some(after.1);
    }
    let before = curve.points.get(next.checked_sub(1)?)?;
    Some(before.1 + (x - before.0) / (after.0 - before.0) * (after.1 - before.1))
}
