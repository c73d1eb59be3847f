//! What a solver claims of itself: how finely it is to be run, its order in the time step, and what its method owes
//! less than others, with the physics.

use crate::solver::Resolution;

/// What a solver claims of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Resolution of all runs but those that show the order. The collisions last some 30 critical steps.
    pub resolution: Resolution,
    /// Order in the time step; none where the solver claims none.
    pub order: Option<Order>,
    /// What it owes less than others.
    pub less: &'static [Less],
    /// Whether scenes in space are run beside those in the plane, which take some methods long.
    pub in_space: bool,
    /// Whether runs that watch the energy take 10⁵ steps instead of some thousands.
    pub long: bool,
}

/// A claim about the order in the time step, for smooth motion without dashpots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The order.
    pub expected: f64,
    /// Three resolutions, each of half the time step of the one before. The run lasts ten critical steps.
    pub levels: [Resolution; 3],
}

/// Something that a method does not keep to rounding, and how far it is off at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Less {
    /// Property, such as `rotation-invariance`.
    pub property: &'static str,
    /// The beginning of the quantity, such as `angular`; empty for all of the property.
    pub quantity: &'static str,
    /// Error, as a part of the row's scale, beyond which the row is red all the same. It is set above what was seen, so
    /// that it tells of a change and of nothing else: what is owed less is never green.
    pub at_most: f64,
    /// The physics of it.
    pub because: &'static str,
}

impl Terms {
    /// Central differences at steps that suit springs: second order.
    pub const SECOND_ORDER: Self = Self {
        resolution: Resolution::CriticalFraction(0.02),
        order: Some(Order {
            expected: 2.0,
            levels: [
                Resolution::CriticalFraction(0.01),
                Resolution::CriticalFraction(0.005),
                Resolution::CriticalFraction(0.0025),
            ],
        }),
        less: &[],
        in_space: true,
        long: false,
    };

    /// No claim about the order.
    #[must_use]
    pub const fn at(resolution: Resolution) -> Self {
        Self { resolution, order: None, less: &[], in_space: true, long: false }
    }

    /// The same of a method that owes less.
    #[must_use]
    pub const fn owing_less(self, less: &'static [Less]) -> Self {
        Self { less, ..self }
    }

    /// The same for scenes in the plane alone.
    #[must_use]
    pub const fn in_the_plane(self) -> Self {
        Self { in_space: false, ..self }
    }

    /// The terms with long runs where the energy is watched.
    #[must_use]
    pub const fn at_length(self) -> Self {
        Self { long: true, ..self }
    }

    /// What is owed less of a quantity.
    #[must_use]
    pub fn less_of(&self, property: &str, quantity: &str) -> Option<&'static Less> {
        self.less.iter().find(|less| less.property == property && quantity.starts_with(less.quantity))
    }
}
