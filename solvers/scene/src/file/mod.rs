//! The scene file: every key a user can write, as serde reads it, one file for each table.
//!
//! Doc comments here are the documentation of the keys: `grainbench schema` prints them.

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

/// A scene: what exists and which physics acts. Numbers are SI; in two dimensions masses, forces and energies of
/// discs are per metre of depth. Vectors have as many components as the scene has dimensions.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Scene")]
pub struct SceneFile {
    /// Title, for reports.
    pub title: String,
    /// Number of dimensions: 2 or 3.
    pub dimension: u8,
    /// What a grain is: `disc` (a cylinder one metre deep, m = ρπR², I = mR²/2; the default in two dimensions) or
    /// `sphere` (m = ρ(4/3)πR³, I = 2mR²/5; in two dimensions a sphere kept in the plane).
    #[serde(default)]
    pub grain_shape: Option<GrainShape>,
    /// Gravity (m/s²): a vector, or magnitude and slope. None when absent.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
    /// Box of the scene (m). Needed for periodic axes and for `random` grains.
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
    /// Largest initial overlap of two grains or a grain and a wall, as a fraction of the smaller radius, that is taken
    /// for intended. Default 0.1.
    #[serde(default = "default_largest_initial_overlap")]
    pub largest_initial_overlap: f64,
    /// Length that resolutions of solvers with a grid refer to (m): the smallest radius, or the smallest edge of a body
    /// where there are no grains, when absent.
    #[serde(default)]
    pub reference_length: Option<f64>,
    /// Stress that deformable bodies start with; none when absent.
    #[serde(default)]
    pub initial_pressure: Option<InitialPressure>,
    /// A damped phase before the clock starts, for deformable bodies.
    #[serde(default)]
    pub settle: Option<SettleSpec>,
    /// A body force, and initial velocities, that make a chosen motion of neo-Hookean bodies the exact one.
    #[serde(default)]
    pub manufactured: Option<ManufacturedSpec>,
    /// Materials by name.
    pub materials: IndexMap<String, MaterialSpec>,
    /// Contact laws by name: the pair table. Every pair of materials that can meet needs one.
    #[serde(default)]
    pub contacts: IndexMap<String, ContactSpec>,
    /// Groups of grains by name. Grains are numbered from 1 in the order of the file.
    #[serde(default)]
    pub grains: IndexMap<String, GrainsSpec>,
    /// Where grains are taken out; nowhere when absent.
    #[serde(default)]
    pub removal: Option<RemovalSpec>,
    /// Deformable bodies that are no grains, by name.
    #[serde(default)]
    pub bodies: IndexMap<String, BodySpec>,
    /// Walls by name.
    #[serde(default)]
    pub walls: IndexMap<String, WallSpec>,
    /// Grains that are moved as walls are, by a name for each group of them.
    #[serde(default)]
    pub driven: IndexMap<String, DrivenSpec>,
    /// What is written down during the run.
    #[serde(default)]
    pub output: OutputSpec,
    /// Named time series.
    #[serde(default)]
    pub probes: IndexMap<String, ProbeSpec>,
    /// Variants: tables of overrides, laid over this file key by key.
    #[serde(default)]
    #[schemars(with = "IndexMap<String, serde_json::Value>")]
    pub variants: IndexMap<String, toml::Table>,
}

const fn default_largest_initial_overlap() -> f64 {
    0.1
}

/// What a grain is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GrainShape {
    /// A cylinder one metre deep that moves in the plane.
    Disc,
    /// A sphere.
    Sphere,
}

/// Gravity as a vector or as a slope.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "a vector such as [0.0, -9.8] or a table { magnitude, slope_deg }")]
pub enum GravitySpec {
    /// Acceleration (m/s²).
    Vector(Vec<f64>),
    /// Gravity seen from a plane inclined by `slope_deg`: (g sin θ, −g cos θ), so that down the slope is +x.
    Slope(SlopeSpec),
}

/// Gravity seen from an inclined plane.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlopeSpec {
    /// Magnitude g (m/s²).
    pub magnitude: f64,
    /// Inclination θ (degrees).
    pub slope_deg: f64,
}

/// The box of the scene.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DomainSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Which axes are periodic, by name (`["x"]`) or one by one (`[true, false]`); none when absent.
    #[serde(default)]
    pub periodic: PeriodicSpec,
}

/// Periodic axes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "names of axes such as [\"x\"], or whether each is periodic such as [true, false]")]
pub enum PeriodicSpec {
    /// Whether each axis is.
    Each(Vec<bool>),
    /// Those that are.
    Named(Vec<AxisName>),
}

impl Default for PeriodicSpec {
    fn default() -> Self {
        Self::Each(Vec::new())
    }
}

/// An axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxisName {
    /// The first.
    X,
    /// The second, upwards in the plane.
    Y,
    /// The third.
    Z,
}

/// A damped phase before the clock starts, in which bodies at rest come to equilibrium; then they are given their
/// velocities and spins and are released.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettleSpec {
    /// How long (s).
    pub duration: f64,
    /// Mass-proportional damping α (1/s).
    pub damping: f64,
    /// Gravity meanwhile; that of the scene when absent.
    #[serde(default)]
    pub gravity: Option<GravitySpec>,
}
