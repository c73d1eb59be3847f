//! Figures of a sweep: error against cost over all points.

use super::Sweep;
use crate::distinct;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};

/// Returns the solvers with their resolution levels, in the order of the points.
pub(super) fn levels(sweep: &Sweep) -> Vec<(String, String)> {
    let levels = distinct(sweep.points.iter().map(|point| (&point.solver, &point.resolution)));
    levels.into_iter().map(|(solver, level)| (solver.clone(), level.clone())).collect()
}

/// Returns the value below which the fraction `part` of the values lies; none for an empty list. Sorts the values.
pub(super) fn quantile(values: &mut [f64], part: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(((values.len() as f64 * part) as usize).min(values.len().saturating_sub(1))).copied()
}

/// Returns the figure of error against particle-steps, with one point for each solver and level.
pub(super) fn work(sweep: &Sweep) -> Option<Figure> {
    let mut curves: Vec<Curve> = Vec::new();
    for (solver, level) in levels(sweep) {
        let level_points = || sweep.points.iter().filter(|point| point.solver == solver && point.resolution == level);
        let mut steps: Vec<f64> =
            level_points().filter_map(|point| point.left.ran.map(|ran| ran.particle_steps as f64)).collect();
        let mut errors: Vec<f64> = level_points().filter_map(super::Point::error).collect();
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
