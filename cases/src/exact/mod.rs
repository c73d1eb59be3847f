//! Closed forms that several cases use. A closed form of one case is in the folder of the case.

pub mod dashpot;
pub mod manufactured;
pub mod one_grain;
pub mod turning;
