//! rapier as a solver: what it is given, what it refuses, and the record of a run.

use crate::engine::Stepping;
use crate::limits;
use crate::settings::Settings;
use crate::simulation::Simulation;
use grainbench_scene::effects::Effects;
use grainbench_scene::record::{Provenance, Record};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_scene::solver::{Resolution, RunError, Solver, Watch};
use std::time::Instant;

/// The release of rapier that is built in.
const RAPIER: &str = "rapier 0.36, f64";

/// Steps after which a watcher hears of progress at the latest.
const STEPS_BETWEEN_PROGRESS: u64 = 1000;

/// The solver `rigid`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rigid {
    /// Settings of the method.
    pub settings: Settings,
}

impl Rigid {
    /// rapier as it comes.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// rapier with other settings, to find out what they do.
    #[must_use]
    pub const fn with(settings: Settings) -> Self {
        Self { settings }
    }

    fn unsupported(&self, reason: String) -> RunError {
        RunError::Unsupported { solver: self.name(), reason }
    }

    /// Time step (s), number of steps, and iterations in each.
    fn steps(&self, scene: &Scene, resolution: &Resolution) -> Result<(f64, u64, usize), RunError> {
        let error = |reason: String| RunError::Resolution { solver: self.name(), reason };
        let Resolution::Rigid { step, substeps, iterations } = *resolution else {
            return Err(error(format!(
                "expected a number of substeps, found {resolution}: rigid contacts have no critical time step"
            )));
        };
        if !(step.is_finite() && step > 0.0 && substeps > 0 && iterations > 0) {
            return Err(error(format!("expected a positive step, substeps and iterations, found {resolution}")));
        }
        let Duration::Seconds(time) = scene.duration else {
            return Err(self.unsupported("its duration is a number of calculation cycles".to_owned()));
        };
        // A whole number of steps; the slack keeps a ratio that is whole but for rounding from gaining one.
        let steps = (time / step * (1.0 - 1e-12)).ceil().max(1.0) * f64::from(substeps);
        Ok((time / steps, steps as u64, iterations as usize))
    }

    /// What was set, in words.
    fn words(&self, scene: &Scene, stepping: &Stepping) -> Vec<String> {
        let Settings { recycling, frequency, wall_frequency, damping_ratio } = self.settings;
        let shared = crate::pairs::Pairs::of(scene).shared();
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
            Some(of) => format!("friction {} and restitution {:.6} for all pairs", of.friction, of.restitution),
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

    fn run(&self, scene: &Scene, resolution: &Resolution, watch: &mut dyn Watch) -> Result<Record, RunError> {
        if let Some(reason) = limits::reason(scene) {
            return Err(self.unsupported(reason));
        }
        let (time_step, steps, iterations) = self.steps(scene, resolution)?;
        let length = scene.grains.iter().map(|grain| grain.radius).sum::<f64>() / scene.grains.len().max(1) as f64;
        let length = if length > 0.0 { length } else { 1.0 };
        let mean_mass = scene.grains.iter().map(|grain| grain.mass).sum::<f64>() / scene.grains.len().max(1) as f64;
        let mass = if mean_mass > 0.0 { mean_mass.log2().round().exp2() } else { 1.0 };
        let stepping = Stepping { time_step, iterations, length, mass, settings: self.settings };
        let start = Instant::now();
        let mut simulation = Simulation::new(scene, stepping);
        let mut recorder = Recorder::new(scene, time_step, steps);
        for now in 0..=steps {
            if now > 0 {
                simulation.advance().map_err(RunError::Broken)?;
            }
            if recorder.is_due(now) {
                recorder.take(scene, simulation.look());
            }
            if now.is_multiple_of(STEPS_BETWEEN_PROGRESS) || now == steps {
                watch.progress(now, steps);
            }
        }
        let (series, snapshots) = recorder.finish();
        let mut cost = simulation.cost;
        cost.wall_seconds = start.elapsed().as_secs_f64();
        Ok(Record {
            provenance: Provenance {
                scene: scene.title.clone(),
                solver: self.name(),
                resolution: resolution.to_string(),
                time_step,
                critical_time_step: None,
                effects: Effects::of(scene).words(),
                options: self.words(scene, &stepping),
            },
            series,
            snapshots,
            cost,
        })
    }
}
