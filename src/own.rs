//! Tests of a solver that implements [`Solver`] against claims of cases and conformance properties:
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let my_solver = || grainbench::dem::solver::Dem::new(grainbench::dem::convention::Convention::LAMMPS);
//! println!("{}", grainbench::judge(my_solver(), &["incline-disc", "backspin"])?.require()?);
//! # Ok(())
//! # }
//! ```

use grainbench_cases::registry;
use grainbench_cases::solvers::{self, Registry};
use grainbench_harness::conformance;
use grainbench_harness::mistake;
use grainbench_harness::runner::RunnerOptions;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::{ControlResult, Verdict, passes};
use grainbench_reports::line;
use grainbench_solver::Solver;
use grainbench_solver::terms::Terms;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Results of a solver, with negative controls that use the same solver.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judgement {
    /// Results of the claims or conformance properties.
    pub verdicts: Vec<Verdict>,
    /// Negative controls of the results. A control that does not fail means that the result does not depend on the
    /// physics in question. For example, the solver ignores a parameter of the scene.
    pub controls: Vec<ControlResult>,
}

/// Reasons why a case cannot test a solver.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum JudgementError {
    /// No case has this name.
    #[error("there is no case `{0}`; there are {known}", known = names())]
    NoSuchCase(String),
    /// No claim of this case is solver-independent.
    #[error(
        "the case `{0}` has no solver-independent claim; each claim tests the convention of the solver that it names"
    )]
    NothingFair(String),
}

/// Failed results of a solver. `Debug` prints the same lines as `Display`, so that a failed test shows them.
#[derive(Clone, PartialEq, Eq, Error)]
#[error("{}", .lines.join("\n"))]
pub struct SolverRejection {
    lines: Vec<String>,
}

impl fmt::Debug for SolverRejection {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the solver does not pass:\n{self}")
    }
}

fn names() -> String {
    registry::CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ")
}

/// Judges a solver by the solver-independent claims of the named cases. The solver replaces the solvers that the claims name.
///
/// The solver gets the resolutions of the claims, as fractions of the critical time step of a spring contact. It may
/// choose another time step.
///
/// # Errors
/// When a case does not exist or has no solver-independent claim.
pub fn judge(solver: impl Solver + 'static, cases: &[&str]) -> Result<Judgement, JudgementError> {
    let solver: Arc<dyn Solver> = Arc::new(solver);
    let all: Arc<dyn Solvers> = Arc::new(Registry);
    let mut judgement = Judgement::default();
    for &name in cases {
        let case = registry::by_name(name).ok_or_else(|| JudgementError::NoSuchCase(name.to_owned()))?;
        let external = Some(Arc::clone(&solver));
        let runner = solvers::runner(case).with(RunnerOptions { external, ..RunnerOptions::default() });
        let claims = runner.claims();
        if claims.is_empty() {
            return Err(JudgementError::NothingFair(name.to_owned()));
        }
        let mut rows = Vec::new();
        for claim in &claims {
            let (verdict, control) = runner.judge_and_control(claim, true);
            judgement.controls.extend(control);
            rows.push(verdict);
        }
        mistake::explain(case, &all, &claims.iter().collect::<Vec<_>>(), &mut rows);
        judgement.verdicts.extend(rows);
    }
    Ok(judgement)
}

/// Tests the conformance properties that every solver must satisfy: conservation, symmetries, free flight, order and determinism.
#[must_use]
pub fn conform(solver: &dyn Solver, terms: &Terms) -> Judgement {
    let (verdicts, controls) = conformance::judge(solver, terms);
    Judgement { verdicts, controls }
}

impl Judgement {
    /// Returns one line for each red result and each control that did not fail.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let failed = |row: &&Verdict| row.outcome.is_red();
        let rows = self.verdicts.iter().filter(failed).map(line::verdict);
        rows.chain(self.controls.iter().filter(|control| !control.turned_red).map(line::control)).collect()
    }

    /// Returns the judgement if it passes: at least one result is judged, none is red, and each control failed as required.
    ///
    /// # Errors
    /// When it does not pass. The error contains the lines of the failures, or of all results if nothing was judged.
    pub fn require(self) -> Result<Self, SolverRejection> {
        if passes(self.verdicts.iter().map(|row| row.outcome), &self.controls) {
            return Ok(self);
        }
        let mut lines = self.failures();
        if lines.is_empty() {
            lines = self.verdicts.iter().map(line::verdict).collect();
            lines.push("nothing was judged".to_owned());
        }
        Err(SolverRejection { lines })
    }
}

/// One line per result, with its outcome first.
impl fmt::Display for Judgement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.verdicts {
            writeln!(formatter, "{:<11} {}", row.outcome.word(), line::verdict(row))?;
        }
        let red = self.controls.iter().filter(|control| control.turned_red).count();
        write!(formatter, "{red} of {} negative controls turned red, as they must", self.controls.len())
    }
}
