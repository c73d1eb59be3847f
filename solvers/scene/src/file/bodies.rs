//! The keys of `bodies`: deformable bodies that are no grains.

use super::grains::SpinSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A deformable body that is no grain: exactly one of `box` and `annulus`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Material by name.
    pub material: String,
    /// A box along the axes.
    #[serde(default, rename = "box")]
    pub cuboid: Option<BoxSpec>,
    /// A ring; two dimensions only.
    #[serde(default)]
    pub annulus: Option<AnnulusSpec>,
    /// Velocity (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity at the start about the middle of its shape (rad/s): one number about z in two dimensions, a vector in
    /// three.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Rates at which it is stretched at the start along the axes (1/s): a velocity of rate times distance from the middle of
    /// its shape. The same rate along all axes lets a ring expand.
    #[serde(default)]
    pub stretch: Option<Vec<f64>>,
    /// Stress at the start in the middle of its shape (Pa, tension positive), `[[xx, xy], [xy, yy]]` in two dimensions.
    #[serde(default)]
    pub stress: Option<Vec<Vec<f64>>>,
    /// What that stress gains a metre along the axes.
    #[serde(default)]
    pub stress_gradient: Option<StressGradientSpec>,
    /// An initial velocity along x that grows from the lower end of a box as the sine of a mode of a held bar.
    #[serde(default)]
    pub wave: Option<WaveSpec>,
    /// Sides of a box that do not move at all.
    #[serde(default)]
    pub fixed: Vec<SideSpec>,
    /// Sides of a box that do not move along their normal.
    #[serde(default)]
    pub sliding: Vec<SideSpec>,
}

/// What a stress gains a metre along each axis (Pa/m): for soil under its weight with a lateral stress of K₀ times the vertical
/// one, `y = [[K₀ρg, 0.0], [0.0, ρg]]`.
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

/// A box along the axes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
}

/// A ring.
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

/// v₀ sin((2n − 1)π (x − x_low)/2L) along x.
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

/// A side of a box.
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
