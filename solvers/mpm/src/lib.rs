//! The material point method: deformable grains in frictional contact, in two dimensions (plane strain) and three.
//!
//! The method is explicit, with lumped mass, in f64. A body is a set of material points with mass, velocity,
//! deformation and stress. Massless tracers represent its surface. Each step has four stages:
//!
//! 1. points scatter mass, momentum and internal force to the nodes of their body's window of the grid;
//! 2. contact acts, as springs between penetrating surfaces or as a condition on node velocities;
//! 3. nodes are integrated, and points gather velocity and displacement from them;
//! 4. velocity gradients give deformation and stress (MUSL: from velocities that points scatter to the nodes again).
//!
//! Each part of a simulation has its own type, and each stage of the cycle (`simulation`) uses the parts that it needs:
//! bodies and points (`state`), the grid (`grid`, `nodes`), prescribed motion (`boundary`), surfaces and contact
//! (`contacts`) and the energy budget (`accounts`). The sums over points and nodes are in `scatter` and `gather`.
//!
//! Type parameters select space, basis, transfer and material, each only in the loops over points that need it. An enum
//! selects each stage. The number of compiled kernels is therefore a sum and not a product of the options. Types also
//! remove absent effects. A run without friction of springs, plastic strain or an energy budget uses
//! [`off::AbsentEffect`] instead, which needs no memory. The affine part of velocities is stored only if the transfer
//! uses it.

mod accounts;
mod basis;
mod bodies;
mod body;
mod boundary;
mod checkpoint;
mod checks;
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
