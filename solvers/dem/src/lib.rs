//! Cundall–Strack discrete element method in two and three dimensions.
//!
//! Rigid grains overlap a little where they touch. A force–displacement law gives the forces from the overlaps, and
//! Newton's law the motion from the forces, in a central-difference cycle with velocity v (m/s), position x (m), force
//! F (N) and mass m (kg):
//!
//! ```text
//! v(n+½) = v(n−½) + F(n)/m Δt        x(n+1) = x(n) + v(n+½) Δt        F(n+1) from x(n+1), v(n+½)
//! ```
//!
//! Source: P. A. Cundall and O. D. L. Strack, Géotechnique 29 (1979) 47–65. What later codes do differently is named in
//! [`convention`].
//!
//! One cycle is written in `simulation`, its motion in `motion`. The pairs that touch are picked from the list in
//! `touching`, and the loops over contacts stand in `forces` and `pairs`: these alone are compiled for each combination of
//! effects (`contact`), picked in [`solver`], and for each path of the processor. Threads have a `share` of the list each. The
//! bits are the same on all.

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
