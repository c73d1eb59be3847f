//! Energy budget of a run.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Energy budget of a run (J; J/m for discs): the energy stored now, and the energy supplied and dissipated since the
/// start.
///
/// Methods update velocities and positions half a step apart. In DEM, kinetic energy and momentum refer to the time of
/// the positions; for material points, to half a step before this time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Kinetic energy of grains or material points, spin included.
    pub kinetic: f64,
    /// Elastic energy of deformed material.
    pub elastic: f64,
    /// Elastic energy of the contact springs.
    pub springs: f64,
    /// Gravitational potential energy.
    pub gravitational: f64,
    /// Work of walls and grains with prescribed motion on the free grains.
    pub work: f64,
    /// Plastic work.
    pub plastic: f64,
    /// Frictional work at slipping contacts.
    pub friction: f64,
    /// Work against dashpots, viscosity and global damping.
    pub damping: f64,
    /// Numerical loss between material points and nodes. It is the kinetic energy that nodes gain but points do not,
    /// plus the work that stresses take from nodes but do not do on points.
    pub transfer: f64,
    /// Numerical loss at contacts. It is the energy that contacts take from the motion but neither store nor dissipate
    /// by friction.
    pub contact: f64,
    /// Momentum (kg m/s).
    pub momentum: Vector3<f64>,
    /// Impulse of walls, of grains with prescribed motion, and of gravity (N s).
    pub impulse: Vector3<f64>,
}

impl Budget {
    /// Returns the stored and dissipated energy less the supplied energy (J). This difference keeps its initial value
    /// if every entry is right.
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
