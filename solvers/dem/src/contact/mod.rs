//! Contact law as a chain of stages: normal, then tangential, then rolling.
//!
//! A stage that a scene does not need is replaced by an empty type. The loop over contacts is then compiled without the
//! branches, history and arithmetic of this stage. The modules `normal`, `tangential` and `rolling` contain the stages
//! with their laws. `chain` evaluates the stages of one contact; `pair` and `at_wall` prepare its input.

pub(crate) mod at_wall;
pub(crate) mod chain;
pub(crate) mod normal;
pub(crate) mod options;
pub(crate) mod pair;
pub(crate) mod rolling;
pub(crate) mod tangential;

use crate::geometry::{Geometry, Linear};
use crate::laws::{Constants, Laws};
use grainbench_lanes::Number;
use options::Options;

/// Length of the history array of a contact. The values of the tangential stage come first, then those of the rolling
/// stage. A contact with a wall also stores its normal, in the last three values.
pub(crate) const MEMORY: usize = 9;

/// History values of a contact.
pub(crate) type Memory<X> = [X; MEMORY];

/// Contact between two bodies as input of the stages, or several such contacts at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactInput<'a, S: Geometry, X: Number> {
    /// Law between the two materials.
    pub(crate) law: &'a Constants<X>,
    /// Vector from the first centre to the second (m). At a wall, the unit vector `e` from the centre to the wall.
    pub(crate) between: S::Vectors<X>,
    /// Inverse of the length of `between` (1/m).
    pub(crate) inverse_distance: X,
    /// Unit vector `e = between · inverse_distance`. A frictionless contact computes its normal force along `between`
    /// instead, which saves the arithmetic for `normal` if there are no dashpots.
    pub(crate) normal: S::Vectors<X>,
    /// Overlap δ (m), positive.
    pub(crate) overlap: X,
    /// Normal along which velocities are decomposed. It is the normal in the middle of the step, or `normal`.
    pub(crate) velocity_normal: S::Vectors<X>,
    /// Rotation of the contact over the step. It is `None` in two dimensions, if grains do not rotate, and if the
    /// convention projects the history.
    pub(crate) turn: Option<ContactRotation<S, X>>,
    /// Ratio of the tangential and of the rolling stiffness at the start of the step to that at its end; 1 if it is not
    /// needed.
    pub(crate) stiffness_ratio: X,
    /// Velocity of the first centre relative to the second body at the contact, v₁ − v₂ (m/s).
    pub(crate) velocity: S::Vectors<X>,
    /// Effective mass m₁m₂/(m₁+m₂), or m₁ at a wall (kg). Between grains, it is set only for dashpots.
    pub(crate) effective_mass: X,
    /// Effective radius R₁R₂/(R₁+R₂), or R₁ at a wall (m). Between grains, it is zero if no stage needs it.
    pub(crate) effective_radius: X,
}

impl<S: Geometry, X: Number> ContactInput<'_, S, X> {
    /// Returns the factor of the displacement of a spring that keeps its force while its stiffness grows, and its
    /// displacement while its stiffness decreases.
    #[inline(always)]
    pub(crate) fn force_keeping_ratio(&self) -> X {
        let (ratio, one) = (self.stiffness_ratio, self.overlap.like(1.0));
        X::choose(ratio.below(one), ratio, one)
    }
}

/// Rotation of a contact over a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactRotation<S: Geometry, X: Number> {
    /// Unit normal in the middle of the step.
    pub(crate) middle: S::Vectors<X>,
    /// Tangent of half the rotation angle about the normal. It is approximated by half the angle (rad).
    pub(crate) half_twist: X,
}

impl<S: Geometry, X: Number> ContactRotation<S, X> {
    /// Returns the rotation of a contact in a step of `elapsed` (s), from the normal in the middle of the step and the
    /// sum of the spins of both bodies (rad/s). About the normal, the contact rotates with the mean of both spins.
    #[inline(always)]
    pub(crate) fn new(middle: S::Vectors<X>, spins: S::Spins<X>, elapsed: f64) -> Self {
        Self { middle, half_twist: S::twist(spins, middle) * (0.25 * elapsed) }
    }
}

/// Normal of a contact in the middle of a step in which it rotates by an angle θ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MidStepNormal<S: Geometry, X: Number> {
    /// Unit normal in the middle of the step.
    pub(crate) normal: S::Vectors<X>,
    /// Ratio of chord to arc, sin(θ/2)/(θ/2). Centres move along chords and surfaces rotate along arcs. Surface
    /// velocities are multiplied by this ratio, so that bodies in rigid rotation do not slip.
    pub(crate) chord: X,
}

impl<S: Geometry, X: Number> MidStepNormal<S, X> {
    /// Returns the normal at the end of the step, for conventions that use it and for new contacts. `like` only selects
    /// the number type.
    #[inline(always)]
    pub(crate) fn end(normal: S::Vectors<X>, like: X) -> Self {
        Self { normal, chord: like.like(1.0) }
    }

    /// Returns the normal in the middle of a step of Δt = `elapsed` (s). The arguments are the unit normal e at the end of
    /// the step, the inverse 1/d of the distance between the centres (1/m), and the relative velocity v = v₁ − v₂
    /// (m/s).
    ///
    /// With h = Δt/2d, the vector between the centres in the middle is d (e + h v). Its squared length is d² (1 + y)
    /// with y = 2h v·e + h² v·v. The factor 1/√(1 + y) is 1 − y/2 + 3y²/8 − 5y³/16 with an error of 35y⁴/128.
    #[inline(always)]
    pub(crate) fn of_centres(
        normal: S::Vectors<X>,
        inverse_distance: X,
        velocity: S::Vectors<X>,
        elapsed: f64,
    ) -> Self {
        let half = inverse_distance * (0.5 * elapsed);
        let along = half * velocity.dot(normal);
        let square = half * half * velocity.dot(velocity);
        let excess = along + along + square;
        let inverse = (excess * -0.5 + 1.0) + excess * excess * (excess * -0.3125 + 0.375);
        Self { normal: (normal + velocity * half) * inverse, chord: chord(square - along * along) }
    }

    /// Returns the normal in the middle of a step, from the unit normals at its start and its end.
    #[inline(always)]
    pub(crate) fn of_normals(before: S::Vectors<X>, now: S::Vectors<X>) -> Self {
        let sum = before + now;
        let squared = sum.dot(sum);
        let one = squared.like(1.0);
        let cosine = squared * 0.25;
        Self { normal: sum * (one / squared.sqrt()), chord: chord((one - cosine) * cosine) }
    }
}

/// Returns sin x/x from sin² x cos² x, with an error of x⁶/2 at most.
#[inline(always)]
fn chord<X: Number>(squared: X) -> X {
    squared * (squared * (-77.0 / 360.0) - 1.0 / 6.0) + 1.0
}

/// Returns the ratio of the stiffness of a spring at the start of a step of `elapsed` (s) to the stiffness at its end.
/// The stiffness is proportional to √δ with the overlap δ. The arguments are 1/δ at the end of the step (1/m) and the
/// approach velocity of the bodies (m/s).
#[inline(always)]
pub(crate) fn stiffness_ratio<X: Number>(inverse_overlap: X, approach: X, elapsed: f64) -> X {
    let ratio = -(approach * elapsed * inverse_overlap) + 1.0;
    ratio.at_least(approach.like(0.0)).sqrt()
}

/// Parameters common to all contacts of an evaluation.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    /// Contact laws of the scene.
    pub(crate) laws: &'a Laws,
    /// Options of the convention.
    pub(crate) options: &'a Options,
    /// Time since the last evaluation (s).
    pub(crate) elapsed: f64,
    /// True if contacts are recorded. Energies are then computed.
    pub(crate) record: bool,
}
