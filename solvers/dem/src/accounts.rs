//! Energy budget of a run, summed from step to step.
//!
//! In a step, a wall or a grain with prescribed motion moves by V Δt, while the force on it changes from F to F'. Its
//! work is −½ (F + F')·V Δt. To second order in Δt, this is the energy that the other grains receive, although their
//! velocities are half a step apart from their positions.
//! [`Tangential::lost`](crate::contact::tangential::Tangential::lost) gives the frictional work, and the energy that
//! tangential springs release when their stiffness changes. The energy left in the tangential spring at the end of a
//! contact is not counted. It is zero if the surfaces slip at the end, as they do with finite friction.

use grainbench_scene::effects::Effects;
use grainbench_scene::scene::{Driven, Grain, Scene};
use grainbench_solver::budget::Budget;
use grainbench_solver::record::GrainState;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Sums of the energy budget since the start, and the forces at the last evaluation, which the next step needs.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Accounts {
    /// Work of walls and grains with prescribed motion (J).
    work: f64,
    /// Frictional work (J).
    pub(crate) friction: f64,
    /// Energy released by tangential springs whose stiffness changed (J).
    pub(crate) released: f64,
    /// Impulse of walls, of grains with prescribed motion, and of gravity (N s).
    pub(crate) impulse: Vector3<f64>,
    /// Forces on groups of grains with prescribed motion, then on walls, at the last evaluation (N).
    forces: Vec<Vector3<f64>>,
}

/// Energy budget of a run.
pub(crate) struct EnergyBudget {
    /// True if the energy budget is requested.
    pub(crate) is_requested: bool,
    pub(crate) accounts: Accounts,
    /// Mass of the grains without prescribed motion (kg).
    pub(crate) free_mass: f64,
}

impl EnergyBudget {
    pub(crate) fn new(scene: &Scene) -> Self {
        let groups = scene.driven_group_of_grains();
        let free = scene.grains.iter().zip(groups).filter(|(_, group)| group.is_none());
        Self {
            is_requested: scene.asks_for_budget(),
            accounts: Accounts::default(),
            free_mass: free.map(|(grain, _)| grain.mass).sum(),
        }
    }
}

/// Returns the reason why the energy budget of a scene cannot be computed; `None` if it can.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    let effects = Effects::from_scene(scene);
    let lossy = effects.contact_damping || effects.rolling_resistance || scene.global_damping != 0.0;
    let turning = scene.walls.iter().any(|wall| wall.motion.rotates());
    let what = if lossy {
        "damping and rolling resistance"
    } else if scene.driven.iter().any(Driven::is_for_a_while) {
        "grains that are driven for a part of the run"
    } else if scene.driven.iter().any(|driven| !driven.motion.is_empty() || driven.spin != Vector3::zeros()) {
        "grains that are driven with a spin or along a motion"
    } else if turning {
        "rotating walls"
    } else {
        return None;
    };
    Some(format!("a probe requests the energy budget, which does not include the energy of {what}"))
}

impl Accounts {
    /// Adds the work and the impulse in a step Δt = `time_step` (s). `forces` (N) and `velocities` (m/s) list the groups of
    /// driven grains first and the walls last.
    pub(crate) fn add_work(
        &mut self,
        forces: Vec<Vector3<f64>>,
        velocities: impl Iterator<Item = Vector3<f64>>,
        time_step: f64,
    ) {
        for ((before, now), velocity) in self.forces.iter().zip(&forces).zip(velocities) {
            let impulse = (before + now) * (-0.5 * time_step);
            self.impulse += impulse;
            self.work += impulse.dot(&velocity);
        }
        self.forces = forces;
    }

    /// Returns the budget at the time of the positions. `grains` holds the states at that time, `springs` the energy of
    /// all springs (J).
    pub(crate) fn budget(&self, scene: &Scene, grains: &[GrainState], springs: f64) -> Budget {
        let kinetic = |(state, grain): (&GrainState, &Grain)| {
            0.5 * (state.mass * state.velocity.norm_squared() + grain.inertia * state.spin.norm_squared())
        };
        Budget {
            kinetic: grains.iter().zip(&scene.grains).map(kinetic).sum(),
            springs,
            gravitational: grains.iter().map(|grain| -grain.mass * scene.gravity.dot(&grain.position)).sum(),
            work: self.work,
            friction: self.friction,
            contact: self.released,
            momentum: grains.iter().map(|grain| grain.velocity * grain.mass).sum(),
            impulse: self.impulse,
            ..Budget::default()
        }
    }
}
