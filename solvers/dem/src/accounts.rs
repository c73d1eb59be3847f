//! What a run that asks for its energy budget adds up from step to step.

use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::tangential::Tangential;
use crate::simulation::Kernel;
use grainbench_scene::budget::Budget;
use grainbench_scene::effects::Effects;
use grainbench_scene::record::GrainState;
use grainbench_scene::scene::Scene;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Sums since the start, and what the next step adds to them.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Accounts {
    /// Work of walls and driven grains (J).
    work: f64,
    /// Work of friction (J).
    friction: f64,
    /// Impulse of walls, driven grains and gravity (N s).
    impulse: Vector3<f64>,
    /// Forces on driven groups, then on walls, at the last evaluation (N).
    forces: Vec<Vector3<f64>>,
}

/// Why the budget of a scene cannot be told, if it cannot.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    let effects = Effects::of(scene);
    let lossy = effects.contact_damping || effects.global_damping || effects.rolling_resistance;
    let turning = scene.walls.iter().any(|wall| wall.motion.phases.iter().any(|phase| phase.spin.norm() > 0.0));
    let what = if lossy {
        "damping and rolling resistance"
    } else if turning {
        "walls that turn"
    } else {
        return None;
    };
    Some(format!("a probe asks for its energy budget, and what {what} take or give is not added up"))
}

impl<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> Kernel<S, N, T, R> {
    /// Force of the others on each group of driven grains (N).
    pub(crate) fn forces_on_driven(&self) -> Vec<Vector3<f64>> {
        let of = |&grain: &usize| S::embed(self.grains.force[self.grains.slot[grain] as usize]);
        self.scene.driven.iter().map(|driven| driven.grains.iter().map(of).sum()).collect()
    }

    /// Adds up what the step did whose forces have just been found.
    ///
    /// Over a step a driven grain moves by V Δt while the force on it goes from F to F': its work is −½ (F + F')·V Δt, which
    /// is to second order what positions and velocities half a step apart take from it. Friction: see
    /// [`Tangential::rubbed`].
    pub(crate) fn account(&mut self) {
        let walls = self.walls.iter().map(|wall| S::embed(wall.force));
        let now: Vec<Vector3<f64>> = self.forces_on_driven().into_iter().chain(walls).collect();
        let driven = self.scene.driven.iter().map(|driven| driven.velocity);
        let velocities = driven.chain(self.walls.iter().map(|wall| wall.velocity()));
        let accounts = &mut self.accounts;
        for ((before, now), velocity) in accounts.forces.iter().zip(&now).zip(velocities) {
            let impulse = (before + now) * (-0.5 * self.time_step);
            accounts.impulse += impulse;
            accounts.work += impulse.dot(&velocity);
        }
        accounts.impulse += self.scene.gravity * (self.free_mass * self.time_step);
        accounts.friction += self.seen.iter().map(|seen| seen.rubbed).sum::<f64>();
        accounts.forces = now;
    }

    /// The budget at the time of the positions.
    pub(crate) fn budget(&self, grains: &[GrainState]) -> Budget {
        let scene = &self.scene;
        let kinetic = |(state, grain): (&GrainState, &grainbench_scene::scene::Grain)| {
            0.5 * (state.mass * state.velocity.norm_squared() + grain.inertia * state.spin.norm_squared())
        };
        Budget {
            kinetic: grains.iter().zip(&scene.grains).map(kinetic).sum(),
            springs: self.seen.iter().map(|seen| seen.elastic_energy).sum(),
            gravitational: grains.iter().map(|grain| -grain.mass * scene.gravity.dot(&grain.position)).sum(),
            work: self.accounts.work,
            friction: self.accounts.friction,
            momentum: grains.iter().map(|grain| grain.velocity * grain.mass).sum(),
            impulse: self.accounts.impulse,
            ..Budget::default()
        }
    }
}
