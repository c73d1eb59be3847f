//! The keys of `probes`: what becomes a time series.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A named time series: exactly one of `grain`, `body`, `point`, `contact`, `wall`, `piston`, `driven`, `stress`, `budget`,
/// `count` and `system`.
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
    /// dimensions), slipping (0 or 1). Of `dem` the forces are those that moved the grains, whose dashpots feel the
    /// velocities of half a step before, kδ − γ v(n−½); LAMMPS and LIGGGHTS do so at walls, but evaluate a contact between
    /// grains anew when they print it, with the velocities at the step, kδ − γ v(n), which differs by γ a Δt/2.
    #[serde(default)]
    pub contact: Option<[String; 2]>,
    /// A wall: columns force_x, … of the grains on it.
    #[serde(default)]
    pub wall: Option<String>,
    /// A wall that is pressed: column advance, how far it has gone along its normal (m).
    #[serde(default)]
    pub piston: Option<String>,
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
    /// How many grains there are, and have come and gone: columns present, entered (the first ones too), left.
    #[serde(default)]
    pub count: Option<bool>,
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
