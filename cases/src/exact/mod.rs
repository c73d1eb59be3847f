//! Closed forms that several cases are judged by; those of one case stand in its folder.

pub mod dashpot;
pub mod manufactured;
pub mod one_grain;
pub mod turning;
