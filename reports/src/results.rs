//! Result files for other programs.

use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::{ControlResult, Verdict};
use serde::Serialize;

use crate::report::{Provenance, Report};
use crate::row;
use crate::table::{Column, Format, Table};

/// Content of `results.json`, whose keys are a public interface.
#[derive(Serialize)]
struct Results<'a> {
    provenance: &'a Provenance,
    verdicts: Vec<&'a Verdict>,
    controls: Vec<&'a ControlResult>,
    points: Vec<Point<'a>>,
    /// True if the report passes, as the exit code states.
    passed: bool,
    /// Further reasons why the report is red, such as an interrupted run.
    red_because: &'a [String],
}

/// Cost of a run: one line of `points.csv`, and one entry of `points` in `results.json`.
#[derive(Serialize)]
struct Point<'a> {
    case: &'a str,
    variant: &'a str,
    solver: &'a str,
    resolution: &'a str,
    time_step: f64,
    fraction: Option<f64>,
    steps: u64,
    particle_steps: u64,
    contact_evaluations: Option<u64>,
    wall_seconds: f64,
}

fn points(report: &Report) -> impl Iterator<Item = Point<'_>> {
    report.sections.iter().flat_map(|section| {
        section.runs.iter().map(move |run| Point {
            case: &section.name,
            variant: &run.variant,
            solver: &run.solver,
            resolution: &run.resolution,
            time_step: run.time_step,
            fraction: run.fraction_of_critical,
            steps: run.steps,
            particle_steps: run.particle_steps,
            contact_evaluations: run.contact_evaluations,
            wall_seconds: run.wall_seconds,
        })
    })
}

/// Returns `results.json`: provenance, results, controls and costs of runs.
///
/// # Errors
/// When a value has no JSON form. This does not occur in reports of this project.
pub fn results_json(report: &Report) -> Result<String, serde_json::Error> {
    let results = Results {
        provenance: &report.provenance,
        verdicts: report.verdicts().collect(),
        controls: report.controls().collect(),
        points: points(report).collect(),
        passed: report.passes(),
        red_because: &report.red_because,
    };
    serde_json::to_string_pretty(&results).map(|text| text + "\n")
}

pub(crate) fn points_table(report: &Report) -> Table<'_> {
    let columns = ["case", "variant", "solver", "resolution"].map(Column::text).into_iter();
    let columns = columns.chain(["time_step", "fraction"].map(Column::number));
    let counts = ["steps", "particle_steps", "contact_evaluations"].map(|name| Column::new(name, Format::Count));
    let columns = columns.chain(counts).chain([Column::number("wall_seconds")]);
    let row = |point: Point<'_>| {
        let Point { case, variant, solver, resolution, time_step, fraction, steps, particle_steps, .. } = point;
        let (contacts, wall) = (point.contact_evaluations, point.wall_seconds);
        row![case, variant, solver, resolution, time_step, fraction, steps, particle_steps, contacts, wall]
    };
    Table::new("points", columns, points(report).map(row))
}

/// Returns an expectation as number and as bound. For a bound, a band or an order, the number is absent, and the text
/// contains the expectation in words.
pub(crate) fn expectation(expected: Option<ExpectedValue>) -> (Option<f64>, String) {
    let bound = expected.filter(|expected| matches!(expected, ExpectedValue::Bound(_)));
    (expected.and_then(ExpectedValue::value), bound.map_or_else(String::new, |bound| bound.to_string()))
}

/// Returns all results as a table: `rows.csv` and, if requested, Parquet.
pub(crate) fn rows_table(report: &Report) -> Table<'_> {
    let [text, number] = [Column::text, Column::number] as [fn(&'static str) -> Column; 2];
    let names = ["case", "variant", "solver", "resolution", "quantity", "unit"].map(text).into_iter();
    let columns = names.chain(["value", "expected"].map(number)).chain([text("bound")]);
    let columns = columns.chain(["scale", "error", "allowed"].map(number));
    let columns = columns.chain(["tolerance", "because", "evidence", "source", "verdict", "detail"].map(text));
    let row = |row: &Verdict| {
        let Verdict { case, variant, solver, resolution, quantity, unit, value, expected, .. } = row;
        let Verdict { scale, error, allowed, tolerance, because, evidence, source, outcome, detail, .. } = row;
        let ((expected, bound), detail) = (expectation(*expected), detail.as_deref().unwrap_or_default());
        let [tolerance, evidence, outcome] = [tolerance.word(), evidence.word(), outcome.word()];
        row![
            case, variant, solver, resolution, quantity, unit, *value, expected, bound, *scale, *error, *allowed,
            tolerance, because, evidence, source, outcome, detail
        ]
    };
    Table::new("rows", columns, report.verdicts().map(row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn results_have_the_agreed_keys() {
        let text = results_json(&sample::report()).unwrap();
        let results: serde_json::Value = serde_json::from_str(&text).unwrap();
        let row = &results["verdicts"][0];
        let keys = "case variant solver resolution quantity unit value expected scale error allowed evidence source verdict \
            severity";
        for key in keys.split(' ') {
            assert!(!row[key].is_null(), "{key}");
        }
        for key in ["version", "commit", "date", "machine", "rustc", "options"] {
            assert!(!results["provenance"][key].is_null(), "{key}");
        }
        assert!(results["controls"].is_array() && results["points"].is_array());
        // The sample has red results.
        assert_eq!(results["passed"], false);
    }

    #[test]
    fn points_have_a_header_even_without_runs() {
        let text = |report: &Report| points_table(report).csv_text();
        let mut report = sample::report();
        assert_eq!(text(&report).lines().nth(1).unwrap(), "backspin,,dem,dt=.1,2e-5,0.1,25000,25000,25000,0.001");
        report.sections.clear();
        assert_eq!(
            text(&report),
            "case,variant,solver,resolution,time_step,fraction,steps,particle_steps,contact_evaluations,wall_seconds\n"
        );
    }

    /// Both tables contain every result of the report, row by row.
    #[test]
    fn a_table_has_every_row() {
        let report = sample::report();
        let rows: Vec<&Verdict> = report.verdicts().collect();
        let text = rows_table(&report).csv_text();
        let mut table = csv::Reader::from_reader(text.as_bytes());
        let lines: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        let file = tempfile::tempfile().unwrap();
        rows_table(&report).parquet(&file).unwrap();
        let file = SerializedFileReader::new(file).unwrap();
        let packed: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert!(!rows.is_empty() && lines.len() == rows.len() && packed.len() == rows.len());
        for ((row, line), packed) in rows.iter().zip(&lines).zip(&packed) {
            assert_eq!([&line[0], &line[16]], [row.case.as_str(), row.outcome.word()]);
            assert_eq!(line[6].parse().ok(), row.value);
            assert_eq!((packed.get_string(0).ok(), packed.get_double(6).ok()), (Some(&row.case), row.value));
            assert_eq!(line[7].is_empty(), row.expected.and_then(ExpectedValue::value).is_none());
        }
    }
}
