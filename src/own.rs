//! The gates for a solver of one's own, in a few lines:
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let my_solver = || grainbench::dem::solver::Dem::new(grainbench::dem::convention::Convention::LAMMPS);
//! println!("{}", grainbench::judge(my_solver(), &["incline-disc", "backspin"])?.require()?);
//! # Ok(())
//! # }
//! ```

use grainbench_cases::registry;
use grainbench_cases::solvers::Registry;
use grainbench_harness::conformance;
use grainbench_harness::mistake;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::{Control, Outcome, Verdict};
use grainbench_reports::line;
use grainbench_scene::solver::Solver;
use grainbench_scene::terms::Terms;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// What was found about a solver: the rows, and for each whether it would have seen wrong physics in this very solver.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judgement {
    /// The rows.
    pub verdicts: Vec<Verdict>,
    /// Their negative controls. One that stays green tells that the solver does not feel what the row is about: that it
    /// ignores a value of the scene, say.
    pub controls: Vec<Control>,
}

/// Why a solver cannot be judged by a case.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotJudged {
    /// There is no such case.
    #[error("there is no case `{0}`; there are {known}", known = names())]
    NoSuchCase(String),
    /// The gates of the case judge the solvers that they name and nothing else.
    #[error("the case `{0}` has no gate that is fair to any solver: all judge a convention of the solvers they name")]
    NothingFair(String),
}

/// A solver that did not pass; it prints the lines that say why, also where only `Debug` is asked for, as tests do.
#[derive(Clone, PartialEq, Eq)]
pub struct Refused {
    lines: Vec<String>,
}

impl fmt::Display for Refused {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.lines.join("\n"))
    }
}

impl fmt::Debug for Refused {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the solver does not pass:\n{self}")
    }
}

impl std::error::Error for Refused {}

fn names() -> String {
    registry::CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ")
}

/// Puts a solver in the place of those that the gates of some cases name. Only gates that are fair to any solver judge
/// it. It is given their resolutions, fractions of the critical step of a spring contact, to be read as it sees fit.
///
/// # Errors
/// When a case does not exist or has no such gate.
pub fn judge(solver: impl Solver + 'static, cases: &[&str]) -> Result<Judgement, NotJudged> {
    let solver: Arc<dyn Solver> = Arc::new(solver);
    let solvers: Arc<dyn Solvers> = Arc::new(Registry);
    let mut judgement = Judgement::default();
    for &name in cases {
        let case = registry::by_name(name).ok_or_else(|| NotJudged::NoSuchCase(name.to_owned()))?;
        let runner = registry::runner(case).with_solver(Arc::clone(&solver));
        let claims = runner.claims();
        if claims.is_empty() {
            return Err(NotJudged::NothingFair(name.to_owned()));
        }
        let mut rows = Vec::new();
        for claim in &claims {
            let verdict = runner.judge(claim);
            if runner.tries_control(claim, &verdict) {
                judgement.controls.push(runner.control(claim));
            }
            rows.push(Some(verdict));
        }
        mistake::explain(case, &solvers, &claims, &mut rows);
        judgement.verdicts.extend(rows.into_iter().flatten());
    }
    Ok(judgement)
}

/// The properties that any solver owes: conservation, symmetries, free flight, order, determinism.
#[must_use]
pub fn conform(solver: &dyn Solver, terms: &Terms) -> Judgement {
    let (verdicts, controls) = conformance::judge(solver, terms);
    Judgement { verdicts, controls }
}

impl Judgement {
    /// A line for every row that failed or broke, and for every control that stayed green.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let failed = |row: &&Verdict| row.outcome.is_red();
        let rows = self.verdicts.iter().filter(failed).map(line::verdict);
        rows.chain(self.controls.iter().filter(|control| !control.turned_red).map(line::control)).collect()
    }

    /// The judgement, if nothing failed and something passed.
    ///
    /// # Errors
    /// With the lines of [`Judgement::failures`], or with every row where none is green.
    pub fn require(self) -> Result<Self, Refused> {
        let mut lines = self.failures();
        if lines.is_empty() && self.verdicts.iter().all(|row| row.outcome != Outcome::Pass) {
            lines = self.verdicts.iter().map(line::verdict).collect();
            lines.push("no row passed".to_owned());
        }
        if lines.is_empty() { Ok(self) } else { Err(Refused { lines }) }
    }
}

/// A line a row, its outcome first.
impl fmt::Display for Judgement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.verdicts {
            writeln!(formatter, "{:<11} {}", row.outcome.word(), line::verdict(row))?;
        }
        let red = self.controls.iter().filter(|control| control.turned_red).count();
        write!(formatter, "{red} of {} negative controls turned red, as they must", self.controls.len())
    }
}
