//! Whether a program that is installed still gives a stored run.

use grainbench_cases::stored::Reference;
use grainbench_cases::verdict::{Evidence, Outcome, Verdict};
use grainbench_reference::live::Live;
use grainbench_reference::statistics::{BLOCKS, Estimate, difference};
use grainbench_reference::stored::{Drift, StoredRun, drift, folder, unusable};
use grainbench_scene::error::SceneError;
use grainbench_scene::record::Series;
use grainbench_scene::solver::{RunError, Solver};

/// How far a rerun may be off for as long as it can be predicted, in units of what moves: a thousand times what one unit
/// in the last place of one position has grown to by then, for another build and processor round every sum otherwise.
pub const ALLOWED: f64 = 1e-6;

/// Reruns a stored run: a row for as long as it can be predicted, and one for what comes after.
///
/// # Errors
/// When the scene of the case is wrong.
pub fn verify(of: &Reference) -> Result<Vec<Verdict>, SceneError> {
    let scene = of.scene()?;
    let row = Verdict {
        case: of.case.name.to_owned(),
        variant: of.id.clone(),
        solver: of.program.name().to_owned(),
        resolution: of.run.resolution.to_string(),
        quantity: "the stored run, run again".to_owned(),
        unit: "1".to_owned(),
        value: None,
        expected: None,
        scale: None,
        error: None,
        allowed: ALLOWED,
        because: String::new(),
        evidence: Evidence::OtherCode,
        source: String::new(),
        outcome: Outcome::NoReference,
        detail: None,
    };
    let directory = folder(of.program, &of.id);
    if !directory.is_dir() {
        return Ok(vec![Verdict { detail: Some("nothing is stored of that name".to_owned()), ..row }]);
    }
    let ended = |error: &RunError| {
        vec![Verdict { outcome: Outcome::from(error), detail: Some(error.to_string()), ..row.clone() }]
    };
    let stored = match StoredRun::load(&directory) {
        Ok(stored) => stored,
        // A damaged file is a failure of ours, not of the program.
        Err(error) => {
            let verdicts = ended(&unusable(of.program, &error));
            return Ok(verdicts.into_iter().map(|row| Verdict { outcome: Outcome::Fail, ..row }).collect());
        }
    };
    if let Err(error) = stored.record(&scene, &of.run.resolution, of.program) {
        return Ok(ended(&error));
    }
    let rerun = match Live::find(of.program).run(&scene, &of.run.resolution, &mut ()) {
        Ok(rerun) => rerun,
        Err(error) => return Ok(ended(&error)),
    };
    let provenance = stored.provenance();
    let source = format!(
        "{}, stored on {}; run again with {}",
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

/// What is not a number is worse than anything else.
fn weight(drift: &Drift) -> f64 {
    if drift.error().is_nan() { f64::INFINITY } else { drift.error().abs() }
}

fn pointwise(row: &Verdict, worst: &Drift, last: u64) -> Verdict {
    let error = worst.error();
    let until = if last == u64::MAX { String::new() } else { format!(" to step {last}") };
    let passes = error.abs() <= ALLOWED;
    Verdict {
        quantity: format!("the stored run, run again{until}: worst in {}", worst.name),
        unit: worst.unit.clone(),
        value: Some(worst.rerun).filter(|value| value.is_finite()),
        expected: Some(worst.stored),
        scale: Some(worst.scale),
        error: Some(error).filter(|error| error.is_finite()),
        because: "a thousand times what one unit in the last place of one position grows to; in units of what moves"
            .to_owned(),
        outcome: if passes { Outcome::Pass } else { Outcome::Fail },
        detail: (!passes).then(|| format!("at t = {:.6} s", worst.time)),
        ..row.clone()
    }
}

/// Means over what cannot be predicted: of sums over all grains, for single grains have none.
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
        let error = (second - first) / scale;
        verdicts.push(Verdict {
            quantity: format!("mean of {} after step {last}", column.name),
            unit: column.unit.clone(),
            value: Some(second).filter(|value| value.is_finite()),
            expected: Some(first),
            scale: Some(scale),
            error: Some(error).filter(|error| error.is_finite()),
            allowed: 1.0,
            because: format!("99 % confidence interval of the difference, from {BLOCKS} blocks"),
            outcome: if error.abs() <= 1.0 { Outcome::Pass } else { Outcome::Fail },
            ..row.clone()
        });
    }
    verdicts
}
