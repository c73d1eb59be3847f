//! Reports of sweeps: runs of one scene over a range of its parameters, with several solvers and resolution levels.

mod figures;
mod map;
mod page;
mod table;

use crate::plot;
use crate::report::Provenance;
use crate::store::SaveError;
use crate::study::point::Timing;
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::{Outcome, Severity, Verdict};
use grainbench_store::StagedDir;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::io;
use std::path::Path;

/// Data of a sweep, from which all its files are written.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Version, date, machine and options of the sweep.
    pub provenance: Provenance,
    /// Title of the page.
    pub title: String,
    /// Introductory text of the page.
    pub about: String,
    /// Case and variant, or scene file.
    pub scene: String,
    /// Varied parameters.
    pub factors: Vec<Factor>,
    /// Measured quantities.
    pub quantities: Vec<Quantity>,
    /// Finished points of all solvers and levels.
    pub points: Vec<Point>,
    /// Number of points that are not finished.
    pub missing: usize,
    /// Indices of the two factors of the map; none for the first two factors with several numeric values.
    pub map: Option<[usize; 2]>,
    /// Line that is drawn on the map.
    pub line: Option<Line>,
}

/// A line on the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Meaning of the line.
    pub label: String,
    /// Points of the line, as values of the two factors.
    pub points: Vec<(f64, f64)>,
}

/// A varied parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// Name of the factor, which is its column in tables.
    pub name: String,
    /// Label in figures.
    pub label: String,
}

/// A measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Description of the quantity, such as `displacement at .3 s`.
    pub words: String,
    /// Unit of the quantity; `1` for a pure number.
    pub unit: String,
    /// Tolerance for all points; none if every point has its own tolerance.
    pub allowed: Option<f64>,
    /// Source of the expected value.
    pub source: String,
}

/// A combination of factors, run with one solver at one level.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Values of the factors, in the order of the factors.
    pub factors: Vec<Value>,
    /// Name of the solver.
    pub solver: String,
    /// Resolution of the run, in words.
    pub resolution: String,
    /// Output of the run.
    pub left: PointOutput,
}

/// Counts, results and timings of a point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointOutput {
    /// Counts and times of the run; none if the run left no record.
    pub ran: Option<RunCounts>,
    /// Results in the order of the quantities.
    pub looked: Vec<QuantityResult>,
    /// Timings of all repetitions; empty if times are not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub timings: Vec<Timing>,
    /// Reason why there is no record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

/// Counts and times of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunCounts {
    /// Number of steps.
    pub steps: u64,
    /// Number of steps times number of grains or material points.
    pub particle_steps: u64,
    /// Number of evaluations of contact laws; absent if the program does not report it.
    pub contact_evaluations: Option<u64>,
    /// Number of grid nodes that were updated, over all steps.
    pub node_updates: Option<u64>,
    /// Time step (s).
    pub time_step: f64,
    /// Wall-clock time of the stepping loop (s).
    pub wall_seconds: f64,
}

/// Measured and expected value of a quantity at one point, with the outcome.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct QuantityResult {
    /// Measured value.
    pub value: Option<f64>,
    /// Expected value, bound, band or order; none if the quantity is only recorded.
    pub expected: Option<ExpectedValue>,
    /// Scale by which the error is divided.
    pub scale: Option<f64>,
    /// Signed error, (value − expected)/scale.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: Option<f64>,
    /// Outcome; none if the quantity is not judged.
    pub verdict: Option<Outcome>,
    /// Reason for the outcome.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

impl QuantityResult {
    /// Returns a result without a value.
    #[must_use]
    pub fn without_value(outcome: Outcome, detail: Option<String>) -> Self {
        Self { verdict: Some(outcome), detail, ..Self::default() }
    }
}

impl From<Verdict> for QuantityResult {
    fn from(row: Verdict) -> Self {
        let Verdict { value, expected, scale, error, allowed, outcome, detail, .. } = row;
        let allowed = Some(allowed).filter(|allowed| allowed.is_finite());
        Self { value, expected, scale, error, allowed, verdict: Some(outcome), detail }
    }
}

/// Colours of points with their words; none for points without an expectation.
pub const KINDS: [(Option<Severity>, &str); 4] = [
    (Some(Severity::Green), "within"),
    (Some(Severity::Red), "outside or broken"),
    (Some(Severity::Amber), "amber"),
    (None, "not judged"),
];

/// Returns the numbers of points of each kind of [`KINDS`].
#[must_use]
pub fn counts<'a>(points: impl IntoIterator<Item = &'a Point>) -> [usize; 4] {
    let mut counts = [0; 4];
    for severity in points.into_iter().map(Point::severity) {
        counts.iter_mut().zip(KINDS).for_each(|(count, (kind, _))| *count += usize::from(kind == severity));
    }
    counts
}

impl Point {
    fn level(&self) -> (&str, &str) {
        (&self.solver, &self.resolution)
    }

    /// Returns the colour of the worst result; none if no quantity has an expectation.
    pub(crate) fn severity(&self) -> Option<Severity> {
        self.left.looked.iter().filter_map(|looked| looked.verdict).map(Outcome::severity).max()
    }

    /// Returns the largest |error| of all quantities; none if no quantity has an error.
    pub(crate) fn error(&self) -> Option<f64> {
        self.left.looked.iter().filter_map(|looked| looked.error).map(f64::abs).reduce(f64::max)
    }
}

/// Writes `index.html`, `results.json`, `rows.csv`, `rows.parquet` and `figures/*.svg` to a directory. If an error
/// occurs, no file is written.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_sweep(dir: impl AsRef<Path>, sweep: &Sweep) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    out.write_with("rows.csv", |file| table::table(sweep).csv(file))?;
    out.write_with("rows.parquet", |file| table::table(sweep).parquet(file))?;
    out.write_with("results.json", |file| table::write_results(sweep, file))?;
    let mut drawings = Vec::new();
    if let Some((caption, svg)) = map::draw(sweep) {
        drawings.push(("map", caption, plot::markup(&svg)));
    }
    if let Some(figure) = figures::work(sweep) {
        let svg = plot::draw(&figure)?;
        drawings.push(("work", figure.caption, svg));
    }
    for (name, _, svg) in &drawings {
        out.write(format!("figures/{name}.svg"), svg)?;
    }
    out.write("index.html", page::render(sweep, &drawings))?;
    Ok(out.commit()?)
}

/// Returns `results.json` of a sweep.
///
/// # Errors
/// When a value has no JSON form. This does not occur in sweeps of this project.
pub fn sweep_json(sweep: &Sweep) -> io::Result<String> {
    let mut bytes = Vec::new();
    table::write_results(sweep, &mut bytes)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point without an expectation shows nothing about the solver, so it does not count as within the tolerance.
    #[test]
    fn a_point_that_is_not_judged_is_not_within() {
        let looked = |verdict| QuantityResult { verdict, ..QuantityResult::default() };
        let point = |verdicts: &[Option<Outcome>]| Point {
            left: PointOutput { looked: verdicts.iter().copied().map(looked).collect(), ..PointOutput::default() },
            ..Point::default()
        };
        for (verdicts, severity) in [
            (&[None][..], None),
            (&[], None),
            (&[None, Some(Outcome::Pass)], Some(Severity::Green)),
            (&[None, Some(Outcome::NoReference)], Some(Severity::Amber)),
            (&[Some(Outcome::Pass), Some(Outcome::Fail)], Some(Severity::Red)),
        ] {
            assert_eq!(point(verdicts).severity(), severity, "{verdicts:?}");
        }
    }
}
