//! Keys of `output` (intervals of samples and snapshots, and the contents of snapshots) and of `probes` (quantities
//! recorded as time series).

use crate::columns::Chosen;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Times and contents of samples and snapshots.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OutputSpec {
    /// Time between samples of the probes (s), rounded to whole cycles. Give at most one of `every` and `every_cycles`.
    /// Default: 200 samples over the run.
    pub every: Option<f64>,
    /// Number of calculation cycles (time steps) between samples of the probes.
    pub every_cycles: Option<u64>,
    /// Number of evenly spaced snapshots between the first one (start of the run) and the last one (end of the run).
    /// Default 0.
    pub snapshots: u32,
    /// Times of further snapshots (s), each taken at the nearest cycle.
    pub snapshot_times: Vec<f64>,
    /// If true, external solvers also write the contacts between grains to snapshots. Our solvers do so without this
    /// key, unless `columns` omits contacts. Default false.
    pub contacts: bool,
    /// Optional contents of snapshots: any of `spin`, `force`, `contacts`, `virial` and `mean-virial`. Snapshots always
    /// contain id, material, radius, mass, position and velocity of every grain. `virial` is the product V σ of volume
    /// and mean stress of each grain (J) at the time of the snapshot. `mean-virial` is the average of V σ over the time
    /// since the previous snapshot. Default: `spin`, `force` and `contacts`.
    pub columns: Option<Vec<Chosen>>,
    /// Number of significant digits in snapshots, from 1 to 15. Radii and masses always have all digits. Fewer digits
    /// make smaller files. Default: all digits.
    pub digits: Option<u8>,
    /// Number of calculation cycles between the samples of `mean-virial`. A cycle with a sample takes about twice as
    /// long as a cycle without one. Default 1.
    pub mean_every_cycles: Option<u64>,
}

/// Probe: quantities recorded as a time series. Exactly one of `grain`, `body`, `point`, `contact`, `wall`, `piston`,
/// `driven`, `stress`, `budget`, `count` and `system` selects them.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ProbeSpec {
    /// Grain: the name of a group with one grain, or `group.k` for the k-th grain of a group, from 1. Columns in two
    /// dimensions: x, y (m), vx, vy (m/s), omega about z (rad/s), angle (rad). Columns in three dimensions: x, y, z,
    /// vx, vy, vz, omega_x, omega_y, omega_z.
    pub grain: Option<String>,
    /// Name of a body other than a grain. The columns are those of `grain`.
    pub body: Option<String>,
    /// Material of a deformable grain or body, averaged over the material points that are nearest to a position at the
    /// start. Columns: displacement ux, … (m), velocity vx, … (m/s), stress (Pa) sigma_xx, sigma_yy, sigma_zz, sigma_xy
    /// (in three dimensions also sigma_yz, sigma_zx), and plastic_strain.
    pub point: Option<PointSpec>,
    /// Contact between a grain and another grain or a wall, by their names. Columns: overlap (m), normal_force (N),
    /// shear_force (N; with a sign in two dimensions), slipping (0 or 1). `dem` reports the forces that moved the
    /// grains. Their dashpots use the velocities half a step earlier: at step n, the normal force is kδ − γ v(n−½),
    /// with stiffness k, overlap δ, dashpot coefficient γ and velocity of separation v. LAMMPS and LIGGGHTS report this
    /// force at walls. Between grains, they report a force that they compute from the velocities at step n: kδ − γ
    /// v(n). The two forces differ by γ a Δt/2, with relative acceleration a and time step Δt.
    pub contact: Option<[String; 2]>,
    /// Name of a wall. Columns force_x, … (N): force of the grains on the wall.
    pub wall: Option<String>,
    /// Name of a wall with `piston` and without `until`. Column advance (m): displacement of the wall along its normal.
    pub piston: Option<String>,
    /// Name of a group in `driven`. Columns force_x, … (N): sum of the contact forces on the
    /// group, from free grains and walls.
    pub driven: Option<String>,
    /// If true, energy budget of the run. Columns (J): kinetic, elastic, springs, gravitational, work, plastic,
    /// friction, damping, transfer, contact, and unbalanced, which is the stored and dissipated energy less the
    /// supplied energy. Further columns (kg m/s): momentum_x, …, impulse_x, …
    pub budget: Option<bool>,
    /// If true, mean stress of the grains from the contacts between them, σ_ij = (1/V) Σ l_i f_j (Love 1927; Weber
    /// 1966). The vector l points from the centre of the first grain of a contact to the centre of the second, and f is
    /// the force on the first grain. V is the volume of the domain or, without a domain, of the bounding box of the
    /// grains. Tension is positive. Contacts with walls are not included. Columns: stress (Pa) sigma_xx, sigma_yy,
    /// sigma_xy (in three dimensions also sigma_zz, sigma_xz, sigma_yz), and coordination, the mean number of contacts
    /// with other grains per grain.
    pub stress: Option<bool>,
    /// If true, numbers of grains. Columns: present, entered (initial and inserted grains), left (removed grains).
    pub count: Option<bool>,
    /// If true, sums over the whole system. Columns: kinetic_energy, rotational_energy, elastic_energy,
    /// gravitational_energy, total_energy (J), momentum_x, … (kg m/s), angular_momentum about the origin (kg m²/s),
    /// contacts, slipping_contacts, and largest_spin of a grain (rad/s).
    pub system: Option<bool>,
}

/// Position in the material of a grain or body.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    /// Grain, by name as in the probe `grain`. Give this or `body`.
    #[serde(default)]
    pub grain: Option<String>,
    /// Name of a body other than a grain. Give this or `grain`.
    #[serde(default)]
    pub body: Option<String>,
    /// Position at the start (m), inside the grain or body.
    pub at: Vec<f64>,
}
