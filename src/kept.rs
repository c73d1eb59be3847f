//! Stored measurements of cost, stability and effects, with the hashes of the solvers' sources.

pub use grainbench_cases::kept::sources;
use grainbench_reports::measured::{Costs, Effects, Measurements, Stability};
use grainbench_reports::study::Study;
use grainbench_store::ReadError;
use grainbench_store::artifact::parse_json;
use grainbench_studies::kept::{COST, EFFECTS, STABILITY};
use std::path::Path;

/// Cost measurements of external solvers, and of our solvers in the same scenes.
const PEERS: &str = include_str!("../peers/cost.json");

/// Reads the stored measurements.
///
/// # Errors
/// When a file cannot be read as a study. The error names the file.
pub fn measured() -> Result<Measurements, ReadError> {
    let read = |name: &str, text: &str| parse_json::<Study>(Path::new(name), text.as_bytes());
    let mut cost = Costs::from_study(&read("studies/kept/cost.json", COST)?, &sources);
    cost.add(Costs::from_study(&read("peers/cost.json", PEERS)?, &sources));
    let stability = Stability::from_study(&read("studies/kept/stability.json", STABILITY)?, &sources);
    let effects = Effects::from_study(&read("studies/kept/effects.json", EFFECTS)?, &sources);
    Ok(Measurements { cost: Some(cost), stability: Some(stability), effects: Some(effects) })
}
