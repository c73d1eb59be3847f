//! Keys of a scene file as types that serde reads, with modules for the tables of keys.
//!
//! Doc comments here are the documentation of the keys: `grainbench scene --schema` prints them.

mod bodies;
mod grains;
mod output;
mod walls;

pub use crate::contact_law::{ContactSpec, LawKind};
pub use crate::material::{ConstitutiveKind, MaterialSpec};
pub use bodies::{AnnulusSpec, AxisAlignedSpec, BodySpec, BoxSpec, ManufacturedSpec, SideSpec, VortexSpec, WaveSpec};
pub use grains::{
    FileSpec, GrainsSpec, LatticeSpec, LogNormalSpec, PackedSpec, PouredSpec, RadiiSpec, RandomSpec, RegionSpec,
    RemovalSpec, SpacingSpec, SpinSpec, StateSpec,
};
pub use output::{OutputSpec, PointSpec, ProbeSpec};
pub use walls::{
    ConeSpec, CylinderSpec, DrivenSpec, LengthUnit, MeshSpec, MotionSpec, Piston, PlaneSpec, RectangleSpec, SineSpec,
    WallSpec,
};

use crate::body::InitialPressure;
use crate::dimension::GrainShape;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scene: grains, bodies, walls, materials, contact laws and output of a run. Numbers are in SI units. In two
/// dimensions, masses, forces and energies of discs are per metre of depth. Vectors have one component per dimension of
/// the scene.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Scene")]
pub struct SceneFile {
    /// Title of the scene in reports.
    pub title: String,
    /// Number of dimensions: 2 or 3.
    pub dimension: u8,
    /// Shape of the grains: `disc` (a cylinder one metre deep, m = ρπR², I = mR²/2; the default in two dimensions) or
    /// `sphere` (m = ρ(4/3)πR³, I = 2mR²/5; in two dimensions, a sphere that moves in the plane).
    #[serde(default)]
    pub grain_shape: Option<GrainShape>,
    /// Gravity (m/s²), as a vector or as magnitude and slope. Default zero.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
    /// Domain of the scene, an axis-aligned box (m). Required for periodic axes and for `random` and `packed` grains.
    #[serde(default)]
    pub domain: Option<DomainSpec>,
    /// Global mass-proportional damping α (1/s). It exerts a force −α m v and a torque −α I ω on every grain. Default
    /// 0.
    #[serde(default)]
    pub global_damping: f64,
    /// Simulated time (s). Give this or `duration_cycles`.
    #[serde(default)]
    pub duration: Option<f64>,
    /// Simulated time in calculation cycles (time steps). Give this or `duration`.
    #[serde(default)]
    pub duration_cycles: Option<u64>,
    /// Largest initial overlap of two grains, or of a grain and a wall, as a fraction of the smaller radius. Larger
    /// overlaps are errors. Default 0.1.
    #[serde(default = "default_largest_initial_overlap")]
    pub largest_initial_overlap: f64,
    /// Reference length for the resolution of solvers with a grid (m). Default: the smallest radius, or the smallest
    /// edge of a body if there are no grains.
    #[serde(default)]
    pub reference_length: Option<f64>,
    /// Initial stress of deformable bodies. Default none.
    #[serde(default)]
    pub initial_pressure: Option<InitialPressure>,
    /// Damped relaxation of deformable bodies before t = 0. Default none.
    #[serde(default)]
    pub settle: Option<SettleSpec>,
    /// Body force and initial velocities that make a chosen motion of neo-Hookean bodies exact. Default none.
    #[serde(default)]
    pub manufactured: Option<ManufacturedSpec>,
    /// Materials by name.
    pub materials: IndexMap<String, MaterialSpec>,
    /// Contact laws by name. Every pair of materials that can come into contact needs one.
    #[serde(default)]
    pub contacts: IndexMap<String, ContactSpec>,
    /// Groups of grains by name. Grains are numbered from 1 in the order of the file.
    #[serde(default)]
    pub grains: IndexMap<String, GrainsSpec>,
    /// Removal of grains that leave a box. Default none.
    #[serde(default)]
    pub removal: Option<RemovalSpec>,
    /// Deformable bodies other than grains, by name.
    #[serde(default)]
    pub bodies: IndexMap<String, BodySpec>,
    /// Walls by name.
    #[serde(default)]
    pub walls: IndexMap<String, WallSpec>,
    /// Groups of grains with prescribed motion, by name.
    #[serde(default)]
    pub driven: IndexMap<String, DrivenSpec>,
    /// Times and contents of samples and snapshots.
    #[serde(default)]
    pub output: OutputSpec,
    /// Probes by name. Each records quantities as a time series.
    #[serde(default)]
    pub probes: IndexMap<String, ProbeSpec>,
    /// Variants of the scene by name. Each is a table of keys that replace or extend the keys of this file. An empty
    /// string removes a key.
    #[serde(default)]
    #[schemars(with = "IndexMap<String, serde_json::Value>")]
    pub variants: IndexMap<String, toml::Table>,
}

const fn default_largest_initial_overlap() -> f64 {
    0.1
}

/// Gravity, as a vector or as magnitude and slope.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "a vector such as [0.0, -9.8] or a table { magnitude, slope_deg }")]
pub enum GravitySpec {
    /// Acceleration (m/s²).
    Vector(Vec<f64>),
    /// Gravity in the frame of a plane that descends towards +x at an inclination θ: (g sin θ, −g cos θ) in two
    /// dimensions, and (g sin θ, 0, −g cos θ) in three dimensions.
    Slope(SlopeSpec),
}

/// Gravity in the frame of an inclined plane.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlopeSpec {
    /// Magnitude g (m/s²).
    pub magnitude: f64,
    /// Inclination θ (degrees).
    pub slope_deg: f64,
}

/// Domain of the scene: an axis-aligned box that may be periodic.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DomainSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Periodic axes, as names (`["x"]`) or as one value per axis (`[true, false]`). Default none.
    #[serde(default)]
    pub periodic: PeriodicSpec,
}

/// Periodic axes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "names of periodic axes such as [\"x\"], or a value for each axis such as [true, false]")]
pub enum PeriodicSpec {
    /// One value per axis, true if the axis is periodic.
    Each(Vec<bool>),
    /// Names of the periodic axes.
    Named(Vec<AxisName>),
}

impl Default for PeriodicSpec {
    fn default() -> Self {
        Self::Each(Vec::new())
    }
}

/// Axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxisName {
    /// First axis.
    X,
    /// Second axis; upwards in two dimensions.
    Y,
    /// Third axis.
    Z,
}

/// Damped relaxation before t = 0. Bodies start at rest and come to equilibrium. At t = 0, they receive their initial
/// velocities and spins, and gravity and damping take the values of the scene.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettleSpec {
    /// Duration (s).
    pub duration: f64,
    /// Mass-proportional damping α (1/s).
    pub damping: f64,
    /// Gravity during the relaxation (m/s²). Default: gravity of the scene.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
}
