//! The energy budget of a run: what it adds up from step to step.
//!
//! Over a step a driven grain or a wall moves by V Δt while the force on it goes from F to F': its work is −½ (F +
//! F')·V Δt, which is to second order what positions and velocities half a step apart take from it. The work of
//! friction, and the energy that tangential springs release as their stiffness changes, are those of
//! [`Tangential::lost`](crate::contact::tangential::Tangential::lost). The energy that is left in the tangential spring of a
//! contact when it ends is in no entry: nothing where surfaces slip in the end, as they do with finite friction.

use grainbench_scene::budget::Budget;
use grainbench_scene::effects::Effects;
use grainbench_scene::record::GrainState;
use grainbench_scene::scene::{Driven, Grain, Scene};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Sums since the start, and the forces from which the next step adds to them.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Accounts {
    /// Work of walls and driven grains (J).
    work: f64,
    /// Work of friction (J).
    friction: f64,
    /// Energy released by tangential springs whose stiffness changed (J).
    released: f64,
    /// Impulse of walls, driven grains and gravity (N s).
    impulse: Vector3<f64>,
    /// Forces on driven groups, then on walls, at the last evaluation (N).
    forces: Vec<Vector3<f64>>,
}

/// Why the energy budget of a scene cannot be computed, if it cannot.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    let effects = Effects::of(scene);
    let lossy = effects.contact_damping || effects.global_damping || effects.rolling_resistance;
    let turning = scene.walls.iter().any(|wall| wall.motion.phases.iter().any(|phase| phase.spin.norm() > 0.0));
    let what = if lossy {
        "damping and rolling resistance"
    } else if scene.driven.iter().any(Driven::is_for_a_while) {
        "grains that begin or end to be driven"
    } else if scene.driven.iter().any(|driven| !driven.motion.is_empty() || driven.spin != Vector3::zeros()) {
        "grains that are driven with a spin or along a motion"
    } else if turning {
        "walls that turn"
    } else {
        return None;
    };
    Some(format!("a probe asks for its energy budget, and what {what} take or give is not added up"))
}

/// What a step did, from the forces that were found at its end.
pub(crate) struct Step {
    /// Forces on driven groups, then on walls (N).
    pub(crate) forces: Vec<Vector3<f64>>,
    /// Velocities of driven groups, then of walls (m/s).
    pub(crate) velocities: Vec<Vector3<f64>>,
    /// Gravity g (m/s²).
    pub(crate) gravity: Vector3<f64>,
    /// Mass of the grains that are not driven (kg).
    pub(crate) free_mass: f64,
    /// Work of friction (J).
    pub(crate) friction: f64,
    /// Energy released by tangential springs whose stiffness changed (J).
    pub(crate) released: f64,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
}

impl Accounts {
    /// Adds up what a step did.
    pub(crate) fn add(&mut self, step: Step) {
        for ((before, now), velocity) in self.forces.iter().zip(&step.forces).zip(&step.velocities) {
            let impulse = (before + now) * (-0.5 * step.time_step);
            self.impulse += impulse;
            self.work += impulse.dot(velocity);
        }
        self.impulse += step.gravity * (step.free_mass * step.time_step);
        self.friction += step.friction;
        self.released += step.released;
        self.forces = step.forces;
    }

    /// The budget at the time of the positions, from the grains then and the energy in the springs (J).
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
