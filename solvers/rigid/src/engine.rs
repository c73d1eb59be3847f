//! Interface between the adapter and the engines rapier2d and rapier3d.

use crate::pairs::Side;
use crate::settings::Settings;
use nalgebra::Vector3;

/// Parameters of the time integration in the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepping {
    /// Time step Δt (s).
    pub(crate) time_step: f64,
    /// Substeps of rapier's constraint solver per time step Δt (`num_solver_iterations`).
    pub(crate) iterations: usize,
    /// Length unit of rapier's tolerances (m), equal to the mean radius.
    pub(crate) length: f64,
    /// Unit of mass in the engine (kg). It is a power of two near the mean mass, so a division by this unit is exact.
    pub(crate) mass: f64,
    /// Settings of rapier that a scene does not define.
    pub(crate) settings: Settings,
}

/// Current centre of a moving wall and its rotation since the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// Index of the wall in the scene.
    pub(crate) wall: usize,
    /// Centre of rotation (m).
    pub(crate) centre: Vector3<f64>,
    /// Rotation vector (rad).
    pub(crate) rotation: Vector3<f64>,
}

/// State of a grain in the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GrainMotion {
    /// Centre (m).
    pub(crate) position: Vector3<f64>,
    /// Velocity (m/s).
    pub(crate) velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub(crate) spin: Vector3<f64>,
    /// Orientation in the plane, from −π to π (rad); zero in three dimensions.
    pub(crate) orientation: f64,
}

/// Contact that transmitted a force in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoadedContact {
    /// The two contact partners.
    pub(crate) sides: [Side; 2],
    /// Unit vector from the first partner to the second.
    pub(crate) normal: Vector3<f64>,
    /// Normal impulse over the step (N s), positive in compression.
    pub(crate) push: f64,
    /// Friction impulse on the first partner over the step (N s).
    pub(crate) shear: Vector3<f64>,
    /// Friction coefficient.
    pub(crate) friction: f64,
}

/// Engine with the grains and walls of a scene.
pub(crate) trait Engine {
    /// Advances the engine by one step. `walls` are the placements of the moving walls at the end of the step.
    fn step(&mut self, walls: &[Placement]);
    /// Returns the state of a grain by its index in the scene.
    fn grain(&self, at: usize) -> GrainMotion;
    /// Returns the contacts that transmitted a force in the last step.
    fn touches(&self) -> Vec<LoadedContact>;
    /// Returns two numbers of the last step: pairs that were tested for contact, and pairs that were in contact.
    fn counts(&self) -> (u64, u64);
}
