//! The keys of `grains`: groups of grains, placed one by one, in order or at random.

use super::driven::RegionSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A group of grains: exactly one of `position`, `lattice`, `random`, `packed`, `poured`, `state` and `file`.
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
    /// Grains on a lattice.
    #[serde(default)]
    pub lattice: Option<LatticeSpec>,
    /// Grains placed at random without overlap, from a seed.
    #[serde(default)]
    pub random: Option<RandomSpec>,
    /// Grains of given sizes, packed densely without overlap, from a seed.
    #[serde(default)]
    pub packed: Option<PackedSpec>,
    /// Grains that come one after the other, from a seed. They come with the group's velocity.
    #[serde(default)]
    pub poured: Option<PouredSpec>,
    /// Grains as a run ended with them, with what their contacts remember.
    #[serde(default)]
    pub state: Option<StateSpec>,
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

/// A lattice: square or simple cubic, or close-packed.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeSpec {
    /// Centre of the first grain (m).
    pub origin: Vec<f64>,
    /// Distance between neighbours along each axis (m); close-packed, one number: that of nearest neighbours.
    pub spacing: SpacingSpec,
    /// Number of grains along each axis; x runs fastest.
    pub count: Vec<u32>,
    /// Close-packed: rows along x, every other one half a spacing further, √3/2 of a spacing apart (hexagonal); in space layers
    /// of them along z, √(2/3) of a spacing apart, each third one above the first (face-centred cubic).
    #[serde(default)]
    pub close_packed: bool,
    /// Centres are moved by up to this length (m), each in a direction of its own, from `seed`.
    #[serde(default)]
    pub perturbation: f64,
    /// Seed of the perturbation: the same seed gives the same grains on every machine.
    #[serde(default)]
    pub seed: u64,
}

/// Distance between neighbours.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged, expecting = "distances along each axis such as [1.0, 1.0], or, close-packed, one number")]
pub enum SpacingSpec {
    /// Of nearest neighbours (m).
    Nearest(f64),
    /// Along each axis (m).
    Along(Vec<f64>),
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
    /// Radii of another distribution, in place of `radius_range`.
    #[serde(default)]
    pub radii: Option<RadiiSpec>,
    /// The part of the domain that they are placed in, faces of which they keep off; all of it when absent.
    #[serde(default)]
    pub region: Option<RegionSpec>,
}

/// A distribution of radii: exactly one of `log_normal` and `by_mass`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiiSpec {
    /// ln R is normally distributed.
    #[serde(default)]
    pub log_normal: Option<LogNormalSpec>,
    /// A sieve curve: pairs of radius (m) and the share of the mass that is no larger, both rising, from a share of 0 to one of
    /// 1; between two of them the mass is spread evenly over the radii.
    #[serde(default)]
    pub by_mass: Option<Vec<(f64, f64)>>,
}

/// R = median · exp(deviation · n), n normally distributed; drawn again outside `range`.
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

/// Grains that come one after the other, each somewhere in a box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PouredSpec {
    /// How many.
    pub count: u32,
    /// Grains in a second (1/s).
    pub rate: f64,
    /// Seed of the generator: the same seed gives the same grains on every machine and to every solver.
    pub seed: u64,
    /// Lower corner of the box in which centres are at first (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// When the first comes (s).
    #[serde(default)]
    pub start: f64,
}

/// Grains as a run ended with them, in a file that `simulate --state` left. Walls are found again by name; what contacts with
/// walls remember that this scene does not have is forgotten.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpec {
    /// Path, relative to the scene file.
    pub path: String,
    /// Whether contacts go on remembering. Programs that read the grains from a data file cannot have that.
    #[serde(default = "yes")]
    pub springs: bool,
}

const fn yes() -> bool {
    true
}

/// Where grains are taken out: beyond the sides of a box.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RemovalSpec {
    /// Lower corner of the box (m).
    pub low: Vec<f64>,
    /// Upper corner (m).
    pub high: Vec<f64>,
    /// Grains are looked for every so many calculation cycles.
    #[serde(default = "default_removal_cycles")]
    pub every_cycles: u64,
}

const fn default_removal_cycles() -> u64 {
    100
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
