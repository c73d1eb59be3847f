//! Bodies and their material points: arrays, initial state, particle batches and thread partitions.

pub(crate) mod arrays;
pub(crate) mod bodies;
pub(crate) mod body;
pub(crate) mod runs;
pub(crate) mod seed;
pub(crate) mod share;
pub(crate) mod state;
pub(crate) mod stress_at_start;
