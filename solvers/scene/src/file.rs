//! The scene file: every key a user can write, as serde reads it.
//!
//! Doc comments here are the documentation of the keys: `grainbench schema` prints them.

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
    /// Which axes are periodic; none when absent.
    #[serde(default)]
    pub periodic: Vec<bool>,
}

/// A material.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Density ρ (kg/m³); not needed for materials of walls, nor where a data file gives it.
    #[serde(default)]
    pub density: Option<f64>,
    /// Young's modulus E (Pa); needed for Hertz contacts unless `rigid`. With Poisson's ratio it makes bodies
    /// deformable for solvers that resolve them.
    #[serde(default)]
    pub young_modulus: Option<f64>,
    /// Poisson's ratio ν, from −1 to 1/2; needed for Hertz contacts unless `rigid`.
    #[serde(default)]
    pub poisson_ratio: Option<f64>,
    /// Whether the material is rigid: its partner alone deforms in a Hertz contact.
    #[serde(default)]
    pub rigid: bool,
    /// Bulk modulus K (Pa), with `shear_modulus` in place of Young's modulus and Poisson's ratio.
    #[serde(default)]
    pub bulk_modulus: Option<f64>,
    /// Shear modulus G (Pa).
    #[serde(default)]
    pub shear_modulus: Option<f64>,
    /// Law of a deformable material: `neo-hookean` (the default), `hypoelastic` or `von-mises`.
    #[serde(default)]
    pub constitutive: Option<ConstitutiveKind>,
    /// Yield stress Y (Pa); needed for `von-mises`.
    #[serde(default)]
    pub yield_stress: Option<f64>,
    /// Hardening modulus H (Pa) of `von-mises`. Default 0.
    #[serde(default)]
    pub hardening_modulus: Option<f64>,
}

/// Law of a deformable material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConstitutiveKind {
    /// The Jaumann rate of the stress is linear in the rate of deformation.
    Hypoelastic,
    /// Compressible: τ = λ ln J + G (b − 1).
    NeoHookean,
    /// Hypoelastic up to a yield stress, with linear isotropic hardening.
    VonMises,
}

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

/// A chosen motion that a body force makes exact: exactly one of `axis-aligned` and `vortex`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ManufacturedSpec {
    /// u_x = A sin(2πX/L) sin(cπt/L), c = √(E/ρ), in a periodic box of length L along x.
    #[serde(default)]
    pub axis_aligned: Option<AxisAlignedSpec>,
    /// Rotation of each circle about the origin, between the radii .75 m and 1.25 m.
    #[serde(default)]
    pub vortex: Option<VortexSpec>,
}

/// u_x = A sin(2πX/L) sin(cπt/L).
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
    /// B (1/s): the motion has the period 2/B.
    pub rate: f64,
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

/// Force law along the normal, and the tangential spring that goes with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LawKind {
    /// Linear springs of given stiffness.
    #[default]
    Linear,
    /// Hertz along the normal, Mindlin's spring along the tangent, from E and ν of both materials; spheres only.
    Hertz,
    /// Coulomb friction and no spring: for bodies that deform themselves, or not at all.
    Coulomb,
}

/// The law of a contact between two materials: a spring and dashpot along the normal, an incremental spring and dashpot
/// along the tangent, limited by Coulomb friction with cohesion, |F_s| ≤ F_n tan φ + c, and rolling resistance.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpec {
    /// The two materials.
    pub between: [String; 2],
    /// `linear` (the default), `hertz` or `coulomb`. One scene has one kind.
    #[serde(default)]
    pub law: LawKind,
    /// Normal stiffness k_n (N/m; N/m per metre for discs). Needed for linear laws.
    #[serde(default)]
    pub normal_stiffness: Option<f64>,
    /// Tangential stiffness k_s (N/m). Needed for linear laws with friction or cohesion.
    #[serde(default)]
    pub tangential_stiffness: f64,
    /// Coefficient of friction μ = tan φ. Give this or `friction_angle_deg`; frictionless when both are absent.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Angle of friction φ (degrees).
    #[serde(default)]
    pub friction_angle_deg: Option<f64>,
    /// Cohesion c (N): the part of the shear strength that needs no normal force.
    #[serde(default)]
    pub cohesion: f64,
    /// Stiffness-proportional contact damping β (s): dashpots c_n = β k_n and c_s = β k_s (Cundall & Strack 1979).
    #[serde(default)]
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s): dashpot c_n = γ_n m_eff, with m_eff = m₁m₂/(m₁+m₂), m at a wall.
    #[serde(default)]
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s): dashpot c_s = γ_t m_eff.
    #[serde(default)]
    pub tangential_damping: f64,
    /// Coefficient of restitution e, above 0 and at most 1: a normal dashpot that gives it exactly when the dashpot may
    /// pull at release, c_n = 2ζ√(k_n m_eff) for linear, 2√(5/6) ζ√(S m_eff) with S = dF/dδ for Hertz contacts, and
    /// ζ = −ln e/√(π² + ln² e).
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Coefficient of rolling resistance μ_r: a moment of at most μ_r R_eff F_n against rolling, R_eff = R₁R₂/(R₁+R₂),
    /// R at a wall. An elastic-plastic spring of stiffness k_r = 2.25 k_n μ_r² R_eff² (Ai et al. 2011, model C).
    #[serde(default)]
    pub rolling_friction: f64,
    /// Damping ratio η_r of the rolling spring: a moment −2η_r√(I_r k_r) times the rolling velocity while it has not
    /// yielded.
    #[serde(default)]
    pub rolling_damping: f64,
}

/// A group of grains: exactly one of `position`, `lattice`, `random`, `packed` and `file`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainsSpec {
    /// Material by name.
    pub material: String,
    /// Radius R (m). Needed unless `random` gives a range, or `packed` or `file` give sizes.
    #[serde(default)]
    pub radius: Option<f64>,
    /// Velocity of every grain of the group (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity (rad/s): one number about z in two dimensions, a vector in three.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// A single grain at this place (m).
    #[serde(default)]
    pub position: Option<Vec<f64>>,
    /// Grains on a square or simple-cubic lattice.
    #[serde(default)]
    pub lattice: Option<LatticeSpec>,
    /// Grains placed at random without overlap, from a seed.
    #[serde(default)]
    pub random: Option<RandomSpec>,
    /// Grains of given sizes, packed densely without overlap, from a seed.
    #[serde(default)]
    pub packed: Option<PackedSpec>,
    /// Grains read from a LAMMPS data file (atom style sphere), plain or gzip.
    #[serde(default)]
    pub file: Option<FileSpec>,
}

/// Angular velocity.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "a number (two dimensions) or a vector of three numbers (three dimensions)")]
pub enum SpinSpec {
    /// About z (rad/s).
    About(f64),
    /// Vector (rad/s).
    Vector(Vec<f64>),
}

/// A square or simple-cubic lattice.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeSpec {
    /// Centre of the first grain (m).
    pub origin: Vec<f64>,
    /// Distance between neighbours along each axis (m).
    pub spacing: Vec<f64>,
    /// Number of grains along each axis; x runs fastest.
    pub count: Vec<u32>,
}

/// Grains placed at random in the domain without overlap.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomSpec {
    /// How many.
    pub count: u32,
    /// Seed of the generator: the same seed gives the same grains on every machine.
    pub seed: u64,
    /// Smallest and largest radius (m), uniformly distributed; `radius` of the group when absent.
    #[serde(default)]
    pub radius_range: Option<[f64; 2]>,
    /// Speed of every grain (m/s), in a random direction.
    #[serde(default)]
    pub speed: f64,
}

/// Grains packed densely into the domain without overlap; faces that are not periodic are walls to the packing.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PackedSpec {
    /// Sizes: pairs of radius (m) and number of grains.
    pub radii: Vec<(f64, u32)>,
    /// Seed of the generator: the same seed gives the same packing on every machine.
    pub seed: u64,
    /// Whether faces that are not periodic cut grains: such a face holds centres then, not whole grains.
    #[serde(default)]
    pub cut: bool,
}

/// Grains read from a file.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// Materials of atom types 1, 2, … by name; the group's material for all when absent.
    #[serde(default)]
    pub types: Vec<String>,
}

/// A wall: exactly one of `plane`, `segment` and `rectangle`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallSpec {
    /// Material by name.
    pub material: String,
    /// An infinite plane (a line in two dimensions), solid behind its normal.
    #[serde(default)]
    pub plane: Option<PlaneSpec>,
    /// A segment between two points (m), solid on both sides; two dimensions only.
    #[serde(default)]
    pub segment: Option<[Vec<f64>; 2]>,
    /// A rectangle, solid on both sides; three dimensions only.
    #[serde(default)]
    pub rectangle: Option<RectangleSpec>,
    /// Prescribed motion: phases that add up.
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

/// One phase of a wall's motion.
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
}

/// Grains that do not obey forces: they move at a constant velocity and do not turn, nor deform. Exactly one of
/// `grains` and `face`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivenSpec {
    /// All grains of a group.
    #[serde(default)]
    pub grains: Option<String>,
    /// The grains that a face of the domain cuts at the start.
    #[serde(default)]
    pub face: Option<SideSpec>,
    /// Velocity (m/s); at rest when absent.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
}

/// What is written down during the run.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputSpec {
    /// Time between samples of the probes (s), rounded to whole cycles. Give this or `every_cycles`; 200 samples over
    /// the run when both are absent.
    #[serde(default)]
    pub every: Option<f64>,
    /// Cycles between samples of the probes.
    #[serde(default)]
    pub every_cycles: Option<u64>,
    /// Number of snapshots, evenly spread, beside the first and the last. Default 0.
    #[serde(default)]
    pub snapshots: u32,
    /// Times of further snapshots (s), each taken at the nearest cycle.
    #[serde(default)]
    pub snapshot_times: Vec<f64>,
}

/// A named time series: exactly one of `grain`, `body`, `point`, `contact`, `wall`, `driven`, `stress`, `budget` and
/// `system`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeSpec {
    /// A grain: the name of a group of one, or `group.k` for the k-th of a group, from 1. Columns x, y, (z), vx, …,
    /// omega (z; or omega_x, …), angle (two dimensions).
    #[serde(default)]
    pub grain: Option<String>,
    /// A body that is no grain: the columns of a grain.
    #[serde(default)]
    pub body: Option<String>,
    /// The material of a deformable grain or body at a place: columns ux, … (displacement), vx, …, sigma_xx, sigma_yy,
    /// sigma_zz, sigma_xy (and sigma_yz, sigma_zx), plastic_strain, mean over the material points nearest to it at the
    /// start.
    #[serde(default)]
    pub point: Option<PointSpec>,
    /// A contact between a grain and a grain or wall. Columns overlap, normal_force, shear_force (signed in two
    /// dimensions), slipping (0 or 1).
    #[serde(default)]
    pub contact: Option<[String; 2]>,
    /// A wall: columns force_x, … of the grains on it.
    #[serde(default)]
    pub wall: Option<String>,
    /// A group of driven grains: columns force_x, … of the other grains on them.
    #[serde(default)]
    pub driven: Option<String>,
    /// Where energy comes from and goes: columns kinetic, elastic, springs, gravitational, work, plastic, friction,
    /// damping, transfer, contact (J), unbalanced (J), and momentum_x, impulse_x, … (kg m/s); see
    /// [`crate::budget::Budget`].
    #[serde(default)]
    pub budget: Option<bool>,
    /// Mean stress of the grains, from the contacts between them: σ_ij = (1/V) Σ l_i f_j with the line l from the
    /// centre of one grain to that of the other, the force f on the first, and V the volume of the domain (Love 1927;
    /// Weber 1966). Tension is positive, walls are left out. Columns sigma_xx, sigma_yy, sigma_xy (and sigma_zz,
    /// sigma_xz, sigma_yz), and coordination, the mean number of grains that a grain touches.
    #[serde(default)]
    pub stress: Option<bool>,
    /// The whole system: kinetic, rotational, elastic and gravitational energy, their sum, momentum, angular momentum
    /// about the origin, number of contacts.
    #[serde(default)]
    pub system: Option<bool>,
}

/// A place in the material of a grain or body.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    /// A grain.
    #[serde(default)]
    pub grain: Option<String>,
    /// Or a body that is no grain.
    #[serde(default)]
    pub body: Option<String>,
    /// Place at the start (m).
    pub at: Vec<f64>,
}
