//! Surfaces of bodies: tracers, their motion, and the interpolation between a surface and the nodes.

pub(crate) mod elements;
pub(crate) mod motion;
pub(crate) mod shape_function;
pub(crate) mod tracers;
