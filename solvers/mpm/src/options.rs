//! Options of the method, and named settings.

use std::fmt;

/// Basis functions of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Hat functions.
    Linear,
    /// Quadratic B-splines.
    Quadratic,
    /// Hat functions averaged over the extent of points (GIMP); the extent grows with the stretch along each axis.
    Gimp,
}

/// Transfer of velocities between points and nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// Points add the change of the nodes' velocity to their own, blended with a fraction `pic` of the velocity itself.
    Flip {
        /// Fraction of the velocity itself in each step; 0 for none.
        pic: f64,
    },
    /// Points carry the affine part of the nodes' velocity.
    Apic,
    /// Points add the change of the nodes' velocity and of its spin to their own.
    Spin,
}

impl Transfer {
    /// Returns true if points carry the affine part of the velocity, or its spin.
    pub(crate) const fn carries_affine(self) -> bool {
        !matches!(self, Self::Flip { .. })
    }
}

/// Time of the stress update within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUpdate {
    /// First, from velocities that points scatter to the nodes.
    First,
    /// Last, from node velocities at the end of the step.
    Last,
    /// Last, from velocities that points scatter to the nodes again (MUSL: Sulsky, Zhou & Schreyer 1995).
    ModifiedLast,
}

/// Contact between bodies, and between bodies and walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// One velocity field for all bodies, which also follows walls.
    NoSlip,
    /// At nodes at which bodies approach (Bardenhagen, Brackbill & Sulsky 2000): bodies separate freely. Each body has
    /// its own normal, from a density smoothed as in eq. 24 of the paper.
    Kinematic,
    /// At nodes with compressive normal traction (Bardenhagen et al. 2001), with each body's own normal. The impulse is
    /// scaled so that cells do not collapse (eq. 22, whose `max` must read `min`).
    Traction,
    /// At nodes near penetrating surface tracers: bodies are treated in pairs along a common normal, while they
    /// approach or are under pressure.
    Gap,
    /// Springs between surface tracers and surfaces, with a tangential spring limited by Coulomb friction. They act at
    /// contact points and not at nodes.
    Penalty,
}

/// A setting of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Basis functions.
    pub basis: Basis,
    /// Transfer of velocities.
    pub transfer: Transfer,
    /// Time of the stress update.
    pub stress_update: StressUpdate,
    /// True if points move with the velocities of the stress update, and not with node velocities after the step; only
    /// for [`StressUpdate::ModifiedLast`].
    ///
    /// The two velocities differ by Δt (1 − S) a, with a the acceleration and S the smoothing by the transfer from
    /// points to nodes and back. In material that vibrates with the velocity v, positions then differ by Δt (1 − S) v
    /// from those that the stress uses. The forces −Σ V σ ∇N(x) of a tension σ respond to this as to a force along v.
    /// With smooth ∇N, waves of wave number k grow at the rate Δt σ k² (1 − S)/2ρ. A bar under a tension of .08 E
    /// breaks apart at rest. Hat functions are not affected, because their ∇N is constant within a cell.
    pub moves_with_stress: bool,
    /// Contact algorithm between bodies and with walls.
    pub contact: Contact,
    /// Springs of [`Contact::Penalty`]: stiffness per area in E'/h, with E' = E/(1 − ν²), harmonic mean of both bodies.
    pub penalty: f64,
    /// Tracers on a surface per cell length.
    pub tracers: f64,
    /// Shift of the grid along each axis (cells).
    pub phase: [f64; 3],
}

impl Setting {
    /// Best known setting, used for all scenes.
    ///
    /// Hat functions cost half and are as good for rolling and impacts. However, points with a spin become unstable on
    /// them after some thousand steps. With softer springs, contacts of a quarter of a cell are more than a tenth too
    /// soft. Stiffer springs, or fewer tracers, slow down discs and spheres that roll at two to four cells per radius.
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

    /// Returns the setting of the original papers with the given contact. More tracers would mark more nodes as in contact.
    #[must_use]
    pub const fn classic(contact: Contact) -> Self {
        let transfer = Transfer::Flip { pic: 0.0 };
        Self { basis: Basis::Linear, transfer, moves_with_stress: false, contact, tracers: 4.0, ..Self::BEST }
    }

    /// Returns a description of the setting.
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
