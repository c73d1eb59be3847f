//! Numerical methods, which differ in the effects that they can omit.

/// Numerical method of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Discrete element method. The resolution is a time step.
    Dem,
    /// Rigid grains. The resolution consists of substeps and iterations.
    Rigid,
    /// Deformable grains on a grid. The resolution consists of cells and points.
    Grid,
}

impl Method {
    /// Returns the method of one of our solvers, by name.
    #[must_use]
    pub fn from_name(solver: &str) -> Option<Self> {
        match solver.split([':', '+']).next() {
            Some("dem") => Some(Self::Dem),
            Some("rigid") => Some(Self::Rigid),
            Some("mpm") => Some(Self::Grid),
            _ => None,
        }
    }

    /// Returns the cause of the error that remains at the finest resolution.
    #[must_use]
    pub const fn floor(self) -> &'static str {
        match self {
            Self::Dem => "compliance of the contact",
            Self::Rigid => "the engine's own overlap and order of contacts",
            Self::Grid => "deformability, and contact as soft as a cell",
        }
    }
}
