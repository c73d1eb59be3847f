//! Keys of `walls` and of `driven` (grains with prescribed motion).

use super::bodies::SideSpec;
use super::grains::{RegionSpec, SpinSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Wall. Its shape is exactly one of `plane`, `segment`, `rectangle`, `cylinder`, `cone` and `mesh`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallSpec {
    /// Name of the material, as in `materials`.
    pub material: String,
    /// Infinite plane (a line in two dimensions). The normal points out of the solid half-space.
    #[serde(default)]
    pub plane: Option<PlaneSpec>,
    /// Segment between two points (m). Two dimensions only. Grains may be in contact with either side. If an end lies
    /// on another wall, the walls are joined: a grain at the joint has one contact.
    #[serde(default)]
    pub segment: Option<[Vec<f64>; 2]>,
    /// Rectangle. Three dimensions only. Grains may be in contact with either side. If an edge lies on another wall,
    /// the walls are joined: a grain at the joint has one contact.
    #[serde(default)]
    pub rectangle: Option<RectangleSpec>,
    /// Lateral surface of a cylinder, without the end faces. Three dimensions only. Grains may be in contact with
    /// either side. The cylinder may rotate about its axis. Contact laws replace the surface by its tangent plane and
    /// ignore its curvature.
    #[serde(default)]
    pub cylinder: Option<CylinderSpec>,
    /// Lateral surface of a cone or truncated cone. Three dimensions only. Contacts and rotation are as for `cylinder`.
    #[serde(default)]
    pub cone: Option<ConeSpec>,
    /// Surface of triangles. Three dimensions only. Grains may be in contact with either side. A grain has at most one
    /// contact with each flat part, each edge between two flat parts, and each corner. The result does not depend on
    /// the triangulation.
    #[serde(default)]
    pub mesh: Option<MeshSpec>,
    /// Piston: the wall moves along its normal under a load, in addition to its prescribed motion. Planes only.
    #[serde(default)]
    pub piston: Option<Piston>,
    /// Removal time of the wall (s), for example of a plug that closes an orifice. Default: never.
    #[serde(default)]
    pub until: Option<f64>,
    /// Prescribed motion in parts, whose displacements are added. Default: no motion.
    #[serde(default)]
    pub motion: Vec<MotionSpec>,
}

/// Infinite plane.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneSpec {
    /// Point on the plane (m).
    pub point: Vec<f64>,
    /// Vector out of the solid, of any length.
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

/// Piston that presses a plane against grains. Its velocity v along the normal of the plane satisfies M dv/dt = F − F_n
/// − M c v, where F_n is the normal force of the grains on the plane. At rest, the plane presses with F.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PistonSpec")]
pub struct Piston {
    /// Force F along the normal (N; N/m in two dimensions).
    pub force: f64,
    /// Mass M (kg; kg/m in two dimensions). It must be at least the total mass of the grains in contact with the plane.
    /// With a smaller mass, the stable time step of the grains is too long for the piston.
    pub mass: f64,
    /// Damping c (1/s). Default 0.
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
    /// Radius at each end (m). The radii must differ, and one may be zero.
    pub radii: [f64; 2],
}

/// Surface of triangles from an STL file, in text or binary form.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSpec {
    /// Path of the file, relative to the scene file.
    pub file: String,
    /// Unit of the coordinates, `m` or `mm`. STL files do not store it.
    pub unit: LengthUnit,
    /// If true, the mesh may be open, like a funnel: an edge may belong to only one triangle. If false, such an edge is
    /// an error. Default false.
    #[serde(default)]
    pub open: bool,
    /// If true, the normals of a closed mesh must point into the enclosed volume, as for a vessel that contains the
    /// grains. If false, they must point outwards. Default false.
    #[serde(default)]
    pub inward: bool,
    /// Largest distance between triangle corners that are merged (m). Equal corners are always merged. Default 0.
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

/// Part of a motion, in one of three forms. The first is a constant `velocity` and `spin` from `start` to `stop`; a
/// `velocity` without `spin` may rise over a `ramp`. The second is a `table`. The third is a `sine`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSpec {
    /// Velocity (m/s). Default zero.
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity (rad/s) about `centre`.
    pub spin: Option<SpinSpec>,
    /// Initial centre of rotation (m). It moves with the wall. Required with `spin`.
    pub centre: Option<Vec<f64>>,
    /// Start (s). Default: the start of the run.
    pub start: Option<f64>,
    /// Stop (s). Default: never.
    pub stop: Option<f64>,
    /// Start as a calculation cycle (time step), instead of `start`.
    pub start_cycle: Option<u64>,
    /// Stop as a calculation cycle (time step), instead of `stop`.
    pub stop_cycle: Option<u64>,
    /// Time (s) over which the velocity rises from zero to `velocity` at a constant rate, beginning at `start`.
    /// Default: the velocity is constant from the start.
    pub ramp: Option<f64>,
    /// Table of displacements from the initial position, with rows `[t, x, y]` or `[t, x, y, z]` of a time (s) and a
    /// displacement (m). Times rise from row to row, and the first displacement is zero. Between rows, the displacement
    /// is linear in time. Before the first row and after the last row, the wall is at rest.
    pub table: Option<Vec<Vec<f64>>>,
    /// Sinusoidal oscillation.
    pub sine: Option<SineSpec>,
}

/// Oscillation with the displacement A (sin(2πfτ + φ) − sin φ), where τ is the time since `start`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SineSpec {
    /// Amplitude A (m).
    pub amplitude: Vec<f64>,
    /// Frequency f (Hz).
    pub frequency: f64,
    /// Phase φ (degrees). Default 0.
    #[serde(default)]
    pub phase_deg: f64,
}

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
