//! Energies of a run: the requested budget, and the check of a closed run.

pub(crate) mod accounts;
pub(crate) mod ledger;
