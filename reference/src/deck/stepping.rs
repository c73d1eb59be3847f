//! Time steps and samples of a deck.

use grainbench_scene::scene::Scene;
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;

/// Time steps and samples of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Number of steps between samples.
    pub interval: u64,
}

impl Eq for Stepping {}

impl Stepping {
    /// Returns time step, number of steps and sampling interval of a scene at a resolution.
    ///
    /// # Errors
    /// If the resolution is not a time step that is valid for this scene.
    pub fn new(scene: &Scene, resolution: &Resolution) -> Result<Self, String> {
        Ok(Self::every(resolution.steps(scene)?, scene))
    }

    /// Returns the stepping with a given time step (s) and number of steps. The sampling interval follows from the
    /// scene.
    pub(crate) fn every((time_step, steps): (f64, u64), scene: &Scene) -> Self {
        let interval = Recorder::new(scene, time_step, steps).interval().min(steps.max(1));
        Self { time_step, steps, interval }
    }

    /// Returns the steps at which samples are taken, including the last step.
    pub(crate) fn samples(&self) -> impl Iterator<Item = u64> + use<> {
        let Self { steps, interval, .. } = *self;
        (0..=steps / interval).map(move |sample| sample * interval).chain((!self.ends_on_a_sample()).then_some(steps))
    }

    /// Returns true if the last step is a regular sample.
    #[must_use]
    pub fn ends_on_a_sample(&self) -> bool {
        self.steps.is_multiple_of(self.interval)
    }
}
