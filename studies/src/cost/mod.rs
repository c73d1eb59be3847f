//! What accuracy costs: each solver over its knobs, error against time.

pub mod against;
pub mod knobs;
pub mod run;
