//! Whom a gate is fair to: the solvers that it names, or any solver.

use grainbench_scene::solver::Solver;

/// Whom a gate may judge. A case says it for every gate; there is no default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The solvers that its runs name: it judges a program's convention, its order in Δt, the compliance of its
    /// contact, or its agreement with one other program.
    Named,
    /// Any solver that can express the scene. The expectation is physics that the scene fixes, the tolerance leaves
    /// room for what the scene leaves open (torque arm, cap on the dashpot), and the negative control is a wrong scene,
    /// so that it can be tried on a stranger too.
    AnySolver,
    /// The same of any solver whose bodies deform. The tolerance leaves room for the discretisation by the row's cells with a
    /// method of second order.
    AnyContinuum,
    /// The same of any solver whose contacts have the springs and dashpots of the scene: what rigid contacts do not have is not
    /// asked of them.
    AnySprings,
}

impl Scope {
    /// Whether solvers may be judged that the case does not name.
    #[must_use]
    pub const fn is_open(self) -> bool {
        !matches!(self, Self::Named)
    }

    /// Whether what grains do tells it, whatever is inside them.
    #[must_use]
    pub const fn is_of_grains(self) -> bool {
        matches!(self, Self::AnySolver | Self::AnySprings)
    }

    /// The solvers in a word, for lists of claims.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::AnySolver => "any",
            Self::AnyContinuum => "continuum",
            Self::AnySprings => "springs",
        }
    }

    /// Whether it is asked of a solver that the case does not name.
    #[must_use]
    pub fn is_asked_of(self, solver: &dyn Solver) -> bool {
        match self {
            Self::Named => false,
            Self::AnySolver => true,
            Self::AnyContinuum => solver.deforms(),
            Self::AnySprings => solver.has_springs(),
        }
    }
}
