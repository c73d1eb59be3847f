//! The keys of `driven`: grains with a prescribed motion.

use super::{MotionSpec, SideSpec, SpinSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grains that do not obey forces: they move at a given velocity and spin, and do not deform. Exactly one of `grains`,
/// `material`, `face` and `region`. Between `start` and `stop` only, where these are given: before and after they are grains
/// as all others are.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivenSpec {
    /// All grains of a group.
    #[serde(default)]
    pub grains: Option<String>,
    /// All grains of a material, by its name.
    #[serde(default)]
    pub material: Option<String>,
    /// The grains that a face of the domain cuts at the start.
    #[serde(default)]
    pub face: Option<SideSpec>,
    /// The grains whose centre is in a box at the start.
    #[serde(default)]
    pub region: Option<RegionSpec>,
    /// Velocity (m/s); at rest when absent.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity of each about its own centre (rad/s): one number about z in two dimensions, a vector in three. They do
    /// not turn when absent.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Motion beside the velocity, as of a wall, but without a spin: parts that add up.
    #[serde(default)]
    pub motion: Vec<MotionSpec>,
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
