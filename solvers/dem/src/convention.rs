//! Conventions in which discrete element codes differ for the same scene. A convention is a set of options. Four
//! conventions have names.

/// Force to which the Coulomb limit applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoulombCap {
    /// Force of the tangential spring. The tangential dashpot is added only while the contact sticks (Cundall & Strack
    /// 1979; LIGGGHTS `tangential history`).
    Spring,
    /// Force of spring and dashpot together. The spring displacement is reset so that this force equals the limit
    /// (Luding 2008, Granular Matter 10, 235, eq. 22; LAMMPS `gran/hooke/history`).
    SpringAndDashpot,
}

/// Normal force to which the Coulomb limit is proportional.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapNormal {
    /// Normal force of the spring (Cundall & Strack 1979, eq. 19).
    Spring,
    /// Magnitude of the force of spring and dashpot together (LAMMPS, LIGGGHTS).
    Total,
    /// Force of spring and dashpot together if it is repulsive, otherwise zero: Coulomb's law as written, |F_s| ≤ F_n
    /// tan φ + c.
    Pushing,
}

/// Lever arm of tangential forces, from the centre of the grain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorqueArm {
    /// Radius R.
    Radius,
    /// R − overlap/2, the distance to the contact point in the middle of the overlap.
    ContactPoint,
}

/// Treatment of a normal dashpot that pulls on separating grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tension {
    /// Tension is allowed. The contact ends when the overlap is zero.
    Allowed,
    /// The normal force is never negative (LAMMPS `limit_damping`, LIGGGHTS `limitForce on`).
    Clipped,
}

/// Transport of the tangential and rolling springs at a contact that rotates or whose stiffness changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum History {
    /// The springs rotate with the normal of the contact, and about the normal with the mean spin of both bodies. In the
    /// plane, the spring displacement is a scalar along the tangent (Cundall & Strack 1979). If its stiffness increases,
    /// a spring keeps its force or moment. If its stiffness decreases, the spring keeps its displacement. A closed
    /// loading cycle then never yields work (`mindlin_rescale/force` of LAMMPS; Thornton, Cummins & Cleary, Powder
    /// Technology 233 (2013) 30-46).
    Turned,
    /// The spring displacement is a vector without its normal part (LAMMPS, LIGGGHTS). The tangential force is stiffness
    /// times displacement. The moment of a rolling spring is the sum of its increments (LIGGGHTS).
    Projected,
}

/// Normal along which the velocities of a step are decomposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocityNormal {
    /// Mean of the normals at the start and the end of the step, because velocities belong to the middle of the step. The
    /// error of the relative velocity at rotating contacts is then of second order in the time step.
    MidStep,
    /// Normal at the end of the step (Cundall & Strack 1979, LAMMPS, LIGGGHTS). The error at rotating contacts is of
    /// first order in the time step. The velocity of a rotating wall is computed from its position at the end of the
    /// step.
    EndOfStep,
}

/// Angular velocity for rolling resistance at a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallRolling {
    /// Angular velocity of the grain relative to the wall, ω − Ω.
    RelativeSpin,
    /// Angular velocity ω of the grain, even at a rotating wall (LAMMPS `wall/gran` with `rolling sds`).
    Spin,
    /// Surface velocity at the lever arm R − δ/2 divided by the distance R − δ of the wall, ω (R − δ/2)/(R − δ), for
    /// the overlap δ. Contacts between grains use the relative spin (LIGGGHTS `rolling_friction epsd`).
    Surface,
}

/// Set of options that defines a convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// Name of the solver with this convention.
    pub name: &'static str,
    /// Force to which the Coulomb limit applies.
    pub coulomb_cap: CoulombCap,
    /// Normal force to which the Coulomb limit is proportional.
    pub cap_normal: CapNormal,
    /// Lever arm of tangential forces.
    pub torque_arm: TorqueArm,
    /// Treatment of a normal dashpot that pulls.
    pub tension: Tension,
    /// Transport of springs at rotating contacts.
    pub history: History,
    /// Normal along which velocities are decomposed.
    pub velocity_normal: VelocityNormal,
    /// Angular velocity for rolling resistance at walls.
    pub wall_rolling: WallRolling,
}

impl Convention {
    /// Default convention. The Coulomb limit holds at every step for spring and dashpot together, and a damped contact
    /// ends when its normal force returns to zero.
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
    /// Cundall & Strack 1979 exactly as published. The Coulomb limit applies to the tangential spring. While the
    /// contact sticks, the dashpot is added to the spring without limit.
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

    /// All named conventions, the default first.
    pub const ALL: [Self; 4] = [Self::DEFAULT, Self::CUNDALL_STRACK, Self::LAMMPS, Self::LIGGGHTS];

    /// Returns the options as text, for a record.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let words = [
            match self.coulomb_cap {
                CoulombCap::Spring => "Coulomb limit on the spring",
                CoulombCap::SpringAndDashpot => "Coulomb limit on spring and dashpot",
            },
            match self.cap_normal {
                CapNormal::Spring => "limit ∝ normal spring force",
                CapNormal::Total => "limit ∝ total normal force",
                CapNormal::Pushing => "limit ∝ total normal force where it pushes",
            },
            match self.torque_arm {
                TorqueArm::Radius => "lever arm R",
                TorqueArm::ContactPoint => "lever arm R − overlap/2",
            },
            match self.tension {
                Tension::Allowed => "tension allowed",
                Tension::Clipped => "tension clipped",
            },
            match self.history {
                History::Turned => "tangential spring turned with the contact",
                History::Projected => "tangential spring projected on the tangent",
            },
            match self.velocity_normal {
                VelocityNormal::MidStep => "velocities on the normal at mid-step",
                VelocityNormal::EndOfStep => "velocities on the normal at the end of the step",
            },
            match self.wall_rolling {
                WallRolling::RelativeSpin => "rolling at walls from the spin relative to the wall",
                WallRolling::Spin => "rolling at walls from the spin",
                WallRolling::Surface => "rolling at walls from the surface",
            },
        ];
        words.map(str::to_owned).to_vec()
    }
}
