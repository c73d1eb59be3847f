//! Kinds of plans.

use super::arguments::Arguments;
use super::of_cost::CostStudy;
use super::of_run::ClaimStudy;
use super::of_stability::StabilityStudy;
use super::of_sweep::SweepStudy;
use super::study::Study;
use crate::cli::exit::Fault;

/// Returns the study of the kind that the arguments name.
pub(crate) fn from_arguments(arguments: &Arguments) -> Result<Box<dyn Study>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(ClaimStudy::new(arguments)?),
        "cost" => Box::new(CostStudy::new(arguments)?),
        "stability" => Box::new(StabilityStudy::new(arguments)?),
        file => Box::new(SweepStudy::new(file, arguments)?),
    })
}
