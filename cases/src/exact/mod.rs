//! Closed forms that several cases use. A closed form of one case is in the folder of the case.

pub(crate) mod dashpot;
pub(crate) mod manufactured;
pub(crate) mod one_grain;
pub(crate) mod turning;
