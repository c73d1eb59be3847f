//! Solver for rigid grains, which uses the engine rapier in two and three dimensions.
//!
//! The adapter passes a scene to rapier and reads the result back. It applies no corrections and no tuning, so results
//! are those of rapier itself. The two engines differ only in the modules `plane` and `solid`. The vectors of rapier
//! are used there and in `world`, whose source is compiled with both engines.
//!
//! # Contact model of rapier
//!
//! A step of length Δt detects contacts once and then takes `iterations` small steps h = Δt/`iterations`. Each small
//! step adds gravity to the velocities, solves normal impulses with a soft correction towards zero overlap, and moves
//! the grains. It then solves normal and friction impulses again without the correction. This has several consequences:
//!
//! - velocities are those of symplectic Euler: exact at constant acceleration, with an error of positions of a h t/2;
//! - there is no spring: stiffness and tangential damping of the scene's law are not used;
//! - the Coulomb limit μN applies to the impulses of one small step, without memory of tangential displacement;
//! - overlap is not a state of the contact law but an error, which is corrected over tens of small steps;
//! - restitution acts once, at the end of the step in which a contact first carries load, on the approach velocity at
//!   the beginning of that step. A contact that carried load before is at rest and does not bounce, unless e = 1.
//!   Grains that start in contact and at rest do not bounce;
//! - a contact carries load up to one small step before the surfaces meet. If this is the last small step of a step,
//!   restitution separates the grains before they meet, and a part of the friction impulse is missing. It happens in one
//!   of `iterations` impacts for any Δt. `cases/separate-balls/derivation.md` gives the formula;
//! - a contact point is fixed on its grain for a step: rotation lifts it by R(1 − cos ΩΔt), and the contact carries no
//!   load until the grain has fallen back. With e = 1 it then bounces, which a resting grain should not do;
//! - the correction towards zero overlap acts as a soft spring: at rest the overlap is g/(2πf)², f = 60 Hz at fixed
//!   walls, for any Δt, and friction acts at the middle of the overlap.
//!
//! Scenes for spring contacts start with a static overlap. rapier reduces it to zero or to the overlap at rest within
//! tenths of a second, at no more than 3 mean radii per second. The tolerances of rapier are lengths in units of the
//! mean radius.

mod engine;
mod limits;
mod pairs;
pub mod settings;
mod simulation;
pub mod solver;

/// Two dimensions: rapier2d.
mod plane;
/// Three dimensions: rapier3d.
mod solid;
