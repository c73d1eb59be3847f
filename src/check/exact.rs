//! Comparison of output with the exact solutions of a case.

use super::covered::CheckedOutput;
use super::judgement::judged;
use grainbench_harness::claim::Claim;
use grainbench_harness::run::FinishedRun;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_solver::record::{Cost, Provenance, Record, Series};
use std::sync::Arc;

/// Judges a claim of the case with the output. The tolerance is increased by the effect of the printed digits on the quantity.
pub(super) fn exact(claim: &Claim, output: &CheckedOutput<'_>) -> Verdict {
    let CheckedOutput { observed, covered, .. } = output;
    let scene = Arc::new(output.candidate.scene.clone());
    let done = |series: Series| FinishedRun::new(Arc::clone(&scene), Arc::new(record(output, series)));
    let measured = |series: Series| (claim.measure)(&[done(series)]);
    let row = Verdict {
        evidence: claim.evidence(),
        source: claim.source.words(),
        allowed: claim.tolerance.allowed(&[done(observed.series.clone())]),
        tolerance: claim.tolerance.made_without_estimate(),
        because: claim.tolerance.because.clone(),
        ..output.row(&claim.quantity, claim.unit)
    };
    if let Some(why) = covered.why_not() {
        return row.left(Outcome::NoReference, why);
    }
    let found = match measured(observed.series.clone()) {
        Ok(found) => found,
        Err(missing) => return row.left(Outcome::NoReference, missing.to_string()),
    };
    let mut open = 0.0;
    for (at, moves) in observed.uncertainty.iter().enumerate() {
        let moved = |sign: f64| {
            let mut series = observed.series.clone();
            series.values[at].iter_mut().zip(moves).for_each(|(value, by)| *value += sign * by);
            measured(series).map_or(0.0, |moved| (moved.error() - found.error()).abs())
        };
        if moves.iter().any(|by| *by > 0.0) {
            open += moved(1.0).max(moved(-1.0));
        }
    }
    let row = judged(row, open, output.outputs, &found);
    // If wrong values in the longest interval do not change the result, the result needs no sample there.
    let is_same = |part: f64| {
        let wrong = covered.with_wrong_sample(&observed.series, part).map(&measured);
        wrong.is_none_or(|wrong| wrong.is_ok_and(|wrong| wrong.error().to_bits() == found.error().to_bits()))
    };
    if is_same(1e3) && is_same(-1e3) { row } else { covered.dense(row) }
}

fn record(output: &CheckedOutput<'_>, series: Series) -> Record {
    let CheckedOutput { outputs, observed, .. } = output;
    let scene = &output.candidate.scene;
    let steps = observed.series.step.last().copied().unwrap_or_default();
    let critical = scene.critical_time_step();
    Record {
        provenance: Provenance {
            scene: scene.title.clone(),
            solver: outputs.name(),
            resolution: String::new(),
            time_step: outputs.time_step().unwrap_or(f64::NAN),
            critical_time_step: critical.is_finite().then_some(critical),
            effects: Vec::new(),
            options: Vec::new(),
        },
        series,
        snapshots: observed.snapshots.clone(),
        cost: Cost::of_program(steps, scene.grains.len(), f64::NAN),
    }
}
