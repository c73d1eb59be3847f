//! The scene that a program is given: everything definite, in SI, nothing to be looked up elsewhere.

use super::deformable::{self, Body, BodyProbe, Grid, Material, Settle};
use super::manifest::SceneFormat;
use crate::deck::Stepping;
use grainbench_scene::contact_law::{ContactLaw, Springs};
use grainbench_scene::effect::Effect;
use grainbench_scene::file::GrainShape;
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::{Scene, Wall, WallShape};
use grainbench_scene::solver::Resolution;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;
use std::f64::consts::PI;

/// The format that this program writes.
const FORMAT: u32 = 1;

/// A scene made definite, with its steps. Lengths are in m, times in s, masses in kg (of discs per metre of depth), angles in
/// rad; vectors have three components, of which scenes in the plane use x and y for places and z for spins.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Resolved {
    /// The format of this file.
    pub format: u32,
    /// Title of the scene.
    pub title: String,
    /// Number of dimensions.
    pub dimension: usize,
    /// What grains are: `disc` or `sphere`.
    pub grain_shape: &'static str,
    /// Effects that the scene calls for.
    pub effects: Vec<&'static str>,
    /// Steps and samples.
    pub steps: Steps,
    /// Gravity (m/s²).
    pub gravity: [f64; 3],
    /// Mass-proportional damping α of every grain (1/s): a force −α m v and a torque −α I ω.
    pub global_damping: f64,
    /// The box, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub domain: Option<Domain>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// The law of each pair of materials that may touch.
    pub laws: Vec<Law>,
    /// The grains.
    pub grains: Vec<Grain>,
    /// The walls.
    pub walls: Vec<ResolvedWall>,
    /// Groups of grains that are moved whatever the forces on them.
    pub driven: Vec<Driven>,
    /// The grid, where bodies deform. Springs and dashpots of `laws` are then not meant, friction is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<Grid>,
    /// Materials that deform, where there is a grid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub deformable: Vec<Material>,
    /// Bodies that are no grains.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
    /// A damped phase before the clock starts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle: Option<Settle>,
    /// Probes of bodies and of the material inside them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<BodyProbe>,
    /// Columns that a table of the series may have.
    pub columns: Vec<String>,
}

/// A scene as it is given to a program at a resolution.
#[derive(Clone, Copy)]
pub struct Given<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// Its steps.
    pub stepping: Stepping,
    /// Its grid, where bodies deform.
    pub grid: Option<Grid>,
}

impl<'s> Given<'s> {
    /// Of a scene at a resolution.
    ///
    /// # Errors
    /// Says what is wrong where there are no such steps of the scene.
    pub fn of(scene: &'s Scene, resolution: &Resolution) -> Result<Self, String> {
        let Resolution::Grid { cells, points, courant } = *resolution else {
            return Ok(Self { scene, stepping: Stepping::of(scene, resolution)?, grid: None });
        };
        let stepping = Stepping::every(resolution.steps_on_grid(scene)?, scene);
        let cell = scene.reference_length / cells;
        Ok(Self { scene, stepping, grid: Some(Grid { cell, points, courant }) })
    }
}

/// Steps and samples.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Steps {
    /// Time step (s).
    pub time_step: f64,
    /// How many.
    pub count: u64,
    /// Steps between samples. There is one at the start, and one at the end.
    pub sample_every: u64,
    /// The critical step 2√(m_min/k_max) (s), where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_time_step: Option<f64>,
}

/// The box of a scene.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Domain {
    /// Lower corner (m).
    pub low: [f64; 3],
    /// Upper corner (m).
    pub high: [f64; 3],
    /// Which axes are periodic.
    pub periodic: [bool; 3],
}

/// The law of a contact between two materials.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Law {
    /// The materials.
    pub between: [String; 2],
    /// `linear`, `hertz-mindlin` or `coulomb`, with its numbers.
    #[serde(flatten)]
    pub springs: Springs,
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Cohesion c (N): |F_s| ≤ μ F_n + c.
    pub cohesion: f64,
    /// Stiffness-proportional damping β (s): dashpots β k_n and β k_s.
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s): a dashpot γ_n m_eff.
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s): a dashpot γ_t m_eff.
    pub tangential_damping: f64,
    /// Coefficient of restitution e, where the scene gives one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Coefficient of rolling resistance μ_r: a moment of at most μ_r R_eff F_n.
    pub rolling_friction: f64,
    /// Damping ratio of the rolling spring.
    pub rolling_damping: f64,
}

/// A grain at the start.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Grain {
    /// Its number, from 1.
    pub id: usize,
    /// Material.
    pub material: String,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia (kg m²).
    pub inertia: f64,
    /// Centre (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
}

/// A wall.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ResolvedWall {
    /// Name.
    pub name: String,
    /// Material.
    pub material: String,
    /// Shape at the start.
    #[serde(flatten)]
    pub shape: Shape,
    /// Centre of rotation at the start (m); it moves with the wall.
    pub centre: [f64; 3],
    /// How it moves: phases that add up; none where it stands still.
    pub motion: Vec<Phase>,
}

/// The shape of a wall.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Everything behind the plane is solid.
    Plane {
        /// A point on it (m).
        point: [f64; 3],
        /// Unit vector out of the solid.
        normal: [f64; 3],
    },
    /// A segment of a line, in the plane, by its ends (m).
    Segment([[f64; 3]; 2]),
    /// A rectangle, in space.
    Rectangle {
        /// A corner (m).
        corner: [f64; 3],
        /// The perpendicular edges from it (m).
        edges: [[f64; 3]; 2],
    },
    /// The side of a cylinder or a part of a cone.
    Round {
        /// Ends of its axis (m).
        axis: [[f64; 3]; 2],
        /// Radius at each (m).
        radii: [f64; 2],
    },
    /// The corners of every triangle of a mesh (m), whose normal is on the side from which they go round to the left.
    Mesh(Vec<[[f64; 3]; 3]>),
}

/// Constant velocity and spin between two moments.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Phase {
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity about the centre (rad/s).
    pub spin: [f64; 3],
    /// When it starts (s).
    pub start: f64,
    /// When it stops (s); at the end of the run where none is said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
}

/// Grains that are moved whatever the forces on them, without turning.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Driven {
    /// Name.
    pub name: String,
    /// Their numbers.
    pub grains: Vec<usize>,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
}

impl Resolved {
    /// Of a scene, with steps.
    #[must_use]
    pub fn of(given: &Given<'_>) -> Self {
        let Given { scene, stepping, grid } = given;
        let vector = |vector: &Vector3<f64>| [vector.x, vector.y, vector.z];
        let material = |place: u16| scene.materials[usize::from(place)].clone();
        let critical = scene.critical_time_step();
        Self {
            format: FORMAT,
            title: scene.title.clone(),
            dimension: scene.dimension.count(),
            grain_shape: match scene.grain_shape {
                GrainShape::Disc => "disc",
                GrainShape::Sphere => "sphere",
            },
            effects: Effect::ALL.into_iter().filter(|effect| effect.is_on(scene)).map(Effect::key_word).collect(),
            steps: Steps {
                time_step: stepping.time_step,
                count: stepping.steps,
                sample_every: stepping.interval,
                critical_time_step: critical.is_finite().then_some(critical),
            },
            gravity: vector(&scene.gravity),
            global_damping: scene.global_damping,
            domain: scene.domain.as_ref().map(|domain| Domain {
                low: vector(&domain.low),
                high: vector(&domain.high),
                periodic: domain.periodic,
            }),
            materials: scene.materials.clone(),
            laws: laws(scene),
            grains: (1..)
                .zip(scene.grains.iter())
                .map(|(id, grain)| Grain {
                    id,
                    material: material(grain.material),
                    radius: grain.radius,
                    mass: grain.mass,
                    inertia: grain.inertia,
                    position: vector(&grain.position),
                    velocity: vector(&grain.velocity),
                    spin: vector(&grain.spin),
                })
                .collect(),
            walls: scene.walls.iter().map(|wall| resolved_wall(wall, material(wall.material), stepping)).collect(),
            driven: scene
                .driven
                .iter()
                .map(|driven| Driven {
                    name: driven.name.clone(),
                    grains: driven.grains.iter().map(|grain| grain + 1).collect(),
                    velocity: vector(&driven.velocity),
                })
                .collect(),
            grid: *grid,
            deformable: if grid.is_some() { deformable::materials(scene) } else { Vec::new() },
            bodies: deformable::bodies(scene),
            settle: deformable::settle(scene),
            probes: deformable::probes(scene),
            columns: Recorder::new(scene, 1.0, 1).finish().0.columns.into_iter().map(|column| column.name).collect(),
        }
    }
}

impl Resolved {
    /// As a file has it.
    ///
    /// # Errors
    /// When a value cannot be written down, in words.
    pub fn text(&self, format: SceneFormat) -> Result<String, String> {
        match format {
            SceneFormat::Json => serde_json::to_string(self).map_err(|error| error.to_string()),
            SceneFormat::Toml => toml::to_string(self).map_err(|error| error.to_string()),
        }
    }
}

/// The JSON schema of resolved scenes.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Resolved)
}

/// The pair table, each pair once.
fn laws(scene: &Scene) -> Vec<Law> {
    let count = scene.materials.len() as u16;
    let pairs = (0..count).flat_map(|first| (first..count).map(move |second| (first, second)));
    let name = |place: u16| scene.materials[usize::from(place)].clone();
    pairs.filter_map(|(first, second)| Some(law([name(first), name(second)], scene.law(first, second)?))).collect()
}

fn law(between: [String; 2], law: &ContactLaw) -> Law {
    let damping = law.damping_ratio;
    Law {
        between,
        springs: law.springs,
        friction: law.friction,
        cohesion: law.cohesion,
        stiffness_damping: law.stiffness_damping,
        normal_damping: law.normal_damping,
        tangential_damping: law.tangential_damping,
        // ζ = −ln e/√(π² + ln² e), the other way round.
        restitution: (damping > 0.0).then(|| (-PI * damping / (1.0 - damping * damping).sqrt()).exp()),
        rolling_friction: law.rolling_friction,
        rolling_damping: law.rolling_damping,
    }
}

fn resolved_wall(wall: &Wall, material: String, stepping: &Stepping) -> ResolvedWall {
    let vector = |vector: Vector3<f64>| [vector.x, vector.y, vector.z];
    let phase = |phase: &grainbench_scene::motion::Phase| {
        let stop = phase.stop.seconds(stepping.time_step);
        Phase {
            velocity: vector(phase.velocity),
            spin: vector(phase.spin),
            start: phase.start.seconds(stepping.time_step),
            stop: stop.is_finite().then_some(stop),
        }
    };
    ResolvedWall {
        name: wall.name.clone(),
        material,
        shape: match wall.shape {
            WallShape::Plane { point, normal } => Shape::Plane { point: vector(point), normal: vector(normal) },
            WallShape::Segment { ends } => Shape::Segment(ends.map(vector)),
            WallShape::Rectangle { corner, edges } => {
                Shape::Rectangle { corner: vector(corner), edges: edges.map(vector) }
            }
            WallShape::Round { axis, radii } => Shape::Round { axis: axis.map(vector), radii },
            WallShape::Mesh(ref mesh) => Shape::Mesh(mesh.triangles().map(|triangle| triangle.map(vector)).collect()),
        },
        centre: vector(wall.motion.centre),
        motion: wall.motion.phases.iter().map(phase).collect(),
    }
}
