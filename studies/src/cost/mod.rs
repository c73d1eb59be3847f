//! Cost-accuracy study: error against time of each solver over its parameters, and the cost of a step.

pub mod against;
pub mod knobs;
pub mod load;
pub mod run;
pub mod step;
