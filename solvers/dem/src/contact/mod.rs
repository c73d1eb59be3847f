//! The contact law as a chain of stages: normal, then tangential, then rolling.
//!
//! A stage that a scene does not call for is another type, of zero size, so that its branch, its memory and its
//! arithmetic are not compiled into the loop over contacts. The stages stand in `normal`, `tangential` and `rolling`,
//! each with its laws; `chain` takes one contact through them, and `pair` and `at_wall` make a contact ready for it.

pub(crate) mod at_wall;
pub(crate) mod chain;
pub mod normal;
pub(crate) mod pair;
pub mod rolling;
pub(crate) mod seen;
pub mod tangential;

use crate::convention::{CapNormal, Convention, Tension, TorqueArm, WallRolling};
use crate::laws::Constants;
use grainbench_scene::space::Space;

/// Two bodies that touch, as the stages see them.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'a, S: Space> {
    /// The law between their materials.
    pub law: &'a Constants,
    /// Vector from the first centre to the second (m); at a wall the unit vector `e` from the centre to the wall.
    pub between: S::Vector,
    /// The inverse of the length of `between` (1/m).
    pub inverse_distance: f64,
    /// Unit vector `e = between · inverse_distance`. Only dashpots, the tangential and the rolling stage read it: the
    /// normal force is taken along `between`.
    pub normal: S::Vector,
    /// Overlap δ (m), positive.
    pub overlap: f64,
    /// Velocity of the first centre relative to the second body at the contact, v₁ − v₂ (m/s).
    pub velocity: S::Vector,
    /// Effective mass m₁m₂/(m₁+m₂), or m₁ at a wall (kg). Only set for dashpots.
    pub effective_mass: f64,
    /// Effective radius R₁R₂/(R₁+R₂), or R₁ at a wall (m). Only set for stages that say so.
    pub effective_radius: f64,
}

/// The options of a convention that are values and not types.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Part of the overlap that is taken off the torque arm: 0 or 1/2.
    pub arm_reduction: f64,
    /// Smallest normal force (N): zero without tension, else −∞.
    pub least_normal_force: f64,
    /// Weight of the dashpot in the normal force that Coulomb's limit is proportional to: 0 or 1.
    pub dashpot_in_cap: f64,
    /// Weight of a normal force that pulls in Coulomb's limit: 0 or 1.
    pub pull_in_cap: f64,
    /// Whether grains roll at walls by their surface's velocity over the distance of the wall, and not by their spin.
    pub rolls_by_surface: bool,
}

impl Options {
    /// The values of a convention's options.
    #[must_use]
    pub const fn of(convention: &Convention) -> Self {
        Self {
            arm_reduction: match convention.torque_arm {
                TorqueArm::Radius => 0.0,
                TorqueArm::ContactPoint => 0.5,
            },
            least_normal_force: match convention.tension {
                Tension::Allowed => f64::NEG_INFINITY,
                Tension::Clipped => 0.0,
            },
            dashpot_in_cap: match convention.cap_normal {
                CapNormal::Spring => 0.0,
                CapNormal::Total | CapNormal::Pushing => 1.0,
            },
            pull_in_cap: match convention.cap_normal {
                CapNormal::Spring | CapNormal::Total => 1.0,
                CapNormal::Pushing => 0.0,
            },
            rolls_by_surface: matches!(convention.wall_rolling, WallRolling::Surface),
        }
    }
}
