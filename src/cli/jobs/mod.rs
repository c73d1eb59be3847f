//! Lists of tasks: in the output directory of a command, or from one plan on this machine or through a batch system.
//! Commands for plans: `--plan DIR`, `run --resume DIR` and `report DIR`.

pub(crate) mod arguments;
mod claims;
pub(crate) mod collect;
mod cost;
mod effects;
pub(crate) mod here;
mod kinds;
pub(crate) mod plan;
mod stability;
pub(crate) mod status;
mod study;
mod sweep;
pub(crate) mod watch;
pub(crate) mod work;

use super::exit::Fault;
use grainbench::jobs::plan::Plan;
use std::path::Path;

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
