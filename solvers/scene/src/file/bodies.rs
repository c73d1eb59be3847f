//! Keys of `bodies`: deformable bodies other than grains.

use super::grains::SpinSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deformable body other than a grain: exactly one of `box` and `annulus`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Name of the material.
    pub material: String,
    /// Axis-aligned box.
    #[serde(default, rename = "box")]
    pub cuboid: Option<BoxSpec>,
    /// Ring; two dimensions only.
    #[serde(default)]
    pub annulus: Option<AnnulusSpec>,
    /// Velocity (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Initial angular velocity about the centre of its shape (rad/s): one number about z in two dimensions, a vector
    /// in three.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Initial stretch rates along the axes (1/s). They add a velocity of rate times distance from the centre of the
    /// shape. Equal rates along all axes make a ring expand.
    #[serde(default)]
    pub stretch: Option<Vec<f64>>,
    /// Initial stress at the centre of the shape (Pa, tension positive), `[[xx, xy], [xy, yy]]` in two dimensions.
    #[serde(default)]
    pub stress: Option<Vec<Vec<f64>>>,
    /// Gradient of the initial stress along the axes (Pa/m).
    #[serde(default)]
    pub stress_gradient: Option<StressGradientSpec>,
    /// Initial velocity along x: a sine mode of a bar fixed at the lower end of the box.
    #[serde(default)]
    pub wave: Option<WaveSpec>,
    /// Fixed sides of a box, which do not move.
    #[serde(default)]
    pub fixed: Vec<SideSpec>,
    /// Sides of a box that do not move along their normal (symmetry boundaries).
    #[serde(default)]
    pub sliding: Vec<SideSpec>,
}

/// Gradient of a stress along each axis (Pa/m). For soil under its own weight with a lateral stress of K₀ times the
/// vertical stress, `y = [[K₀ρg, 0.0], [0.0, ρg]]`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StressGradientSpec {
    /// Along x.
    #[serde(default)]
    pub x: Option<Vec<Vec<f64>>>,
    /// Along y.
    #[serde(default)]
    pub y: Option<Vec<Vec<f64>>>,
    /// Along z.
    #[serde(default)]
    pub z: Option<Vec<Vec<f64>>>,
}

/// Axis-aligned box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
}

/// Ring.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnnulusSpec {
    /// Centre (m).
    pub centre: Vec<f64>,
    /// Inner radius (m).
    pub inner: f64,
    /// Outer radius (m).
    pub outer: f64,
}

/// Initial velocity v₀ sin((2n − 1)π (x − x_low)/2L) along x.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveSpec {
    /// Amplitude v₀ (m/s).
    pub amplitude: f64,
    /// Mode n, from 1.
    #[serde(default = "first_mode")]
    pub mode: u32,
}

const fn first_mode() -> u32 {
    1
}

/// Side of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SideSpec {
    /// The side at the smallest x.
    XLow,
    /// The side at the largest x.
    XHigh,
    /// The side at the smallest y.
    YLow,
    /// The side at the largest y.
    YHigh,
    /// The side at the smallest z.
    ZLow,
    /// The side at the largest z.
    ZHigh,
}
