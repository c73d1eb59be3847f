//! Campaigns: many runs from one plan.
//!
//! A [`plan`] is a directory with a file of [`task`]s, one per line. A worker reserves the tasks of a [`shard`] by a
//! [`lease`], runs them, and appends the results to its own [`log`]. Lines that are incomplete after a crash are
//! ignored. No worker repeats [`finished`] tasks. A batch system ([`slurm`]) only starts workers.
//!
//! The tasks come from a study of this program or from a [`sweep`], a design over scene keys, solvers and levels.

pub mod fault;
pub mod finished;
pub mod lease;
pub mod log;
pub mod plan;
pub mod shard;
pub mod share;
pub mod slurm;
pub mod status;
pub mod sweep;
pub mod task;
pub mod work;

pub use fault::Fault;
