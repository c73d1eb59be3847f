//! Kinds of work.

use super::arguments::Arguments;
use super::claims::ClaimStudy;
use super::cost::CostStudy;
use super::effects::EffectStudy;
use super::stability::StabilityStudy;
use super::study::AnyStudy;
use super::sweep::SweepStudy;
use crate::cli::exit::Fault;

/// Returns the study of the kind that the arguments name. If `is_shared` is true, several processes may run its tasks.
pub(crate) fn from_arguments(arguments: &Arguments, is_shared: bool) -> Result<Box<dyn AnyStudy>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(ClaimStudy::new(arguments)?),
        "cost" => Box::new(CostStudy::new(arguments, is_shared)?),
        "stability" => Box::new(StabilityStudy::new(arguments, is_shared)?),
        "effects" => Box::new(EffectStudy::new(arguments)?),
        file => Box::new(SweepStudy::new(file)?),
    })
}
