//! The keys of `walls`, and the prescribed motion of a wall.

use super::SpinSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A wall: exactly one of `plane`, `segment`, `rectangle`, `cylinder`, `cone` and `mesh`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallSpec {
    /// Material by name.
    pub material: String,
    /// An infinite plane (a line in two dimensions), solid behind its normal.
    #[serde(default)]
    pub plane: Option<PlaneSpec>,
    /// A segment between two points (m), solid on both sides; two dimensions only. Each wall is a surface of its own: a
    /// grain at the joint of two touches both, and feels both.
    #[serde(default)]
    pub segment: Option<[Vec<f64>; 2]>,
    /// A rectangle, solid on both sides; three dimensions only. At the joint of two a grain touches both.
    #[serde(default)]
    pub rectangle: Option<RectangleSpec>,
    /// The side of a cylinder, without its ends, solid on both sides; three dimensions only. It may turn about its axis. A
    /// contact law takes it for the plane that touches it: its curvature is in no law.
    #[serde(default)]
    pub cylinder: Option<CylinderSpec>,
    /// The side of a cone or of a part of one, as of a cylinder.
    #[serde(default)]
    pub cone: Option<ConeSpec>,
    /// A surface of triangles, solid on both sides; three dimensions only. A grain touches each flat part, each edge between
    /// two and each corner once at most, however they are cut into triangles: over a seam it feels nothing.
    #[serde(default)]
    pub mesh: Option<MeshSpec>,
    /// What presses it: then it moves along its normal as a piston does, beside its prescribed motion. Planes only.
    #[serde(default)]
    pub piston: Option<PistonSpec>,
    /// When it is taken away (s), as the plug of an orifice is; never when absent.
    #[serde(default)]
    pub until: Option<f64>,
    /// Prescribed motion: parts that add up.
    #[serde(default)]
    pub motion: Vec<MotionSpec>,
}

/// An infinite plane.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneSpec {
    /// A point on it (m).
    pub point: Vec<f64>,
    /// Direction out of the solid; need not have unit length.
    pub normal: Vec<f64>,
}

/// A rectangle: a corner and two perpendicular edges from it.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleSpec {
    /// One corner (m).
    pub corner: Vec<f64>,
    /// The two edges from it (m).
    pub edges: [Vec<f64>; 2],
}

/// A plane that is pressed: M dv/dt = F − F_n − M c v along its normal, with the normal force F_n of the grains on it. At rest
/// it presses with F.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PistonSpec {
    /// Force F along its normal (N; N/m in two dimensions).
    pub force: f64,
    /// Mass M (kg; kg/m in two dimensions): no less than that of the grains together that it touches, or the step at which they
    /// are stable is too long for it.
    pub mass: f64,
    /// Damping c (1/s).
    #[serde(default)]
    pub damping: f64,
}

/// The side of a cylinder.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderSpec {
    /// The ends of its axis (m).
    pub axis: [Vec<f64>; 2],
    /// Radius (m).
    pub radius: f64,
}

/// The side of a cone.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeSpec {
    /// The ends of its axis (m).
    pub axis: [Vec<f64>; 2],
    /// Radius at each end (m); one of them may be zero.
    pub radii: [f64; 2],
}

/// A surface of triangles from a file beside the scene: STL, as text or binary.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSpec {
    /// The file, relative to that of the scene.
    pub file: String,
    /// The unit of its coordinates: `m` or `mm`. The format has none.
    pub unit: LengthUnit,
    /// Whether edges of one triangle only are meant, as of a funnel; else they are refused.
    #[serde(default)]
    pub open: bool,
    /// Whether the normals of a mesh that is closed point into what it encloses, as of a vessel that is drawn from within; else
    /// that is refused.
    #[serde(default)]
    pub inward: bool,
    /// Corners that are no farther apart are taken for one (m); those that are equal are one anyway.
    #[serde(default)]
    pub merge: f64,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    M,
    /// Millimetres.
    Mm,
}

/// One part of a motion: a `velocity` or `spin` from `start` to `stop`, reached at once or by a `ramp`; a `table`; or a `sine`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionSpec {
    /// Velocity (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity (rad/s) about `centre`.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Centre of rotation (m), which moves along with the wall. Needed with `spin`.
    #[serde(default)]
    pub centre: Option<Vec<f64>>,
    /// Start (s). The beginning of the run when both starts are absent.
    #[serde(default)]
    pub start: Option<f64>,
    /// Stop (s). Never when both stops are absent.
    #[serde(default)]
    pub stop: Option<f64>,
    /// Start in calculation cycles.
    #[serde(default)]
    pub start_cycle: Option<u64>,
    /// Stop in calculation cycles.
    #[serde(default)]
    pub stop_cycle: Option<u64>,
    /// Time over which the velocity is reached, evenly, from the start on (s).
    #[serde(default)]
    pub ramp: Option<f64>,
    /// Where it is beside its place at the start, by time: rows of time (s), x, y, (z) (m), with rising times and straight lines
    /// between them; before the first row and after the last it stands still.
    #[serde(default)]
    pub table: Option<Vec<Vec<f64>>>,
    /// An oscillation.
    #[serde(default)]
    pub sine: Option<SineSpec>,
}

/// A (sin(2πft + φ) − sin φ) from its start on.
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
