//! `grainbench plan`, `work`, `status` and `collect`: many runs from one plan, on this machine or by a batch system.

pub(crate) mod collect;
mod of_cost;
mod of_run;
mod of_stability;
mod of_sweep;
pub(crate) mod plan;
pub(crate) mod status;
mod study;
pub(crate) mod work;

use super::exit::Fault;
use grainbench::campaign;
use grainbench::campaign::plan::Plan;
use std::path::Path;

impl From<campaign::Fault> for Fault {
    fn from(fault: campaign::Fault) -> Self {
        match fault {
            campaign::Fault::Input(words) => Self::input(words),
            campaign::Fault::Write(error) => Self::writing(error),
            // What a batch system refuses is no fault of what was typed.
            campaign::Fault::Batch(words) => Self::Broken(words),
        }
    }
}

/// Reads a plan, and goes where it was made: paths in it are seen from there. Its own path stays what it was.
fn enter(path: &Path) -> Result<Plan, Fault> {
    let mut plan = Plan::read(path)?;
    let whole = std::fs::canonicalize(path).map_err(|error| Fault::input(format!("{}: {error}", path.display())))?;
    std::env::set_current_dir(&plan.head.directory).map_err(|error| {
        let place = plan.head.directory.display();
        Fault::input(format!(
            "{}: directory: expected a directory that is there, found {place}: {error}",
            path.display()
        ))
    })?;
    plan.path = whole;
    Ok(plan)
}
