//! What accuracy costs: each solver over its knobs, error against time; and what a step costs.

pub mod against;
pub mod knobs;
pub mod load;
pub mod run;
pub mod step;
