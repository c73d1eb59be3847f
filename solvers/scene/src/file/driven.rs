//! Keys of `driven`: grains with prescribed motion.

use super::{MotionSpec, SideSpec, SpinSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grains with prescribed motion: they have a given velocity and spin, ignore forces, and do not deform. Give exactly
/// one of `grains`, `material`, `face` and `region`. Before `start` and after `stop`, they move freely.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivenSpec {
    /// All grains of a group.
    #[serde(default)]
    pub grains: Option<String>,
    /// All grains of a material, by its name.
    #[serde(default)]
    pub material: Option<String>,
    /// The grains that intersect a face of the domain at the start.
    #[serde(default)]
    pub face: Option<SideSpec>,
    /// The grains with their centres in a box at the start.
    #[serde(default)]
    pub region: Option<RegionSpec>,
    /// Velocity (m/s). Default zero.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity of each grain about its own centre (rad/s): one number about z in two dimensions, a vector in
    /// three. Default zero.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Further motion in addition to the velocity, as for a wall but without spin. The parts add up.
    #[serde(default)]
    pub motion: Vec<MotionSpec>,
    /// Start of the prescribed motion (s). Default: the start of the run.
    #[serde(default)]
    pub start: Option<f64>,
    /// End of the prescribed motion (s). Default: the end of the run.
    #[serde(default)]
    pub stop: Option<f64>,
}

/// Axis-aligned box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegionSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
}
