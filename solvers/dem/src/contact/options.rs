//! Options of a convention, as numbers for the compiled loops.

use crate::convention::{CapNormal, Convention, CoulombCap, History, Tension, TorqueArm, VelocityNormal, WallRolling};

/// Force to which the Coulomb limit applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cap {
    /// Force of the spring. The dashpot is added only while the contact sticks.
    Spring,
    /// Force of spring and dashpot together. The spring displacement is reset so that this force equals the limit
    /// (Luding 2008, Granular Matter 10, 235, eq. 22). If the dashpot alone exceeds the limit, the displacement is set
    /// to zero, so that the spring never acts in the sliding direction.
    Total,
    /// Force of spring and dashpot together, as in LAMMPS. The spring may act in the sliding direction. If the spring
    /// has no displacement yet, as at the start, a force beyond the limit is set to zero.
    TotalAsLammps,
}

/// Options of a convention as numbers for the compiled loops. The option `Convention::history` also selects which loop
/// runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    /// Fraction of the overlap that is subtracted from the lever arm: 0 or 1/2.
    pub(crate) arm_reduction: f64,
    /// Smallest normal force (N): zero if the dashpot must not pull, otherwise −∞.
    pub(crate) least_normal_force: f64,
    /// Weight of the dashpot in the normal force of the Coulomb limit: 0 or 1.
    pub(crate) dashpot_in_cap: f64,
    /// Weight of the magnitude of an attractive normal force in the Coulomb limit: 0 or 1.
    pub(crate) pull_in_cap: f64,
    /// Force to which the Coulomb limit applies.
    pub(crate) cap: Cap,
    /// True if rolling resistance at walls uses the surface velocity divided by the distance from the wall, instead of
    /// the spin.
    pub(crate) rolls_by_surface: bool,
    /// Weight of the wall's spin in the rolling velocity: 0 or 1.
    pub(crate) wall_spin: f64,
    /// True if velocities are decomposed along the mid-step normal.
    pub(crate) mid_step: bool,
}

impl Options {
    /// Returns true if a normal dashpot may pull.
    pub(crate) const fn may_pull(&self) -> bool {
        self.least_normal_force < 0.0
    }

    /// Returns the options of a convention.
    #[must_use]
    pub(crate) const fn from_convention(convention: &Convention) -> Self {
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
