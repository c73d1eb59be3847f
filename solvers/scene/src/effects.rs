//! Which physics a scene calls for, derived from the scene and never typed beside it.

use crate::scene::{ContactLaw, Scene};

/// The effects that are on. Solvers pick their kernels from this, once, before the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Tangential forces at contacts: some law has friction or cohesion. Without them nothing can exert a torque, and
    /// no grain carries history or spin.
    pub friction: bool,
    /// Dashpots at contacts: some law has a damping coefficient.
    pub contact_damping: bool,
    /// Mass-proportional damping of every grain.
    pub global_damping: bool,
    /// Gravity.
    pub gravity: bool,
    /// Periodic axes.
    pub periodic: bool,
    /// Walls that move.
    pub moving_walls: bool,
}

impl Effects {
    /// What `scene` calls for.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            friction: scene.laws.iter().flatten().any(ContactLaw::has_friction),
            contact_damping: scene.laws.iter().flatten().any(ContactLaw::has_damping),
            global_damping: scene.global_damping != 0.0,
            gravity: scene.gravity.norm() > 0.0,
            periodic: scene.is_periodic(),
            moving_walls: scene.walls.iter().any(|wall| wall.motion.is_moving()),
        }
    }

    /// The effects that are on, in words.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        [
            (self.friction, "friction and rotation"),
            (self.contact_damping, "contact damping"),
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
