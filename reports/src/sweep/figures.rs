//! Figures of a sweep: error against cost over all points.

use super::{Point, Sweep};
use crate::{distinct, quantile};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};

/// Returns the solvers with their resolution levels and the points of each level, in the order of the points.
pub(super) fn levels(sweep: &Sweep) -> Vec<(&str, &str, Vec<&Point>)> {
    let points = |level: (&str, &str)| sweep.points.iter().filter(|point| point.level() == level).collect();
    let levels = distinct(sweep.points.iter().map(Point::level)).into_iter();
    levels.map(|(solver, level)| (solver, level, points((solver, level)))).collect()
}

/// Returns the figure of error against particle-steps, with one point for each solver and level.
pub(super) fn work(sweep: &Sweep) -> Option<Figure> {
    let mut curves: Vec<Curve> = Vec::new();
    for (solver, _, points) in levels(sweep) {
        let ran = points.iter().filter_map(|point| point.left.ran);
        let mut steps: Vec<f64> = ran.map(|ran| ran.particle_steps as f64).collect();
        let mut errors: Vec<f64> = points.iter().filter_map(|point| point.error()).collect();
        let Some(middle) = quantile(&mut steps, 0.5) else { continue };
        for (label, part) in [("median", 0.5), ("90 % of the errors are below", 0.9)] {
            let Some(error) = quantile(&mut errors, part) else { continue };
            let label = format!("{solver}, {label}");
            match curves.iter_mut().find(|curve| curve.label == label) {
                Some(curve) => curve.points.push((middle, error)),
                None => curves.push(Curve::new(label, Stroke::MarkedLine, vec![(middle, error)])),
            }
        }
    }
    for curve in &mut curves {
        curve.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    (!curves.is_empty()).then(|| {
        Figure::graph(
            "work",
            "Cost of accuracy over all points of the design",
            "The worst error of the recorded quantities against the particle steps of the median run, one point per \
             level. Counts do not depend on the machine.",
            [Axis::log("particle-steps of the median run"), Axis::log("|error|")],
            curves,
        )
    })
}
