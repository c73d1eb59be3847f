//! Which physics a scene calls for, derived from the scene and never typed beside it.

use crate::scene::{ContactLaw, Scene};

/// The effects that are on. Solvers pick their kernels from this, once, before the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Tangential forces or rolling moments at contacts: some law has friction, cohesion or rolling resistance. Without
    /// them nothing can exert a torque, and no grain carries history or spin.
    pub friction: bool,
    /// Dashpots at contacts: some law has a damping coefficient or a restitution below 1.
    pub contact_damping: bool,
    /// Normal dashpots that give a coefficient of restitution.
    pub restitution: bool,
    /// Hertz contacts instead of linear springs.
    pub hertz: bool,
    /// Moments against rolling: some law has rolling resistance.
    pub rolling_resistance: bool,
    /// Mass-proportional damping of every grain.
    pub global_damping: bool,
    /// Gravity.
    pub gravity: bool,
    /// Periodic axes.
    pub periodic: bool,
    /// Walls, or driven grains, that move.
    pub moving_walls: bool,
}

impl Effects {
    /// What `scene` calls for.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            friction: scene.laws.iter().flatten().any(|law| law.has_friction() || law.rolling_friction > 0.0),
            contact_damping: scene.laws.iter().flatten().any(ContactLaw::has_damping),
            restitution: scene.laws.iter().flatten().any(|law| law.damping_ratio != 0.0),
            hertz: scene.laws.iter().flatten().any(ContactLaw::is_hertz),
            rolling_resistance: scene.laws.iter().flatten().any(|law| law.rolling_friction > 0.0),
            global_damping: scene.global_damping != 0.0,
            gravity: scene.gravity.norm() > 0.0,
            periodic: scene.is_periodic(),
            moving_walls: scene.walls.iter().any(|wall| wall.motion.is_moving())
                || scene.driven.iter().any(|driven| driven.velocity.norm() > 0.0),
        }
    }

    /// The effects that are on, in words.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        [
            (self.friction, "friction and rotation"),
            (self.hertz, "Hertz contacts"),
            (self.contact_damping, "contact damping"),
            (self.restitution, "restitution"),
            (self.rolling_resistance, "rolling resistance"),
            (self.global_damping, "global damping"),
            (self.gravity, "gravity"),
            (self.periodic, "periodic axes"),
            (self.moving_walls, "moving walls"),
        ]
        .iter()
        .filter(|(on, _)| *on)
        .map(|(_, words)| (*words).to_owned())
        .collect()
    }
}
