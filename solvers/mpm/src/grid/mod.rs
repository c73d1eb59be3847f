//! Grid of nodes: basis functions, lattice, node values and stencil blocks.

pub(crate) mod basis;
pub(crate) mod lattice;
pub(crate) mod nodes;
pub(crate) mod patch;
