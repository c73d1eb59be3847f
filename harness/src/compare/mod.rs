//! Comparison of two runs: sample by sample until a perturbed run diverges, and by means after that.

pub mod peers;
pub mod perturbed;
pub mod pointwise;
