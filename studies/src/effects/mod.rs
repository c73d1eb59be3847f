//! Effects study: the influence of each physical effect on the claims of a case.
//!
//! Each effect that a scene uses is switched off in turn, and the claims of the case are evaluated again. As in a
//! negative control, the solver gets the scene without the effect. The expected value is still computed from the scene
//! with the effect. Each effect that the scene does not use is turned on with a neutral value, which must not change
//! the result.

pub mod idle;
pub mod ledger;
pub mod scene;

use grainbench_reports::study::effects::{EffectResult, Entry};
use grainbench_scene::effect::Effect;
use grainbench_solver::record::Record;

/// Shortest run whose time is compared (s); the ratio of shorter runs is noise.
const SHORTEST: f64 = 0.1;

/// Returns the ratio of the times of two runs, or `None` if one of them is too short to time.
fn ratio_of_times(with: &Record, without: &Record) -> Option<f64> {
    let [with, without] = [with, without].map(|record| record.cost.wall_seconds);
    (with >= SHORTEST && without >= SHORTEST).then(|| with / without)
}

/// Returns the ratio of the numbers of particle-steps and contact evaluations of two runs.
fn ratio_of_counts(with: &Record, without: &Record) -> f64 {
    with.cost.work() as f64 / (without.cost.work() as f64).max(1.0)
}

/// Returns the entry of an effect that is not tested yet. `key` turns the effect on in the scene; `None` if the effect is off.
fn untested(case: &str, variant: &str, effect: Effect, key: Option<String>) -> Entry {
    Entry {
        case: case.to_owned(),
        variant: variant.to_owned(),
        effect: effect.word().to_owned(),
        on: key.is_some(),
        key: key.unwrap_or_default(),
        worth: EffectResult::Untold,
        shifts: Vec::new(),
        counts: None,
        time: None,
        tried: Vec::new(),
        detail: None,
    }
}

/// Completes the entry of an effect that is switched off in one of the runs: conclusion from the changes, and cost.
fn conclude(entry: &mut Entry, runs: Option<[&Record; 2]>) {
    entry.worth = match (entry.shifts.iter().any(|shift| shift.red), entry.shifts.is_empty()) {
        (true, _) => EffectResult::Needed,
        (false, false) => EffectResult::NotWorthSimulating,
        (false, true) => EffectResult::Untold,
    };
    if let Some([with, without]) = runs {
        entry.counts = Some(ratio_of_counts(with, without));
        entry.time = ratio_of_times(with, without);
    }
}
