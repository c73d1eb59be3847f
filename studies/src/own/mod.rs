//! Cost, stability and effects of any scene with probes. There is no exact solution. The errors of each solver are estimated
//! from its own levels, within a time budget.

pub mod convergence;
pub mod cost;
pub mod effects;
pub mod ladder;
pub mod limit;
pub mod network;
pub mod schedule;
mod stored_run;
pub mod within;
