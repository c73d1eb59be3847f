//! Keys of `grains`: groups of grains, placed one by one, in order or at random.

use super::driven::RegionSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Group of grains: exactly one of `position`, `lattice`, `random`, `packed`, `poured`, `state` and `file`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainsSpec {
    /// Name of the material.
    pub material: String,
    /// Radius R (m). Required unless `random`, `packed`, `state` or `file` gives sizes.
    #[serde(default)]
    pub radius: Option<f64>,
    /// Velocity of every grain of the group (m/s).
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity (rad/s): one number about z in two dimensions, a vector in three.
    #[serde(default)]
    pub spin: Option<SpinSpec>,
    /// Position of a single grain (m).
    #[serde(default)]
    pub position: Option<Vec<f64>>,
    /// Grains on a lattice.
    #[serde(default)]
    pub lattice: Option<LatticeSpec>,
    /// Grains placed at random without overlap, from a seed.
    #[serde(default)]
    pub random: Option<RandomSpec>,
    /// Grains of given sizes in a dense packing without overlap, from a seed.
    #[serde(default)]
    pub packed: Option<PackedSpec>,
    /// Grains inserted one after the other, from a seed. They start with the velocity of the group.
    #[serde(default)]
    pub poured: Option<PouredSpec>,
    /// Grains in the final state of a run, with their contact history.
    #[serde(default)]
    pub state: Option<StateSpec>,
    /// Grains from a LAMMPS data file (atom style sphere), plain or gzip.
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

/// Lattice: square, simple cubic, or close-packed.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeSpec {
    /// Centre of the first grain (m).
    pub origin: Vec<f64>,
    /// Distance between neighbours along each axis (m). For `close_packed`, one number: the distance of nearest
    /// neighbours.
    pub spacing: SpacingSpec,
    /// Number of grains along each axis. Grains are numbered along x first.
    pub count: Vec<u32>,
    /// Close-packed lattice. Rows along x are √3/2 of a spacing apart, and every second row is shifted by half a
    /// spacing (hexagonal). In three dimensions, such layers are √(2/3) of a spacing apart along z, and the fourth
    /// layer lies above the first (face-centred cubic).
    #[serde(default)]
    pub close_packed: bool,
    /// Largest random displacement of the centres (m), each in a random direction, from `seed`.
    #[serde(default)]
    pub perturbation: f64,
    /// Seed of the perturbation. The same seed gives the same grains on every machine.
    #[serde(default)]
    pub seed: u64,
}

/// Distance between neighbours.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "distances along each axis such as [1.0, 1.0], or, close-packed, one number")]
pub enum SpacingSpec {
    /// Distance of nearest neighbours (m).
    Nearest(f64),
    /// Distance along each axis (m).
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
    /// Smallest and largest radius (m) of a uniform distribution. Default: `radius` of the group.
    #[serde(default)]
    pub radius_range: Option<[f64; 2]>,
    /// Speed of every grain (m/s), in a random direction.
    #[serde(default)]
    pub speed: f64,
    /// Another distribution of radii, instead of `radius_range`.
    #[serde(default)]
    pub radii: Option<RadiiSpec>,
    /// Part of the domain in which grains are placed without crossing its faces. Default: the whole domain.
    #[serde(default)]
    pub region: Option<RegionSpec>,
}

/// Distribution of radii: exactly one of `log_normal` and `by_mass`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiiSpec {
    /// Log-normal distribution: ln R is normally distributed.
    #[serde(default)]
    pub log_normal: Option<LogNormalSpec>,
    /// Sieve curve: pairs of a radius (m) and the mass fraction of grains that are no larger. Both rise, and the
    /// fraction rises from 0 to 1. Between two pairs, the mass is spread uniformly over the radii.
    #[serde(default)]
    pub by_mass: Option<Vec<(f64, f64)>>,
}

/// Log-normal distribution R = median · exp(deviation · n) with n normally distributed. Values outside `range` are
/// redrawn.
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

/// Dense packing in the domain without overlap. Faces that are not periodic are walls for the packing.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PackedSpec {
    /// Sizes: pairs of radius (m) and number of grains.
    pub radii: Vec<(f64, u32)>,
    /// Seed of the generator. The same seed gives the same packing on every machine.
    pub seed: u64,
    /// If true, faces that are not periodic bound the centres of grains, so that these faces cut grains. Default false.
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
    /// Lower corner of the box in which centres are inserted (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Time of the first insertion (s).
    #[serde(default)]
    pub start: f64,
}

/// Grains in the final state of a run, from a file written by `simulate --state`. Walls are matched by name. The
/// history of contacts with walls that this scene lacks is dropped.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// If true, contacts keep their history. Programs that read the grains from a data file do not support this.
    /// Default true.
    #[serde(default = "yes")]
    pub springs: bool,
}

const fn yes() -> bool {
    true
}

/// Removal of grains outside a box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RemovalSpec {
    /// Lower corner of the box (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Calculation cycles between searches for such grains. Default 100.
    #[serde(default = "default_removal_cycles")]
    pub every_cycles: u64,
}

const fn default_removal_cycles() -> u64 {
    100
}

/// Grains from a file.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// Names of the materials of atom types 1, 2, …. Default: the group's material for all types.
    #[serde(default)]
    pub types: Vec<String>,
}
