//! Lists of tasks and their execution.
//!
//! A [`execute::TaskList`] performs its tasks on threads, in memory or from a directory that many machines share. A
//! [`plan`] is a directory with a file of [`task`]s, one per line. A worker reserves the tasks of a [`shard`] by a
//! [`lease`], performs them, and appends the results to its own file ([`grainbench_store::log`]). No worker repeats
//! finished tasks. A batch system ([`slurm`]) only starts workers.
//!
//! The tasks come from a study of this program or from a [`sweep`], a design over scene keys, solvers and levels.

pub mod execute;
pub mod fault;
pub mod lease;
pub mod plan;
pub mod shard;
pub mod slurm;
pub mod status;
pub mod sweep;
pub mod task;
pub mod work;

pub use fault::Fault;
