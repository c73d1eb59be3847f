//! Table of a sweep, with one row for each point, solver, level and quantity.

use super::{Point, QuantityResult, Sweep};
use crate::parts::Values;
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::Outcome;
use serde_json::Value;
use std::io::{self, Write};

/// Row of the table: a point, the index of a quantity, and the result of this quantity.
type Row<'a> = (&'a Point, usize, &'a QuantityResult);

fn rows(sweep: &Sweep) -> Vec<Row<'_>> {
    let point_rows = |point| -> Vec<Row<'_>> {
        let point: &Point = point;
        point.left.looked.iter().enumerate().map(|(at, looked)| (point, at, looked)).collect()
    };
    sweep.points.iter().flat_map(point_rows).collect()
}

/// Returns the columns of the table with their names. Absent values are null.
pub(super) fn columns(sweep: &Sweep) -> Vec<(String, Values)> {
    let rows = rows(sweep);
    let words = |value: &dyn Fn(&Row<'_>) -> String| Values::Word(rows.iter().map(value).collect());
    let optional = |value: &dyn Fn(&Row<'_>) -> Option<f64>| Values::Told(rows.iter().map(value).collect());
    let count = |value: &dyn Fn(&super::RunCounts) -> Option<u64>| {
        optional(&|(point, _, _)| point.left.ran.as_ref().and_then(value).map(|count| count as f64))
    };
    let mut columns = vec![("case".to_owned(), words(&|_| sweep.scene.clone()))];
    for (place, factor) in sweep.factors.iter().enumerate() {
        let are_numbers = sweep.points.iter().all(|point| point.factors[place].is_number());
        let values = if are_numbers {
            optional(&|(point, _, _)| point.factors[place].as_f64())
        } else {
            words(&|(point, _, _)| match &point.factors[place] {
                Value::String(word) => word.clone(),
                other => other.to_string(),
            })
        };
        columns.push((factor.name.clone(), values));
    }
    let bound = |looked: &QuantityResult| match looked.expected {
        Some(bound @ ExpectedValue::Bound(_)) => bound.to_string(),
        Some(ExpectedValue::Value(_)) | None => String::new(),
    };
    let detail = |point: &Point, looked: &QuantityResult| {
        looked.detail.clone().or(point.left.detail.clone()).unwrap_or_default()
    };
    let rest: [(&str, Values); 18] = [
        ("solver", words(&|(point, _, _)| point.solver.clone())),
        ("resolution", words(&|(point, _, _)| point.resolution.clone())),
        ("quantity", words(&|(_, at, _)| sweep.quantities[*at].words.clone())),
        ("unit", words(&|(_, at, _)| sweep.quantities[*at].unit.clone())),
        ("value", optional(&|(_, _, looked)| looked.value)),
        ("expected", optional(&|(_, _, looked)| looked.expected.and_then(ExpectedValue::value))),
        ("bound", words(&|(_, _, looked)| bound(looked))),
        ("scale", optional(&|(_, _, looked)| looked.scale)),
        ("error", optional(&|(_, _, looked)| looked.error)),
        ("allowed", optional(&|(_, _, looked)| looked.allowed)),
        ("verdict", words(&|(_, _, looked)| looked.verdict.map_or("", Outcome::word).to_owned())),
        ("detail", words(&|(point, _, looked)| detail(point, looked))),
        ("steps", count(&|ran| Some(ran.steps))),
        ("particle_steps", count(&|ran| Some(ran.particle_steps))),
        ("contact_evaluations", count(&|ran| ran.contact_evaluations)),
        ("node_updates", count(&|ran| ran.node_updates)),
        ("time_step", optional(&|(point, _, _)| point.left.ran.map(|ran| ran.time_step))),
        ("wall_seconds", optional(&|(point, _, _)| wall(point))),
    ];
    columns.extend(rest.map(|(name, values)| (name.to_owned(), values)));
    columns
}

/// Returns the median wall-clock time of the repetitions (s), or the wall-clock time of the single run.
pub(super) fn wall(point: &Point) -> Option<f64> {
    let walls: Vec<f64> = point.left.timings.iter().map(|timing| timing.wall).collect();
    if walls.is_empty() {
        return point.left.ran.map(|ran| ran.wall_seconds);
    }
    Some(grainbench_harness::statistics::median(&walls))
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
