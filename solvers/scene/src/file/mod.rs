//! Scene file: every key that users can write, as serde reads it, with one module per table.
//!
//! Doc comments here are the documentation of the keys: `grainbench scene --schema` prints them.

mod bodies;
mod driven;
mod grains;
mod manufactured;
mod output;
mod probes;
mod walls;

pub use crate::contact_law::{ContactSpec, LawKind};
pub use crate::material::{ConstitutiveKind, MaterialSpec};
pub use bodies::{AnnulusSpec, BodySpec, BoxSpec, SideSpec, WaveSpec};
pub use driven::{DrivenSpec, RegionSpec};
pub use grains::{
    FileSpec, GrainsSpec, LatticeSpec, LogNormalSpec, PackedSpec, PouredSpec, RadiiSpec, RandomSpec, RemovalSpec,
    SpacingSpec, SpinSpec, StateSpec,
};
pub use manufactured::{AxisAlignedSpec, ManufacturedSpec, VortexSpec};
pub use output::OutputSpec;
pub use probes::{PointSpec, ProbeSpec};
pub use walls::{
    ConeSpec, CylinderSpec, LengthUnit, MeshSpec, MotionSpec, PistonSpec, PlaneSpec, RectangleSpec, SineSpec, WallSpec,
};

use crate::body::InitialPressure;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scene: its contents and its physics. Numbers are in SI units. In two dimensions, masses, forces and energies of
/// discs are per metre of depth. Vectors have one component per dimension of the scene.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Scene")]
pub struct SceneFile {
    /// Title, for reports.
    pub title: String,
    /// Number of dimensions: 2 or 3.
    pub dimension: u8,
    /// Shape of the grains: `disc` (a cylinder one metre deep, m = ρπR², I = mR²/2; the default in two dimensions) or
    /// `sphere` (m = ρ(4/3)πR³, I = 2mR²/5; in two dimensions, a sphere that moves in the plane).
    #[serde(default)]
    pub grain_shape: Option<GrainShape>,
    /// Gravity (m/s²): a vector, or magnitude and slope. Default zero.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
    /// Domain of the scene (m). Required for periodic axes and for `random` and `packed` grains.
    #[serde(default)]
    pub domain: Option<DomainSpec>,
    /// Global mass-proportional damping α (1/s): a force −α m v and a torque −α I ω on every grain.
    #[serde(default)]
    pub global_damping: f64,
    /// Simulated time (s). Give this or `duration_cycles`.
    #[serde(default)]
    pub duration: Option<f64>,
    /// Simulated time in calculation cycles. Give this or `duration`.
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
    /// Damped relaxation of deformable bodies before t = 0.
    #[serde(default)]
    pub settle: Option<SettleSpec>,
    /// Body force and initial velocities that make a chosen motion of neo-Hookean bodies exact.
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
    /// Removal of grains. Default none.
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
    /// Output of the run.
    #[serde(default)]
    pub output: OutputSpec,
    /// Named time series.
    #[serde(default)]
    pub probes: IndexMap<String, ProbeSpec>,
    /// Variants by name: tables of overrides, applied to this file key by key.
    #[serde(default)]
    #[schemars(with = "IndexMap<String, serde_json::Value>")]
    pub variants: IndexMap<String, toml::Table>,
}

const fn default_largest_initial_overlap() -> f64 {
    0.1
}

/// Shape of the grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GrainShape {
    /// Cylinder one metre deep that moves in the plane.
    Disc,
    /// Sphere.
    Sphere,
}

/// Gravity as a vector or as a slope.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "a vector such as [0.0, -9.8] or a table { magnitude, slope_deg }")]
pub enum GravitySpec {
    /// Acceleration (m/s²).
    Vector(Vec<f64>),
    /// Gravity in the frame of a plane inclined by `slope_deg`: (g sin θ, −g cos θ). Down the slope is +x.
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

/// Domain of the scene.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DomainSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Periodic axes, by name (`["x"]`) or one by one (`[true, false]`). Default none.
    #[serde(default)]
    pub periodic: PeriodicSpec,
}

/// Periodic axes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "names of axes such as [\"x\"], or whether each is periodic such as [true, false]")]
pub enum PeriodicSpec {
    /// One flag per axis.
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
    /// Second axis, upwards in the plane.
    Y,
    /// Third axis.
    Z,
}

/// Damped relaxation before t = 0. Bodies at rest come to equilibrium, then receive their velocities and spins and are
/// released.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettleSpec {
    /// Duration (s).
    pub duration: f64,
    /// Mass-proportional damping α (1/s).
    pub damping: f64,
    /// Gravity during the relaxation. Default: gravity of the scene.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
}
