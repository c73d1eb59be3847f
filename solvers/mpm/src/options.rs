//! Options of the method, and named settings.

/// Basis functions of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Hat functions.
    Linear,
    /// Quadratic B-splines.
    Quadratic,
    /// Hat functions averaged over the extent of points (GIMP). The extent grows with the stretch along each axis.
    Gimp,
}

/// Transfer of velocities between points and nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// FLIP: points add the change of the node velocity to their own velocity, blended with a fraction `pic` of the
    /// node velocity (PIC).
    Flip {
        /// Fraction of the node velocity in the new velocity; 0 for pure FLIP.
        pic: f64,
    },
    /// APIC: points store the affine part of the node velocity.
    Apic,
    /// FLIP with spin: points add the changes of velocity and spin of the velocity field to their own velocity and spin.
    Spin,
}

/// Time of the stress update within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUpdate {
    /// At the start of the step, from velocities that points scatter to the nodes.
    First,
    /// At the end of the step, from the node velocities after the step.
    Last,
    /// At the end of the step, from velocities that points scatter to the nodes again (MUSL: Sulsky, Zhou & Schreyer
    /// 1995).
    ModifiedLast,
}

/// Contact between bodies, and between bodies and walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// One velocity field for all bodies. At walls, this field has the velocity of the wall.
    NoSlip,
    /// Contact at nodes at which bodies approach (Bardenhagen, Brackbill & Sulsky 2000). Bodies separate freely. Each
    /// body has its own normal, from a density smoothed as in eq. 24 of the paper.
    Kinematic,
    /// Contact at nodes with compressive normal traction (Bardenhagen et al. 2001), with each body's own normal. The
    /// impulse is scaled so that cells do not collapse (eq. 22, whose `max` must read `min`).
    Traction,
    /// Contact at nodes near penetrating surface tracers. It acts between pairs of bodies along a common normal, while
    /// they approach or are under pressure.
    Gap,
    /// Springs between surface tracers and surfaces, with a tangential spring limited by Coulomb friction. The springs
    /// act at contact points and not at nodes.
    Penalty,
}

/// Setting of the method: all parameters except the resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Basis functions.
    pub basis: Basis,
    /// Transfer of velocities between points and nodes.
    pub transfer: Transfer,
    /// Time of the stress update.
    pub stress_update: StressUpdate,
    /// True if points move with the velocities of the stress update instead of node velocities after the step. It
    /// applies only to [`StressUpdate::ModifiedLast`].
    ///
    /// The two velocities differ by Δt (1 − S) a, with the acceleration a and the smoothing S by the transfer from
    /// points to nodes and back. In material that vibrates with the velocity v, positions then differ by Δt (1 − S) v
    /// from the positions that the stress uses. The forces −Σ V σ ∇N(x) of a tension σ respond to this difference as to
    /// a force along v. With smooth ∇N, waves of wave number k grow at the rate Δt σ k² (1 − S)/2ρ. A bar at rest under
    /// a tension of .08 E breaks apart. Hat functions are not affected, because their ∇N is constant within a cell.
    pub moves_with_stress: bool,
    /// Contact algorithm between bodies and with walls.
    pub contact: Contact,
    /// Stiffness per area of the springs of [`Contact::Penalty`], in units of E'/h. E' is the harmonic mean of E/(1 −
    /// ν²) over both bodies, and h the cell length.
    pub penalty: f64,
    /// Number of surface tracers per cell length.
    pub tracers: f64,
    /// Shift of the grid along each axis (cells).
    pub phase: [f64; 3],
}

impl Setting {
    /// Best known setting, used for all scenes.
    ///
    /// Hat functions cost half as much and are as good for rolling and impacts. However, with hat functions, points with
    /// a spin become unstable after some thousand steps. With softer springs, contacts that are half a cell wide
    /// are more than a tenth too soft. With stiffer springs or fewer tracers, discs and spheres roll too slowly at two to
    /// four cells per radius.
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

    /// Returns the setting of the original papers with the given contact. It has fewer tracers than [`Self::BEST`],
    /// because more tracers would mark more nodes as in contact.
    #[must_use]
    pub const fn classic(contact: Contact) -> Self {
        let transfer = Transfer::Flip { pic: 0.0 };
        Self { basis: Basis::Linear, transfer, moves_with_stress: false, contact, tracers: 4.0, ..Self::BEST }
    }

    /// Returns a description of the setting.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let basis = match self.basis {
            Basis::Linear => "linear basis",
            Basis::Quadratic => "quadratic B-splines",
            Basis::Gimp => "GIMP basis",
        };
        let transfer = match self.transfer {
            Transfer::Flip { pic: 0.0 } => "FLIP".to_owned(),
            Transfer::Flip { pic } => format!("FLIP with {pic} PIC"),
            Transfer::Apic => "APIC".to_owned(),
            Transfer::Spin => "FLIP with spin".to_owned(),
        };
        let update = match self.stress_update {
            StressUpdate::First => "stress updated first",
            StressUpdate::Last => "stress updated last",
            StressUpdate::ModifiedLast => "stress updated last from reprojected velocities (MUSL)",
        };
        let contact = match self.contact {
            Contact::NoSlip => "no slip: one velocity field",
            Contact::Kinematic => "nodal contact on approach (2000)",
            Contact::Traction => {
                "nodal contact under compressive traction (2001), which keeps no Coulomb limit at walls"
            }
            Contact::Gap => "nodal contact where surfaces have met",
            Contact::Penalty => "springs between surfaces",
        };
        let mut words = vec![basis.to_owned(), transfer, update.to_owned()];
        if self.moves_with_stress && self.stress_update == StressUpdate::ModifiedLast {
            words.push("points move with the reprojected velocities of the stress update".to_owned());
        }
        words.push(contact.to_owned());
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
