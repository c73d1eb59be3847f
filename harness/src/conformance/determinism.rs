//! Determinism: a repeated run, and a run continued from a checkpoint, give the same bits.

use super::end::NoEnd;
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_solver::Solver;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench_solver::failure::RunError;
use grainbench_solver::kept_record;
use grainbench_solver::observer::{Observer, RunOptions, RunOutline};
use grainbench_solver::record::{Cost, Record};

pub(super) const RERUN: Property = Property {
    name: "rerun",
    claim: "the same scene at the same resolution gives the same record, except for computing times",
    flaw: Flaw::Irreproducible,
    evidence: Evidence::Invariant,
    source: "a program is a function of its input",
    because: "bits must be equal",
    check: rerun,
};

pub(super) const RESTART: Property = Property {
    name: "restart",
    claim: "a run that is continued from a checkpoint halfway gives the record of the uninterrupted run, except for \
            computing times",
    flaw: Flaw::Restarted,
    evidence: Evidence::Invariant,
    source: "a checkpoint contains everything that the next step depends on",
    because: "bits must be equal",
    check: restart,
};

/// Quantity and unit of the results.
const DIFFERING: (&str, &str) = ("bytes of the record that differ", "1");

fn rerun(rows: &Rows<'_>) -> Vec<Verdict> {
    let resolution = &rows.terms.resolution;
    rows.each(scenes::collisions(), resolution, DIFFERING, |named| {
        let run = |solver: &dyn Solver| solver.run(&named.scene, resolution, &mut ());
        differing(run(rows.solver)?, run(rows.again)?)
    })
}

fn restart(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, resolution) = (rows.again, &rows.terms.resolution);
    let scenes = scenes::collisions().and_then(|all| Ok([all, scenes::held()?].into_iter().flatten().collect()));
    rows.each(scenes, resolution, DIFFERING, |named| {
        let mut halfway = HalfwayCheckpoint::new(RunOptions::DEFAULT);
        let whole = solver.run(&named.scene, resolution, &mut halfway)?;
        // A checkpoint must survive being written and read.
        let bytes = halfway.written_by(solver)?.to_bytes().map_err(RunError::from)?;
        let checkpoint = Checkpoint::from_bytes(&bytes).map_err(RunError::from)?;
        differing(whole, solver.run_from(&named.scene, resolution, Some(&checkpoint), &mut ())?)
    })
}

/// Returns the number of bytes in which two stored records differ. The measured run time is ignored.
fn differing(mut first: Record, mut second: Record) -> Result<PropertyValue, NoEnd> {
    for record in [&mut first, &mut second] {
        record.cost = Cost { wall_seconds: 0.0, ..record.cost };
    }
    let bytes = |record: &Record| kept_record::body("", record).map_err(NoEnd::Record);
    let (first, second) = (bytes(&first)?, bytes(&second)?);
    let count = first.iter().zip(&second).filter(|(a, b)| a != b).count() + first.len().abs_diff(second.len());
    Ok(PropertyValue::deviation(count as f64, 1.0, 0.0))
}

/// Observer that stores the checkpoint after half of the steps.
pub struct HalfwayCheckpoint {
    options: RunOptions,
    steps: u64,
    checkpoint: Option<Checkpoint>,
}

impl HalfwayCheckpoint {
    /// Returns the observer of a run with the given options.
    #[must_use]
    pub const fn new(options: RunOptions) -> Self {
        Self { options, steps: 0, checkpoint: None }
    }

    /// Returns the checkpoint of a finished run of a solver.
    ///
    /// # Errors
    /// When the solver wrote no checkpoint.
    pub fn written_by(self, solver: &dyn Solver) -> Result<Checkpoint, RunError> {
        self.checkpoint.ok_or_else(|| {
            let reason = "it writes no checkpoints".to_owned();
            RunError::Unsupported { solver: solver.name(), reason }
        })
    }
}

impl Observer for HalfwayCheckpoint {
    fn begin(&mut self, ahead: RunOutline) {
        self.steps = ahead.steps;
    }

    fn options(&self) -> RunOptions {
        RunOptions { checkpoint_interval: Some(self.steps.div_ceil(2)), ..self.options }
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.checkpoint = Some(checkpoint);
        Ok(())
    }
}
