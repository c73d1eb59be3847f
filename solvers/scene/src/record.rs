//! What a run leaves behind: time series, snapshots, cost, provenance.

use crate::budget::Budget;
use crate::effects::Effects;
use crate::scene::{Grain, Scene};
use crate::solver::Resolution;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One column of a time series.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Name, such as `disc.x` or `wall-corner.normal_force`.
    pub name: String,
    /// SI unit, such as `m/s`; `1` for a pure number.
    pub unit: String,
}

/// Time series of all probes of a scene, sampled together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Step (calculation cycle) of every sample.
    pub step: Vec<u64>,
    /// Time of every sample (s).
    pub time: Vec<f64>,
    /// The columns.
    pub columns: Vec<Column>,
    /// `values[c][k]` is column `c` at sample `k`.
    pub values: Vec<Vec<f64>>,
}

impl Series {
    /// The values of a column, if there is one of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let at = self.columns.iter().position(|column| column.name == name)?;
        Some(&self.values[at])
    }
}

/// One grain as a snapshot shows it. In two dimensions z components are zero and spin is along z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrainState {
    /// Identity, from 1, the same in every snapshot.
    pub id: u32,
    /// Place of its material in the scene, from 0.
    pub material: u16,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg; per metre of depth for discs).
    pub mass: f64,
    /// Centre (m), inside the domain along periodic axes.
    pub position: Vector3<f64>,
    /// Velocity at the time of the snapshot (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s); not a number where nobody told it.
    #[serde(with = "untold")]
    pub spin: Vector3<f64>,
    /// Rotation since the start (rad), about z; absent in three dimensions, and where a program did not tell it.
    pub angle: Option<f64>,
    /// Sum of all forces, gravity excluded (N; N/m for discs); absent where a program did not tell it.
    pub force: Option<Vector3<f64>>,
    /// Sum of all torques (N m; N for discs); absent where a program did not tell it.
    pub torque: Option<Vector3<f64>>,
    /// Equivalent plastic strain, its mean over the mass; zero for a grain that does not yield.
    #[serde(default)]
    pub plastic_strain: f64,
    /// V σ of the instant: xx, yy, zz, xy, yz, zx (J; J/m for discs), where it is asked for (see [`crate::virial`]). Apart from
    /// the grain, for few runs ask for it and large ones hold a million grains.
    #[serde(default)]
    pub virial: Option<Box<[f64; 6]>>,
    /// The same, its mean over the time since the snapshot before; none in the first.
    #[serde(default)]
    pub mean_virial: Option<Box<[f64; 6]>>,
}

impl GrainState {
    /// A grain of which nobody has told more than where it started: neither angle nor forces. Ids count from 1.
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
            angle: None,
            force: None,
            torque: None,
            plastic_strain: 0.0,
            virial: None,
            mean_virial: None,
        }
    }
}

/// One body that is no grain, as a snapshot shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Name in the scene.
    pub name: String,
    /// Mass (kg; per metre of depth in the plane).
    pub mass: f64,
    /// Moment of inertia about its centre of mass, mean over the axes it can turn about (kg m²).
    pub inertia: f64,
    /// Centre of mass (m).
    pub position: Vector3<f64>,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vector3<f64>,
    /// Angular momentum over moment of inertia (rad/s).
    pub spin: Vector3<f64>,
    /// Rotation since the start (rad), about z; zero in three dimensions.
    pub angle: f64,
    /// Sum of all forces of contacts (N).
    pub force: Vector3<f64>,
}

/// Which body a material point belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Owner {
    /// A grain, by id.
    Grain(u32),
    /// A body that is no grain, by its place in the scene, from 0.
    Body(u32),
}

/// One material point of a deformable body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointState {
    /// Which body it belongs to.
    pub owner: Owner,
    /// Position (m); along periodic axes not taken back into the domain.
    pub position: Vector3<f64>,
    /// Displacement since the start (m).
    pub displacement: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Cauchy stress xx, yy, zz, xy, yz, zx (Pa), tension positive.
    pub stress: [f64; 6],
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
    /// Rotation R of the deformation F = R U (rad), about z, in the turn nearest to that of its body; zero in three
    /// dimensions.
    #[serde(default)]
    pub rotation: f64,
    /// Volume (m³; m² in the plane).
    pub volume: f64,
}

/// The other side of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Partner {
    /// A grain, by id.
    Grain(u32),
    /// A body that is no grain, by its place in the scene, from 0.
    Body(u32),
    /// A wall, by its place in the scene, from 0.
    Wall(u16),
}

/// One contact as a snapshot shows it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The grain, by id.
    pub grain: u32,
    /// What it touches.
    pub partner: Partner,
    /// Contact point (m), halfway through the overlap.
    pub point: Vector3<f64>,
    /// Unit vector from the grain to its partner.
    pub normal: Vector3<f64>,
    /// Overlap (m), positive while touching.
    pub overlap: f64,
    /// Normal force, dashpot included (N), positive when it pushes apart.
    pub normal_force: f64,
    /// Tangential force on the grain, dashpot included (N).
    pub shear_force: Vector3<f64>,
    /// Whether the Coulomb limit was reached in the last step.
    pub slipping: bool,
}

/// One wall as a snapshot shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallState {
    /// Name in the scene.
    pub name: String,
    /// Corner points (m): two for a segment, four for a rectangle; point and normal for a plane; the ends of its axis, and a
    /// point of the rim at each, for a cylinder or a cone; where the origin of its file and points 1 m along x and y from
    /// there are, for a mesh; none of a wall that has been taken away.
    pub corners: Vec<Vector3<f64>>,
    /// True when `corners` is a point and the unit normal of an infinite plane.
    pub infinite: bool,
    /// Force of the grains on the wall (N; N/m for discs); absent where a program did not tell it.
    pub force: Option<Vector3<f64>>,
}

/// Everything at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Step (calculation cycle).
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Corners of the domain (m), for drawing and for dump headers.
    pub bounds: (Vector3<f64>, Vector3<f64>),
    /// Which axes are periodic.
    pub periodic: [bool; 3],
    /// Grains in order of id.
    pub grains: Vec<GrainState>,
    /// All contacts, in order of grain id; absent where a program did not tell them, which is not the same as none.
    pub contacts: Option<Vec<ContactState>>,
    /// Walls in the order of the scene.
    pub walls: Vec<WallState>,
    /// Bodies that are no grains, in the order of the scene.
    #[serde(default)]
    pub bodies: Vec<BodyState>,
    /// Material points, where a solver has them.
    #[serde(default)]
    pub points: Vec<PointState>,
}

impl Snapshot {
    /// The contacts that are told: none where nobody has told any, so that pictures show nothing where nothing is known.
    /// What is judged asks for `contacts` itself.
    #[must_use]
    pub fn told_contacts(&self) -> &[ContactState] {
        self.contacts.as_deref().unwrap_or_default()
    }

    /// Number of contacts, and how many of them slip; none where nobody has told them.
    #[must_use]
    pub fn touching(&self) -> Option<[usize; 2]> {
        let contacts = self.contacts.as_ref()?;
        Some([contacts.len(), contacts.iter().filter(|contact| contact.slipping).count()])
    }

    /// Place of the grain of an id in the list of grains; none where it is not there.
    #[must_use]
    pub fn place_of(&self, id: u32) -> Option<usize> {
        // Where all are there the id tells it.
        let place = (id as usize).checked_sub(1)?;
        if self.grains.get(place).is_some_and(|grain| grain.id == id) {
            return Some(place);
        }
        self.grains.binary_search_by_key(&id, |grain| grain.id).ok()
    }

    /// The grain of an id; none where it is not there.
    #[must_use]
    pub fn grain(&self, id: u32) -> Option<&GrainState> {
        self.place_of(id).map(|place| &self.grains[place])
    }

    /// What a solver shows that knows of grains alone: no contacts, and walls as far as they have moved, without
    /// forces.
    #[must_use]
    pub fn of_grains(scene: &Scene, step: u64, time: f64, grains: Vec<GrainState>) -> Self {
        let time_step = if step == 0 { 0.0 } else { time / step as f64 };
        let walls = scene.walls.iter().map(|wall| {
            let displacement = wall.motion.displacement(time, time_step);
            let (corners, infinite) = wall.shape.moved(&wall.motion, &displacement).corners();
            WallState { name: wall.name.clone(), corners, infinite, force: None }
        });
        Self {
            step,
            time,
            bounds: bounds(scene, &grains),
            periodic: scene.domain.map_or([false; 3], |domain| domain.periodic),
            walls: walls.collect(),
            contacts: None,
            grains,
            bodies: Vec::new(),
            points: Vec::new(),
        }
    }
}

/// Corners of the domain (m), or of the box around all grains where the scene has none, or of that around its bodies as
/// they start where there are no grains either; z from −0.5 to 0.5 in the plane.
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
        boxes.fold(start, |(low, high), of| (low.inf(&of.0), high.sup(&of.1)))
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

/// A simulation at one step, with what its probes need beside the snapshot.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Grains in order of id, contacts, walls.
    pub snapshot: Snapshot,
    /// Number of contacts, and how many of them slip, where they are known; they may be where none is shown.
    pub touching: Option<[usize; 2]>,
    /// Energy in the springs of contacts and in deformed material (J).
    pub elastic_energy: f64,
    /// Kinetic energy beyond that of the rigid motion of grains and bodies (J).
    pub inner_kinetic_energy: f64,
    /// Energy of rotation ½ ω·Iω with the tensors I of inertia, beyond ½ I ω² with the scalars I of grains and bodies (J).
    pub uneven_rotational_energy: f64,
    /// Angular momentum Iω with the tensors I of inertia, beyond that with the scalars I of grains and bodies (kg m²/s).
    pub uneven_angular_momentum: Vector3<f64>,
    /// The material at the places that probes ask for, in the order of [`Scene::spots`].
    pub spots: Vec<PointState>,
    /// Force of the other grains on each group of driven ones (N), in the order of [`Scene::driven`]; empty where it is
    /// not known.
    pub driven: Vec<Vector3<f64>>,
    /// Where energy comes from and goes, where a probe asks for it and the solver knows.
    pub budget: Option<Budget>,
}

impl Look {
    /// Of rigid grains.
    #[must_use]
    pub fn of_rigid(snapshot: Snapshot, elastic_energy: f64) -> Self {
        Self {
            touching: snapshot.touching(),
            snapshot,
            elastic_energy,
            inner_kinetic_energy: 0.0,
            uneven_rotational_energy: 0.0,
            uneven_angular_momentum: Vector3::zeros(),
            spots: Vec::new(),
            driven: Vec::new(),
            budget: None,
        }
    }
}

/// What a solver of ours has done so far, whatever the machine: equal from run to run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains, or times material points.
    pub particle_steps: u64,
    /// Contact laws evaluated.
    pub contact_evaluations: u64,
    /// Listed pairs tested for touching.
    pub pair_tests: u64,
    /// Neighbour lists built.
    pub neighbour_builds: u64,
    /// Nodes of a grid that took a step, in all steps.
    pub node_updates: u64,
    /// Memory that the state of the simulation takes up at its largest (B), where it is counted.
    pub bytes: u64,
}

/// What a run cost: times depend on the machine, counts do not. What a program did not count is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains, or times material points.
    pub particle_steps: u64,
    /// Contact laws evaluated.
    pub contact_evaluations: Option<u64>,
    /// Listed pairs tested for touching.
    pub pair_tests: Option<u64>,
    /// Neighbour lists built.
    pub neighbour_builds: Option<u64>,
    /// Nodes of a grid that took a step, in all steps.
    pub node_updates: Option<u64>,
    /// Memory that the state of the simulation takes up at its largest (B).
    pub bytes: Option<u64>,
    /// Wall-clock time of the stepping loop (s); not a number where nobody took it.
    pub wall_seconds: f64,
}

impl Cost {
    /// Of a solver of ours.
    #[must_use]
    pub const fn of(counts: Counts, wall_seconds: f64) -> Self {
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

    /// Particle-steps and contact evaluations together.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.particle_steps + self.contact_evaluations.unwrap_or_default()
    }

    /// Of a program, which counts nothing for us: `grains` grains that took `steps` steps.
    #[must_use]
    pub fn of_program(steps: u64, grains: usize, wall_seconds: f64) -> Self {
        Self { steps, particle_steps: steps * grains as u64, wall_seconds, ..Self::default() }
    }
}

/// Where a record comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Title of the scene.
    pub scene: String,
    /// Solver and convention, such as `dem:lammps`.
    pub solver: String,
    /// Resolution in words, such as `dt=.1`.
    pub resolution: String,
    /// Time step (s).
    pub time_step: f64,
    /// Critical time step `2√(m_min/k_max)` (s); absent where the method has none.
    pub critical_time_step: Option<f64>,
    /// Physics that the scene called for, in words.
    pub effects: Vec<String>,
    /// Solver options in words.
    pub options: Vec<String>,
}

impl Provenance {
    /// Of a run of a scene at a time step (s), by a solver for which the scene's critical step is the critical one.
    #[must_use]
    pub fn of(scene: &Scene, solver: String, resolution: &Resolution, time_step: f64, options: Vec<String>) -> Self {
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

/// What there is of a run that broke or was ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Remains {
    /// Time series up to the last sample before.
    pub series: Series,
    /// Snapshots before, without those that the watcher took.
    pub snapshots: Vec<Snapshot>,
    /// The state that it broke in or was ended at. Of one that broke the contacts are not told.
    pub end: Snapshot,
}

/// What a run leaves behind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Where it comes from.
    pub provenance: Provenance,
    /// Time series of the scene's probes.
    pub series: Series,
    /// Snapshots in order of time; the last one is the end of the run.
    pub snapshots: Vec<Snapshot>,
    /// What it cost.
    pub cost: Cost,
}

/// A vector that is not a number where nobody told it: absent in a file, for JSON has no such number.
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
