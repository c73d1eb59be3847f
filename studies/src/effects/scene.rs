//! Effects study of a scene without claims: changes of the probes if an effect is omitted, and cost of the effect.

use super::idle::try_idly;
use super::{conclude, untested};
use crate::chaos::{change_of_mean, farthest, perturbed_runs};
use grainbench_reports::study::effects::{EffectResult, Entry, Shift};
use grainbench_scene::effect::Effect;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

/// Smallest relevant change of a mean in a chaotic scene, divided by the largest change in the perturbed runs. For normally
/// distributed means and four perturbed runs, an effect without influence exceeds it in 0.11 % of columns.
const SCATTER: f64 = 5.0;

/// Runs of the unchanged scene.
pub struct WholeRuns {
    /// Run of the scene.
    pub record: Record,
    /// Runs of the perturbed scene, if it is chaotic: a tiny displacement of one grain changes a probe column by more than
    /// the relevant change. Otherwise empty.
    pub perturbed: Vec<Record>,
}

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
    /// Smallest relevant change of a probe column, relative to the largest absolute value of the probe in this unit.
    pub matters: f64,
}

impl StudyInput<'_> {
    /// Runs the unchanged scene, and perturbed scenes if it is chaotic.
    ///
    /// # Errors
    /// When the solver cannot run the scene.
    pub fn whole(&self) -> Result<WholeRuns, RunError> {
        let record = self.solver.run(self.scene, &self.resolution, &mut ())?;
        let mut run = |scene: &Scene| self.solver.run(scene, &self.resolution, &mut ());
        let perturbed = perturbed_runs(self.scene, &record, self.matters, &mut run)?;
        Ok(WholeRuns { record, perturbed })
    }

    /// Evaluates an effect. An effect that the scene uses is switched off; another effect is tested with its neutral
    /// value. If the run without the effect ends with an error, the influence of the effect is unknown.
    ///
    /// Returns `None` if the effect has no neutral value or the solver does not support the effect.
    #[must_use]
    pub fn entry(&self, whole: &WholeRuns, effect: Effect) -> Option<Entry> {
        if Method::from_name(&self.solver.name()).is_some_and(|method| !effect.concerns(method)) {
            return None;
        }
        let mut entry = untested(&self.name, "", effect, effect.key(self.scene));
        if entry.on {
            self.switched_off(whole, effect, &mut entry)
        } else {
            self.idly(effect, &mut entry)?
        }
        Some(entry)
    }

    fn switched_off(&self, runs: &WholeRuns, effect: Effect, entry: &mut Entry) {
        let whole = &runs.record;
        let difference = if runs.perturbed.is_empty() { farthest } else { change_of_mean };
        let mut without = self.scene.clone();
        effect.switch_off(&mut without);
        // The time step is computed from the unchanged scene.
        let resolution = match self.resolution.steps(self.scene) {
            Ok((step, _)) => Resolution::TimeStep(step),
            Err(_) => self.resolution,
        };
        let record = match self.solver.run(&without, &resolution, &mut ()) {
            Ok(record) => record,
            Err(error) => {
                entry.detail = Some(format!("no result without it: {error}"));
                return;
            }
        };
        let difference = |other: &Record, at: usize| difference(self.scene, whole, other, at);
        for (at, column) in whole.series.columns.iter().enumerate() {
            // Columns without values are skipped.
            let Some(moved) = difference(&record, at) else { continue };
            let scatter = runs.perturbed.iter().filter_map(|other| difference(other, at)).fold(0.0, f64::max);
            let allowed = self.matters.max(SCATTER * scatter);
            entry.shifts.push(Shift {
                quantity: column.name.clone(),
                solver: self.solver.name(),
                with: Some(0.0),
                without: Some(moved).filter(|moved| moved.is_finite()),
                allowed,
                red: !moved.is_finite() || moved > allowed,
            });
        }
        conclude(entry, Some([whole, &record]));
    }

    /// Tests the neutral value of an effect, if the method of the solver leaves the effect out when it is off. A rigid-body
    /// engine, for example, moves a wall by another kind of body.
    fn idly(&self, effect: Effect, entry: &mut Entry) -> Option<()> {
        let method = Method::from_name(&self.solver.name());
        if method.is_some_and(|method| !effect.left_out_by().contains(&method)) {
            return None;
        }
        let idle = try_idly(self.solver, self.scene, &self.resolution, effect).ok()??;
        entry.worth = if idle.same { EffectResult::Inert } else { EffectResult::NotInert };
        (entry.counts, entry.time) = (Some(idle.counts), idle.time);
        entry.tried.push(self.solver.name());
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_dem::convention::Convention;
    use grainbench_dem::solver::Dem;

    const ROLLS: &str = "title = 'A disc rolls'\ndimension = 2\ngravity = [1.0, -9.81]\nduration = 0.5\n\
        materials.m.density = 1000.0\n[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
        tangential_stiffness = 3.0e6\nfriction = 0.4\n[grains.disc]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.1]\n\
        [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
        [output]\nevery = 0.01\n[probes]\ndisc = { grain = 'disc' }\n";

    fn worth(effect: Effect, matters: f64) -> EffectResult {
        worth_in(ROLLS, effect, matters)
    }

    fn worth_in(text: &str, effect: Effect, matters: f64) -> EffectResult {
        let scene = Scene::from_text("scene", text).unwrap();
        let solver = Dem::new(Convention::DEFAULT);
        let resolution = Resolution::CriticalFraction(0.1);
        let asked = StudyInput { name: "rolls".to_owned(), scene: &scene, solver: &solver, resolution, matters };
        let whole = asked.whole().unwrap();
        asked.entry(&whole, effect).unwrap().worth
    }

    /// Without friction the disc slides 1.5 times as far and does not rotate.
    #[test]
    fn needed_and_unneeded_effects_differ() {
        assert_eq!(worth(Effect::Friction, 0.01), EffectResult::Needed);
        assert_eq!(worth(Effect::Cohesion, 0.01), EffectResult::Inert);
        // With a very large limit, no effect is needed.
        assert_eq!(worth(Effect::Friction, 1e3), EffectResult::NotWorthSimulating);
    }

    /// A distant disc falls with damping. Without damping it moves by more than its radius in a step, and the run ends with an
    /// error. The probed disc is at rest, so the error does not show that it needs the damping.
    #[test]
    fn an_error_without_an_effect_is_no_need_for_it() {
        let text = "title = 'Two discs'\ndimension = 2\ngravity = [0.0, -10.0]\nduration = 12.0\n\
            global_damping = 100.0\nmaterials.m.density = 1000.0\n[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
            restitution = 0.5\n\
            [grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.1]\n\
            [grains.b]\nmaterial = 'm'\nradius = 1.0e-3\nposition = [5.0, 500.0]\n\
            [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
            [output]\nevery = 0.1\n[probes]\na = { grain = 'a' }\n";
        let scene = Scene::from_text("scene", text).unwrap();
        let solver = Dem::new(Convention::DEFAULT);
        let resolution = Resolution::CriticalFraction(0.5);
        let asked = StudyInput { name: "two".to_owned(), scene: &scene, solver: &solver, resolution, matters: 0.01 };
        let whole = asked.whole().unwrap();
        let entry = asked.entry(&whole, Effect::GlobalDamping).unwrap();
        assert_eq!((entry.worth, entry.shifts.len()), (EffectResult::Untold, 0), "{entry:?}");
        assert!(entry.detail.is_some_and(|detail| detail.contains("radius")));
    }

    /// In a gas of discs, a restitution of 1 − 10⁻⁹ changes all later positions but no mean. A lower one takes energy.
    #[test]
    fn chaos_is_not_taken_for_an_effect() {
        let gas = |restitution: &str| {
            format!(
                "title = 'A gas'\ndimension = 2\nduration = 4.0\nmaterials.m.density = 1000.0\n[contacts.m]\n\
                 between = ['m', 'm']\nnormal_stiffness = 1.0e6\nrestitution = {restitution}\n\
                 [grains.a]\nmaterial = 'm'\nradius = 0.1\nvelocity = [1.0, 0.3]\n\
                 lattice = {{ origin = [0.15, 0.15], spacing = [0.35, 0.35], count = [3, 3] }}\n\
                 [grains.b]\nmaterial = 'm'\nradius = 0.1\nvelocity = [-1.0, 0.7]\n\
                 lattice = {{ origin = [0.2, 1.25], spacing = [0.35, 0.35], count = [3, 3] }}\n[walls]\n\
                 left = {{ material = 'm', plane = {{ point = [0.0, 0.0], normal = [1.0, 0.0] }} }}\n\
                 right = {{ material = 'm', plane = {{ point = [1.2, 0.0], normal = [-1.0, 0.0] }} }}\n\
                 floor = {{ material = 'm', plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}\n\
                 lid = {{ material = 'm', plane = {{ point = [0.0, 2.3], normal = [0.0, -1.0] }} }}\n\
                 [output]\nevery = 0.02\n[probes]\nall = {{ system = true }}\n"
            )
        };
        assert_eq!(worth_in(&gas("0.999999999"), Effect::Restitution, 0.01), EffectResult::NotWorthSimulating);
        assert_eq!(worth_in(&gas("0.9"), Effect::Restitution, 0.01), EffectResult::Needed);
    }
}
