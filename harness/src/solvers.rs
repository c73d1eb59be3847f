//! The solvers that are handed to the harness, which knows none itself.

use crate::case::Case;
use crate::claim::Claim;
use crate::reading::Table;
use crate::run::{Made, Run};
use grainbench_scene::record::Record;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Defect, RunError, Solver};
use std::sync::Arc;
use std::time::Duration;

/// What is kept of a run with its case.
pub struct Kept {
    /// Its record, without snapshots.
    pub record: Record,
    /// What was read of them.
    pub tables: Vec<Table>,
    /// Provenance.
    pub made: Made,
}

/// A program beside the solvers of the registry.
#[derive(Clone, Debug, PartialEq)]
pub struct Stranger {
    /// Its name.
    pub name: String,
    /// Time steps that it is asked for, parts of the critical one; the usual ones where it names none.
    pub fractions: Vec<f64>,
    /// Cells per reference length that it is asked for; the usual ones where it names none.
    pub cells: Vec<f64>,
    /// Whether its contacts have springs.
    pub has_springs: bool,
    /// Whether its bodies deform.
    pub deforms: bool,
    /// Whether it stays from run to run.
    pub stays: bool,
}

/// Solvers by name, and the runs of other programs that are kept.
pub trait Solvers: Send + Sync {
    /// The solver of a name.
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>>;

    /// The same with a limit to the time that a run of another program may take.
    fn find_within(&self, name: &str, _limit: Duration) -> Option<Arc<dyn Solver>> {
        self.find(name)
    }

    /// The same with a defect, where it can have one.
    fn with_defect(&self, _name: &str, _defect: Defect) -> Option<Arc<dyn Solver>> {
        None
    }

    /// Whether a name is that of another program.
    fn is_program(&self, _name: &str) -> bool {
        false
    }

    /// Programs beside the solvers of the registry.
    fn strangers(&self) -> Vec<Stranger> {
        Vec::new()
    }

    /// What tells finished runs of a name apart beside it: of a program that may change, when it was read.
    fn edition(&self, _name: &str) -> String {
        String::new()
    }

    /// The stored record of a run of another program; none where nothing is stored.
    fn stored(&self, _case: &Case, _run: &Run, _scene: &Scene) -> Option<Result<Record, RunError>> {
        None
    }

    /// What is kept of a run of any solver whose snapshots are read, with the scene that it was given, which a negative
    /// control of this name changed; none where nothing is kept.
    fn kept(&self, _case: &Case, _run: &Run, _scene: &Scene, _control: Option<&str>) -> Option<Result<Kept, RunError>> {
        None
    }

    /// The stored numerical uncertainty of a claim's value, in units of its scale.
    fn uncertainty(&self, _case: &Case, _claim: &Claim) -> Option<f64> {
        None
    }

    /// Whether a record is stored of a run of another program.
    fn is_stored(&self, _case: &Case, _run: &Run) -> bool {
        false
    }
}
