//! Options of the method, and the settings that have names.

use std::fmt;

/// Basis functions of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Hat functions.
    Linear,
    /// Quadratic B-splines.
    Quadratic,
    /// Hat functions averaged over the extent of points, which grows with the stretch along each axis (GIMP).
    Gimp,
}

/// How velocities travel between points and nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// Points take on the change of the nodes' velocity, blended with `pic` of the velocity itself.
    Flip {
        /// Fraction of the velocity itself in each step, 0 for none.
        pic: f64,
    },
    /// Points carry the affine part of the nodes' velocity.
    Apic,
    /// Points take on the change of the nodes' velocity and of its spin.
    Spin,
}

impl Transfer {
    /// Whether points carry the affine part of the velocity, or its spin.
    pub(crate) const fn carries_affine(self) -> bool {
        !matches!(self, Self::Flip { .. })
    }
}

/// When the stress follows the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUpdate {
    /// First: from the velocities that the points bring to the nodes.
    First,
    /// Last: from the nodes' velocities at the end of the step.
    Last,
    /// Last, from velocities that the points bring to the nodes once more (MUSL: Sulsky, Zhou & Schreyer 1995).
    ModifiedLast,
}

/// How bodies touch each other and walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// One velocity field for all bodies, which walls carry along.
    NoSlip,
    /// Nodes at which bodies approach (Bardenhagen, Brackbill & Sulsky 2000): released on departure, each body along
    /// its own normal, from a density smoothed as in their eq. 24.
    Kinematic,
    /// Nodes at which the normal traction is compressive (Bardenhagen et al. 2001), each body along its own normal; the
    /// impulse is scaled to keep cells from collapsing (eq. 22, whose `max` must read `min`).
    Traction,
    /// Nodes at which surfaces have met, found from tracers on them: bodies pair by pair along a common normal, while
    /// they approach or press.
    Gap,
    /// Springs between tracers on the surfaces, with a Coulomb-limited spring along them, that act where surfaces meet
    /// and not at nodes.
    Penalty,
}

/// A setting of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Basis functions.
    pub basis: Basis,
    /// Transfer of velocities.
    pub transfer: Transfer,
    /// When the stress follows.
    pub stress_update: StressUpdate,
    /// Whether points move with the velocities that stresses follow, and not with those of the nodes after the step: of
    /// [`StressUpdate::ModifiedLast`].
    ///
    /// The two differ by Δt (1 − S) a, a the acceleration and S the smoothing of points by nodes and of nodes by points. In
    /// material that swings with the velocity v, positions are then off by Δt (1 − S) v from what the stress knows of, and the
    /// forces −Σ V σ ∇N(x) of a tension σ feel it as a force along v: with smooth ∇N waves of wave number k grow by
    /// Δt σ k² (1 − S)/2ρ a second. A bar under a tension of .08 E falls to pieces at rest. Hat functions, whose ∇N is constant
    /// in a cell, feel nothing of it there.
    pub moves_with_stress: bool,
    /// Contact.
    pub contact: Contact,
    /// Springs of [`Contact::Penalty`]: stiffness per area in E'/h, with E' = E/(1 − ν²), harmonic mean of both bodies.
    pub penalty: f64,
    /// Tracers on a surface per cell length.
    pub tracers: f64,
    /// Where nodes stand: shift of the grid in cells along each axis.
    pub phase: [f64; 3],
}

impl Setting {
    /// One setting for all scenes: the best known. With hat functions, which cost half, rolling and impacts are as
    /// good, but points with a spin become unstable on them after some thousand steps. Softer springs show contacts of
    /// a quarter of a cell more than a tenth too soft; stiffer ones, or fewer tracers, slow discs and spheres that roll
    /// at two to four cells a radius.
    pub const BEST: Self = Self {
        basis: Basis::Quadratic,
        transfer: Transfer::Spin,
        stress_update: StressUpdate::ModifiedLast,
        moves_with_stress: true,
        contact: Contact::Penalty,
        penalty: 2.6,
        tracers: 6.0,
        phase: [0.0; 3],
    };

    /// What the papers used, with another contact. More tracers would mark more nodes as met.
    #[must_use]
    pub const fn classic(contact: Contact) -> Self {
        let transfer = Transfer::Flip { pic: 0.0 };
        Self { basis: Basis::Linear, transfer, moves_with_stress: false, contact, tracers: 4.0, ..Self::BEST }
    }

    /// The setting in words.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let mut words = vec![self.basis.to_string(), self.transfer.to_string(), self.stress_update.to_string()];
        if self.moves_with_stress && self.stress_update == StressUpdate::ModifiedLast {
            words.push("points move with the velocities that stresses follow".to_owned());
        }
        words.push(self.contact.to_string());
        if self.contact == Contact::Penalty {
            words.push(format!("contact stiffness {} E'/h per area", self.penalty));
        }
        if matches!(self.contact, Contact::Penalty | Contact::Gap) {
            words.push(format!("{} tracers per cell on surfaces", self.tracers));
        }
        if self.phase != [0.0; 3] {
            words.push(format!("grid shifted by {:?} cells", self.phase));
        }
        words
    }
}

impl fmt::Display for Basis {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Linear => "linear basis",
            Self::Quadratic => "quadratic B-splines",
            Self::Gimp => "GIMP basis",
        })
    }
}

impl fmt::Display for Transfer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flip { pic: 0.0 } => formatter.write_str("FLIP"),
            Self::Flip { pic } => write!(formatter, "FLIP with {pic} PIC"),
            Self::Apic => formatter.write_str("APIC"),
            Self::Spin => formatter.write_str("FLIP with spin"),
        }
    }
}

impl fmt::Display for StressUpdate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::First => "stress updated first",
            Self::Last => "stress updated last",
            Self::ModifiedLast => "stress updated last from reprojected velocities (MUSL)",
        })
    }
}

impl fmt::Display for Contact {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NoSlip => "no slip: one velocity field",
            Self::Kinematic => "nodal contact on approach (2000)",
            Self::Traction => "nodal contact under compressive traction (2001), which keeps no Coulomb limit at walls",
            Self::Gap => "nodal contact where surfaces have met",
            Self::Penalty => "springs between surfaces",
        })
    }
}
