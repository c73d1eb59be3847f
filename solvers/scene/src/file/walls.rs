//! Keys of `walls`, and the prescribed motion of a wall.

use super::SpinSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Wall: exactly one of `plane`, `segment`, `rectangle`, `cylinder`, `cone` and `mesh`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallSpec {
    /// Name of the material.
    pub material: String,
    /// Infinite plane (a line in two dimensions), solid behind its normal.
    #[serde(default)]
    pub plane: Option<PlaneSpec>,
    /// Segment between two points (m), solid on both sides; two dimensions only. Edges that lie on
    /// another wall are joined: a grain at the joint has one contact.
    #[serde(default)]
    pub segment: Option<[Vec<f64>; 2]>,
    /// Rectangle, solid on both sides; three dimensions only. Edges that lie on another wall are joined: a grain at the
    /// joint has one contact.
    #[serde(default)]
    pub rectangle: Option<RectangleSpec>,
    /// Lateral surface of a cylinder, without its ends, solid on both sides; three dimensions only. It may rotate about
    /// its axis. Contact laws replace it by its tangent plane and ignore its curvature.
    #[serde(default)]
    pub cylinder: Option<CylinderSpec>,
    /// Lateral surface of a cone or truncated cone, treated like that of a cylinder.
    #[serde(default)]
    pub cone: Option<ConeSpec>,
    /// Surface of triangles, solid on both sides; three dimensions only. A grain has at most one contact with each flat
    /// part, each edge between two flat parts, and each corner. The result does not depend on the triangulation.
    #[serde(default)]
    pub mesh: Option<MeshSpec>,
    /// Piston: the wall moves along its normal under a load, in addition to its prescribed motion. Planes only.
    #[serde(default)]
    pub piston: Option<PistonSpec>,
    /// Time of its removal (s), as for the plug of an orifice. Default never.
    #[serde(default)]
    pub until: Option<f64>,
    /// Prescribed motion. The parts add up.
    #[serde(default)]
    pub motion: Vec<MotionSpec>,
}

/// Infinite plane.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneSpec {
    /// Point on the plane (m).
    pub point: Vec<f64>,
    /// Direction out of the solid. Its length does not matter.
    pub normal: Vec<f64>,
}

/// Rectangle: a corner and two perpendicular edges from it.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleSpec {
    /// Corner (m).
    pub corner: Vec<f64>,
    /// The two edges from the corner (m).
    pub edges: [Vec<f64>; 2],
}

/// Piston that presses a plane: M dv/dt = F − F_n − M c v along its normal, with the normal force F_n of the grains on
/// it. At rest it presses with F.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PistonSpec {
    /// Force F along the normal (N; N/m in two dimensions).
    pub force: f64,
    /// Mass M (kg; kg/m in two dimensions). It must not be less than the total mass of the grains in contact with the
    /// plane; otherwise the stable time step of the grains is too long for the piston.
    pub mass: f64,
    /// Damping c (1/s).
    #[serde(default)]
    pub damping: f64,
}

/// Lateral surface of a cylinder.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderSpec {
    /// Ends of the axis (m).
    pub axis: [Vec<f64>; 2],
    /// Radius (m).
    pub radius: f64,
}

/// Lateral surface of a cone.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeSpec {
    /// Ends of the axis (m).
    pub axis: [Vec<f64>; 2],
    /// Radius at each end (m). One of them may be zero.
    pub radii: [f64; 2],
}

/// Surface of triangles from an STL file beside the scene, as text or binary.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSpec {
    /// Path of the file, relative to the scene file.
    pub file: String,
    /// Unit of the coordinates: `m` or `mm`. The format does not store a unit.
    pub unit: LengthUnit,
    /// If true, the mesh may have edges of one triangle only, as a funnel has. Otherwise such edges are errors. Default
    /// false.
    #[serde(default)]
    pub open: bool,
    /// If true, the normals of a closed mesh must point into the enclosed volume, as for a vessel drawn from within.
    /// Otherwise they must point outwards. Default false.
    #[serde(default)]
    pub inward: bool,
    /// Largest distance of corners that are merged (m). Equal corners are always merged. Default 0.
    #[serde(default)]
    pub merge: f64,
}

/// Unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    M,
    /// Millimetres.
    Mm,
}

/// Part of a motion: a `velocity` or `spin` from `start` to `stop`, immediate or with a `ramp`; a `table`; or a `sine`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionSpec {
    /// Velocity (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity (rad/s) about `centre`.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Centre of rotation (m), which moves with the wall. Required with `spin`.
    #[serde(default)]
    pub centre: Option<Vec<f64>>,
    /// Start (s). Default: the start of the run.
    #[serde(default)]
    pub start: Option<f64>,
    /// Stop (s). Default: never.
    #[serde(default)]
    pub stop: Option<f64>,
    /// Start in calculation cycles.
    #[serde(default)]
    pub start_cycle: Option<u64>,
    /// Stop in calculation cycles.
    #[serde(default)]
    pub stop_cycle: Option<u64>,
    /// Time in which the velocity is reached at a constant rate from the start (s).
    #[serde(default)]
    pub ramp: Option<f64>,
    /// Displacement from the initial position by time: rows of time (s), x, y, (z) (m) with rising times, joined by
    /// straight lines. Before the first row and after the last row the wall is at rest.
    #[serde(default)]
    pub table: Option<Vec<Vec<f64>>>,
    /// Oscillation.
    #[serde(default)]
    pub sine: Option<SineSpec>,
}

/// Oscillation A (sin(2πft + φ) − sin φ) from its start.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SineSpec {
    /// Amplitude A (m).
    pub amplitude: Vec<f64>,
    /// Frequency f (Hz).
    pub frequency: f64,
    /// Phase φ (degrees).
    #[serde(default)]
    pub phase_deg: f64,
}
