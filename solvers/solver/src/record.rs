//! Output of a run, which consists of time series, snapshots, cost and provenance.

use crate::budget::Budget;
use crate::resolution::Resolution;
use grainbench_scene::effects::Effects;
use grainbench_scene::scene::{Grain, Scene};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Column of a time series.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Name, such as `disc.x` or `wall-corner.normal_force`.
    pub name: String,
    /// SI unit, such as `m/s`; `1` for a pure number.
    pub unit: String,
}

/// Time series of all probes of a scene, sampled at the same steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Step (calculation cycle) of every sample.
    pub step: Vec<u64>,
    /// Time of every sample (s).
    pub time: Vec<f64>,
    /// Name and unit of every column.
    pub columns: Vec<Column>,
    /// `values[c][k]` is column `c` at sample `k`.
    pub values: Vec<Vec<f64>>,
}

impl Series {
    /// Returns the values of the column of this name; `None` if there is none.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let at = self.columns.iter().position(|column| column.name == name)?;
        Some(&self.values[at])
    }
}

/// Grain in a snapshot. In two dimensions, z components are zero and the spin is along z.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GrainState {
    /// Id, from 1; the same in every snapshot.
    pub id: u32,
    /// Index of its material in the scene, from 0.
    pub material: u16,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg; per metre of depth for discs).
    pub mass: f64,
    /// Centre (m), inside the domain along periodic axes.
    pub position: Vector3<f64>,
    /// Velocity at the time of the snapshot (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s); NaN if the solver does not report it.
    #[serde(with = "untold")]
    pub spin: Vector3<f64>,
    /// Rotation about z since the start (rad); absent in three dimensions, or if the solver does not report it.
    pub angle: Option<f64>,
    /// Sum of all forces except gravity (N; N/m for discs); absent if the solver does not report it.
    pub force: Option<Vector3<f64>>,
    /// Sum of all torques (N m; N for discs); absent if the solver does not report it.
    pub torque: Option<Vector3<f64>>,
    /// Equivalent plastic strain, averaged over the mass; zero for a grain that does not yield.
    #[serde(default)]
    pub plastic_strain: f64,
    /// Product V σ of volume and mean stress at the time of the snapshot, if requested: xx, yy, zz, xy, yz, zx (J; J/m
    /// for discs); see [`crate::virial`]. It is boxed to save memory, because few runs request it and large runs have a
    /// million grains.
    #[serde(default)]
    pub virial: Option<Box<[f64; 6]>>,
    /// Average of V σ (J; J/m for discs) over the time since the previous snapshot, if requested; absent in the first
    /// snapshot.
    #[serde(default)]
    pub mean_virial: Option<Box<[f64; 6]>>,
}

impl GrainState {
    /// Returns a grain in its initial state, without angle and forces. Ids count from 1.
    #[must_use]
    pub fn start(id: u32, grain: &Grain) -> Self {
        Self {
            id,
            material: grain.material,
            radius: grain.radius,
            mass: grain.mass,
            position: grain.position,
            velocity: grain.velocity,
            spin: grain.spin,
            ..Self::default()
        }
    }
}

/// Deformable body other than a grain, in a snapshot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Name in the scene.
    pub name: String,
    /// Mass (kg; per metre of depth in the plane).
    pub mass: f64,
    /// Moment of inertia about the centre of mass, averaged over the axes of possible rotation (kg m²).
    pub inertia: f64,
    /// Centre of mass (m).
    pub position: Vector3<f64>,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vector3<f64>,
    /// Angular momentum divided by the moment of inertia (rad/s).
    pub spin: Vector3<f64>,
    /// Rotation about z since the start (rad); zero in three dimensions.
    pub angle: f64,
    /// Sum of all contact forces (N).
    pub force: Vector3<f64>,
}

/// Body to which a material point belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Owner {
    /// Grain, by id.
    Grain(u32),
    /// Other body, by index in the scene, from 0.
    Body(u32),
}

impl Default for Owner {
    fn default() -> Self {
        Self::Body(0)
    }
}

/// Material point of a deformable body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointState {
    /// Body to which the point belongs.
    pub owner: Owner,
    /// Position (m), not wrapped into the domain along periodic axes.
    pub position: Vector3<f64>,
    /// Displacement since the start (m).
    pub displacement: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Cauchy stress xx, yy, zz, xy, yz, zx (Pa), tension positive.
    pub stress: [f64; 6],
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
    /// Angle about z (rad) of the rotation R in the deformation gradient F = R U. Full turns are added so that the
    /// angle is nearest to the rotation of the body. The angle is zero in three dimensions.
    #[serde(default)]
    pub rotation: f64,
    /// Volume (m³; m² in the plane).
    pub volume: f64,
}

/// Partner of a grain in a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Partner {
    /// Grain, by id.
    Grain(u32),
    /// Other body, by index in the scene, from 0.
    Body(u32),
    /// Wall, by index in the scene, from 0.
    Wall(u16),
}

impl Default for Partner {
    fn default() -> Self {
        Self::Wall(0)
    }
}

/// Contact in a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// Grain, by id.
    pub grain: u32,
    /// Grain, body or wall on the other side of the contact.
    pub partner: Partner,
    /// Contact point (m), in the middle of the overlap.
    pub point: Vector3<f64>,
    /// Unit vector from the grain to its partner.
    pub normal: Vector3<f64>,
    /// Overlap (m); positive in contact.
    pub overlap: f64,
    /// Normal force, dashpot included (N); positive if repulsive.
    pub normal_force: f64,
    /// Tangential force on the grain, dashpot included (N).
    pub shear_force: Vector3<f64>,
    /// True if the contact reached the Coulomb limit in the last step.
    pub slipping: bool,
}

/// Wall in a snapshot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallState {
    /// Name in the scene.
    pub name: String,
    /// Reference points of the wall (m); empty for a removed wall.
    ///
    /// - Segment: its two ends. Rectangle: its four corners. Plane: a point and the normal.
    /// - Cylinder or cone: the ends of its axis, and a point of the rim at each end.
    /// - Mesh: the origin of its file, and the points 1 m from the origin along x and y.
    pub corners: Vec<Vector3<f64>>,
    /// True if `corners` holds a point and the unit normal of an infinite plane.
    pub infinite: bool,
    /// Force of the grains on the wall (N; N/m for discs); absent if the solver does not report it.
    pub force: Option<Vector3<f64>>,
}

/// State at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Step (calculation cycle).
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Lower and upper corner (m) of the domain or, without a domain, of the bounding box of the grains.
    pub bounds: (Vector3<f64>, Vector3<f64>),
    /// True for each periodic axis.
    pub periodic: [bool; 3],
    /// Grains, sorted by id.
    pub grains: Vec<GrainState>,
    /// All contacts, sorted by grain id. The list is absent if the solver does not report contacts, and empty if there
    /// are no contacts.
    pub contacts: Option<Vec<ContactState>>,
    /// Walls in the order of the scene.
    pub walls: Vec<WallState>,
    /// Bodies other than grains, in the order of the scene.
    #[serde(default)]
    pub bodies: Vec<BodyState>,
    /// Material points, if the solver has any.
    #[serde(default)]
    pub points: Vec<PointState>,
}

impl Snapshot {
    /// Returns the contacts; an empty list if the solver does not report contacts. Figures use this function.
    /// Evaluations read `contacts`, because the field distinguishes missing contacts from no contacts.
    #[must_use]
    pub fn told_contacts(&self) -> &[ContactState] {
        self.contacts.as_deref().unwrap_or_default()
    }

    /// Returns the number of contacts and the number of slipping contacts; `None` if the solver does not report
    /// contacts.
    #[must_use]
    pub fn touching(&self) -> Option<[usize; 2]> {
        let contacts = self.contacts.as_ref()?;
        Some([contacts.len(), contacts.iter().filter(|contact| contact.slipping).count()])
    }

    /// Returns the index of the grain with an id; `None` if it is absent.
    #[must_use]
    pub fn place_of(&self, id: u32) -> Option<usize> {
        // If all grains are present, the index follows from the id.
        let place = (id as usize).checked_sub(1)?;
        if self.grains.get(place).is_some_and(|grain| grain.id == id) {
            return Some(place);
        }
        self.grains.binary_search_by_key(&id, |grain| grain.id).ok()
    }

    /// Returns the grain with an id; `None` if it is absent.
    #[must_use]
    pub fn grain(&self, id: u32) -> Option<&GrainState> {
        self.place_of(id).map(|place| &self.grains[place])
    }

    /// Returns a snapshot with the given grains and with the walls at their positions at `time` (s). It contains no
    /// contacts and no forces on walls.
    #[must_use]
    pub fn of_grains(scene: &Scene, step: u64, time: f64, grains: Vec<GrainState>) -> Self {
        let time_step = if step == 0 { 0.0 } else { time / step as f64 };
        let walls = scene.walls.iter().map(|wall| {
            let displacement = wall.motion.displacement(time, time_step);
            let (corners, infinite) = wall.shape.moved(&wall.motion, &displacement).corners();
            WallState { name: wall.name.clone(), corners, infinite, force: None }
        });
        Self::new(scene, step, time, grains, walls.collect(), None)
    }

    /// Returns a snapshot without bodies and material points.
    #[must_use]
    pub fn new(
        scene: &Scene,
        step: u64,
        time: f64,
        grains: Vec<GrainState>,
        walls: Vec<WallState>,
        contacts: Option<Vec<ContactState>>,
    ) -> Self {
        let bounds = bounds(scene, &grains);
        let periodic = scene.domain.map_or([false; 3], |domain| domain.periodic);
        Self { step, time, bounds, periodic, grains, contacts, walls, ..Self::default() }
    }
}

/// Returns the corners of the domain (m). Without a domain, these are the corners of the bounding box of all grains or,
/// without grains, of the bodies at the start. In the plane, z extends from −0.5 m to 0.5 m.
#[must_use]
pub fn bounds(scene: &Scene, grains: &[GrainState]) -> (Vector3<f64>, Vector3<f64>) {
    if let Some(domain) = scene.domain {
        return (domain.low, domain.high);
    }
    let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    let of_grain = |grain: &GrainState| {
        let reach = Vector3::repeat(grain.radius);
        (grain.position - reach, grain.position + reach)
    };
    let around = |boxes: &mut dyn Iterator<Item = (Vector3<f64>, Vector3<f64>)>| {
        boxes.fold(start, |(low, high), extent| (low.inf(&extent.0), high.sup(&extent.1)))
    };
    let (mut low, mut high) = match (grains, &scene.bodies[..]) {
        ([], []) => (Vector3::zeros(), Vector3::zeros()),
        ([], bodies) => around(&mut bodies.iter().map(|body| body.shape.corners())),
        _ => around(&mut grains.iter().map(of_grain)),
    };
    if scene.dimension.count() == 2 {
        (low.z, high.z) = (-0.5, 0.5);
    }
    (low, high)
}

/// Returns the angle nearest to `expected` that differs from `angle` by full turns (rad).
#[must_use]
pub fn nearest_turn(angle: f64, expected: f64) -> f64 {
    angle + ((expected - angle) / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// State of a simulation at one step: a snapshot, and further data for probes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepState {
    /// Grains sorted by id, contacts and walls.
    pub snapshot: Snapshot,
    /// Number of contacts and number of slipping contacts, if known. They may be known although the snapshot has no
    /// list of contacts.
    pub touching: Option<[usize; 2]>,
    /// Elastic energy of contact springs and deformed material (J).
    pub elastic_energy: f64,
    /// Kinetic energy in excess of the rigid motion of grains and bodies (J).
    pub inner_kinetic_energy: f64,
    /// Difference in rotational energy (J): ½ ω·Iω with inertia tensors I, less ½ I ω² with the scalar moments of
    /// inertia I of grains and bodies.
    pub uneven_rotational_energy: f64,
    /// Difference in angular momentum (kg m²/s): Iω with inertia tensors I, less Iω with the scalar moments of inertia
    /// I of grains and bodies.
    pub uneven_angular_momentum: Vector3<f64>,
    /// Material at the positions of point probes, in the order of [`Scene::spots`].
    pub spots: Vec<PointState>,
    /// Sum of the contact forces on each group of grains with prescribed motion (N), from free grains and walls, in the
    /// order of [`Scene::driven`]; empty if unknown.
    pub driven: Vec<Vector3<f64>>,
    /// Energy budget, if a probe requests it and the solver computes it.
    pub budget: Option<Budget>,
}

impl StepState {
    /// Returns the state of a simulation with rigid grains.
    #[must_use]
    pub fn of_rigid(snapshot: Snapshot, elastic_energy: f64) -> Self {
        Self { touching: snapshot.touching(), snapshot, elastic_energy, ..Self::default() }
    }
}

/// Work counters of one of our solvers since the start of the run. They do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains or material points.
    pub particle_steps: u64,
    /// Number of contact laws evaluated.
    pub contact_evaluations: u64,
    /// Number of listed pairs tested for contact.
    pub pair_tests: u64,
    /// Number of neighbour lists built.
    pub neighbour_builds: u64,
    /// Number of active grid nodes, summed over all steps.
    pub node_updates: u64,
    /// Largest memory of the simulation state (B), if it is measured.
    pub bytes: u64,
}

/// Cost of a run. Times depend on the machine, counts do not. Counts that a solver does not report are absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Number of steps.
    pub steps: u64,
    /// Steps times grains or material points.
    pub particle_steps: u64,
    /// Number of contact laws evaluated.
    pub contact_evaluations: Option<u64>,
    /// Number of listed pairs tested for contact.
    pub pair_tests: Option<u64>,
    /// Number of neighbour lists built.
    pub neighbour_builds: Option<u64>,
    /// Number of active grid nodes, summed over all steps.
    pub node_updates: Option<u64>,
    /// Largest memory of the simulation state (B).
    pub bytes: Option<u64>,
    /// Wall-clock time of the stepping loop (s); NaN if it was not measured.
    pub wall_seconds: f64,
}

impl Cost {
    /// Returns the cost of a run of one of our solvers.
    #[must_use]
    pub const fn new(counts: Counts, wall_seconds: f64) -> Self {
        Self {
            steps: counts.steps,
            particle_steps: counts.particle_steps,
            contact_evaluations: Some(counts.contact_evaluations),
            pair_tests: Some(counts.pair_tests),
            neighbour_builds: Some(counts.neighbour_builds),
            node_updates: Some(counts.node_updates),
            bytes: Some(counts.bytes),
            wall_seconds,
        }
    }

    /// Returns the sum of particle-steps and contact evaluations.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.particle_steps + self.contact_evaluations.unwrap_or_default()
    }

    /// Returns the cost of a run of an external program that reports no counts, with `grains` grains and `steps` steps.
    #[must_use]
    pub fn of_program(steps: u64, grains: usize, wall_seconds: f64) -> Self {
        Self { steps, particle_steps: steps * grains as u64, wall_seconds, ..Self::default() }
    }
}

/// Origin of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Title of the scene.
    pub scene: String,
    /// Solver and convention, such as `dem:lammps`.
    pub solver: String,
    /// Resolution as text, such as `dt=.1`.
    pub resolution: String,
    /// Time step (s).
    pub time_step: f64,
    /// Critical time step `2√(m_min/k_max)` (s); absent if the method has none.
    pub critical_time_step: Option<f64>,
    /// Physical effects that the scene uses, as text.
    pub effects: Vec<String>,
    /// Solver options, as text.
    pub options: Vec<String>,
}

impl Provenance {
    /// Returns the provenance of a run at a time step (s), for solvers whose critical time step is that of the scene.
    #[must_use]
    pub fn new(scene: &Scene, solver: String, resolution: &Resolution, time_step: f64, options: Vec<String>) -> Self {
        let critical = scene.critical_time_step();
        Self {
            scene: scene.title.clone(),
            solver,
            resolution: resolution.to_string(),
            time_step,
            critical_time_step: critical.is_finite().then_some(critical),
            effects: Effects::words(scene),
            options,
        }
    }
}

/// Partial output of a run that broke or was interrupted.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialOutput {
    /// Time series up to the last sample.
    pub series: Series,
    /// Snapshots so far, without those that the observer did not return.
    pub snapshots: Vec<Snapshot>,
    /// Last state of the run. If the run broke, contacts are absent.
    pub end: Snapshot,
}

/// Output of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Origin of the record.
    pub provenance: Provenance,
    /// Time series of the scene's probes.
    pub series: Series,
    /// Snapshots in order of time. The last snapshot is the end of the run.
    pub snapshots: Vec<Snapshot>,
    /// Cost of the run.
    pub cost: Cost,
}

/// Serialisation of a vector that is NaN if the solver does not report it. The vector is then absent in files, because
/// JSON has no NaN.
mod untold {
    use nalgebra::Vector3;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(vector: &Vector3<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        vector.iter().all(|component| !component.is_nan()).then_some(vector).serialize(serializer)
    }

    pub(super) fn deserialize<'d, D: Deserializer<'d>>(deserializer: D) -> Result<Vector3<f64>, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or_else(|| Vector3::repeat(f64::NAN)))
    }
}
