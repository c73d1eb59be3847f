//! Table of a sweep, with one row for each point, solver, level and quantity.

use super::{Point, Sweep};
use crate::results::expectation;
use crate::table::{Cell, Column, Table};
use grainbench_harness::statistics::range;
use grainbench_harness::verdict::Outcome;
use serde_json::Value;
use std::io::{self, Write};

/// Returns the table. Absent values are empty cells.
pub(super) fn table(sweep: &Sweep) -> Table<'_> {
    let [text, number] = [Column::text, Column::number] as [fn(&'static str) -> Column; 2];
    let are_numbers = |place: usize| sweep.points.iter().all(|point| point.factors[place].is_number());
    let is_number: Vec<bool> = (0..sweep.factors.len()).map(are_numbers).collect();
    let factors = sweep.factors.iter().zip(&is_number);
    let factors =
        factors.map(|(factor, &is)| if is { Column::number(&factor.name) } else { Column::text(&factor.name) });
    let columns = [text("case")].into_iter().chain(factors.collect::<Vec<_>>());
    let columns = columns.chain(["solver", "resolution", "quantity", "unit"].map(text));
    let columns = columns.chain(["value", "expected"].map(number)).chain([text("bound")]);
    let columns = columns.chain(["scale", "error", "allowed"].map(number)).chain(["verdict", "detail"].map(text));
    const COUNTS: [&str; 6] =
        ["steps", "particle_steps", "contact_evaluations", "node_updates", "time_step", "wall_seconds"];
    let rows = sweep.points.iter().flat_map(move |point| {
        let is_number = is_number.clone();
        let factor = move |(value, is): (&Value, bool)| match value {
            _ if is => Cell::from(value.as_f64()),
            Value::String(word) => word.into(),
            other => other.to_string().into(),
        };
        let values = point.factors.iter().zip(is_number).map(factor).collect::<Vec<_>>();
        point.left.looked.iter().zip(&sweep.quantities).map(move |(looked, quantity)| {
            let (expected, bound) = expectation(looked.expected);
            let detail = looked.detail.clone().or_else(|| point.left.detail.clone()).unwrap_or_default();
            let mut cells = vec![Cell::from(&sweep.scene)];
            cells.extend(values.iter().cloned());
            cells.extend([&point.solver, &point.resolution, &quantity.words, &quantity.unit].map(Cell::from));
            cells.extend([looked.value.into(), expected.into(), bound.into()]);
            cells.extend([looked.scale, looked.error, looked.allowed].map(Cell::from));
            cells.extend([looked.verdict.map_or("", Outcome::word).into(), detail.into()]);
            let ran = point.left.ran.as_ref();
            let counts =
                ran.map(|ran| [Some(ran.steps), Some(ran.particle_steps), ran.contact_evaluations, ran.node_updates]);
            cells.extend(counts.unwrap_or_default().map(|count| count.map(|count| count as f64).into()));
            cells.extend([ran.map(|ran| ran.time_step), wall(point)].map(Cell::from));
            cells.into_iter().collect()
        })
    });
    Table::new("rows", columns.chain(COUNTS.map(number)), rows)
}

/// Returns the median wall-clock time of the repetitions (s), or the wall-clock time of the single run.
fn wall(point: &Point) -> Option<f64> {
    let walls: Vec<f64> = point.left.timings.iter().map(|timing| timing.wall).collect();
    range(&walls).map(|[_, median, _]| median).or(point.left.ran.map(|ran| ran.wall_seconds))
}

/// Writes `results.json`, whose keys are a public interface, with one entry per result and the cost of each run. The
/// file is written in pieces, because 100,000 results take about 80 MB.
pub(super) fn write_results(sweep: &Sweep, out: &mut impl Write) -> io::Result<()> {
    let knobs = |point: &Point| -> serde_json::Map<String, Value> {
        let names = sweep.factors.iter().map(|factor| factor.name.clone());
        names.zip(point.factors.iter().cloned()).collect()
    };
    out.write_all(b"{\n  \"provenance\": ")?;
    serde_json::to_writer(&mut *out, &sweep.provenance)?;
    out.write_all(b",\n  \"verdicts\": [")?;
    let mut before = "\n    ";
    for point in &sweep.points {
        for (quantity, looked) in sweep.quantities.iter().zip(&point.left.looked) {
            let detail = looked.detail.as_ref().or(point.left.detail.as_ref());
            let row = serde_json::json!({
                "case": sweep.scene, "variant": "", "set": knobs(point), "solver": point.solver,
                "resolution": point.resolution, "quantity": quantity.words, "unit": quantity.unit, "value": looked.value,
                "expected": looked.expected, "scale": looked.scale, "error": looked.error, "allowed": looked.allowed,
                "source": quantity.source, "verdict": looked.verdict.map(Outcome::word), "detail": detail,
                "severity": looked.verdict.map(Outcome::severity),
            });
            out.write_all(before.as_bytes())?;
            serde_json::to_writer(&mut *out, &row)?;
            before = ",\n    ";
        }
    }
    out.write_all(b"\n  ],\n  \"controls\": [],\n  \"points\": [")?;
    before = "\n    ";
    for point in &sweep.points {
        let Some(ran) = &point.left.ran else { continue };
        let row = serde_json::json!({
            "case": sweep.scene, "set": knobs(point), "solver": point.solver, "resolution": point.resolution,
            "steps": ran.steps, "particle_steps": ran.particle_steps, "contact_evaluations": ran.contact_evaluations,
            "node_updates": ran.node_updates, "time_step": ran.time_step, "wall_seconds": wall(point),
            "repetitions": point.left.timings,
        });
        out.write_all(before.as_bytes())?;
        serde_json::to_writer(&mut *out, &row)?;
        before = ",\n    ";
    }
    out.write_all(b"\n  ]\n}\n")
}
