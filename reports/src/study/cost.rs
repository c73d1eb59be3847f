//! Cost of accuracy: Pareto fronts, cheapest settings, and figures of measured against expected values.

use super::point::{Counts, Diagram, Point, PointStatus};
use crate::distinct;
use crate::number;
use crate::plot::palette::SOLVERS;
use crate::table::{Cell, Column, Format, Table};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use std::collections::BTreeSet;

/// Errors for which the cost is stated, as fractions of the scale of the quantity.
pub const TARGETS: [f64; 3] = [0.1, 0.01, 0.001];
/// Smallest plotted error. Smaller errors are rounding errors and are plotted at this value.
const LEAST: f64 = 1e-16;

/// Returns the Pareto front in the order of time: points to which no other point is superior in both error and time.
pub(crate) fn front<'a>(points: impl IntoIterator<Item = &'a Point>) -> Vec<&'a Point> {
    let mut sorted: Vec<(f64, f64, &Point)> =
        points.into_iter().filter_map(|point| point.place().map(|(error, time)| (time, error, point))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    sorted.retain(|(_, error, _)| {
        let better = *error < best;
        best = best.min(*error);
        better
    });
    sorted.into_iter().map(|(_, _, point)| point).collect()
}

/// Returns the solvers of some diagrams: all of `SOLVERS`, followed by all other solvers that have points.
pub fn lines<'a>(diagrams: impl IntoIterator<Item = &'a Diagram>) -> Vec<&'a str> {
    let points = diagrams.into_iter().flat_map(|diagram| &diagram.points);
    distinct(SOLVERS.into_iter().chain(points.map(|point| point.solver.as_str())))
}

/// Returns the points of a solver in a diagram.
pub(crate) fn of_line<'a>(diagram: &'a Diagram, line: &'a str) -> impl Iterator<Item = &'a Point> {
    diagram.points.iter().filter(move |point| point.solver == line)
}

/// Returns the point with the shortest time of a solver with at most the error `target`.
#[must_use]
pub fn cheapest<'a>(diagram: &'a Diagram, line: &'a str, target: f64) -> Option<&'a Point> {
    let within = of_line(diagram, line).filter(|point| point.place().is_some_and(|(error, _)| error <= target));
    within.min_by(|a, b| a.wall_seconds.unwrap_or(f64::NAN).total_cmp(&b.wall_seconds.unwrap_or(f64::NAN)))
}

/// Returns the time (s) of the cheapest setting of a solver with at most the error `target`.
pub(crate) fn time(diagram: &Diagram, line: &str, target: f64) -> Option<f64> {
    cheapest(diagram, line, target)?.wall_seconds
}

/// Returns true if no other solver reaches the error `target` in less time.
pub(crate) fn is_cheapest(diagram: &Diagram, line: &str, target: f64) -> bool {
    let others = lines([diagram]).into_iter().filter(|other| *other != line);
    let mut others = others.filter_map(|other| time(diagram, other, target));
    time(diagram, line, target).is_some_and(|mine| others.all(|other| mine <= other))
}

/// Returns true if a solver reaches the error `target`, but in less time than the variation of its start-up.
#[must_use]
pub fn is_hidden(diagram: &Diagram, line: &str, target: f64) -> bool {
    let is_reached = |point: &Point| point.error.is_some_and(|error| error <= target) && point.wall_seconds.is_none();
    cheapest(diagram, line, target).is_none() && of_line(diagram, line).any(is_reached)
}

/// Sentence about a comparison with an earlier study without changes.
pub(super) const NO_CHANGE: &str = "all counts are equal, and no time differs by more than noise";

/// Returns a sentence about the cost of an error of at most `target`. It names the cheapest setting of each solver, with the
/// time of the setting divided by the shortest time of all solvers.
#[must_use]
pub fn sentence(diagram: &Diagram, target: f64) -> String {
    let lines = lines([diagram]);
    let mut reached: Vec<(&str, &Point)> =
        lines.iter().filter_map(|line| cheapest(diagram, line, target).map(|point| (*line, point))).collect();
    reached.sort_by(|a, b| a.1.wall_seconds.unwrap_or(0.0).total_cmp(&b.1.wall_seconds.unwrap_or(0.0)));
    let best = reached.first().and_then(|(_, point)| point.wall_seconds).unwrap_or(f64::NAN);
    let part = |(line, point): &(&str, &Point)| {
        let wall = point.wall_seconds.unwrap_or(f64::NAN);
        let times = if wall > best { format!(" (× {})", number::significant(wall / best, 2)) } else { String::new() };
        format!("{line} {} in {}{times}", point.setting(), number::seconds(wall))
    };
    let mut parts: Vec<String> = reached.iter().map(part).collect();
    if parts.is_empty() {
        parts.push("no solver reaches it".to_owned());
    }
    let unreached = |line: &str| {
        if is_hidden(diagram, line, target) {
            return Some(format!("{line} in less time than the variation of its start-up"));
        }
        let best = of_line(diagram, line).filter_map(|point| point.error).min_by(f64::total_cmp)?;
        let is_reached = cheapest(diagram, line, target).is_some();
        (!is_reached).then(|| format!("{line} does not reach it (at best {})", number::fraction(best)))
    };
    parts.extend(lines.into_iter().filter_map(unreached));
    format!("{}: {}.", number::fraction(target), parts.join("; "))
}

pub(crate) fn figure(diagram: &Diagram) -> Figure {
    let drawn = |point: &Point| point.place().map(|(error, time)| (time, error.max(LEAST)));
    let errors = || diagram.points.iter().filter_map(drawn).map(|(_, error)| error);
    let top = 10.0 * errors().fold(LEAST, f64::max);
    let mut curves = Vec::new();
    let mut bars = Vec::new();
    for line in lines([diagram]) {
        let own = front(of_line(diagram, line));
        let is_own = |point: &Point| own.iter().any(|other| std::ptr::eq(*other, point));
        let label = match of_line(diagram, line).next() {
            None => format!("{line} (not measured)"),
            Some(_) if !own.is_empty() => line.to_owned(),
            Some(point) if point.standing == PointStatus::Unsupported => format!("{line} (unsupported)"),
            Some(point) => format!("{line} ({})", point.standing.word("cannot")),
        };
        curves.push(Curve::new(label, Stroke::MarkedLine, own.iter().filter_map(|point| drawn(point)).collect()));
        let others = of_line(diagram, line).filter(|point| !is_own(point)).filter_map(drawn);
        curves.push(Curve::new("", Stroke::Beside, others.collect()));
        let failed = of_line(diagram, line).filter(|point| point.standing == PointStatus::Failed);
        let failed = failed.filter_map(|point| point.wall_seconds.map(|wall| (wall, top)));
        curves.push(Curve::new("", Stroke::Failed, failed.collect()));
        bars.extend(floors(diagram, line));
    }
    curves.push(Curve::new("floor: error that refinement does not reduce", Stroke::Bars, bars));
    let all: Vec<(f64, f64)> = front(&diagram.points).into_iter().filter_map(drawn).collect();
    let stairs = all.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1), pair[1]]);
    curves.push(Curve::new("Pareto front", Stroke::Dashed, stairs.collect()));
    // The legend names each solver, also without points.
    curves.retain(|curve| curve.stroke == Stroke::MarkedLine || !curve.points.is_empty());
    let failures = diagram.points.iter().any(|point| point.standing == PointStatus::Failed);
    let crosses = if failures { " Crosses at the top are failed runs, drawn at the time of the failure." } else { "" };
    Figure::graph(
        &crate::page::slug(&diagram.quantity),
        &format!("{}, {}: {}", diagram.case, diagram.variant, diagram.quantity),
        &format!(
            "Each point is a setting. Filled markers on a line are settings for which no other setting of this solver \
             is both faster and more accurate. Hollow markers are the remaining settings.{crosses} Exact solution: {}.",
            diagram.source
        ),
        [Axis::log("wall-clock time of the stepping loop (s)"), Axis::log("|error| / scale")],
        curves,
    )
}

/// Returns the bars at the error floors of a solver, each from the first to the last point on the floor.
fn floors(diagram: &Diagram, line: &str) -> Vec<(f64, f64)> {
    let mut names: Vec<(&str, &str)> = of_line(diagram, line)
        .filter_map(|point| point.floor.as_deref().map(|floor| (floor, point.knobs.as_str())))
        .collect();
    names.dedup();
    let bar = |(floor, knobs): (&str, &str)| {
        let on = |point: &&Point| point.floor.as_deref() == Some(floor) && point.knobs == knobs;
        let places: Vec<(f64, f64)> = of_line(diagram, line).filter(on).filter_map(Point::place).collect();
        let times = || places.iter().map(|(_, time)| *time);
        let (first, last) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
        let (error, _) = places.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some([(first, error.max(LEAST)), (last, error.max(LEAST))])
    };
    names.into_iter().filter_map(bar).flatten().collect()
}

/// Returns figures of measured against expected values over all cases, one for each unit. For each quantity, a solver
/// has the point with its smallest error.
pub(crate) fn scatters(diagrams: &[Diagram]) -> Vec<Figure> {
    let points = diagrams.iter().flat_map(|diagram| &diagram.points);
    let units: BTreeSet<&str> = points.map(|point| point.unit.as_str()).collect();
    units.into_iter().filter_map(|unit| scatter(diagrams, unit)).collect()
}

/// Returns the point with the smallest error of a solver, for each diagram whose quantity has this unit.
fn best<'a>(diagrams: &'a [Diagram], unit: &'a str, line: &'a str) -> Vec<&'a Point> {
    let cheapest = |diagram: &'a Diagram| {
        let points = of_line(diagram, line).filter(|point| point.unit == unit && point.place().is_some());
        points.min_by(|a, b| a.error.unwrap_or(f64::NAN).total_cmp(&b.error.unwrap_or(f64::NAN)))
    };
    diagrams.iter().filter_map(cheapest).collect()
}

/// Returns the bias and the spread of measured/expected. The bias is the geometric mean, and the spread is the standard
/// deviation of the natural logarithm.
fn bias(points: &[&Point]) -> Option<(f64, f64)> {
    let ratios = points.iter().filter_map(|point| Some(point.value? / point.expected?));
    let logs: Vec<f64> = ratios.filter(|ratio| ratio.is_finite() && *ratio > 0.0).map(f64::ln).collect();
    let count = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / count;
    let variance = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    (!logs.is_empty()).then(|| (mean.exp(), variance.sqrt()))
}

/// Returns the dashed line y = x over the range of the horizontal coordinates of curves.
pub(super) fn diagonal(label: &str, curves: &[Curve]) -> Curve {
    let all = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.0);
    let ends = [all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max)];
    Curve::new(label, Stroke::Dashed, ends.map(|end| (end, end)).to_vec())
}

fn scatter(diagrams: &[Diagram], unit: &str) -> Option<Figure> {
    let mut curves = Vec::new();
    for line in lines(diagrams) {
        let points = best(diagrams, unit, line);
        let Some((factor, spread)) = bias(&points) else { continue };
        let [factor, spread] = [factor - 1.0, spread].map(number::fraction);
        let label = format!("{line}: bias {factor}, spread {spread}");
        let places = points.iter().filter_map(|point| Some((point.expected?.abs(), point.value?.abs())));
        let places = places.filter(|(expected, value)| *expected > 0.0 && *value > 0.0);
        curves.push(Curve::new(label, Stroke::Markers, places.collect()));
    }
    if curves.iter().all(|curve| curve.points.is_empty()) {
        return None;
    }
    curves.push(diagonal("measured = expected", &curves));
    let words = if unit == "1" { "pure numbers".to_owned() } else { format!("quantities in {unit}") };
    Some(Figure::graph(
        &format!("measured-expected-{}", if unit == "1" { "ratio" } else { unit }),
        &format!("Measured against expected: {words}"),
        "Each marker is one solver in one case, at the setting with the smallest error. Bias and spread are the mean \
         and the standard deviation of ln(measured/expected).",
        ["expected", "measured"].map(|value| Axis::log(&format!("{value} ({unit})"))),
        curves,
    ))
}

pub(super) fn points_table(diagrams: &[Diagram]) -> Table<'_> {
    let columns = ["case", "variant", "quantity", "solver", "resolution", "knobs", "standing"].map(Column::text);
    let times = ["error", "wall_seconds", "wall_spread", "cpu_seconds", "start_up_seconds"].map(Column::number);
    let counts = Counts::default().named().map(|(name, _)| Column::new(name, Format::Count));
    let rows = diagrams.iter().flat_map(|diagram| &diagram.points).map(|point| {
        let names = [&point.case, &point.variant, &point.quantity, &point.solver, &point.resolution, &point.knobs];
        let names = names.map(Cell::from).into_iter().chain([point.standing.word("cannot").into()]);
        let times = [point.error, point.wall_seconds, point.wall_spread, point.cpu_seconds, point.start_up_seconds];
        names.chain(times.map(Cell::from)).chain(point.counts.named().map(|(_, count)| count.into())).collect()
    });
    Table::new("points", columns.into_iter().chain(times).chain(counts), rows)
}
