//! Conformance properties of a solver: the resolution in tests, the order of convergence in the time step, and the
//! limitations with their physical reasons.

use crate::resolution::Resolution;

/// Conformance properties of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Resolution of all runs except those that determine the order. The collisions last about 30 critical time steps.
    pub resolution: Resolution,
    /// Order of convergence in the time step; `None` if the solver claims none.
    pub order: Option<Order>,
    /// Properties that the solver satisfies only within an error limit.
    pub less: &'static [Limitation],
    /// True if the tests include scenes in three dimensions. Some methods need a long time for them.
    pub in_space: bool,
    /// True if runs that monitor the energy take 10⁵ steps instead of some thousands.
    pub long: bool,
}

/// Claimed order of convergence in the time step, for smooth motion without dashpots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Expected order of convergence in the time step, such as 2.
    pub expected: f64,
    /// Three resolutions. Each has half the time step of the previous one. The runs last ten critical time steps.
    pub levels: [Resolution; 3],
}

/// Limitation: property that a method satisfies only within an error limit above rounding errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limitation {
    /// Property, such as `rotation-invariance`.
    pub property: &'static str,
    /// Prefix of the quantity, such as `angular`; empty for all quantities of the property.
    pub quantity: &'static str,
    /// Error limit, relative to the scale of the result, above which the result fails. It is larger than the observed
    /// error, so that only a change of the solver exceeds it. A result with a limitation is never green.
    pub at_most: f64,
    /// Physical reason.
    pub because: &'static str,
}

impl Limitation {
    /// Creates a limitation.
    #[must_use]
    pub const fn new(property: &'static str, quantity: &'static str, at_most: f64, because: &'static str) -> Self {
        Self { property, quantity, at_most, because }
    }
}

impl Terms {
    /// Properties of central differences, which are of second order in the time step. The time steps suit contact
    /// springs.
    pub const SECOND_ORDER: Self = Self {
        order: Some(Order {
            expected: 2.0,
            levels: [
                Resolution::CriticalFraction(0.01),
                Resolution::CriticalFraction(0.005),
                Resolution::CriticalFraction(0.0025),
            ],
        }),
        ..Self::at(Resolution::CriticalFraction(0.02))
    };

    /// Returns properties with a resolution, and without a claimed order or limitations.
    #[must_use]
    pub const fn at(resolution: Resolution) -> Self {
        Self { resolution, order: None, less: &[], in_space: true, long: false }
    }

    /// Returns these properties with the given limitations.
    #[must_use]
    pub const fn owing_less(self, less: &'static [Limitation]) -> Self {
        Self { less, ..self }
    }

    /// Returns these properties for scenes in two dimensions only.
    #[must_use]
    pub const fn in_the_plane(self) -> Self {
        Self { in_space: false, ..self }
    }

    /// Returns these properties with long runs that monitor the energy.
    #[must_use]
    pub const fn at_length(self) -> Self {
        Self { long: true, ..self }
    }

    /// Returns the limitation that applies to a quantity; `None` if there is none.
    #[must_use]
    pub fn less_of(&self, property: &str, quantity: &str) -> Option<&'static Limitation> {
        self.less.iter().find(|less| less.property == property && quantity.starts_with(less.quantity))
    }
}
