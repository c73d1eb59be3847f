//! Keys of `bodies` (deformable bodies other than grains) and of `manufactured` (motions that a body force makes exact).

use super::grains::SpinSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deformable body other than a grain. Its shape is exactly one of `box` and `annulus`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Name of the material, as in `materials`.
    pub material: String,
    /// Axis-aligned box.
    #[serde(default, rename = "box")]
    pub cuboid: Option<BoxSpec>,
    /// Ring. Two dimensions only.
    #[serde(default)]
    pub annulus: Option<AnnulusSpec>,
    /// Initial velocity (m/s). Default zero.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Initial angular velocity about the centre of the shape (rad/s). In two dimensions, it is one number (about z);
    /// in three dimensions, a vector. Default zero.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Initial stretch rates aᵢ along the axes i (1/s). They add the velocity aᵢ (xᵢ − cᵢ) along axis i at a position
    /// x, where c is the centre of the shape. Equal rates along x and y make a ring expand. Default zero.
    #[serde(default)]
    pub stretch: Option<Vec<f64>>,
    /// Initial Cauchy stress at the centre of the shape (Pa, tension positive). In two dimensions, it is `[[xx, xy],
    /// [xy, yy]]`, and σ_zz follows from plane strain. Not together with `initial_pressure`. Default zero.
    #[serde(default)]
    pub stress: Option<Vec<Vec<f64>>>,
    /// Gradients of the initial stress along the axes (Pa/m). Default zero.
    #[serde(default)]
    pub stress_gradient: Option<StressGradientSpec>,
    /// Initial velocity along x, in addition to `velocity`: a vibration mode of a bar that is fixed at its end of
    /// smallest x. Boxes only.
    #[serde(default)]
    pub wave: Option<WaveSpec>,
    /// Sides of a box that do not move, such as `["x-low"]`. Default none.
    #[serde(default)]
    pub fixed: Vec<SideSpec>,
    /// Sides of a box that do not move along their normal (symmetry boundaries). Default none.
    #[serde(default)]
    pub sliding: Vec<SideSpec>,
}

/// Gradients of the initial stress along the axes (Pa/m). Example for soil of density ρ under its own weight, with y
/// upwards and a lateral stress of K₀ times the vertical stress: `y = [[K₀ρg, 0.0], [0.0, ρg]]`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StressGradientSpec {
    /// Gradient along x (Pa/m): a symmetric tensor, row by row. Default zero.
    pub x: Option<Vec<Vec<f64>>>,
    /// Gradient along y (Pa/m): a symmetric tensor, row by row. Default zero.
    pub y: Option<Vec<Vec<f64>>>,
    /// Gradient along z (Pa/m): a symmetric tensor, row by row. Three dimensions only. Default zero.
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

/// Initial velocity v₀ sin((2n − 1)π (x − x_low)/2L) along x, in a box of length L that begins at x_low.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveSpec {
    /// Amplitude v₀ (m/s).
    pub amplitude: f64,
    /// Number n of the mode, from 1. Default 1.
    #[serde(default = "first_mode")]
    pub mode: u32,
}

const fn first_mode() -> u32 {
    1
}

/// Side of a box, or face of the domain.
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

impl SideSpec {
    /// Returns the axis (0 to 2), and 0 for the lower or 1 for the upper side along it.
    pub(crate) const fn axis_and_end(self) -> [usize; 2] {
        [self as usize / 2, self as usize % 2]
    }
}

/// Manufactured solution: a chosen motion with the body force that makes it exact. Give exactly one of `axis-aligned`
/// and `vortex`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ManufacturedSpec {
    /// Displacement u_x = A sin(2πX/L) sin(cπt/L) in a periodic box of length L along x. X is the initial position, t
    /// the time, and c = √(E/ρ) the bar wave speed.
    pub axis_aligned: Option<AxisAlignedSpec>,
    /// Rotation of each circle about the origin with a radius between 0.75 m and 1.25 m. The angle depends on the
    /// radius.
    pub vortex: Option<VortexSpec>,
}

/// Displacement u_x = A sin(2πX/L) sin(cπt/L) at the initial position X and time t, with the bar wave speed c.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisAlignedSpec {
    /// Amplitude A (m), below L/2π.
    pub amplitude: f64,
    /// Length L (m). Default 1.
    #[serde(default = "one_metre")]
    pub length: f64,
}

const fn one_metre() -> f64 {
    1.0
}

/// Rotation about the origin by the angle α = A sin(Bπt) (1 − 16 (R − 1)²)² at time t and radius R, for 0.75 m < R <
/// 1.25 m.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VortexSpec {
    /// Largest angle A (rad).
    pub amplitude: f64,
    /// Rate B (1/s). The period of the motion is 2/B.
    pub rate: f64,
}
