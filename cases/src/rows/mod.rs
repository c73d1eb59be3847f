//! Claims that several cases share. Each file has the claims of one kind of run.

pub(crate) mod bulk;
pub mod draws;
pub mod elastic;
pub(crate) mod elastic_backspin;
pub mod incline;
pub mod one_grain_cost;
pub mod program_forces;
pub mod programs;
pub mod rigid;
pub(crate) mod ringing;
pub mod set_down;
