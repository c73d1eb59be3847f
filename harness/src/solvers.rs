//! Interface to the solvers. The caller supplies them, because the harness contains none.

use crate::case::Case;
use crate::claim::Claim;
use crate::run::{FinishedRun, Run};
use grainbench_scene::scene::Scene;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_solver::{Defect, Solver};
use std::sync::Arc;
use std::time::Duration;

/// External solver, with the resolutions of its runs.
#[derive(Clone, Debug, PartialEq)]
pub struct ExternalSolver {
    /// Name of the solver in its manifest.
    pub name: String,
    /// Time steps of its runs, as fractions of the critical time step; empty for the defaults.
    pub fractions: Vec<f64>,
    /// Cells per reference length of its runs; empty for the defaults.
    pub cells: Vec<f64>,
    /// True if its contacts have springs.
    pub has_springs: bool,
    /// True if its bodies deform.
    pub deforms: bool,
    /// True if one process does all runs.
    pub stays: bool,
}

/// Solvers by name.
pub trait Solvers: Send + Sync {
    /// Returns the solver with this name; none if there is none.
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>>;

    /// Returns the solver with this name. A run of another program ends with an error after the time limit.
    fn find_within(&self, name: &str, _limit: Duration) -> Option<Arc<dyn Solver>> {
        self.find(name)
    }

    /// Returns the solver with this name and a defect; none if it does not support defects.
    fn with_defect(&self, _name: &str, _defect: Defect) -> Option<Arc<dyn Solver>> {
        None
    }

    /// Returns true if a name refers to another program.
    fn is_program(&self, _name: &str) -> bool {
        false
    }

    /// Returns the external solvers.
    fn external_solvers(&self) -> Vec<ExternalSolver> {
        Vec::new()
    }

    /// Returns a string that identifies the version of a solver, so that finished runs can be reused. For a program
    /// that may change, it is a hash of its files or executable, or the time when they were read.
    fn edition(&self, _name: &str) -> String {
        String::new()
    }

    /// Returns the stored runs and results. Without them, every run is simulated.
    fn references(&self) -> &dyn References {
        &NoReferences
    }
}

/// Stored runs and results that claims use.
pub trait References: Send + Sync {
    /// Returns the stored record of a run of another program; none if no record is stored.
    fn stored(&self, _case: &Case, _run: &Run, _scene: &Scene) -> Option<Result<Record, RunError>> {
        None
    }

    /// Returns the stored result of a run whose snapshots are read, without snapshots; none if no result is stored. `_scene` is
    /// the scene that the solver got, and `_control` names the negative control that changed it.
    fn kept(
        &self,
        _case: &Case,
        _run: &Run,
        _scene: &Arc<Scene>,
        _control: Option<&str>,
    ) -> Option<Result<FinishedRun, RunError>> {
        None
    }

    /// Returns the reason if stored runs and initial states are not installed; none if they are.
    fn missing_data(&self) -> Option<String> {
        None
    }

    /// Returns the stored numerical uncertainty of a claim's value, in units of the claim's scale.
    fn uncertainty(&self, _case: &Case, _claim: &Claim) -> Option<f64> {
        None
    }

    /// Returns true if a record of a run of another program is stored.
    fn is_stored(&self, _case: &Case, _run: &Run) -> bool {
        false
    }
}

/// References of solvers without stored runs.
struct NoReferences;

impl References for NoReferences {}
