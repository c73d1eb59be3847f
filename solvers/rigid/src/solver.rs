//! Solver `rigid`: its conformance properties, its time steps, and its runs with rapier.

use crate::engine::Stepping;
use crate::limits;
use crate::pairs::common_coefficients;
use crate::settings::Settings;
use crate::simulation::Simulation;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::Solver;
use grainbench_solver::drive::Course;
use grainbench_solver::failure::RunError;
use grainbench_solver::limits::beyond_run;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::{Provenance, Record};
use grainbench_solver::resolution::Resolution;
use grainbench_solver::terms::{Limitation, Terms};

/// Version of rapier and type of its numbers, as stated in records.
const RAPIER: &str = "rapier 0.36, f64";

/// Maximum number of steps between two progress reports.
const STEPS_BETWEEN_PROGRESS: u64 = 1000;

/// Reason for the limitations of the property `objectivity`: a grain that is compressed between walls does not follow
/// the motion of the walls.
const PRESSED: &str = "walls that press on a rigid grain from both sides overlap it, and the load between them is \
                       undetermined: impulses remove the overlap on one side and then on the other, and their friction \
                       rotates the grain";

/// Solver `rigid`, which runs scenes with rapier.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rigid {
    /// Settings of the method.
    pub settings: Settings,
}

impl Rigid {
    /// Conformance properties, with the limitations of the engine.
    pub const TERMS: Terms = Terms::at(Resolution::substeps(8)).owing_less(&[
        Limitation::new(
            "momentum",
            "angular",
            1e-3,
            "contact points are fixed to the grains for a step and rotate with them: the two impulses of a contact act at \
             points that separate by about v Δt",
        ),
        Limitation::new(
            "permutation",
            "",
            3e-3,
            "contacts are solved one after another, in the order of the list, and the solver stops after some iterations",
        ),
        Limitation::new(
            "free-flight",
            "",
            1e-12,
            "spins are converted to the units of the engine and back in each step, which adds rounding",
        ),
        Limitation::new("objectivity", "place", 0.1, PRESSED),
        Limitation::new("objectivity", "spin", 1.0, PRESSED),
    ]);

    /// Returns rapier with its default settings.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns rapier with other settings, to study their influence.
    #[must_use]
    pub const fn with(settings: Settings) -> Self {
        Self { settings }
    }

    /// Returns the time step (s), the number of steps, and the iterations in each step.
    fn steps(&self, scene: &Scene, resolution: &Resolution) -> Result<(f64, u64, usize), RunError> {
        let Resolution::Rigid { step, substeps, iterations } = *resolution else {
            return Err(self.resolution_error(format!(
                "expected a number of substeps, found {resolution}: rigid contacts have no critical time step"
            )));
        };
        if !(step.is_finite() && step > 0.0 && substeps > 0 && iterations > 0) {
            let reason = format!("expected a positive step, substeps and iterations, found {resolution}");
            return Err(self.resolution_error(reason));
        }
        let Duration::Seconds(time) = scene.duration else {
            return Err(self.unsupported("its duration is a number of calculation cycles".to_owned()));
        };
        // The number of steps is rounded up. The tolerance prevents rounding errors from adding a step.
        let steps = (time / step * (1.0 - 1e-12)).ceil().max(1.0) * f64::from(substeps);
        if let Some(refusal) = beyond_run(scene, time / steps, steps) {
            return Err(self.resolution_error(refusal));
        }
        Ok((time / steps, steps as u64, iterations as usize))
    }

    /// Returns a description of engine, settings, units and coefficients.
    fn words(&self, scene: &Scene, stepping: &Stepping) -> Vec<String> {
        let Settings { recycling, frequency, wall_frequency, damping_ratio } = self.settings;
        let shared = common_coefficients(scene);
        let mut words = vec![
            RAPIER.to_owned(),
            format!("{} iterations a step", stepping.iterations),
            format!(
                "pull towards zero overlap at {frequency} Hz, {wall_frequency} Hz at fixed walls, damping ratio {damping_ratio}"
            ),
            format!("unit of length {:.6e} m, the mean radius; of mass {:.6e} kg", stepping.length, stepping.mass),
            "no sleeping, no continuous detection".to_owned(),
        ];
        words.push(match shared {
            Some(coefficients) => format!(
                "friction {} and restitution {:.6} for all pairs",
                coefficients.friction, coefficients.restitution
            ),
            None => "friction and restitution set pair by pair".to_owned(),
        });
        let recycled = recycling && shared.is_some();
        words.push(if recycled { "contact points recycled" } else { "contact points found at every step" }.to_owned());
        words
    }
}

impl Solver for Rigid {
    fn name(&self) -> String {
        "rigid".to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        if let Some(reason) = limits::reason(scene) {
            return Err(self.unsupported(reason));
        }
        let (time_step, steps, iterations) = self.steps(scene, resolution)?;
        let length = scene.grains.iter().map(|grain| grain.radius).sum::<f64>() / scene.grains.len().max(1) as f64;
        let length = if length > 0.0 { length } else { 1.0 };
        let mean_mass = scene.grains.iter().map(|grain| grain.mass).sum::<f64>() / scene.grains.len().max(1) as f64;
        let mass = if mean_mass > 0.0 { libm::exp2(libm::log2(mean_mass).round()) } else { 1.0 };
        let stepping = Stepping { time_step, iterations, length, mass, settings: self.settings };
        let provenance = Provenance {
            critical_time_step: None,
            ..Provenance::new(scene, self.name(), resolution, time_step, self.words(scene, &stepping))
        };
        let between_progress = STEPS_BETWEEN_PROGRESS;
        let course = Course { solver: self.name(), scene, steps, from: None, between_progress, provenance };
        course.drive(&mut Simulation::new(scene, stepping), observer)
    }
}
