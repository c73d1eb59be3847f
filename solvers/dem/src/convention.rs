//! What separates one discrete element code from another when the scene is the same: named options, and presets.

use std::fmt;

/// What Coulomb's limit acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoulombCap {
    /// The tangential spring; the tangential dashpot is added only while the contact sticks
    /// (Cundall & Strack 1979; LIGGGHTS `tangential history`).
    Spring,
    /// Spring and dashpot together; the spring is reset to match (Luding 2008, Granular Matter 10, 235, eq. 22; LAMMPS
    /// `gran/hooke/history`).
    SpringAndDashpot,
}

/// Which normal force Coulomb's limit is proportional to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapNormal {
    /// The spring's (Cundall & Strack 1979, eq. 19).
    Spring,
    /// The magnitude of spring and dashpot together (LAMMPS, LIGGGHTS).
    Total,
    /// Spring and dashpot together where they push, none where they pull: Coulomb's law as it is written,
    /// |F_s| ≤ F_n tan φ + c.
    Pushing,
}

/// Distance from a grain's centre at which tangential forces act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorqueArm {
    /// The radius R.
    Radius,
    /// R − overlap/2, the contact point halfway through the overlap.
    ContactPoint,
}

/// Whether a normal dashpot may pull on grains that are about to part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tension {
    /// It may: the contact ends when the overlap does.
    Allowed,
    /// The normal force is never below zero (LAMMPS `limit_damping`, LIGGGHTS `limitForce on`).
    Clipped,
}

/// Transport of the tangential and the rolling spring at a contact that turns or whose stiffness changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum History {
    /// The springs turn with the contact: with its normal, and about the normal with the mean spin of both bodies. In the
    /// plane that is a scalar along the tangent (Cundall & Strack 1979). A tangential spring whose stiffness grows keeps its
    /// force, and one whose stiffness falls its stretch (`mindlin_rescale` of LAMMPS; Thornton, Cummins & Cleary, Powder
    /// Technology 233 (2013) 30-46): no closed cycle yields work.
    Turned,
    /// A vector whose normal part is taken off (LAMMPS, LIGGGHTS), with a force of stiffness times stretch.
    Projected,
}

/// Normal along which the velocities of a step are decomposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocityNormal {
    /// The mean of the normals at the start and at the end of the step, as velocities belong to its middle: second order
    /// at contacts that turn.
    MidStep,
    /// The normal at the end of the step (Cundall & Strack 1979, LAMMPS, LIGGGHTS): first order at contacts that turn. A wall
    /// that turns has the velocity of its place at the end of the step.
    EndOfStep,
}

/// Angular velocity that rolls at a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallRolling {
    /// The grain's relative to the wall's, ω − Ω.
    RelativeSpin,
    /// The grain's own, ω, also at a wall that turns (LAMMPS `wall/gran` with `rolling sds`).
    Spin,
    /// The velocity of its surface at the torque arm over the distance of the wall, ω (R − δ/2)/(R − δ): between grains
    /// the two are the same (LIGGGHTS `rolling_friction epsd`).
    Surface,
}

/// A convention: the options together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// Name of the solver that has it.
    pub name: &'static str,
    /// What Coulomb's limit acts on.
    pub coulomb_cap: CoulombCap,
    /// Which normal force the limit is proportional to.
    pub cap_normal: CapNormal,
    /// Torque arm.
    pub torque_arm: TorqueArm,
    /// Tension at release.
    pub tension: Tension,
    /// Transport of springs.
    pub history: History,
    /// Normal of velocities.
    pub velocity_normal: VelocityNormal,
    /// Angular velocity against which walls resist.
    pub wall_rolling: WallRolling,
}

impl Convention {
    /// The default: Coulomb's limit holds at every step, for spring and dashpot together, and a damped contact ends when its
    /// normal force returns to zero.
    pub const DEFAULT: Self = Self {
        name: "dem",
        coulomb_cap: CoulombCap::SpringAndDashpot,
        cap_normal: CapNormal::Pushing,
        torque_arm: TorqueArm::Radius,
        tension: Tension::Clipped,
        history: History::Turned,
        velocity_normal: VelocityNormal::MidStep,
        wall_rolling: WallRolling::RelativeSpin,
    };
    /// Cundall & Strack 1979 to the letter: the limit is that of the springs, and the tangential dashpot is added to it
    /// while the contact sticks, however large it is.
    pub const CUNDALL_STRACK: Self = Self {
        name: "dem:1979",
        coulomb_cap: CoulombCap::Spring,
        cap_normal: CapNormal::Spring,
        torque_arm: TorqueArm::Radius,
        tension: Tension::Allowed,
        history: History::Turned,
        velocity_normal: VelocityNormal::EndOfStep,
        wall_rolling: WallRolling::RelativeSpin,
    };
    /// LAMMPS `gran/hooke/history`.
    pub const LAMMPS: Self = Self {
        name: "dem:lammps",
        coulomb_cap: CoulombCap::SpringAndDashpot,
        cap_normal: CapNormal::Total,
        torque_arm: TorqueArm::Radius,
        tension: Tension::Allowed,
        history: History::Projected,
        velocity_normal: VelocityNormal::EndOfStep,
        wall_rolling: WallRolling::Spin,
    };
    /// LIGGGHTS `hooke/stiffness tangential history`.
    pub const LIGGGHTS: Self = Self {
        name: "dem:liggghts",
        coulomb_cap: CoulombCap::Spring,
        cap_normal: CapNormal::Total,
        torque_arm: TorqueArm::ContactPoint,
        tension: Tension::Allowed,
        history: History::Projected,
        velocity_normal: VelocityNormal::EndOfStep,
        wall_rolling: WallRolling::Surface,
    };

    /// Every preset.
    pub const ALL: [Self; 4] = [Self::DEFAULT, Self::CUNDALL_STRACK, Self::LAMMPS, Self::LIGGGHTS];

    /// The options in words, for a record.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        vec![
            format!(
                "Coulomb cap on {}",
                match self.coulomb_cap {
                    CoulombCap::Spring => "the spring",
                    CoulombCap::SpringAndDashpot => "spring and dashpot",
                }
            ),
            format!(
                "cap ∝ {}",
                match self.cap_normal {
                    CapNormal::Spring => "normal spring force",
                    CapNormal::Total => "total normal force",
                    CapNormal::Pushing => "total normal force where it pushes",
                }
            ),
            format!(
                "torque arm {}",
                match self.torque_arm {
                    TorqueArm::Radius => "R",
                    TorqueArm::ContactPoint => "R − overlap/2",
                }
            ),
            format!(
                "tension {}",
                match self.tension {
                    Tension::Allowed => "allowed",
                    Tension::Clipped => "clipped",
                }
            ),
            format!(
                "stretch {}",
                match self.history {
                    History::Turned => "turned with the contact",
                    History::Projected => "projected on the tangent",
                }
            ),
            format!(
                "velocities on the normal of {}",
                match self.velocity_normal {
                    VelocityNormal::MidStep => "mid-step",
                    VelocityNormal::EndOfStep => "the end of the step",
                }
            ),
            format!(
                "rolling at walls by {}",
                match self.wall_rolling {
                    WallRolling::RelativeSpin => "the spin relative to the wall",
                    WallRolling::Spin => "the spin",
                    WallRolling::Surface => "the surface",
                }
            ),
        ]
    }
}

impl fmt::Display for Convention {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}
