//! Energy of a closed run, which the checks compare with its initial value.

use serde::{Deserialize, Serialize};

/// Energy of a closed run (J; J/m for discs).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct EnergyGuard {
    /// Initial kinetic, elastic and gravitational energy, without the energy of the springs.
    pub(crate) start: f64,
    /// Initial energy of springs; known after the first step.
    pub(crate) springs: Option<f64>,
    /// Largest kinetic and elastic energy so far.
    pub(crate) largest: f64,
}
