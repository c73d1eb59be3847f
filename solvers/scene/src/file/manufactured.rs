//! Keys of `manufactured`: motions that a body force makes exact.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Chosen motion that a body force makes exact: exactly one of `axis-aligned` and `vortex`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ManufacturedSpec {
    /// Motion u_x = A sin(2πX/L) sin(cπt/L), c = √(E/ρ), in a periodic box of length L along x.
    #[serde(default)]
    pub axis_aligned: Option<AxisAlignedSpec>,
    /// Rotation of each circle about the origin, between the radii .75 m and 1.25 m.
    #[serde(default)]
    pub vortex: Option<VortexSpec>,
}

/// Motion u_x = A sin(2πX/L) sin(cπt/L).
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

/// Rotation by α = A sin(Bπt) (1 − 16 (R − 1)²)².
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VortexSpec {
    /// Largest angle A (rad).
    pub amplitude: f64,
    /// Rate B (1/s). The period of the motion is 2/B.
    pub rate: f64,
}
