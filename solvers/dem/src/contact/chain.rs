//! One contact through its chain of stages: normal, then tangential, then rolling.

use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{Options, Touch};
use grainbench_scene::space::Space;

/// What a contact remembers from step to step: the histories of the tangential and of the rolling stage.
pub(crate) type Memory<S, T, R> = (<T as Tangential<S>>::History, <R as Rolling<S>>::History);

/// A memory with the roles of first and second grain exchanged.
pub(crate) fn exchanged<S: Space, T: Tangential<S>, R: Rolling<S>>(
    (shear, rolling): Memory<S, T, R>,
) -> Memory<S, T, R> {
    (T::exchange(shear), R::exchange(rolling))
}

/// How two bodies turn at their contact.
pub(crate) struct Turning<S: Space> {
    /// ω₁a₁ + ω₂a₂, with the angular velocities ω and the torque arms a: by what the surfaces slip because the bodies
    /// turn (m/s).
    pub(crate) surface: S::Spin,
    /// Angular velocity of the first body relative to the second, ω₁ − ω₂ (rad/s), or what rolls in its place at a
    /// wall.
    pub(crate) relative: S::Spin,
    /// Moment of inertia of the two about their contact, [1/(I₁ + m₁R₁²) + 1/(I₂ + m₂R₂²)]⁻¹ (kg m²).
    pub(crate) inertia: f64,
}

/// What the chain answers: forces and moments on the first body, and what is shown of the contact.
pub(crate) struct Answer<S: Space> {
    /// Unit normal e from the first body to the second.
    pub(crate) normal: S::Vector,
    /// Overlap δ (m).
    pub(crate) overlap: f64,
    /// Force on the first body (N).
    pub(crate) force: S::Vector,
    /// `e × F_s` (N): times the torque arm (m) it is the torque of the tangential force F_s.
    pub(crate) twist: S::Spin,
    /// Moment against rolling on the first body (N m).
    pub(crate) rolling: S::Spin,
    /// Torque arms of both bodies (m).
    pub(crate) arms: [f64; 2],
    /// Normal force F_n (N), positive when it pushes apart.
    pub(crate) normal_force: f64,
    /// Tangential force F_s on the first body (N).
    pub(crate) shear: S::Tangent,
    /// Whether Coulomb's limit was reached.
    pub(crate) slipping: bool,
    /// Energy in the springs (J), only when it is recorded.
    pub(crate) elastic_energy: f64,
    /// Work of friction in the step (J), only when it is recorded.
    pub(crate) rubbed: f64,
}

/// Takes one contact through its stages. `arms` are the torque arms of both bodies (m), `turning` is `None` where
/// bodies do not rotate, and `elapsed` is the time since the last evaluation (s). Energies are found only with
/// `RECORD`.
#[inline(always)]
pub(crate) fn stages<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>, const RECORD: bool>(
    touch: &Touch<'_, S>,
    arms: [f64; 2],
    turning: Option<Turning<S>>,
    options: &Options,
    elapsed: f64,
    history: &mut Memory<S, T, R>,
) -> Answer<S> {
    let normal = N::force(touch, options);
    let mut answer = Answer {
        normal: touch.normal,
        overlap: touch.overlap,
        force: touch.between * -(normal.total * touch.inverse_distance),
        twist: S::NO_SPIN,
        rolling: S::NO_SPIN,
        arms,
        normal_force: normal.total,
        shear: S::NO_TANGENT,
        slipping: false,
        elastic_energy: 0.0,
        rubbed: 0.0,
    };
    if let (true, Some(turning)) = (T::ACTIVE, turning) {
        let slip = S::slip_velocity(touch.velocity, turning.surface, touch.normal);
        let before = history.0;
        let shear = T::respond::<N>(touch, normal, slip, elapsed, &mut history.0);
        let force = S::along(shear.force, touch.normal);
        answer.force += force;
        answer.twist = S::torque(touch.normal, force);
        if RECORD {
            answer.rubbed = T::rubbed::<N>(touch, slip, elapsed, before, history.0);
        }
        (answer.shear, answer.slipping) = (shear.force, shear.slipping);
        if R::ACTIVE {
            answer.rolling = R::moment::<N>(touch, normal, turning.relative, elapsed, turning.inertia, &mut history.1);
        }
    }
    if RECORD {
        let shear = T::energy(history.0, N::tangential_stiffness(touch));
        answer.elastic_energy = N::energy(touch) + shear + R::energy::<N>(touch, history.1);
    }
    answer
}
