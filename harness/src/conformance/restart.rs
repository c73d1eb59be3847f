//! Restart: a run continued from a checkpoint gives the record of the uninterrupted run.

use super::end::NoEnd;
use super::rerun::differing;
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_solver::Solver;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::{Observer, RunOptions, RunOutline};

pub(super) const PROPERTY: Property = Property {
    name: "restart",
    claim: "a run that is continued from a checkpoint halfway gives the record of the uninterrupted run, except for \
            computing times",
    flaw: Flaw::Restarted,
    evidence: Evidence::Invariant,
    source: "a checkpoint contains everything that the next step depends on",
    because: "bits must be equal",
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.again, rows.terms);
    let quantity = ("bytes of the record that differ", "1");
    let scenes = scenes::collisions().and_then(|mut all| {
        all.extend(scenes::held()?);
        Ok(all)
    });
    rows.each(scenes, &terms.resolution, quantity, |named| {
        let mut halfway = HalfwayCheckpoint::default();
        let whole = solver.run(&named.scene, &terms.resolution, &mut halfway)?;
        let checkpoint = halfway.through_a_file().map_err(NoEnd::Run)?.ok_or_else(|| no_checkpoint(solver))?;
        let continued = solver.restart(&named.scene, &terms.resolution, &checkpoint, &mut ())?;
        Ok(PropertyValue::deviation(differing(whole, continued)? as f64, 1.0, 0.0))
    })
}

fn no_checkpoint(solver: &dyn Solver) -> RunError {
    RunError::Unsupported { solver: solver.name(), reason: "it writes no checkpoints".to_owned() }
}

/// Observer that keeps the checkpoint after half of the steps.
#[derive(Default)]
struct HalfwayCheckpoint {
    steps: u64,
    checkpoint: Option<Checkpoint>,
}

impl HalfwayCheckpoint {
    /// Writes the checkpoint to bytes, reads it back and returns it; none if the solver wrote no checkpoint.
    fn through_a_file(self) -> Result<Option<Checkpoint>, RunError> {
        let reread = |checkpoint: Checkpoint| Checkpoint::from_bytes(&checkpoint.to_bytes()?);
        Ok(self.checkpoint.map(reread).transpose()?)
    }
}

impl Observer for HalfwayCheckpoint {
    fn begin(&mut self, ahead: RunOutline) {
        self.steps = ahead.steps;
    }

    fn options(&self) -> RunOptions {
        RunOptions { checkpoint_interval: Some(self.steps.div_ceil(2)), ..RunOptions::DEFAULT }
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.checkpoint = Some(checkpoint);
        Ok(())
    }
}
