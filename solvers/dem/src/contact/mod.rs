//! The contact law as a chain of stages: normal, then tangential, then rolling.
//!
//! A stage that a scene does not call for is another type, of zero size, so that its branch, its memory and its
//! arithmetic are not compiled into the loop over contacts. The stages stand in `normal`, `tangential` and `rolling`,
//! each with its laws; `chain` takes one contact through them, and `pair` and `at_wall` make a contact ready for it.

pub(crate) mod at_wall;
pub(crate) mod chain;
pub(crate) mod normal;
pub(crate) mod pair;
pub(crate) mod rolling;
pub(crate) mod tangential;

use crate::convention::{CapNormal, Convention, CoulombCap, History, Tension, TorqueArm, WallRolling};
use crate::geometry::Geometry;
use crate::laws::Constants;
use grainbench_lanes::Number;
pub(crate) use tangential::Cap;

/// Numbers that a contact may remember from step to step: the tangential stage's first, the rolling stage's after them.
pub(crate) const MEMORY: usize = 8;

/// What a contact remembers from step to step.
pub(crate) type Memory<X> = [X; MEMORY];

/// Two bodies that touch, as the stages see them; or several such contacts at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<'a, S: Geometry, X: Number> {
    /// The law between their materials.
    pub(crate) law: &'a Constants<X>,
    /// Vector from the first centre to the second (m); at a wall the unit vector `e` from the centre to the wall.
    pub(crate) between: S::Vectors<X>,
    /// The inverse of the length of `between` (1/m).
    pub(crate) inverse_distance: X,
    /// Unit vector `e = between · inverse_distance`. Only dashpots, the tangential and the rolling stage read it: the
    /// normal force is taken along `between`.
    pub(crate) normal: S::Vectors<X>,
    /// Overlap δ (m), positive.
    pub(crate) overlap: X,
    /// Velocity of the first centre relative to the second body at the contact, v₁ − v₂ (m/s).
    pub(crate) velocity: S::Vectors<X>,
    /// Effective mass m₁m₂/(m₁+m₂), or m₁ at a wall (kg). Only set for dashpots.
    pub(crate) effective_mass: X,
    /// Effective radius R₁R₂/(R₁+R₂), or R₁ at a wall (m). Only set for stages that say so.
    pub(crate) effective_radius: X,
}

/// The options of a convention that are values and not types.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    /// Part of the overlap that is taken off the torque arm: 0 or 1/2.
    pub(crate) arm_reduction: f64,
    /// Smallest normal force (N): zero without tension, else −∞.
    pub(crate) least_normal_force: f64,
    /// Weight of the dashpot in the normal force that Coulomb's limit is proportional to: 0 or 1.
    pub(crate) dashpot_in_cap: f64,
    /// Weight of a normal force that pulls in Coulomb's limit: 0 or 1.
    pub(crate) pull_in_cap: f64,
    /// What Coulomb's limit acts on.
    pub(crate) cap: Cap,
    /// Whether grains roll at walls by their surface's velocity over the distance of the wall, and not by their spin.
    pub(crate) rolls_by_surface: bool,
}

impl Options {
    /// The values of a convention's options.
    #[must_use]
    pub(crate) const fn of(convention: &Convention) -> Self {
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
            cap: match (convention.coulomb_cap, convention.history) {
                (CoulombCap::Spring, _) => Cap::Spring,
                (CoulombCap::SpringAndDashpot, History::Turned) => Cap::Total,
                (CoulombCap::SpringAndDashpot, History::Projected) => Cap::TotalAsLammps,
            },
            rolls_by_surface: matches!(convention.wall_rolling, WallRolling::Surface),
        }
    }
}
