//! Keys of `driven`: grains with prescribed motion.

use super::bodies::SideSpec;
use super::grains::{RegionSpec, SpinSpec};
use super::walls::MotionSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grains with prescribed velocity and spin. The grains do not deform, and forces do not change their motion. Exactly
/// one of `grains`, `material`, `face` and `region` selects the grains. Before `start` and after `stop`, the grains
/// move freely.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DrivenSpec {
    /// Name of a group, which selects all its grains.
    pub grains: Option<String>,
    /// Name of a material, which selects all grains of this material.
    pub material: Option<String>,
    /// Face of the domain, which selects the grains that intersect it at the start. The face must not be periodic.
    pub face: Option<SideSpec>,
    /// Box, which selects the grains whose centres lie in it at the start.
    pub region: Option<RegionSpec>,
    /// Prescribed velocity (m/s). Default zero.
    pub velocity: Option<Vec<f64>>,
    /// Prescribed angular velocity of each grain about its own centre (rad/s). In two dimensions, it is one number
    /// (about z); in three dimensions, a vector. Not supported by MPM. Default zero.
    pub spin: Option<SpinSpec>,
    /// Further motion, which is added to `velocity`. It has the keys of the motion of a wall, but no `spin`, and its
    /// times are in seconds. The displacements of all parts are added.
    pub motion: Vec<MotionSpec>,
    /// Start of the prescribed motion (s). Default: the start of the run.
    pub start: Option<f64>,
    /// End of the prescribed motion (s). Default: the end of the run.
    pub stop: Option<f64>,
}
