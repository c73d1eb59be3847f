//! Scene for external programs. All values are explicit and in SI units, so that no other source is needed.

use super::manifest::SceneFormat;
use crate::deck::Stepping;
use grainbench_scene::body::{Block, BlockShape, Settle, Sides, Wave};
use grainbench_scene::contact_law::Springs;
use grainbench_scene::dimension::GrainShape;
use grainbench_scene::effect::Effect;
use grainbench_scene::material::{Constitutive, Deformable};
use grainbench_scene::scene::{BodyName, Domain, Probe, ProbeTarget, Scene, Wall, WallShape};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use std::f64::consts::PI;
use std::io;

/// Version of the file format of resolved scenes.
const FORMAT: u32 = 1;

/// Scene with explicit values and its time steps.
///
/// Lengths are in m, times in s, masses in kg and angles in rad. The mass, inertia and stiffness of a disc are per
/// metre of depth. Vectors have three components; scenes in two dimensions use x and y of positions and z of spins.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Resolved {
    /// Version of the file format, 1.
    pub format: u32,
    /// Title of the scene.
    pub title: String,
    /// Number of dimensions, 2 or 3.
    pub dimension: usize,
    /// Shape of all grains: `disc` or `sphere`.
    #[schemars(with = "String")]
    pub grain_shape: GrainShape,
    /// Names of the physical effects that the scene uses, such as `friction`.
    pub effects: Vec<&'static str>,
    /// Time steps and samples.
    pub steps: Steps,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 3],
    /// Mass-proportional damping α of every grain (1/s), 0 for none. The force is −α m v and the torque −α I ω.
    pub global_damping: f64,
    /// Box of the scene; absent if the scene has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub domain: Option<Domain>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Contact law of each pair of materials that can come into contact.
    pub laws: Vec<Law>,
    /// Grains at the start of the run.
    pub grains: Vec<Grain>,
    /// Walls at the start of the run.
    pub walls: Vec<ResolvedWall>,
    /// Groups of grains with prescribed motion, which forces do not affect.
    pub driven: Vec<Driven>,
    /// Grid of a run with deformable bodies, otherwise absent. With a grid, springs and dashpots of `laws` are ignored,
    /// and only friction applies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<Grid>,
    /// Deformable materials; absent without a grid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub deformable: Vec<Material>,
    /// Deformable bodies other than grains; absent if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
    /// Damped relaxation before the run; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle: Option<Settle>,
    /// Probes of bodies and of points inside bodies; absent if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<BodyProbe>,
    /// Columns of the scene's series. A table of the program may contain them.
    pub columns: Vec<String>,
}

/// Scene with the time steps and the grid of a run.
#[derive(Clone, Copy)]
pub struct DiscretizedScene<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// Time steps and samples of the run.
    pub stepping: Stepping,
    /// Grid of the run; `None` if no bodies deform.
    pub grid: Option<Grid>,
}

impl<'s> DiscretizedScene<'s> {
    /// Returns the time steps and the grid of a scene at a resolution.
    ///
    /// # Errors
    /// If the resolution is not valid for the scene. The error is the reason.
    pub fn new(scene: &'s Scene, resolution: &Resolution) -> Result<Self, String> {
        let Resolution::Grid { cells, points, courant } = *resolution else {
            return Ok(Self { scene, stepping: Stepping::new(scene, resolution)?, grid: None });
        };
        let stepping = Stepping::every(resolution.steps_on_grid(scene)?, scene);
        let cell = scene.reference_length / cells;
        Ok(Self { scene, stepping, grid: Some(Grid { cell, points, courant }) })
    }
}

/// Time steps and samples of a run.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Steps {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub count: u64,
    /// Number of steps between samples. There are also samples at the start and at the end.
    pub sample_every: u64,
    /// Critical time step 2√(m_min/k_max) from the smallest mass and the largest stiffness (s); absent without
    /// stiffness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_time_step: Option<f64>,
}

/// Contact law between two materials.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Law {
    /// Names of the two materials.
    pub between: [String; 2],
    /// Type of law (key `law`: `linear`, `hertz-mindlin` or `coulomb`) with its stiffnesses or moduli.
    #[serde(flatten)]
    pub springs: Springs,
    /// Coefficient of friction μ, 0 for none.
    pub friction: f64,
    /// Cohesion c (N) in the friction limit |F_s| ≤ μ F_n + c, 0 for none.
    pub cohesion: f64,
    /// Stiffness-proportional damping β (s), 0 for none. The dashpots are β k_n and β k_s.
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s), 0 for none. The dashpot is γ_n m_eff, with m_eff = m₁m₂/(m₁+m₂), or
    /// m at a wall.
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s), 0 for none. The dashpot is γ_t m_eff.
    pub tangential_damping: f64,
    /// Coefficient of restitution e, which sets a normal dashpot; absent if the scene has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Coefficient of rolling resistance μ_r, 0 for none. The rolling moment is at most μ_r R_eff F_n.
    pub rolling_friction: f64,
    /// Damping ratio of the rolling spring, 0 for none.
    pub rolling_damping: f64,
}

/// Grain at the start of the run.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Grain {
    /// Id, counted from 1.
    pub id: usize,
    /// Name of the grain's material.
    pub material: String,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg; kg/m for discs).
    pub mass: f64,
    /// Moment of inertia (kg m²; kg m for discs).
    pub inertia: f64,
    /// Position of the centre (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
}

/// Wall at the start of the run.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ResolvedWall {
    /// Name of the wall.
    pub name: String,
    /// Name of the wall's material.
    pub material: String,
    /// Initial shape.
    #[serde(flatten)]
    pub shape: Shape,
    /// Initial centre of rotation (m), which moves with the wall.
    pub centre: [f64; 3],
    /// Phases of the motion. The velocities of simultaneous phases are added. The list is empty for a wall at rest.
    pub motion: Vec<Phase>,
}

/// Shape of a wall.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Plane. The space behind it is solid.
    Plane {
        /// A point on the plane (m).
        point: [f64; 3],
        /// Unit normal vector, which points out of the solid.
        normal: [f64; 3],
    },
    /// Line segment in two dimensions, given by its ends (m).
    Segment([[f64; 3]; 2]),
    /// Rectangle in three dimensions.
    Rectangle {
        /// Corner of the rectangle (m).
        corner: [f64; 3],
        /// Perpendicular edge vectors from the corner (m).
        edges: [[f64; 3]; 2],
    },
    /// Side of a cylinder or a part of a cone.
    Round {
        /// Ends of the axis (m).
        axis: [[f64; 3]; 2],
        /// Radius at each end (m).
        radii: [f64; 2],
    },
    /// Triangles of a mesh, given by their corners (m). The corners are counterclockwise when seen from the side of the
    /// normal.
    Mesh(Vec<[[f64; 3]; 3]>),
}

/// Phase of a motion with constant velocity and spin.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Phase {
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity about the centre (rad/s).
    pub spin: [f64; 3],
    /// Start time (s).
    pub start: f64,
    /// End time (s); absent if the phase lasts until the end of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
}

/// Group of grains with a prescribed velocity and without rotation.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Driven {
    /// Name of the group.
    pub name: String,
    /// Ids of the grains in the group.
    pub grains: Vec<usize>,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
}

/// Grid of a run with deformable bodies.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Grid {
    /// Edge length h of a cell (m).
    pub cell: f64,
    /// Number of material points per cell and axis at the start, for programs that have material points.
    pub points: u32,
    /// Courant number c Δt/h, with the speed c of the fastest wave and the time step Δt.
    pub courant: f64,
}

/// Deformable material.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Material {
    /// Name of the material.
    pub material: String,
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Constitutive law (key `constitutive`: `hypoelastic`, `neo-hookean`, `kelvin-voigt` or `von-mises`) with its
    /// parameters.
    #[serde(flatten)]
    pub law: Constitutive,
}

/// Deformable body that is not a grain.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Body {
    /// Name of the body.
    pub name: String,
    /// Name of the body's material.
    pub material: String,
    /// Initial density ρ (kg/m³).
    pub density: f64,
    /// Initial shape of the body.
    pub shape: BlockShape,
    /// Initial velocity (m/s), to which `spin`, `stretch` and `wave` add.
    pub velocity: [f64; 3],
    /// Initial angular velocity ω about the centre c of the shape (rad/s). It adds ω × (x − c) to the velocity at x.
    pub spin: [f64; 3],
    /// Initial stretch rates a along the axes (1/s). They add aᵢ (xᵢ − cᵢ) to the velocity component vᵢ.
    pub stretch: [f64; 3],
    /// Constraints of the lower and the upper side of a box along each axis: `free`, `sliding` (no normal motion) or
    /// `fixed` (no motion).
    #[schemars(with = "[[String; 2]; 3]")]
    pub sides: Sides,
    /// Sine wave that is added to the velocity along x; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// Probe of a body or of a point inside a body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BodyProbe {
    /// Name of the probe, with which its columns in the series begin.
    pub name: String,
    /// Name of the body, or `grain N` with the id N of a grain.
    pub of: String,
    /// Initial position of the material point that the probe follows (m); absent for a probe of the whole body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

impl Resolved {
    /// Returns the resolved scene of a run.
    #[must_use]
    pub fn new(given: &DiscretizedScene<'_>) -> Self {
        let DiscretizedScene { scene, stepping, grid } = given;
        let material = |place: u16| scene.materials[usize::from(place)].clone();
        let critical = scene.critical_time_step();
        Self {
            format: FORMAT,
            title: scene.title.clone(),
            dimension: scene.dimension.count(),
            grain_shape: scene.grain_shape,
            effects: Effect::ALL.into_iter().filter(|effect| effect.is_on(scene)).map(Effect::key_word).collect(),
            steps: Steps {
                time_step: stepping.time_step,
                count: stepping.steps,
                sample_every: stepping.interval,
                critical_time_step: critical.is_finite().then_some(critical),
            },
            gravity: scene.gravity.into(),
            global_damping: scene.global_damping,
            domain: scene.domain,
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
                    position: grain.position.into(),
                    velocity: grain.velocity.into(),
                    spin: grain.spin.into(),
                })
                .collect(),
            walls: scene.walls.iter().map(|wall| resolved_wall(wall, material(wall.material), stepping)).collect(),
            driven: scene
                .driven
                .iter()
                .map(|driven| Driven {
                    name: driven.name.clone(),
                    grains: driven.grains.iter().map(|grain| grain + 1).collect(),
                    velocity: driven.velocity.into(),
                })
                .collect(),
            grid: *grid,
            deformable: if grid.is_some() { materials(scene) } else { Vec::new() },
            bodies: bodies(scene),
            settle: scene.start.settle,
            probes: probes(scene),
            columns: Recorder::new(scene, 1.0, 1).finish().0.columns.into_iter().map(|column| column.name).collect(),
        }
    }

    /// Writes the resolved scene as JSON or TOML.
    ///
    /// # Errors
    /// When a value cannot be serialized or a write fails.
    pub fn write(&self, format: SceneFormat, out: &mut dyn io::Write) -> io::Result<()> {
        match format {
            SceneFormat::Json => Ok(serde_json::to_writer(out, self)?),
            SceneFormat::Toml => out.write_all(toml::to_string(self).map_err(io::Error::other)?.as_bytes()),
        }
    }

    /// Returns the resolved scene as JSON or TOML text.
    ///
    /// # Errors
    /// When a value cannot be serialized. The error is the reason.
    pub fn text(&self, format: SceneFormat) -> Result<String, String> {
        let mut bytes = Vec::new();
        self.write(format, &mut bytes).map_err(|error| error.to_string())?;
        String::from_utf8(bytes).map_err(|error| error.to_string())
    }
}

/// Returns the JSON schema of resolved scenes.
#[must_use]
pub fn schema() -> schemars::Schema {
    // A field that is left out if it is empty is required only in a schema of files to be read.
    SchemaSettings::default().for_serialize().into_generator().into_root_schema_for::<Resolved>()
}

/// Returns the contact laws of all pairs of materials, each pair once.
fn laws(scene: &Scene) -> Vec<Law> {
    let count = scene.materials.len() as u16;
    let pairs = (0..count).flat_map(|first| (first..count).map(move |second| (first, second)));
    let name = |place: u16| scene.materials[usize::from(place)].clone();
    let resolved = |(first, second)| {
        let law = scene.law(first, second)?;
        let damping = law.damping_ratio;
        Some(Law {
            between: [name(first), name(second)],
            springs: law.springs,
            friction: law.friction,
            cohesion: law.cohesion,
            stiffness_damping: law.stiffness_damping,
            normal_damping: law.normal_damping,
            tangential_damping: law.tangential_damping,
            // The inverse of ζ = −ln e/√(π² + ln² e).
            restitution: (damping > 0.0).then(|| (-PI * damping / (1.0 - damping * damping).sqrt()).exp()),
            rolling_friction: law.rolling_friction,
            rolling_damping: law.rolling_damping,
        })
    };
    pairs.filter_map(resolved).collect()
}

fn resolved_wall(wall: &Wall, material: String, stepping: &Stepping) -> ResolvedWall {
    let phase = |phase: &grainbench_scene::motion::Phase| {
        let stop = phase.stop.seconds(stepping.time_step);
        Phase {
            velocity: phase.velocity.into(),
            spin: phase.spin.into(),
            start: phase.start.seconds(stepping.time_step),
            stop: stop.is_finite().then_some(stop),
        }
    };
    ResolvedWall {
        name: wall.name.clone(),
        material,
        shape: match wall.shape {
            WallShape::Plane { point, normal } => Shape::Plane { point: point.into(), normal: normal.into() },
            WallShape::Segment { ends } => Shape::Segment(ends.map(Into::into)),
            WallShape::Rectangle { corner, edges } => {
                Shape::Rectangle { corner: corner.into(), edges: edges.map(Into::into) }
            }
            WallShape::Round { axis, radii } => Shape::Round { axis: axis.map(Into::into), radii },
            WallShape::Mesh(ref mesh) => {
                Shape::Mesh(mesh.triangles().map(|triangle| triangle.map(Into::into)).collect())
            }
        },
        centre: wall.motion.centre.into(),
        motion: wall.motion.phases.iter().map(phase).collect(),
    }
}

/// Returns the materials of a scene for which elastic moduli are given.
fn materials(scene: &Scene) -> Vec<Material> {
    let material = |(name, deformable): (&String, &Option<Deformable>)| {
        let Deformable { bulk_modulus, shear_modulus, constitutive } = (*deformable)?;
        Some(Material { material: name.clone(), bulk_modulus, shear_modulus, law: constitutive })
    };
    scene.materials.iter().zip(&scene.deformable).filter_map(material).collect()
}

/// Returns the deformable bodies of a scene.
fn bodies(scene: &Scene) -> Vec<Body> {
    let body = |body: &Block| Body {
        name: body.name.clone(),
        material: scene.materials[usize::from(body.material)].clone(),
        density: body.density,
        shape: body.shape,
        velocity: body.velocity.into(),
        spin: body.spin.into(),
        stretch: body.stretch.into(),
        sides: body.sides,
        wave: body.wave,
    };
    scene.bodies.iter().map(body).collect()
}

/// Returns the probes of bodies, and of points inside bodies and grains.
fn probes(scene: &Scene) -> Vec<BodyProbe> {
    let name = |body_name: BodyName| match body_name {
        BodyName::Grain(at) => format!("grain {}", at + 1),
        BodyName::Body(at) => scene.bodies[at].name.clone(),
    };
    let probe = |probe: &Probe| {
        let (body, at) = match probe.target {
            ProbeTarget::Body(at) => (BodyName::Body(at), None),
            ProbeTarget::Point(at) => (scene.spots[at].body, Some(scene.spots[at].at.into())),
            _ => return None,
        };
        Some(BodyProbe { name: probe.name.clone(), of: name(body), at })
    };
    scene.probes.iter().filter_map(probe).collect()
}
