//! Transfer of velocities and forces between points and nodes.

pub(crate) mod gather;
pub(crate) mod gradients;
pub(crate) mod scatter;
pub(crate) mod schemes;
