//! Chain of stages for one contact: normal, then tangential, then rolling.

use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{ContactInput, MEMORY, Memory, Terms};
use crate::geometry::Geometry;
use grainbench_lanes::Number;

/// Layout of the contact history.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Number of history values.
    pub(crate) numbers: usize,
    /// Factor by which each value is multiplied when the first and the second grain are exchanged.
    pub(crate) exchanged: [f64; MEMORY],
}

impl Layout {
    /// Returns the layout of a chain of stages.
    pub(crate) fn new<S: Geometry, T: Tangential<S>, R: Rolling<S>>() -> Self {
        let mut exchanged = [1.0; MEMORY];
        exchanged[..T::NUMBERS].fill(T::EXCHANGED);
        exchanged[T::NUMBERS..T::NUMBERS + R::NUMBERS].fill(-1.0);
        Self { numbers: T::NUMBERS + R::NUMBERS, exchanged }
    }
}

/// Rotation of two bodies at their contact.
pub(crate) struct BodyRotations<S: Geometry, X: Number> {
    /// Slip velocity due to rotation, ω₁a₁ + ω₂a₂, with angular velocities ω and lever arms a (m/s).
    pub(crate) surface: S::Spins<X>,
    /// Angular velocity of the first body relative to the second, ω₁ − ω₂ (rad/s). At a wall, the convention defines this
    /// angular velocity (`WallRolling`).
    pub(crate) relative: S::Spins<X>,
    /// Moment of inertia of both bodies about the contact, [1/(I₁ + m₁R₁²) + 1/(I₂ + m₂R₂²)]⁻¹ (kg m²).
    pub(crate) inertia: X,
}

/// Spring energy of a contact, and the energies that it dissipated or released in one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energies<X> {
    /// Energy in the springs (J).
    pub(crate) elastic: X,
    /// Frictional work in the step (J).
    pub(crate) rubbed: X,
    /// Energy released by the tangential spring in the step because its stiffness changes (J).
    pub(crate) released: X,
}

/// Forces, torques and output data of a contact, computed by the chain of stages.
pub(crate) struct Answer<S: Geometry, X: Number> {
    /// Unit normal e from the first body to the second.
    pub(crate) normal: S::Vectors<X>,
    /// Overlap δ (m).
    pub(crate) overlap: X,
    /// Force on the first body (N). The force on the second body is opposite.
    pub(crate) force: S::Vectors<X>,
    /// Torques on both bodies (N m), from the tangential force and from rolling resistance.
    pub(crate) torques: [S::Spins<X>; 2],
    /// Normal force F_n (N); positive if repulsive.
    pub(crate) normal_force: X,
    /// Tangential force F_s on the first body (N).
    pub(crate) shear: S::Tangents<X>,
    /// True if the Coulomb limit was reached.
    pub(crate) slipping: X::Mask,
    /// Energies; computed only if contacts are recorded.
    pub(crate) energies: Energies<X>,
}

/// Evaluates the stages for one contact, or for several contacts at a time. `arms` holds the lever arms of both bodies
/// (m). `turning` is `None` if grains do not rotate.
#[inline(always)]
pub(crate) fn stages<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>, X: Number>(
    touch: &ContactInput<'_, S, X>,
    arms: [X; 2],
    turning: Option<BodyRotations<S, X>>,
    terms: Terms<'_>,
    memory: &mut Memory<X>,
) -> Answer<S, X> {
    let Terms { options, elapsed, record, .. } = terms;
    let normal = N::force(touch, options);
    let zero = touch.overlap.like(0.0);
    let none = S::spin([zero; 4]);
    let mut answer = Answer {
        normal: touch.normal,
        overlap: touch.overlap,
        force: touch.between * -(normal.total * touch.inverse_distance),
        torques: [none; 2],
        normal_force: normal.total,
        shear: S::tangential(S::vector([zero; 4]), touch.normal),
        slipping: zero.below(zero),
        energies: Energies { elastic: zero, rubbed: zero, released: zero },
    };
    if let (true, Some(turning)) = (T::ACTIVE, turning) {
        let slip = S::slip(touch.velocity, turning.surface, touch.velocity_normal);
        let before = *memory;
        let shear = T::respond::<N, X>(touch, normal, slip, terms, memory);
        let force = S::along(shear.force, touch.normal);
        answer.force = answer.force + force;
        let twist = S::torque_of(touch.normal, force);
        answer.torques = [twist * arms[0], twist * arms[1]];
        if record {
            [answer.energies.rubbed, answer.energies.released] = T::lost::<N, X>(touch, slip, elapsed, &before, memory);
        }
        (answer.shear, answer.slipping) = (shear.force, shear.slipping);
        if R::ACTIVE {
            let memory = &mut memory[T::NUMBERS..];
            let moment = R::moment::<N, T, X>(touch, normal, turning.relative, elapsed, turning.inertia, memory);
            answer.torques = [answer.torques[0] + moment, answer.torques[1] - moment];
        }
    }
    if record {
        let shear = T::energy(memory, N::tangential_stiffness(touch));
        answer.energies.elastic = N::energy(touch) + shear + R::energy::<N, X>(touch, &memory[T::NUMBERS..]);
    }
    answer
}
