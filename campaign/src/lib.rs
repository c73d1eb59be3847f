//! Campaigns: many runs from one plan.
//!
//! A [`plan`] is a directory with a line for each [`task`]. A worker runs a [`shard`] of tasks under a [`lease`] and
//! appends the results to its own [`log`]. After a crash, each line of the log is either whole or ignored. [`finished`]
//! tasks are not repeated by any worker. A batch system ([`slurm`]) only starts workers.
//!
//! A plan belongs to a study of this program or to a [`sweep`], a design over scene keys, solvers and levels.

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
