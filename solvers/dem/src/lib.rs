//! Cundall–Strack discrete element method in two and three dimensions.
//!
//! Rigid grains overlap a little where they touch; a force–displacement law turns the overlap into forces, and Newton's
//! law turns those into motion, in a central-difference cycle:
//!
//! ```text
//! v(n+½) = v(n−½) + F(n)/m Δt        x(n+1) = x(n) + v(n+½) Δt        F(n+1) from x(n+1), v(n+½)
//! ```
//!
//! Source: P. A. Cundall and O. D. L. Strack, Géotechnique 29 (1979) 47–65. What later codes do differently is named in
//! [`convention`]. The kernel is compiled once for each combination of effects ([`contact`]) and picked in [`solver`].

mod accounts;
mod cells;
pub mod contact;
pub mod convention;
mod grains;
mod neighbours;
mod observe;
mod simulation;
pub mod solver;
pub mod stability;
mod state;
mod walls;

pub use simulation::Simulation;
