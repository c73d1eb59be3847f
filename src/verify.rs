//! Comparison of a stored run with a new run by the installed program.

use grainbench_cases::stored::Reference;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::Measurement;
use grainbench_harness::statistics::{BLOCKS, Estimate, difference};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::live::LiveProgram;
use grainbench_reference::stored::{Drift, StoredRun, drift, folder, unusable};
use grainbench_scene::error::SceneError;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Series;

/// Largest accepted |difference| of the new run while the run is predictable, divided by the extent of the column.
/// During this time, a rounding error of one unit in the last place of one position grows to a thousandth of this
/// limit. Other builds and processors round every sum differently.
const ALLOWED: f64 = 1e-6;

/// Repeats a stored run and compares both runs, sample by sample while the run is predictable, and by means after that.
///
/// # Errors
/// When the scene of the case is invalid.
pub fn verify(reference: &Reference) -> Result<Vec<Verdict>, SceneError> {
    let scene = reference.scene()?;
    let row = Verdict {
        variant: reference.id.clone(),
        solver: reference.program.name().to_owned(),
        resolution: reference.run.resolution.to_string(),
        allowed: ALLOWED,
        tolerance: ToleranceOrigin::Computed,
        evidence: Evidence::OtherCode,
        ..Verdict::open(reference.case.name, "the stored run, repeated", "1")
    };
    let directory = folder(reference.program, &reference.id);
    if !directory.is_dir() {
        return Ok(vec![row.left(Outcome::NoReference, "nothing is stored under this name")]);
    }
    let ended = |error: &RunError| vec![row.clone().ended(error)];
    let stored = match StoredRun::load(&directory) {
        Ok(stored) => stored,
        // A damaged stored file is an error of our project, not of the external program.
        Err(error) => {
            return Ok(vec![row.left(Outcome::Fail, unusable(reference.program, &error).to_string())]);
        }
    };
    if let Err(error) = stored.record(&scene, &reference.run.resolution, reference.program) {
        return Ok(ended(&error));
    }
    let rerun = match LiveProgram::find(reference.program).run(&scene, &reference.run.resolution, &mut ()) {
        Ok(rerun) => rerun,
        Err(error) => return Ok(ended(&error)),
    };
    let provenance = &stored.provenance;
    let source = format!(
        "{}, stored on {}; repeated with {}",
        provenance.version,
        provenance.date,
        rerun.provenance.options.join(", ")
    );
    let row = Verdict { source, ..row };
    let before = stored.series(&scene);
    let last = provenance.predictable_steps.unwrap_or(u64::MAX);
    let mut verdicts = Vec::new();
    let worst = drift(&before, &rerun.series, last).into_iter().max_by(|a, b| weight(a).total_cmp(&weight(b)));
    if let Some(worst) = worst {
        verdicts.push(pointwise(&row, &worst, last));
    }
    if provenance.predictable_steps.is_some() {
        verdicts.extend(statistics(&row, &before, &rerun.series, last));
    }
    Ok(verdicts)
}

/// Returns the magnitude of a difference; infinity for NaN.
fn weight(drift: &Drift) -> f64 {
    if drift.error().is_nan() { f64::INFINITY } else { drift.error().abs() }
}

fn pointwise(row: &Verdict, worst: &Drift, last: u64) -> Verdict {
    let until = if last == u64::MAX { String::new() } else { format!(" to step {last}") };
    let found = Measurement {
        course: vec![(worst.time, worst.error())],
        ..Measurement::new(worst.rerun, worst.stored, worst.scale)
    };
    let row = Verdict {
        quantity: format!("the stored run, repeated{until}: worst in {}", worst.name),
        unit: worst.unit.clone(),
        because: "a thousand times the final effect of one unit in the last place of one position, relative to the \
                  motion"
            .to_owned(),
        ..row.clone()
    };
    row.judged(&found)
}

/// Compares means over the part of a run that is not predictable. Only quantities of the whole system are compared,
/// because means of single grains are not reproducible.
fn statistics(row: &Verdict, before: &Series, rerun: &Series, last: u64) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    let places: Vec<usize> = (0..before.step.len()).filter(|&at| before.step[at] > last).collect();
    for (column, values) in before.columns.iter().zip(&before.values) {
        let of_grain = ["m", "m/s", "rad/s", "rad"].contains(&column.unit.as_str());
        let Some(of_rerun) = rerun.column(&column.name).filter(|_| !of_grain) else { continue };
        let again =
            |at: usize| rerun.step.binary_search(&before.step[at]).ok().and_then(|at| of_rerun.get(at).copied());
        let old: Vec<f64> = places.iter().map(|&at| values[at]).collect();
        let new: Vec<f64> = places.iter().map(|&at| again(at).unwrap_or(f64::NAN)).collect();
        let Some(Estimate { first, second, half_width }) = difference(&old, &new, BLOCKS) else { continue };
        let scale = if half_width > 0.0 { half_width } else { first.abs().max(f64::MIN_POSITIVE) };
        let row = Verdict {
            quantity: format!("mean of {} after step {last}", column.name),
            unit: column.unit.clone(),
            allowed: 1.0,
            tolerance: ToleranceOrigin::Interval,
            because: format!("99 % confidence interval of the difference, from {BLOCKS} blocks"),
            ..row.clone()
        };
        verdicts.push(row.judged(&Measurement::new(second, first, scale)));
    }
    verdicts
}
