//! Keys of `probes`: quantities recorded as time series.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Named time series: exactly one of `grain`, `body`, `point`, `contact`, `wall`, `piston`, `driven`, `stress`,
/// `budget`, `count` and `system`.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeSpec {
    /// Grain: the name of a group with one grain, or `group.k` for the k-th grain of a group, from 1. Columns x, y,
    /// (z), vx, …, omega (about z; or omega_x, …), angle (two dimensions).
    #[serde(default)]
    pub grain: Option<String>,
    /// Body other than a grain, with the same columns as a grain.
    #[serde(default)]
    pub body: Option<String>,
    /// Material of a deformable grain or body at a position, averaged over the nearest material points at the start.
    /// Columns ux, … (displacement), vx, …, sigma_xx, sigma_yy, sigma_zz, sigma_xy (and sigma_yz, sigma_zx),
    /// plastic_strain.
    #[serde(default)]
    pub point: Option<PointSpec>,
    /// Contact between a grain and a grain or wall. Columns overlap, normal_force, shear_force (signed in two
    /// dimensions), slipping (0 or 1). The forces of `dem` are those that moved the grains. Their dashpots use the
    /// velocities of half a step before, kδ − γ v(n−½). LAMMPS and LIGGGHTS do the same at walls, but recompute a
    /// contact between grains for output. They then use the velocities at the step, kδ − γ v(n), which differs by γ a
    /// Δt/2.
    #[serde(default)]
    pub contact: Option<[String; 2]>,
    /// Wall. Columns force_x, … of the grains on the wall.
    #[serde(default)]
    pub wall: Option<String>,
    /// Pressed wall. Column advance: its displacement along its normal (m).
    #[serde(default)]
    pub piston: Option<String>,
    /// Group of grains with prescribed motion. Columns force_x, … of the other grains on the group.
    #[serde(default)]
    pub driven: Option<String>,
    /// Energy budget. Columns kinetic, elastic, springs, gravitational, work, plastic, friction, damping, transfer,
    /// contact (J), unbalanced (J), and momentum_x, impulse_x, … (kg m/s).
    #[serde(default)]
    pub budget: Option<bool>,
    /// Mean stress of the grains from the contacts between them, σ_ij = (1/V) Σ l_i f_j (Love 1927; Weber 1966). The
    /// vector l points from the centre of one grain to that of the other. f is the force on the first grain, and V the
    /// volume of the domain. Tension is positive; walls are not included. Columns sigma_xx, sigma_yy, sigma_xy (and
    /// sigma_zz, sigma_xz, sigma_yz), and coordination, the mean number of contacts with other grains per grain.
    #[serde(default)]
    pub stress: Option<bool>,
    /// Number of grains. Columns present, entered (including the initial grains), left.
    #[serde(default)]
    pub count: Option<bool>,
    /// Whole system. Columns are the kinetic, rotational, elastic and gravitational energy, their sum, the momentum,
    /// the angular momentum about the origin, and the number of contacts.
    #[serde(default)]
    pub system: Option<bool>,
}

/// Position in the material of a grain or body.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    /// Name of the grain.
    #[serde(default)]
    pub grain: Option<String>,
    /// Or name of a body other than a grain.
    #[serde(default)]
    pub body: Option<String>,
    /// Initial position (m).
    pub at: Vec<f64>,
}
