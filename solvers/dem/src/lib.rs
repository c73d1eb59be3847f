//! Cundall–Strack discrete element method in two and three dimensions.
//!
//! Rigid grains overlap slightly at contacts. A force–displacement law gives the forces from the overlaps, and Newton's
//! law gives the motion from the forces. The central-difference cycle uses velocity v (m/s), position x (m), force F
//! (N) and mass m (kg):
//!
//! ```text
//! v(n+½) = v(n−½) + F(n)/m Δt        x(n+1) = x(n) + v(n+½) Δt        F(n+1) from x(n+1), v(n+½)
//! ```
//!
//! Source: P. A. Cundall and O. D. L. Strack, Géotechnique 29 (1979) 47–65. Deviations of later codes are options in
//! [`convention`].
//!
//! The cycle is in `simulation`, and its integration step in `motion`. `touching` selects the pairs in contact from the
//! neighbour list, and the loops over contacts are in `forces` and `pairs`. Only these loops are compiled for each
//! combination of effects (`contact`), which [`solver`] selects, and for each instruction set of the processor. Each
//! thread has its own partition of the list (`share`). The results are equal bit for bit on all processors and for any
//! number of threads.

mod accounts;
mod cells;
mod contact;
pub mod convention;
mod critical;
mod driving;
mod edge;
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
mod seen;
mod share;
mod simulation;
mod skin;
pub mod solver;
pub mod stability;
mod state;
mod touching;
mod walls;

pub use edge::Simulation;
