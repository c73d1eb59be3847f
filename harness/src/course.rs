//! Claims about curves: a time series must follow an exact solution, or an error must decrease with the resolution.
//!
//! The figure of a claim plots the data that the claim compares.

use crate::case::Case;
use crate::claim::{Claim, ClaimCurves, ClaimFigure, ClaimWithExpectation, Expectation, Points, Quantity, Trace};
use crate::expect::{Bound, ExpectedValue, Measurement};
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::measure::slope;
use crate::run::{FinishedRun, MissingData};
use crate::runner::Runner;
use crate::source::Source;
use grainbench_solver::failure::RunError;
use std::sync::Arc;

/// Largest number of points of a plotted curve.
const DRAWN: usize = 300;

/// Returns the time (s) and the value of every sample of a column.
///
/// # Errors
/// When the record lacks the column, or the column is empty.
pub fn samples(done: &FinishedRun, column: &str) -> Result<Points, MissingData> {
    Ok(done.series().time.iter().copied().zip(done.column(column)?.iter().copied()).collect())
}

/// Returns the time (s) of every sample of a column, and its value minus the first value of the column.
///
/// # Errors
/// When the record lacks the column, or the column is empty.
pub fn from_start(done: &FinishedRun, column: &str) -> Result<Points, MissingData> {
    let mut points = samples(done, column)?;
    let start = points[0].1;
    points.iter_mut().for_each(|(_, value)| *value -= start);
    Ok(points)
}

impl Quantity {
    /// Compares a time series of the first run with the exact value at every sample. `read` returns the time (s) and the
    /// value of every sample. `exact` returns the exact value at a time (s). The error is divided by `scale`.
    pub fn follows(
        self,
        source: Source,
        read: impl Fn(&FinishedRun) -> Result<Points, MissingData> + Send + Sync + 'static,
        exact: impl Fn(&FinishedRun, f64) -> f64 + Send + Sync + 'static,
        scale: impl Fn(&FinishedRun) -> f64 + Send + Sync + 'static,
    ) -> ClaimWithExpectation {
        let trace: Trace = Arc::new(move |done| {
            let measured = read(&done[0])?;
            let expected = measured.iter().map(|&(time, _)| (time, exact(&done[0], time))).collect();
            Ok(ClaimCurves { measured, expected, slope: None })
        });
        let compared = Arc::clone(&trace);
        let compare = move |done: &[FinishedRun]| {
            let ClaimCurves { measured, expected, .. } = compared(done)?;
            let (time, values): (Vec<f64>, Vec<f64>) = measured.into_iter().unzip();
            let expected: Vec<f64> = expected.into_iter().map(|(_, value)| value).collect();
            Ok(Measurement::worst_of(&time, &values, &expected, scale(&done[0])))
        };
        self.equals(source, compare).traced(trace)
    }

    /// Reads two numbers from every run: the varied parameter, such as a time step or a cell size, and the quantity that
    /// depends on it, such as the error. Expects this order of convergence, fitted over all runs.
    pub fn fits(
        self,
        order: f64,
        source: Source,
        read: impl Fn(&FinishedRun) -> Result<(f64, f64), MissingData> + Send + Sync + 'static,
    ) -> ClaimWithExpectation {
        let read = Arc::new(read);
        let fitted = Arc::clone(&read);
        let trace: Trace = Arc::new(move |done| {
            let measured: Points =
                done.iter().map(|done| read(done).map(|(x, y)| (x, y.abs()))).collect::<Result<_, _>>()?;
            let end = measured.iter().copied().reduce(|a, b| if b.0 < a.0 { b } else { a });
            let widest = measured.iter().map(|point| point.0).fold(0.0, f64::max);
            let guide = end.map(|(x, y)| vec![(x, y), (widest, y * (widest / x).powf(order))]);
            Ok(ClaimCurves { measured, expected: guide.unwrap_or_default(), slope: Some(order) })
        });
        let measure = move |done: &[FinishedRun]| {
            let points: Result<Points, MissingData> = done.iter().map(|done| fitted(done)).collect();
            Ok(Measurement::new(slope(&points?), ExpectedValue::Bound(Bound::Order(order)), 1.0))
        };
        self.expects(Expectation::Converges, source, measure).traced(trace)
    }

    /// Reads two numbers from every run, as [`Self::fits`] does. Expects that the quantity is proportional to the varied
    /// parameter raised to `power`. The error of the fitted power is divided by `scale`.
    pub fn scales(
        self,
        power: f64,
        scale: f64,
        source: Source,
        read: impl Fn(&FinishedRun) -> Result<(f64, f64), MissingData> + Send + Sync + 'static,
    ) -> ClaimWithExpectation {
        let expecting = self.fits(power, source, read);
        let fitted = Arc::clone(&expecting.measure);
        let measure = Arc::new(move |done: &[FinishedRun]| Ok(Measurement::new(fitted(done)?.value, power, scale)));
        ClaimWithExpectation { expectation: Expectation::Equals, measure, ..expecting }
    }
}

/// Returns the figures of the claims, one graph per figure, in the order of the claims.
///
/// # Errors
/// When a run fails. Claims whose records lack the quantity are left out.
pub fn figures(runner: &Runner, claims: &[Claim]) -> Result<Vec<Figure>, RunError> {
    let mut graphs: Vec<(&'static ClaimFigure, Vec<Curve>, Vec<Curve>)> = Vec::new();
    for claim in claims {
        let (Some((plate, label)), Some(trace)) = (&claim.drawn, &claim.trace) else { continue };
        let done: Vec<FinishedRun> = claim.runs.iter().map(|run| runner.run(run)).collect::<Result<_, _>>()?;
        let Ok(traced) = trace(&done) else { continue };
        let at = graphs.iter().position(|(drawn, ..)| drawn.name == plate.name).unwrap_or_else(|| {
            graphs.push((plate, Vec::new(), Vec::new()));
            graphs.len() - 1
        });
        let (_, measured, expected) = &mut graphs[at];
        let stroke = if traced.slope.is_some() { Stroke::MarkedLine } else { Stroke::Line };
        measured.push(Curve::new(label.clone(), stroke, thinned(traced.measured, DRAWN)));
        let curve = thinned(traced.expected, DRAWN);
        if !curve.is_empty() && !expected.iter().any(|drawn| looks_alike(&drawn.points, &curve)) {
            let rounded = |power: f64| format!("slope {}", (power * 1e3).round() / 1e3);
            let word = if matches!(claim.source, Source::Derived(_)) { "exact" } else { "expected" };
            let label = traced.slope.map_or_else(|| format!("{label}, {word}"), rounded);
            // Curves with the same slope share one guide line.
            if !expected.iter().any(|guide| guide.label == label) {
                expected.push(Curve::new(label, Stroke::Dashed, curve));
            }
        }
    }
    let figure = |(plate, measured, mut expected): (&ClaimFigure, Vec<Curve>, Vec<Curve>)| {
        let axis = |label| if plate.logarithmic { Axis::log(label) } else { Axis::linear(label) };
        if let ([exact], [_, _, ..], false) = (expected.as_mut_slice(), measured.as_slice(), plate.logarithmic) {
            exact.label = exact.label.rsplit(", ").next().unwrap_or_default().to_owned();
        }
        Figure::graph(plate.name, plate.title, plate.caption, plate.axes.map(axis), [measured, expected].concat())
    };
    Ok(graphs.into_iter().map(figure).collect())
}

/// Returns true if two plotted curves differ by less than the width of a line.
fn looks_alike(a: &[(f64, f64)], b: &[(f64, f64)]) -> bool {
    const LINE: f64 = 2e-3;
    let ends = |coordinate: &dyn Fn(&(f64, f64)) -> f64| {
        let all = a.iter().chain(b).map(coordinate);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    let (low, high) = ends(&|point| point.1);
    // Between two points, a curve with a kink differs from a straight line by at most half a second difference.
    let bend = |at: usize| match (at.checked_sub(1).and_then(|before| a.get(before)), a.get(at), a.get(at + 1)) {
        (Some(before), Some(here), Some(after)) => 0.5 * (before.1 - 2.0 * here.1 + after.1).abs(),
        _ => 0.0,
    };
    b.iter().all(|&(x, y)| {
        let after = a.partition_point(|point| point.0 < x).clamp(1, a.len().max(2) - 1);
        let (Some(&(x0, y0)), Some(&(x1, y1))) = (a.get(after - 1), a.get(after)) else { return false };
        let share = if x1 > x0 { (x - x0) / (x1 - x0) } else { 0.0 };
        let share = share.clamp(0.0, 1.0);
        let missed = 4.0 * share * (1.0 - share) * bend(after - 1).max(bend(after));
        (y0 + share * (y1 - y0) - y).abs() <= LINE * (high - low) + missed
    })
}

/// Returns at most `most` values, evenly spaced in the list.
#[must_use]
pub fn thinned<T>(values: Vec<T>, most: usize) -> Vec<T> {
    let every = values.len().div_ceil(most).max(1);
    values.into_iter().step_by(every).collect()
}

/// Returns no figures. Cases whose figures all come from claims use this function.
///
/// # Errors
/// Never.
pub const fn no_more(_: &Runner) -> Result<Vec<Figure>, RunError> {
    Ok(Vec::new())
}

/// Returns all figures of a case: the figures of the given claims and the case's own figures.
///
/// # Errors
/// When a run fails.
pub fn of_case(case: &Case, runner: &Runner, claims: &[Claim]) -> Result<Vec<Figure>, RunError> {
    let mut all = figures(runner, claims)?;
    all.extend((case.figures)(runner)?);
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_at_other_times_are_one_curve() {
        let sine = |count: u32| -> Points {
            (0..=count).map(|k| f64::from(k) / f64::from(count)).map(|x| (x, (6.0 * x).sin())).collect()
        };
        assert!(looks_alike(&sine(200), &sine(173)));
        let other: Points = sine(173).into_iter().map(|(x, y)| (x, 1.01 * y)).collect();
        assert!(!looks_alike(&sine(200), &other));
        let kinked = |count: u32| -> Points { sine(count).into_iter().map(|(x, _)| (x, (x - 0.337).abs())).collect() };
        assert!(looks_alike(&kinked(40), &kinked(173)), "a kink lies between two points");
        let moved: Points = kinked(173).into_iter().map(|(x, y)| (x, y + 0.01)).collect();
        assert!(!looks_alike(&kinked(40), &moved));
        assert!(!looks_alike(&[], &sine(9)) && !looks_alike(&[(0.0, 0.0)], &sine(9)));
    }
}
