//! Many runs from one plan, on this machine or through a batch system. Commands: `--plan DIR`, `run --resume DIR` and
//! `report DIR`.

pub(crate) mod arguments;
pub(crate) mod collect;
mod kinds;
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
            // A failure of the batch system is not an input error.
            campaign::Fault::Batch(words) => Self::Broken(words),
        }
    }
}

/// Reads a plan and changes to the directory in which the plan was made, because paths in the plan are relative to it.
/// The path of the plan becomes absolute.
fn enter(path: &Path) -> Result<Plan, Fault> {
    let mut plan = Plan::read(path)?;
    let whole = std::fs::canonicalize(path).map_err(|error| Fault::input(format!("{}: {error}", path.display())))?;
    std::env::set_current_dir(&plan.head.directory).map_err(|error| {
        let place = plan.head.directory.display();
        Fault::input(format!("{}: directory: expected an existing directory, found {place}: {error}", path.display()))
    })?;
    plan.path = whole;
    Ok(plan)
}
