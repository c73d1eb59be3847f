//! Lists of tasks: in the output directory of a command, or from one plan on this machine or through a batch system.
//! Commands for plans: `--plan DIR`, `run --resume DIR` and `report DIR`.

pub(crate) mod arguments;
pub(crate) mod collect;
mod cost;
mod effects;
pub(crate) mod plan;
mod stability;
pub(crate) mod study;
mod sweep;
pub(crate) mod watch;
pub(crate) mod work;

use super::claims::tasks::ClaimTasks;
use super::exit::Fault;
use arguments::Arguments;
use cost::CostStudy;
use effects::EffectStudy;
use grainbench::jobs::plan::Plan;
use stability::StabilityStudy;
use std::path::Path;
use study::AnyStudy;
use sweep::SweepStudy;

/// Returns the study of the kind that the arguments name. If `is_shared` is true, several processes may run its tasks.
fn from_arguments(arguments: &Arguments, is_shared: bool) -> Result<Box<dyn AnyStudy>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(ClaimTasks::from_arguments(arguments)?),
        "cost" => Box::new(CostStudy::new(arguments, is_shared)?),
        "stability" => Box::new(StabilityStudy::new(arguments, is_shared)?),
        "effects" => Box::new(EffectStudy::new(arguments)?),
        file => Box::new(SweepStudy::new(file)?),
    })
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
