//! Comparing two runs: sample by sample, up to where perturbed runs part, and by means after it.

pub mod peers;
pub mod perturbed;
pub mod pointwise;
