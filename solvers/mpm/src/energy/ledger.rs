//! Energies that the loops over tracers, nodes and points record for the energy budget, if a run requests it.

use serde::{Deserialize, Serialize};

/// Energies of contacts in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Energy in springs (J).
    pub(crate) springs: f64,
    /// Work of friction (J).
    pub(crate) friction: f64,
    /// Work of walls (J).
    pub(crate) walls: f64,
    /// Energy that springs take from the motion of surfaces (J). It includes the half with velocities before the step,
    /// and the full contribution of walls.
    pub(crate) taken: f64,
}

/// Stress work, plastic work and viscous work of a step (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// Σ V σ:Δε with the stresses after the step (J).
    pub(crate) taken: f64,
    /// Work of plastic flow (J).
    pub(crate) plastic: f64,
    /// Work against viscosity, from the mean of the viscous stresses before and after the step (J).
    pub(crate) viscous: f64,
}

/// Energy of a closed run (J; J/m for discs), which the checks compare with its initial value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct EnergyGuard {
    /// Initial kinetic, elastic and gravitational energy, without the energy of the springs.
    pub(crate) start: f64,
    /// Initial energy of springs; known after the first step.
    pub(crate) springs: Option<f64>,
    /// Largest kinetic and elastic energy so far.
    pub(crate) largest: f64,
}
