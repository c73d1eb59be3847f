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

/// How the tangential spring's stretch is carried along with a contact that turns in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum History {
    /// As a scalar along the tangent, which turns with the contact (Cundall & Strack 1979).
    Turned,
    /// As a vector whose normal part is taken off (LAMMPS, LIGGGHTS).
    Projected,
}

/// Which angular velocity rolls at a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallRolling {
    /// The grain's own, ω.
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
    /// Stretch at a contact that turns.
    pub history: History,
    /// Angular velocity against which walls resist.
    pub wall_rolling: WallRolling,
}

impl Convention {
    /// Ours: Coulomb's limit holds at every step, for spring and dashpot together.
    pub const DEFAULT: Self = Self {
        name: "dem",
        coulomb_cap: CoulombCap::SpringAndDashpot,
        cap_normal: CapNormal::Pushing,
        torque_arm: TorqueArm::Radius,
        tension: Tension::Allowed,
        history: History::Turned,
        wall_rolling: WallRolling::Spin,
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
        wall_rolling: WallRolling::Spin,
    };
    /// LAMMPS `gran/hooke/history`.
    pub const LAMMPS: Self = Self {
        name: "dem:lammps",
        coulomb_cap: CoulombCap::SpringAndDashpot,
        cap_normal: CapNormal::Total,
        torque_arm: TorqueArm::Radius,
        tension: Tension::Allowed,
        history: History::Projected,
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
        wall_rolling: WallRolling::Surface,
    };
    /// Ours with the normal force never below zero.
    pub const NO_TENSION: Self = Self { name: "dem:no-tension", tension: Tension::Clipped, ..Self::DEFAULT };

    /// Every preset.
    pub const ALL: [Self; 5] = [Self::DEFAULT, Self::CUNDALL_STRACK, Self::LAMMPS, Self::LIGGGHTS, Self::NO_TENSION];

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
                "rolling at walls by {}",
                match self.wall_rolling {
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
