//! Interface of solvers. A solver receives a scene and a resolution, and returns a record.
//!
//! [`Solver`] is the interface. [`drive::Stepper`] is the interface of a state that the common time loop advances.

pub mod brief;
pub mod budget;
pub mod checkpoint;
pub mod drive;
pub mod failure;
pub mod finite;
pub mod kept_record;
pub mod limits;
pub mod observer;
pub mod perturbed;
mod probe;
mod probe_columns;
pub mod record;
pub mod recorder;
pub mod reduction;
pub mod refined;
pub mod resolution;
pub mod space;
pub mod terms;
pub mod virial;

use crate::checkpoint::Checkpoint;
use crate::failure::RunError;
use crate::observer::Observer;
use crate::record::Record;
use crate::resolution::Resolution;
use grainbench_scene::scene::Scene;

/// Deliberate defect of a solver, for a negative control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    /// All contacts lose their history after every step.
    ForgetsHistory,
}

/// Solver, internal or external.
pub trait Solver: Send + Sync {
    /// Returns the name and the convention, such as `dem:lammps`.
    fn name(&self) -> String;

    /// Checks that the solver can run on this machine. Our own solvers always can.
    ///
    /// # Errors
    /// When the solver is an external program that is not installed: [`RunError::NotAvailable`].
    fn available(&self) -> Result<(), RunError> {
        Ok(())
    }

    /// Returns true if contacts of the solver have the springs and dashpots of the scene. Claims about springs and
    /// dashpots are not evaluated for solvers with rigid contacts.
    fn has_springs(&self) -> bool {
        true
    }

    /// Returns true if bodies deform in the solver. Claims about the interior of bodies, or about the effect of
    /// deformation on motion, are evaluated only for solvers with deformable bodies.
    fn deforms(&self) -> bool {
        false
    }

    /// Runs a scene.
    ///
    /// # Errors
    /// When the scene is not supported, the resolution is not valid, or the simulation breaks.
    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError>;

    /// Runs a scene or, with a checkpoint, continues a run of the same scene at the same resolution. The record of a
    /// continued run equals that of an uninterrupted run in every bit except for wall-clock times.
    ///
    /// # Errors
    /// When [`Solver::run`] fails, the checkpoint belongs to another run, or the solver writes no checkpoints.
    fn run_from(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        match from {
            None => self.run(scene, resolution, observer),
            Some(_) => Err(self.unsupported("it writes no checkpoints".to_owned())),
        }
    }

    /// Returns the error for a scene or a request that the solver does not support.
    fn unsupported(&self, reason: String) -> RunError {
        RunError::Unsupported { solver: self.name(), reason }
    }

    /// Returns the error for a resolution that is not valid.
    fn resolution_error(&self, reason: String) -> RunError {
        RunError::Resolution { solver: self.name(), reason }
    }
}
