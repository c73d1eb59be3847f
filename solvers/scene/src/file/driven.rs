//! The keys of `driven`: grains with a prescribed motion.

use super::SideSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grains that do not obey forces: they move at a constant velocity and do not turn, nor deform. Exactly one of
/// `grains`, `face` and `region`. Between `start` and `stop` only, where these are given: before and after they are grains
/// as all others are.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivenSpec {
    /// All grains of a group.
    #[serde(default)]
    pub grains: Option<String>,
    /// The grains that a face of the domain cuts at the start.
    #[serde(default)]
    pub face: Option<SideSpec>,
    /// The grains whose centre is in a box at the start.
    #[serde(default)]
    pub region: Option<RegionSpec>,
    /// Velocity (m/s); at rest when absent.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// From when on (s); from the start when absent.
    #[serde(default)]
    pub start: Option<f64>,
    /// Until when (s); to the end when absent.
    #[serde(default)]
    pub stop: Option<f64>,
}

/// A box whose sides are along the axes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegionSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
}
