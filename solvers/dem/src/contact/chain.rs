//! One contact through its chain of stages: normal, then tangential, then rolling.

use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{MEMORY, Memory, Options, Touch};
use crate::geometry::Geometry;
use grainbench_lanes::Number;

/// How the memory of a contact is laid out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Numbers that are remembered.
    pub(crate) numbers: usize,
    /// What each is multiplied by when the roles of first and second grain are exchanged.
    pub(crate) exchanged: [f64; MEMORY],
}

impl Layout {
    /// The layout of a chain of stages.
    pub(crate) fn of<S: Geometry, T: Tangential<S>, R: Rolling<S>>() -> Self {
        let mut exchanged = [1.0; MEMORY];
        exchanged[..T::NUMBERS].fill(T::EXCHANGED);
        exchanged[T::NUMBERS..T::NUMBERS + R::NUMBERS].fill(-1.0);
        Self { numbers: T::NUMBERS + R::NUMBERS, exchanged }
    }
}

/// How two bodies turn at their contact.
pub(crate) struct Turning<S: Geometry, X: Number> {
    /// ω₁a₁ + ω₂a₂, with the angular velocities ω and the torque arms a: by what the surfaces slip because the bodies
    /// turn (m/s).
    pub(crate) surface: S::Spins<X>,
    /// Angular velocity of the first body relative to the second, ω₁ − ω₂ (rad/s), or what rolls in its place at a
    /// wall.
    pub(crate) relative: S::Spins<X>,
    /// Moment of inertia of the two about their contact, [1/(I₁ + m₁R₁²) + 1/(I₂ + m₂R₂²)]⁻¹ (kg m²).
    pub(crate) inertia: X,
}

/// What the chain answers: forces and moments, and what is shown of the contact.
pub(crate) struct Answer<S: Geometry, X: Number> {
    /// Unit normal e from the first body to the second.
    pub(crate) normal: S::Vectors<X>,
    /// Overlap δ (m).
    pub(crate) overlap: X,
    /// Force on the first body (N); on the second acts the opposite.
    pub(crate) force: S::Vectors<X>,
    /// Torques on both bodies (N m): of the tangential force at their arms, and the moments against rolling.
    pub(crate) torques: [S::Spins<X>; 2],
    /// Normal force F_n (N), positive when it pushes apart.
    pub(crate) normal_force: X,
    /// Tangential force F_s on the first body (N).
    pub(crate) shear: S::Tangents<X>,
    /// Whether Coulomb's limit was reached.
    pub(crate) slipping: X::Mask,
    /// Energy in the springs (J), only when it is recorded.
    pub(crate) elastic_energy: X,
    /// Work of friction in the step (J), only when it is recorded.
    pub(crate) rubbed: X,
    /// Energy that the tangential spring releases in the step because its stiffness changes (J), only when it is recorded.
    pub(crate) released: X,
}

/// How a contact is evaluated.
#[derive(Clone, Copy)]
pub(crate) struct Evaluation<'a> {
    /// The options of the convention.
    pub(crate) options: &'a Options,
    /// Time since the last evaluation (s).
    pub(crate) elapsed: f64,
    /// Whether energies are found.
    pub(crate) record: bool,
}

/// Takes one contact through its stages. `arms` are the torque arms of both bodies (m), and `turning` is `None` where
/// bodies do not rotate.
#[inline(always)]
pub(crate) fn stages<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>, X: Number>(
    touch: &Touch<'_, S, X>,
    arms: [X; 2],
    turning: Option<Turning<S, X>>,
    evaluation: Evaluation<'_>,
    memory: &mut Memory<X>,
) -> Answer<S, X> {
    let Evaluation { options, elapsed, record } = evaluation;
    let normal = N::force(touch, options);
    let zero = touch.overlap.like(0.0);
    let none = S::as_spin([zero; 3]);
    let mut answer = Answer {
        normal: touch.normal,
        overlap: touch.overlap,
        force: touch.between * -(normal.total * touch.inverse_distance),
        torques: [none; 2],
        normal_force: normal.total,
        shear: S::tangential(S::vector([zero; 4]), touch.normal),
        slipping: zero.below(zero),
        elastic_energy: zero,
        rubbed: zero,
        released: zero,
    };
    if let (true, Some(turning)) = (T::ACTIVE, turning) {
        let slip = S::slip(touch.velocity, turning.surface, touch.velocity_normal);
        let before = *memory;
        let shear = T::respond::<N, X>(touch, normal, slip, evaluation, memory);
        let force = S::along(shear.force, touch.normal);
        answer.force = answer.force + force;
        let twist = S::torque_of(touch.normal, force);
        answer.torques = [twist * arms[0], twist * arms[1]];
        if record {
            [answer.rubbed, answer.released] = T::lost::<N, X>(touch, slip, elapsed, &before, memory);
        }
        (answer.shear, answer.slipping) = (shear.force, shear.slipping);
        if R::ACTIVE {
            let memory = &mut memory[T::NUMBERS..];
            let moment = R::moment::<N, X>(touch, normal, turning.relative, elapsed, turning.inertia, memory);
            answer.torques = [answer.torques[0] + moment, answer.torques[1] - moment];
        }
    }
    if record {
        let shear = T::energy(memory, N::tangential_stiffness(touch));
        answer.elastic_energy = N::energy(touch) + shear + R::energy::<N, X>(touch, &memory[T::NUMBERS..]);
    }
    answer
}
