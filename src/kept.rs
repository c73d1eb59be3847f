//! What accuracy costs and what stays stable, as it was measured when somebody measured it, and of which sources.

pub use grainbench_cases::kept::sources;
use grainbench_reports::measured::{Costs, Measurements, Stability};
use grainbench_reports::study::Study;
use grainbench_studies::kept::{COST, STABILITY};

/// Other people's solvers beside ours in some scenes.
const PEERS: &str = include_str!("../peers/cost.json");

/// What was measured before.
///
/// # Errors
/// Names the file that is not what was kept.
pub fn measured() -> Result<Measurements, String> {
    let read = |name: &str, text: &str| -> Result<Study, String> {
        serde_json::from_str(text).map_err(|error| format!("{name}: {error}"))
    };
    let mut cost = Costs::of(&read("studies/kept/cost.json", COST)?, &sources);
    cost.add(Costs::of(&read("peers/cost.json", PEERS)?, &sources));
    let stability = Stability::of(&read("studies/kept/stability.json", STABILITY)?, &sources);
    Ok(Measurements { cost: Some(cost), stability: Some(stability) })
}
