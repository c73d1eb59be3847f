//! Rigid grains: rapier in two and three dimensions behind the solver trait, for what a rigid-body engine can express.
//!
//! The adapter passes a scene on and reads the result back; it corrects nothing and tunes nothing, so that what a row
//! shows is what rapier makes of the scene. rapier's own vectors stay in `plane` and `solid`, the two places where the
//! engines of two and three dimensions differ, and in `world`, one source that is compiled with each of them.
//!
//! # What rapier does with a contact
//!
//! A step of length Δt detects contacts once and then takes `iterations` small steps h = Δt/`iterations`, each of which
//! adds gravity to the velocities, solves normal impulses with a soft pull towards zero overlap, moves the grains, and
//! solves normal and friction impulses again without that pull. Hence
//!
//! - velocities are those of symplectic Euler: exact at constant acceleration, while positions are off by a h t/2;
//! - there is no spring: stiffness and tangential damping of the scene's law are not used;
//! - Coulomb's limit μN is that of the impulses of the same small step, without memory of tangential displacement;
//! - overlap is no state of the law but an error, which is pushed out over tens of small steps;
//! - restitution acts once, at the end of the step in which a contact first carries load, on the approach velocity that
//!   the grains had at the beginning of that step. A contact that carried load before is at rest and does not bounce,
//!   unless e = 1. Grains that are set down touching and at rest do not bounce;
//! - a contact point is fixed on its grain for a step: turning lifts it by R(1 − cos ΩΔt), and the load drops out until
//!   the grain has fallen after it. Where e = 1 it then bounces, which a resting grain never should;
//! - the pull towards zero overlap is that of a soft spring: at rest the overlap is g/(2πf)², f = 60 Hz at fixed walls,
//!   whatever Δt, and friction acts at the middle of it.
//!
//! A start with static overlap, as scenes for spring contacts have it, is pushed out or kept to that overlap within
//! tenths of a second, at 3 mean radii a second at most; rapier's tolerances are lengths in units of the mean radius.

mod engine;
mod limits;
mod pairs;
pub mod settings;
mod simulation;
pub mod solver;

/// The plane: rapier2d.
mod plane;
/// Space: rapier3d.
mod solid;
