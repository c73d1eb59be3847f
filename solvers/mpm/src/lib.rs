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
//! bodies and points (`points`), the grid (`grid`), prescribed motion (`boundary`), surfaces (`surface`), contact
//! (`contact`), materials (`material`) and energies (`energy`). The sums over points and nodes are in `transfer`.
//!
//! Type parameters select space, basis, transfer and material, each only in the loops over points that need it. An enum
//! selects each stage. The number of compiled kernels is therefore a sum and not a product of the options. Absent effects
//! need no memory: friction of springs, plastic strain, an energy budget, and the affine part of velocities are stored
//! only if the run uses them.

mod boundary;
mod checks;
mod contact;
mod energy;
mod failure;
mod grid;
mod limits;
pub mod material;
mod observe;
pub mod options;
mod points;
#[cfg(test)]
mod processors;
mod scheme;
mod simulation;
pub mod solver;
mod start;
mod stepper;
mod surface;
mod terms;
mod transfer;
#[cfg(test)]
mod trial;
