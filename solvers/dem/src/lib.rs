//! Discrete element method (DEM) for rigid discs and spheres.
//!
//! The calculation cycle is in `simulation`, and its integration step in `motion`. `touching` selects the pairs in
//! contact from the neighbour list. `forces` and `pairs` contain the loops over contacts. These loops are compiled for
//! each combination of effects (`contact`); [`solver`] selects the combination for a scene. The loops over pairs are also
//! compiled for each instruction set of the processor. Each thread has its own partition of the neighbour list (`share`).
//! Results are equal bit for bit for all instruction sets and for any number of threads.

mod accounts;
mod cells;
mod contact;
pub mod convention;
mod critical;
mod driving;
mod end_state;
mod forces;
mod geometry;
mod grains;
mod joints;
mod laws;
mod listed;
mod mean_virial;
mod meshes;
mod motion;
mod neighbours;
mod observe;
mod pairs;
#[cfg(test)]
mod processors;
mod recording;
mod seen;
mod share;
mod simulation;
mod skin;
pub mod solver;
pub mod stability;
mod stepper;
mod touching;
mod walls;
