//! Scope of a claim: only the solvers that it names, or all solvers of a kind.

use grainbench_solver::Solver;

/// Solvers to which a claim applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Only the solvers named in the claim's runs. The expected value depends on the convention of a program, its order
    /// in Δt, the compliance of its contacts, or its agreement with another program.
    Named,
    /// Any solver that can run the scene. The scene determines the expectation. The tolerance allows for conventions
    /// that the scene leaves open, such as lever arm and limit on the dashpot. The negative control is a wrong scene,
    /// so that an external solver can run it too.
    AnySolver,
    /// Any solver with deformable bodies. The tolerance allows for the discretisation error of a second-order method
    /// with the cells of the run.
    AnyContinuum,
    /// Any solver whose contacts have the springs and dashpots of the scene. Solvers with rigid contacts are excluded.
    AnySprings,
}

impl Scope {
    /// Returns true if the claim can apply to solvers that the case does not name.
    #[must_use]
    pub const fn is_open(self) -> bool {
        !matches!(self, Self::Named)
    }

    /// Returns true if only the motion of grains is measured, not fields inside them.
    #[must_use]
    pub const fn is_of_grains(self) -> bool {
        matches!(self, Self::AnySolver | Self::AnySprings)
    }

    /// Returns the scope as one word, for lists of claims.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::AnySolver => "any",
            Self::AnyContinuum => "continuum",
            Self::AnySprings => "springs",
        }
    }

    /// Returns true if the claim applies to a given solver that the case does not name.
    #[must_use]
    pub fn applies_to(self, solver: &dyn Solver) -> bool {
        match self {
            Self::Named => false,
            Self::AnySolver => true,
            Self::AnyContinuum => solver.deforms(),
            Self::AnySprings => solver.has_springs(),
        }
    }
}
