//! What the loops over tracers, nodes and points tell the energy budget, where a run asks for it.

use crate::off::Off;
use serde::{Deserialize, Serialize};

/// What contacts tell of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Energy in springs (J).
    pub(crate) springs: f64,
    /// Work of friction (J).
    pub(crate) friction: f64,
    /// Work of walls (J).
    pub(crate) walls: f64,
    /// What springs take from the motion of surfaces, by half of their velocities before the step and all of the walls'
    /// (J).
    pub(crate) taken: f64,
}

/// Where contacts tell what they do to energy: the budget of a run that asks for it, or its absence.
pub(crate) trait Ledger {
    /// What they tell of the step, if anybody asks.
    fn tally(&mut self) -> Option<&mut Tally>;
}

impl Ledger for Off {
    #[inline(always)]
    fn tally(&mut self) -> Option<&mut Tally> {
        None
    }
}

impl Ledger for &mut Tally {
    #[inline(always)]
    fn tally(&mut self) -> Option<&mut Tally> {
        Some(self)
    }
}

/// What stresses tell of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// Σ V σ:Δε of the stresses after the step (J).
    pub(crate) taken: f64,
    /// Work of plastic flow (J).
    pub(crate) plastic: f64,
    /// Work against viscosity: of the mean of the viscous stresses before and after the step (J).
    pub(crate) viscous: f64,
}
