//! Where the energy of a run comes from and goes, each entry found where it arises.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The energy budget of a run (J; J/m of discs): what is stored now, and what was brought in and lost since the start.
///
/// Methods move velocities and positions in turn, half a step apart. Kinetic energy and momentum are those that belong
/// to the method's own sums: at the time of the positions for grains on springs, half a step before them for material
/// points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Kinetic energy: of grains and their spin, or of material points and the spin that they carry.
    pub kinetic: f64,
    /// Elastic energy of deformed material.
    pub elastic: f64,
    /// Energy in the springs of contacts.
    pub springs: f64,
    /// Energy of height in the field of gravity.
    pub gravitational: f64,
    /// Work that walls and driven grains have done on the others.
    pub work: f64,
    /// Work of plastic flow.
    pub plastic: f64,
    /// Work of friction where surfaces slip.
    pub friction: f64,
    /// Work against dashpots, viscosity and global damping.
    pub damping: f64,
    /// Lost by the method between material points and nodes: what nodes gain in kinetic energy and points do not, and
    /// what stresses take from nodes and do not do on points.
    pub transfer: f64,
    /// Lost by the method at contacts: what contacts take from the motion and neither store nor rub away.
    pub contact: f64,
    /// Momentum (kg m/s).
    pub momentum: Vector3<f64>,
    /// Impulse that walls, driven grains and gravity have given (N s).
    pub impulse: Vector3<f64>,
}

impl Budget {
    /// What is stored, and what was lost, less what was brought in (J): what it is at the start for as long as every
    /// entry is right.
    #[must_use]
    pub fn unbalanced(&self) -> f64 {
        let stored = self.kinetic + self.elastic + self.springs + self.gravitational;
        let lost = self.plastic + self.friction + self.damping + self.transfer + self.contact;
        stored + lost - self.work
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_brought_in_is_stored_or_lost() {
        let budget =
            Budget { kinetic: 2.0, springs: 1.0, friction: 3.0, contact: -0.5, work: 5.5, ..Budget::default() };
        assert_eq!(budget.unbalanced(), 0.0);
    }
}
