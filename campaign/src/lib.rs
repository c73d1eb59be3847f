//! Many runs from one plan.
//!
//! A [`plan`] is a directory with a line for each [`task`]. Who works does a [`chunk`] of them under a [`lease`], and leaves what
//! comes out in a [`log`] of its own, to which it only ever adds: whatever is killed, what stands there is whole or is not taken.
//! What is [`finished`] is not done again, whoever did it. A batch system ([`slurm`]) starts workers and knows nothing else.
//!
//! A plan is of a study of this program or of a [`sweep`]: a design over the keys of a scene, solvers and levels.

pub mod chunk;
pub mod fault;
pub mod finished;
pub mod lease;
pub mod log;
pub mod machine;
pub mod plan;
pub mod share;
pub mod slurm;
pub mod status;
pub mod sweep;
pub mod task;
pub mod work;

pub use fault::Fault;
