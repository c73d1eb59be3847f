//! Keys of `grains` (groups of grains and their placement) and of `removal`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Group of grains. Exactly one of `position`, `lattice`, `random`, `packed`, `poured`, `state` and `file` gives their
/// positions.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainsSpec {
    /// Name of the material, as in `materials`.
    pub material: String,
    /// Radius R of every grain (m). Required unless `random`, `packed`, `state` or `file` gives the radii.
    #[serde(default)]
    pub radius: Option<f64>,
    /// Initial velocity of every grain of the group (m/s). `state` and `file` give velocities themselves. Default zero.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Initial angular velocity of every grain of the group (rad/s). In two dimensions, it is one number (about z); in
    /// three dimensions, a vector. Not with `poured`; `state` and `file` give angular velocities themselves. Default
    /// zero.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Centre of a single grain (m).
    #[serde(default)]
    pub position: Option<Vec<f64>>,
    /// Grains on a lattice.
    #[serde(default)]
    pub lattice: Option<LatticeSpec>,
    /// Grains at random positions without overlap.
    #[serde(default)]
    pub random: Option<RandomSpec>,
    /// Grains of given radii in a dense random packing without overlap.
    #[serde(default)]
    pub packed: Option<PackedSpec>,
    /// Grains inserted one after the other during the run, at random positions in a box. Each grain starts with
    /// `velocity`.
    #[serde(default)]
    pub poured: Option<PouredSpec>,
    /// Grains from the final state of another run, with their contact history.
    #[serde(default)]
    pub state: Option<StateSpec>,
    /// Grains from a LAMMPS data file (atom style sphere), plain or gzip.
    #[serde(default)]
    pub file: Option<FileSpec>,
}

/// Angular velocity (rad/s).
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "a number (two dimensions) or a vector of three numbers (three dimensions)")]
pub enum SpinSpec {
    /// Angular velocity about z (rad/s), in two dimensions.
    About(f64),
    /// Angular velocity vector (rad/s), in three dimensions.
    Vector(Vec<f64>),
}

/// Lattice: rows along the axes (square or simple cubic), or close-packed.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeSpec {
    /// Centre of the first grain (m).
    pub origin: Vec<f64>,
    /// Distance between neighbours along each axis (m). For `close_packed`, it is one number, the distance between
    /// nearest neighbours.
    pub spacing: SpacingSpec,
    /// Number of grains along each axis. Grains are numbered along x first, then along y, then along z.
    pub count: Vec<u32>,
    /// If true, the lattice is close-packed. Rows along x are √3/2 of the spacing apart, and every second row is
    /// shifted by half the spacing (hexagonal). In three dimensions, layers of this kind are √(2/3) of the spacing
    /// apart along z, and the fourth layer lies exactly above the first (face-centred cubic). Default false.
    #[serde(default)]
    pub close_packed: bool,
    /// Largest random displacement of a centre (m). Each centre moves in a random direction by at most this distance.
    /// Default 0.
    #[serde(default)]
    pub perturbation: f64,
    /// Seed of the perturbation. The same seed gives the same grains on every machine. Default 0.
    #[serde(default)]
    pub seed: u64,
}

/// Distance between neighbours.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "distances along each axis such as [1.0, 1.0], or one number if close-packed")]
pub enum SpacingSpec {
    /// Distance between nearest neighbours (m), for a close-packed lattice.
    Nearest(f64),
    /// Distances between neighbours along the axes (m).
    Along(Vec<f64>),
}

/// Grains placed at random in the domain without overlap.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomSpec {
    /// Number of grains.
    pub count: u32,
    /// Seed of the generator. The same seed gives the same grains on every machine.
    pub seed: u64,
    /// Smallest and largest radius (m) of a uniform distribution. Default: every grain has the `radius` of the group.
    #[serde(default)]
    pub radius_range: Option<[f64; 2]>,
    /// Initial speed of every grain (m/s), in a random direction. This velocity is added to `velocity` of the group.
    /// Default 0.
    #[serde(default)]
    pub speed: f64,
    /// Distribution of radii that is not uniform. Not together with `radius_range`.
    #[serde(default)]
    pub radii: Option<RadiiSpec>,
    /// Box inside the domain in which grains are placed. Grains do not cross its faces. Default: the whole domain.
    #[serde(default)]
    pub region: Option<RegionSpec>,
}

/// Distribution of radii. Give exactly one of `log_normal` and `by_mass`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RadiiSpec {
    /// Log-normal distribution: ln R is normally distributed.
    pub log_normal: Option<LogNormalSpec>,
    /// Sieve curve: pairs of a radius (m) and the mass fraction of the grains up to this radius. Radii and fractions
    /// must not decrease. The first fraction is 0, and the last is 1. Between two pairs, the mass is distributed
    /// uniformly over the radii.
    pub by_mass: Option<Vec<(f64, f64)>>,
}

/// Log-normal distribution R = median · exp(deviation · n) with a standard normal variable n. Radii outside `range` are
/// drawn again.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LogNormalSpec {
    /// Median of R (m).
    pub median: f64,
    /// Standard deviation of ln R.
    pub deviation: f64,
    /// Smallest and largest radius (m).
    pub range: [f64; 2],
}

/// Dense random packing in the domain without overlap. Non-periodic faces of the domain act as walls during packing.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PackedSpec {
    /// Pairs of a radius (m) and the number of grains of this radius. The total is at most 20,000 grains.
    pub radii: Vec<(f64, u32)>,
    /// Seed of the generator. The same seed gives the same packing on every machine.
    pub seed: u64,
    /// If true, only the centres of grains must lie within the non-periodic faces, so that grains may cross these
    /// faces. Default false.
    #[serde(default)]
    pub cut: bool,
}

/// Grains inserted one after the other at random positions in a box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PouredSpec {
    /// Number of grains.
    pub count: u32,
    /// Insertion rate (1/s).
    pub rate: f64,
    /// Seed of the generator. The same seed gives the same grains on every machine and in every solver.
    pub seed: u64,
    /// Lower corner of the box for the centres of inserted grains (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Time of the first insertion (s). Default 0.
    #[serde(default)]
    pub start: f64,
}

/// Grains from the final state of another run, read from a file that `simulate --state` wrote. The walls of the other
/// run and of this scene are matched by name. The history of contacts with walls that this scene lacks is dropped.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// If true, contacts start with the history in the file. External programs that read grains from a data file do not
    /// support this. Default true.
    #[serde(default = "yes")]
    pub springs: bool,
}

const fn yes() -> bool {
    true
}

/// Removal of grains whose centre lies outside a box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RemovalSpec {
    /// Lower corner of the box (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Calculation cycles (time steps) between searches for grains to remove. Default 100.
    #[serde(default = "default_removal_cycles")]
    pub every_cycles: u64,
}

const fn default_removal_cycles() -> u64 {
    100
}

/// Grains from a LAMMPS data file (atom style sphere).
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// Names of the materials of atom types 1, 2, …. Default: `material` of the group for all types.
    #[serde(default)]
    pub types: Vec<String>,
}

/// Axis-aligned box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegionSpec {
    /// Lower corner (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
}
