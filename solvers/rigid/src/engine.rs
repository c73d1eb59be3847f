//! What the adapter asks of an engine, whatever its dimension.

use crate::pairs::Side;
use crate::settings::Settings;
use nalgebra::Vector3;

/// How an engine steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepping {
    /// Time step Δt (s).
    pub(crate) time_step: f64,
    /// Small steps and solver iterations in it.
    pub(crate) iterations: usize,
    /// Length that makes rapier's tolerances absolute (m): the mean radius.
    pub(crate) length: f64,
    /// Mass that makes rapier's thresholds relative (kg): a power of two near the mean mass, so that no digit changes.
    pub(crate) mass: f64,
    /// The rest.
    pub(crate) settings: Settings,
}

/// Where a wall is: its origin and its turn since the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// The wall, by place in the scene.
    pub(crate) wall: usize,
    /// Centre of rotation (m).
    pub(crate) centre: Vector3<f64>,
    /// Rotation vector (rad).
    pub(crate) rotation: Vector3<f64>,
}

/// A grain as the engine has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moving {
    /// Centre (m).
    pub(crate) position: Vector3<f64>,
    /// Velocity (m/s).
    pub(crate) velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub(crate) spin: Vector3<f64>,
    /// Orientation in the plane, from −π to π (rad); zero in space.
    pub(crate) orientation: f64,
}

/// A contact that carried load in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// The two sides.
    pub(crate) sides: [Side; 2],
    /// Unit vector from the first to the second.
    pub(crate) normal: Vector3<f64>,
    /// Normal impulse over the step (N s), positive when it pushes apart.
    pub(crate) push: f64,
    /// Friction impulse on the first side over the step (N s).
    pub(crate) shear: Vector3<f64>,
    /// Friction coefficient.
    pub(crate) friction: f64,
}

/// An engine with the grains and walls of a scene.
pub(crate) trait Engine {
    /// Takes a step, at the end of which the moving walls are where `walls` says.
    fn step(&mut self, walls: &[Placement]);
    /// A grain, by place in the scene.
    fn grain(&self, at: usize) -> Moving;
    /// Contacts that carried load in the last step.
    fn touches(&self) -> Vec<Touch>;
    /// Pairs that were tested for touching in the last step, and pairs that were solved.
    fn counts(&self) -> (u64, u64);
}
