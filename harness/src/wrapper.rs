//! Solvers that change the runs of another solver.

use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::checkpoint::Checkpoint;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

/// Start of a run.
#[derive(Clone, Copy)]
pub struct Start<'a> {
    /// Scene.
    pub scene: &'a Scene,
    /// Resolution.
    pub resolution: &'a Resolution,
    /// Checkpoint from which the run continues; `None` for a run from the beginning.
    pub from: Option<&'a Checkpoint>,
}

impl Start<'_> {
    /// Runs the scene from its beginning or from the checkpoint.
    ///
    /// # Errors
    /// When the solver fails, or the checkpoint belongs to another run.
    pub fn run(&self, solver: &dyn Solver, observer: &mut dyn Observer) -> Result<Record, RunError> {
        solver.run_from(self.scene, self.resolution, self.from, observer)
    }
}

/// Change of the runs of another solver.
pub trait Wrapper: Send + Sync {
    /// Returns the other solver.
    fn inner(&self) -> &dyn Solver;

    /// Returns the name of the changed solver.
    fn name(&self) -> String {
        self.inner().name()
    }

    /// Does a run.
    ///
    /// # Errors
    /// When the run of the other solver fails.
    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError>;
}

/// Solver with changed runs. Only this type forwards the methods of [`Solver`] to another solver, so that no wrapper can
/// omit one.
pub struct Wrapped<W>(pub W);

impl<W: Wrapper> Solver for Wrapped<W> {
    fn name(&self) -> String {
        self.0.name()
    }

    fn available(&self) -> Result<(), RunError> {
        self.0.inner().available()
    }

    fn has_springs(&self) -> bool {
        self.0.inner().has_springs()
    }

    fn deforms(&self) -> bool {
        self.0.inner().deforms()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        self.run_from(scene, resolution, None, observer)
    }

    fn run_from(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        self.0.run(Start { scene, resolution, from }, observer)
    }
}
