//! Trend over several reports: outcomes and counts side by side, written as `trend.html`.

use crate::number;
use crate::page::{captioned, shell, sign};
use crate::row;
use crate::store::SaveError;
use crate::table::{Cell, Column as Head, Format, Row, Table};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::verdict::{Outcome, Severity};
use grainbench_store::artifact::read_json;
use grainbench_store::{ReadError, StagedDir};
use maud::{Markup, html};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Largest number of changed results that are listed.
const MOST: usize = 400;
/// Names of the counts of runs, in the order of the tables.
const COUNTED: [&str; 5] = ["steps", "particle_steps", "contact_evaluations", "node_updates", "pair_tests"];

/// A report as a column of the trend.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name of the report.
    name: String,
    commit: String,
    date: String,
    /// Outcome of each result, by the key of the result.
    rows: BTreeMap<String, Outcome>,
    /// Counts of each run, by the key of the run.
    runs: BTreeMap<String, BTreeMap<&'static str, u64>>,
}

/// The parts of `results.json` that the trend uses.
#[derive(Deserialize)]
struct Results {
    provenance: ReportProvenance,
    #[serde(default)]
    verdicts: Vec<Map<String, Value>>,
    #[serde(default)]
    points: Vec<Map<String, Value>>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct ReportProvenance {
    commit: String,
    date: String,
}

/// Returns the key of a result or a run: its descriptive fields, joined as words.
fn key(about: &Map<String, Value>) -> String {
    const PARTS: [&str; 7] = ["case", "variant", "set", "solver", "resolution", "knobs", "quantity"];
    let words = PARTS.iter().filter_map(|part| match about.get(*part)? {
        Value::String(word) if word.is_empty() => None,
        Value::String(word) => Some(word.clone()),
        Value::Object(knobs) => {
            let knobs: Vec<String> = knobs.iter().map(|(name, value)| format!("{name}={value}")).collect();
            Some(knobs.join(" ")).filter(|words| !words.is_empty())
        }
        _ => None,
    });
    words.collect::<Vec<_>>().join(" · ")
}

impl Column {
    /// Reads a report from its `results.json`.
    ///
    /// # Errors
    /// When the file is missing, damaged or not a valid `results.json`.
    pub fn read(name: &str, path: &Path) -> Result<Self, ReadError> {
        let Results { provenance, verdicts, points } = read_json(path)?;
        let outcome = |row: &Map<String, Value>| row.get("verdict").map_or(Ok(None), Option::<Outcome>::deserialize);
        let rows = verdicts.iter().map(|row| Ok(outcome(row)?.map(|outcome| (key(row), outcome))));
        let rows = rows.filter_map(Result::transpose).collect::<Result<_, serde_json::Error>>();
        let rows = rows.map_err(|error| ReadError::other(path, "outcomes of results", error.to_string()))?;
        let counts = |point: &Map<String, Value>| {
            // In a study, the counts of a point are in an object of their own.
            let inner = point.get("counts").and_then(Value::as_object).unwrap_or(point);
            COUNTED.iter().filter_map(|name| Some((*name, inner.get(*name)?.as_u64()?))).collect()
        };
        let runs = points.iter().map(|point| (key(point), counts(point))).collect();
        Ok(Self { name: name.to_owned(), commit: provenance.commit, date: provenance.date, rows, runs })
    }

    fn count(&self, severity: Severity) -> u64 {
        self.rows.values().filter(|outcome| outcome.severity() == severity).count() as u64
    }

    /// Returns the sum of a count over the runs that are in all reports.
    fn sum(&self, name: &str, shared: &[&String]) -> u64 {
        shared.iter().filter_map(|run| self.runs.get(*run)?.get(name)).sum()
    }
}

/// Labels of the colours, with the severities.
const KINDS: [(&str, Severity); 3] =
    [("pass", Severity::Green), ("fail, broken or stale", Severity::Red), ("amber", Severity::Amber)];

/// Adds `trend.html` to the directory of a report. The columns are in order of time, and the last is this report.
///
/// # Errors
/// When a file cannot be written.
pub fn write_trend(dir: impl AsRef<Path>, columns: &[Column]) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    out.write("trend.html", render(columns))?;
    // The other files of the directory stay unchanged.
    Ok(out.commit_beside()?)
}

fn render(columns: &[Column]) -> String {
    let shared: Vec<&String> = columns.first().map_or_else(Vec::new, |first| {
        first.runs.keys().filter(|run| columns.iter().all(|column| column.runs.contains_key(*run))).collect()
    });
    let mut figures = vec![verdicts(columns)];
    figures.extend(counts(columns, &shared));
    let body = html! {
        main.alone {
            header id="summary" {
                p.kicker { "grainbench" }
                h1 { "The trend over " (columns.len()) " reports" }
                p.lead { "Verdicts and operation counts, from the oldest report to this one. Counts do not depend on \
                          the machine, so a change shows that the program changed." }
            }
            @for figure in &figures { (captioned(figure)) }
            (table(columns, &shared))
            (changed_rows(columns))
            (changed_counts(columns, &shared))
        }
    };
    shell("grainbench · trend", &body)
}

fn verdicts(columns: &[Column]) -> Figure {
    let curve = |(label, severity): &(&str, Severity)| {
        let points =
            columns.iter().zip(1_u32..).map(|(column, at)| (f64::from(at), column.count(*severity) as f64)).collect();
        Curve::new(*label, Stroke::MarkedLine, points)
    };
    Figure::graph(
        "trend-verdicts",
        "Results by outcome",
        "The reports from left to right, in the order of the table below.",
        [Axis::linear("report"), Axis::linear("rows")],
        KINDS.iter().map(curve).collect(),
    )
}

/// Returns the figure of counts, each divided by the count of the first report.
fn counts(columns: &[Column], shared: &[&String]) -> Option<Figure> {
    let first = columns.first()?;
    let curve = |name: &&str| {
        let one = first.sum(name, shared) as f64;
        let part = |(column, at): (&Column, u32)| (f64::from(at), column.sum(name, shared) as f64 / one);
        Curve::new(name.replace('_', " "), Stroke::MarkedLine, columns.iter().zip(1_u32..).map(part).collect())
    };
    let curves: Vec<Curve> = COUNTED.iter().filter(|name| first.sum(name, shared) > 0).map(curve).collect();
    (!curves.is_empty()).then(|| {
        Figure::graph(
            "trend-counts",
            "Operation counts relative to the first report",
            "Sums over the runs that are in all reports.",
            [Axis::linear("report"), Axis::linear("count / count in the first report")],
            curves,
        )
    })
}

fn table(columns: &[Column], shared: &[&String]) -> Markup {
    let heads = ["Report", "Name", "Commit", "Date", "Pass", "Fail, broken or stale", "Amber"].map(Head::text);
    let heads = heads.into_iter().chain(COUNTED.map(|name| Head::new(name.replace('_', " "), Format::Count)));
    let row = |(at, column): (usize, &Column)| {
        let names = [&column.name, &column.commit, &column.date].map(Cell::from);
        let outcomes = KINDS.map(|(_, severity)| Cell::from(column.count(severity)));
        let counts = COUNTED.map(|name| Cell::from(column.sum(name, shared)));
        [Cell::from(at + 1)].into_iter().chain(names).chain(outcomes).chain(counts).collect()
    };
    let table = Table::new("Reports", heads, columns.iter().enumerate().map(row));
    html! { section id="reports" { h2 { "Reports" } (table.page("")) } }
}

/// Renders a section with the rows that differ between reports, at most [`MOST`].
fn changed<'a>(id: &str, none: &str, count: usize, table: Table<'a>) -> Markup {
    html! {
        section id=(id) {
            h2 { (table.name) }
            @if count == 0 { p { (none) } }
            @else {
                @if count > MOST { p.note { "The first " (MOST) " of " (number::count(count as u64)) "." } }
                (table.page(""))
            }
        }
    }
}

/// Renders a table of the results whose outcome differs between reports.
fn changed_rows(columns: &[Column]) -> Markup {
    let mut names: BTreeSet<&String> = columns.iter().flat_map(|column| column.rows.keys()).collect();
    let outcomes = |name: &String| -> Vec<Option<Outcome>> {
        columns.iter().map(|column| column.rows.get(name).copied()).collect()
    };
    names.retain(|name| outcomes(name).windows(2).any(|pair| pair[0] != pair[1]));
    let count = names.len();
    let cell = |outcome: Option<Outcome>| {
        let (symbol, class) = outcome.map_or(("", ""), sign);
        let word = outcome.map_or("—", Outcome::word);
        Cell::from(html! { span class={ "mark " (class) } { (symbol) " " (word) } })
    };
    let row = |name: &&String| [Cell::from(*name)].into_iter().chain(outcomes(name).into_iter().map(cell)).collect();
    let heads = [Head::heading("Row")].into_iter().chain((1..=columns.len()).map(|at| Head::text(at.to_string())));
    let table = Table::new("Rows that changed", heads, names.iter().take(MOST).map(row));
    changed("rows", "None: every result has the same outcome in all reports.", count, table)
}

/// Renders a table of the runs whose counts differ between consecutive reports.
fn changed_counts(columns: &[Column], shared: &[&String]) -> Markup {
    let mut lines: Vec<Row> = Vec::new();
    for run in shared {
        for (at, pair) in columns.windows(2).enumerate() {
            let [before, after] = [&pair[0].runs[*run], &pair[1].runs[*run]];
            for name in COUNTED.iter().filter(|name| before.get(*name) != after.get(*name)) {
                let count =
                    |counts: &BTreeMap<&str, u64>| counts.get(name).map_or("—".to_owned(), |n| number::count(*n));
                let change = format!("{} → {}", count(before), count(after));
                lines.push(row![*run, format!("{} to {}", at + 1, at + 2), name.replace('_', " "), change]);
            }
        }
    }
    let heads = ["Run", "Reports", "Count", "Change"].map(Head::text);
    let count = lines.len();
    let table = Table::new("Counts that changed", heads, lines.into_iter().take(MOST));
    changed("counts", "None: each run has the same counts in all reports.", count, table)
}
