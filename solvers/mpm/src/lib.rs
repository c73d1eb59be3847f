//! The material point method: deformable grains in frictional contact, in two dimensions (plane strain) and three.
//!
//! Explicit, with lumped mass, f64. A body is a cloud of material points that carry mass, velocity, deformation and
//! stress, and a surface of massless tracers. In each step
//!
//! 1. points bring mass, momentum and internal force to the nodes of their body's window of the grid;
//! 2. contact acts, as springs where surfaces have met or as a condition on the velocities of nodes;
//! 3. nodes take the step, and points take velocity and way from them;
//! 4. velocity gradients give deformation and stress (MUSL: from velocities that the points bring to the nodes anew).
//!
//! Each part of a simulation has its own type, and each stage of the cycle (`simulation`) takes the parts that it
//! needs: bodies and points (`state`), the grid (`grid`, `nodes`), what moves as it is told (`boundary`), surfaces and
//! contact (`contacts`), the energy budget (`accounts`). The sums over points and nodes stand in `scatter` and
//! `gather`.
//!
//! Type parameters stand for space, basis, transfer and material, each only in the loops over points that need it, and
//! an enum chooses between the stages; so kernels add and do not multiply. What a scene does not call for is absent by
//! the same means: friction of springs, plastic strain and the energy budget are [`off::Off`] in loops that do without,
//! and no list is kept for them, nor for the affine part of velocities that no transfer carries.

mod accounts;
mod basis;
mod bodies;
mod boundary;
mod checkpoint;
mod contact;
mod contacts;
mod damping;
mod driven;
mod failure;
mod gather;
mod gradients;
mod grid;
mod guard;
mod held;
mod ledger;
mod limits;
pub mod material;
mod nodes;
mod observe;
pub mod off;
pub mod options;
mod patch;
mod points;
#[cfg(test)]
mod processors;
mod runs;
mod scatter;
mod scheme;
pub mod seed;
mod share;
mod simulation;
pub mod solver;
mod start;
mod state;
mod stress;
mod stress_at_start;
mod surface;
mod terms;
mod transfer;
#[cfg(test)]
mod trial;
mod walls;
