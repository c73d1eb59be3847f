//! First stage: the force along the normal.

use super::{Options, Touch};
use grainbench_scene::space::Space;

/// Normal force at a contact (N), positive when it pushes apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce {
    /// Of spring and dashpot.
    pub total: f64,
    /// What Coulomb's limit is proportional to.
    pub for_cap: f64,
}

/// The normal stage.
pub trait Normal: Copy + Send + 'static {
    /// Whether dashpots act at contacts, along the tangent too.
    const DAMPED: bool;

    /// The normal force.
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce;
}

/// A linear spring, F_n = k_n δ.
#[derive(Clone, Copy, Debug)]
pub struct Spring;

impl Normal for Spring {
    const DAMPED: bool = false;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, _options: &Options) -> NormalForce {
        let spring = touch.law.normal_stiffness * touch.overlap;
        NormalForce { total: spring, for_cap: spring }
    }
}

/// A linear spring and a dashpot, F_n = k_n δ + c_n δ̇ with c_n = β k_n + γ_n m_eff (Cundall & Strack 1979, eqs. 26 and
/// 28; LAMMPS and LIGGGHTS write the second term).
#[derive(Clone, Copy, Debug)]
pub struct SpringDashpot;

impl Normal for SpringDashpot {
    const DAMPED: bool = true;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce {
        let law = touch.law;
        let spring = law.normal_stiffness * touch.overlap;
        let viscosity = law.stiffness_damping * law.normal_stiffness + law.normal_damping * touch.effective_mass;
        let dashpot = viscosity * S::dot(touch.velocity, touch.normal);
        let total = (spring + dashpot).max(options.least_normal_force);
        let for_cap = (spring + options.dashpot_in_cap * (total - spring)).abs();
        NormalForce { total, for_cap }
    }
}
