//! Comparing two runs: sample by sample, up to where twins part, and by means after it.

pub mod peers;
pub mod pointwise;
pub mod twins;
