//! Effects study of a scene without claims: changes of the probes if an effect is omitted, and cost of the effect.

use super::idle::{ratio_of_times, try_idly};
use grainbench_reports::study::effects::{EffectResult, Entry, Shift};
use grainbench_scene::effect::Effect;
use grainbench_scene::record::Record;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Method, Resolution, RunError, Solver};
use std::time::Duration;

/// Time limit for repeated runs that test an absent effect. The minimum number of runs may exceed it.
const PATIENCE: Duration = Duration::from_millis(300);

/// Scene, solver and resolution of an effects study.
pub struct StudyInput<'a> {
    /// Name of the scene.
    pub name: String,
    /// Scene whose effects are evaluated.
    pub scene: &'a Scene,
    /// Solver that runs the scene with and without each effect.
    pub solver: &'a dyn Solver,
    /// Resolution of all runs.
    pub resolution: Resolution,
    /// Smallest relevant change of a probe column, relative to the largest absolute value of the column.
    pub matters: f64,
}

impl StudyInput<'_> {
    /// Runs the unchanged scene.
    ///
    /// # Errors
    /// When the solver cannot run the scene.
    pub fn whole(&self) -> Result<Record, RunError> {
        self.solver.run(self.scene, &self.resolution, &mut ())
    }

    /// Evaluates an effect. An effect that the scene uses is switched off; another effect is tested with its neutral
    /// value.
    ///
    /// Returns `None` if the effect has no neutral value or the solver does not support the effect.
    #[must_use]
    pub fn entry(&self, whole: &Record, effect: Effect) -> Option<Entry> {
        if Method::from_name(&self.solver.name()).is_some_and(|method| !effect.concerns(method)) {
            return None;
        }
        let key = effect.key(self.scene);
        let mut entry = Entry {
            case: self.name.clone(),
            variant: String::new(),
            effect: effect.word().to_owned(),
            on: key.is_some(),
            key: key.unwrap_or_default(),
            worth: EffectResult::Untold,
            shifts: Vec::new(),
            counts: None,
            time: None,
            tried: Vec::new(),
        };
        if entry.on {
            self.switched_off(whole, effect, &mut entry)
        } else {
            self.idly(effect, &mut entry)?
        }
        Some(entry)
    }

    fn switched_off(&self, whole: &Record, effect: Effect, entry: &mut Entry) {
        let mut without = self.scene.clone();
        effect.switch_off(&mut without);
        // The time step is computed from the unchanged scene.
        let resolution = match self.resolution.steps(self.scene) {
            Ok((step, _)) => Resolution::TimeStep(step),
            Err(_) => self.resolution,
        };
        let record = self.solver.run(&without, &resolution, &mut ()).ok();
        for (at, column) in whole.series.columns.iter().enumerate() {
            let moved = record.as_ref().map_or(Some(f64::NAN), |record| farthest(whole, record, at));
            // Columns without values are skipped.
            let Some(moved) = moved else { continue };
            entry.shifts.push(Shift {
                quantity: column.name.clone(),
                solver: self.solver.name(),
                with: Some(0.0),
                without: Some(moved).filter(|moved| moved.is_finite()),
                allowed: self.matters,
                red: !moved.is_finite() || moved > self.matters,
            });
        }
        entry.worth = match (entry.shifts.iter().any(|shift| shift.red), entry.shifts.is_empty()) {
            (true, _) => EffectResult::Needed,
            (false, false) => EffectResult::NotWorthSimulating,
            (false, true) => EffectResult::Untold,
        };
        if let Some(record) = record {
            entry.counts = Some(whole.cost.work() as f64 / (record.cost.work() as f64).max(1.0));
            entry.time = ratio_of_times(whole, &record);
        }
    }

    fn idly(&self, effect: Effect, entry: &mut Entry) -> Option<()> {
        let idle = try_idly(self.solver, self.scene, &self.resolution, effect, PATIENCE).ok()??;
        entry.worth = if idle.same { EffectResult::Inert } else { EffectResult::NotInert };
        (entry.counts, entry.time) = (Some(idle.counts), idle.time);
        entry.tried.push(self.solver.name());
        Some(())
    }
}

/// Returns the largest difference of a column between two runs at equal samples, relative to the largest absolute value of
/// the column with the effect.
///
/// The result is NaN if the run without the effect has another number of samples or a value that is NaN. It is `None`
/// if the column is empty.
fn farthest(whole: &Record, without: &Record, column: usize) -> Option<f64> {
    let values = whole.series.values.get(column)?;
    let scale = values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |scale, value| scale.max(value.abs()));
    let others = without.series.column(&whole.series.columns.get(column)?.name).unwrap_or_default();
    if scale == 0.0 {
        // If the column is zero with the effect, any other value without the effect counts as a relative change of 1.
        let largest = others.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        return (!values.is_empty()).then_some(if largest > 0.0 { 1.0 } else { 0.0 });
    }
    if others.len() != values.len() {
        return Some(f64::NAN);
    }
    let off =
        values.iter().zip(others).filter(|(value, _)| value.is_finite()).map(|(value, other)| (other - value).abs());
    Some(off.fold(0.0, |most: f64, off| if off.is_nan() || most.is_nan() { f64::NAN } else { most.max(off) }) / scale)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use grainbench_dem::convention::Convention;
    use grainbench_dem::solver::Dem;
    use grainbench_scene::source::SceneSource;
    use std::path::Path;

    const ROLLS: &str = "title = 'A disc rolls'\ndimension = 2\ngravity = [1.0, -9.81]\nduration = 0.5\n\
        materials.m.density = 1000.0\n[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
        tangential_stiffness = 3.0e6\nfriction = 0.4\n[grains.disc]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.1]\n\
        [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
        [output]\nevery = 0.01\n[probes]\ndisc = { grain = 'disc' }\n";

    fn worth(effect: Effect, matters: f64) -> EffectResult {
        let source = SceneSource::from_text("rolls", Path::new(""), ROLLS);
        let scene = source.scene(&grainbench_scene::resolve::no_data_file).unwrap();
        let solver = Dem::new(Convention::DEFAULT);
        let resolution = Resolution::CriticalFraction(0.1);
        let asked = StudyInput { name: "rolls".to_owned(), scene: &scene, solver: &solver, resolution, matters };
        let whole = asked.whole().unwrap();
        asked.entry(&whole, effect).unwrap().worth
    }

    /// Without friction the disc slides 1.5 times as far and does not rotate.
    #[test]
    fn what_a_scene_needs_is_told_from_what_it_does_not() {
        assert_eq!(worth(Effect::Friction, 0.01), EffectResult::Needed);
        assert_eq!(worth(Effect::Cohesion, 0.01), EffectResult::Inert);
        // With a very large limit, no effect is needed.
        assert_eq!(worth(Effect::Friction, 1e3), EffectResult::NotWorthSimulating);
    }
}
