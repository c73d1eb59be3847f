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

use crate::convention::{CapNormal, Convention, CoulombCap, History, Tension, TorqueArm, VelocityNormal, WallRolling};
use crate::geometry::{Geometry, Linear};
use crate::laws::Constants;
use grainbench_lanes::Number;
pub(crate) use tangential::Cap;

/// Numbers that a contact may remember from step to step: the tangential stage's first, the rolling stage's after them. A
/// contact with a wall remembers its normal in the last three.
pub(crate) const MEMORY: usize = 9;

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
    /// Normal along which velocities are decomposed: the mean over the step, or `normal` itself.
    pub(crate) velocity_normal: S::Vectors<X>,
    /// Turning of the contact over the step; none where a convention projects what is remembered.
    pub(crate) turn: Option<Turn<S, X>>,
    /// Stiffness of the tangential spring at the start of the step over that at its end.
    pub(crate) stiffness_ratio: X,
    /// Velocity of the first centre relative to the second body at the contact, v₁ − v₂ (m/s).
    pub(crate) velocity: S::Vectors<X>,
    /// Effective mass m₁m₂/(m₁+m₂), or m₁ at a wall (kg). Only set for dashpots.
    pub(crate) effective_mass: X,
    /// Effective radius R₁R₂/(R₁+R₂), or R₁ at a wall (m). Only set for stages that say so.
    pub(crate) effective_radius: X,
}

/// Turning of a contact over a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<S: Geometry, X: Number> {
    /// Mean of the unit normals at the start and at the end of the step.
    pub(crate) middle: S::Vectors<X>,
    /// Tangent of half the angle by which it turns about the normal.
    pub(crate) half_twist: X,
}

impl<S: Geometry, X: Number> Turn<S, X> {
    /// The turning of a contact whose normal has a mean over a step of `elapsed` (s), in which its bodies have two spins with
    /// this sum (rad/s): about the normal it turns with the mean of both.
    #[inline(always)]
    pub(crate) fn new(middle: S::Vectors<X>, spins: S::Spins<X>, elapsed: f64) -> Self {
        Self { middle, half_twist: S::twist(spins, middle) * (0.25 * elapsed) }
    }
}

/// Mean of the unit normals at the start and at the end of a step of `elapsed` (s), from the vector `between` two centres (m)
/// at its end, the inverse of its length (1/m), its unit vector and the relative velocity v₁ − v₂ (m/s).
///
/// The vector at the start is b − (v₂ − v₁)Δt, exactly; the inverse of its length over that at the end, 1/√r, is taken as
/// (3 + r)/(1 + 3r), whose error is (r − 1)³/32.
#[inline(always)]
pub(crate) fn middle_normal<S: Geometry, X: Number>(
    (between, inverse_distance, normal): (S::Vectors<X>, X, S::Vectors<X>),
    velocity: S::Vectors<X>,
    elapsed: f64,
) -> S::Vectors<X> {
    let before = between + velocity * inverse_distance.like(elapsed);
    let squared = before.dot(before) * (inverse_distance * inverse_distance);
    let inverse = inverse_distance * (squared + 3.0) / (squared * 3.0 + 1.0);
    mean_normal::<S, X>(before * inverse, normal)
}

/// Mean over a step of a unit normal that turns from one direction to another by an angle θ, as long as sin(θ/2)/(θ/2): half
/// the sum m of both has the length cos(θ/2), and m (4 − m·m)/3 is right to θ⁴/2880. So bodies that turn rigidly, whose centres
/// move along chords, do not slip.
#[inline(always)]
pub(crate) fn mean_normal<S: Geometry, X: Number>(before: S::Vectors<X>, now: S::Vectors<X>) -> S::Vectors<X> {
    let sum = before + now;
    let squared = sum.dot(sum);
    sum * (squared.like(2.0 / 3.0) - squared * (1.0 / 24.0))
}

/// Stiffness of a tangential spring, proportional to the root of the overlap δ (m), at the start of a step of `elapsed` (s)
/// over that at its end, where bodies approach at `approach` (m/s) in it.
#[inline(always)]
pub(crate) fn stiffness_ratio<X: Number>(overlap: X, approach: X, elapsed: f64) -> X {
    let ratio = overlap.like(1.0) - approach * elapsed / overlap;
    ratio.at_least(overlap.like(0.0)).sqrt()
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
    /// Weight of a wall's spin in the angular velocity that rolls at it: 0 or 1.
    pub(crate) wall_spin: f64,
    /// Whether velocities are decomposed along the normal of mid-step.
    pub(crate) mid_step: bool,
}

impl Options {
    /// Whether a normal dashpot may pull.
    pub(crate) const fn may_pull(&self) -> bool {
        self.least_normal_force < 0.0
    }

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
            wall_spin: match convention.wall_rolling {
                WallRolling::RelativeSpin => 1.0,
                WallRolling::Spin | WallRolling::Surface => 0.0,
            },
            mid_step: matches!(convention.velocity_normal, VelocityNormal::MidStep),
        }
    }
}
