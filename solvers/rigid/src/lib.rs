//! Solver for rigid grains, which uses the engine rapier in two and three dimensions.
//!
//! The adapter passes a scene to rapier and reads the result back. It applies no corrections and no tuning, so its
//! results are those of rapier. The code for the two engines differs only in the modules `plane` and `solid`. Only
//! these modules and `world` use rapier's vectors. The source of `world` is compiled once for each engine.
//!
//! # Contact model of rapier
//!
//! A step of length Δt detects contacts once and then takes `iterations` small steps h = Δt/`iterations`. Each small
//! step adds gravity to the velocities, solves normal impulses with a soft correction towards zero overlap, and moves
//! the grains. It then solves normal and friction impulses again without the correction. This has several consequences:
//!
//! - velocities and positions are those of the symplectic Euler scheme. At constant acceleration a, velocities are
//!   exact and positions have the error a h t/2 after a time t;
//! - there is no spring: stiffness and tangential damping of the scene's law are not used;
//! - the Coulomb limit μN applies to the impulses of one small step. No tangential displacement is stored;
//! - overlap is not a state of the contact law but an error, which is corrected over tens of small steps;
//! - restitution acts once, at the end of the step in which a contact first transmits a force. It uses the approach
//!   velocity at the beginning of that step. A contact that transmitted a force before is at rest and does not bounce,
//!   unless e = 1. Grains that start in contact and at rest do not bounce;
//! - a contact transmits a force up to one small step before the surfaces meet. If this is the last small step of a
//!   step, restitution separates the grains before they meet, and a part of the friction impulse is missing. This
//!   happens in one of `iterations` impacts, whatever Δt. `cases/separate-balls/derivation.md` gives the formula;
//! - a contact point is fixed on its grain for a step. Rotation lifts the point by R(1 − cos ΩΔt), and the contact
//!   transmits no force until the grain has fallen back. With e = 1 the grain then bounces, although a resting grain
//!   should not;
//! - the correction towards zero overlap acts as a soft spring. At rest the overlap is g/(2πf)², with f = 60 Hz at
//!   fixed walls, whatever Δt. Friction acts at the middle of the overlap.
//!
//! Scenes for spring contacts start with a static overlap. rapier reduces it to zero, or to the overlap at rest, within
//! tenths of a second and at no more than 3 mean radii per second. The tolerances of rapier are lengths in units of the
//! mean radius.

mod engine;
mod limits;
mod pairs;
pub mod settings;
mod simulation;
pub mod solver;

/// Engine in two dimensions, rapier2d.
mod plane;
/// Engine in three dimensions, rapier3d.
mod solid;
