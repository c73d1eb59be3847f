//! Comparison of runs. Chaotic runs are compared sample by sample until a perturbed run diverges, and by their means
//! after that.

pub mod peers;
pub mod perturbed;
pub mod pointwise;
