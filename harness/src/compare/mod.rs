//! Comparison of two runs. Samples are compared until a perturbed run diverges, and means after that.

pub mod peers;
pub mod perturbed;
pub mod pointwise;
