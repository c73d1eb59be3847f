//! Keys of `manufactured`: chosen motions that are exact under a body force (manufactured solutions).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
