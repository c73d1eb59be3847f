//! A scene made definite: every grain, wall and law, checked, in SI. Solvers read this and nothing else.

pub use crate::body::Block;
use crate::body::Start;
use crate::columns::{Chosen, Columns};
use crate::contact_law::ContactLaw;
use crate::end_state::Springs;
use crate::file::GrainShape;
use crate::grains::Grains;
use crate::material::Deformable;
use crate::mesh::Mesh;
use crate::motion::{Displacement, Motion};
use crate::stays::Stays;
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::sync::Arc;

/// Number of dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// The plane (x, y).
    Two,
    /// Space.
    Three,
}

impl Dimension {
    /// 2 or 3.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

impl GrainShape {
    /// Mass of a grain of this shape: discs per metre of depth (kg/m), spheres (kg).
    #[must_use]
    pub fn mass(self, radius: f64, density: f64) -> f64 {
        match self {
            Self::Disc => density * PI * radius * radius,
            Self::Sphere => density * (4.0 / 3.0) * PI * radius.powi(3),
        }
    }

    /// I/(mR²): 1/2 for a disc, 2/5 for a sphere.
    #[must_use]
    pub const fn inertia_factor(self) -> f64 {
        match self {
            Self::Disc => 0.5,
            Self::Sphere => 0.4,
        }
    }
}

/// One grain at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Place in [`Scene::materials`].
    pub material: u16,
    /// Radius R (m).
    pub radius: f64,
    /// Mass m (kg; per metre for discs).
    pub mass: f64,
    /// Moment of inertia I (kg m²).
    pub inertia: f64,
    /// Centre (m).
    pub position: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub spin: Vector3<f64>,
}

/// Shape of a wall at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// Everything behind the plane through `point` with unit `normal` is solid.
    Plane {
        /// A point on it (m).
        point: Vector3<f64>,
        /// Unit vector out of the solid.
        normal: Vector3<f64>,
    },
    /// The segment between two points (m), in the plane.
    Segment {
        /// The ends.
        ends: [Vector3<f64>; 2],
    },
    /// A rectangle in space.
    Rectangle {
        /// One corner (m).
        corner: Vector3<f64>,
        /// The perpendicular edges from it (m).
        edges: [Vector3<f64>; 2],
    },
    /// The side of a cylinder or of a part of a cone, in space.
    Round {
        /// The ends of its axis (m).
        axis: [Vector3<f64>; 2],
        /// Radius at each end (m).
        radii: [f64; 2],
    },
    /// A surface of triangles, in space.
    Mesh(Mesh),
}

impl WallShape {
    /// The shape after its wall has moved.
    #[must_use]
    pub fn moved(&self, motion: &Motion, displacement: &Displacement) -> Self {
        let at = |point: Vector3<f64>| motion.moved(point, displacement);
        let turn = |direction: Vector3<f64>| motion.turned(direction, displacement);
        match *self {
            Self::Plane { point, normal } => Self::Plane { point: at(point), normal: turn(normal) },
            Self::Segment { ends } => Self::Segment { ends: ends.map(at) },
            Self::Rectangle { corner, edges } => Self::Rectangle { corner: at(corner), edges: edges.map(turn) },
            Self::Round { axis, radii } => Self::Round { axis: axis.map(at), radii },
            Self::Mesh(ref mesh) => Self::Mesh(mesh.moved(motion, displacement)),
        }
    }

    /// Corner points, or point and normal of a plane, and which it is (see [`crate::record::WallState`]).
    #[must_use]
    pub fn corners(&self) -> (Vec<Vector3<f64>>, bool) {
        match *self {
            Self::Plane { point, normal } => (vec![point, normal], true),
            Self::Segment { ends } => (ends.to_vec(), false),
            Self::Rectangle { corner, edges: [u, v] } => (vec![corner, corner + u, corner + u + v, corner + v], false),
            Self::Round { axis: [from, to], radii } => {
                let out = across(to - from);
                (vec![from, to, from + out * radii[0], to + out * radii[1]], false)
            }
            Self::Mesh(ref mesh) => (vec![mesh.origin, mesh.place(Vector3::x()), mesh.place(Vector3::y())], false),
        }
    }
}

/// A unit vector across a direction; along an axis where the direction is along another.
pub(crate) fn across(direction: Vector3<f64>) -> Vector3<f64> {
    let least = (0..3).min_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs())).unwrap_or(0);
    let axis = Vector3::ith(least, 1.0);
    (axis - direction * (direction.dot(&axis) / direction.norm_squared())).normalize()
}

/// A wall with its prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Name in the file.
    pub name: String,
    /// Place in [`Scene::materials`].
    pub material: u16,
    /// Shape at the start.
    pub shape: WallShape,
    /// How it moves.
    pub motion: Motion,
    /// What presses it.
    pub piston: Option<Piston>,
    /// When it is taken away (s).
    pub until: Option<f64>,
}

/// What presses a plane: M dv/dt = F − F_n − M c v along its normal, with the normal force F_n of the grains on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piston {
    /// Force F along the normal (N).
    pub force: f64,
    /// Mass M (kg).
    pub mass: f64,
    /// Damping c (1/s).
    pub damping: f64,
}

/// Grains that are moved as a wall is, whatever the forces on them: at a constant velocity and spin, and by a motion beside it.
#[derive(Clone, PartialEq)]
pub struct Driven {
    /// Name in the file.
    pub name: String,
    /// Which grains, by place in [`Scene::grains`].
    pub grains: Vec<usize>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// From when on, and until when (s): before and after they are grains as all others are.
    pub span: [f64; 2],
    /// Angular velocity of each about its own centre (rad/s).
    pub spin: Vector3<f64>,
    /// Motion beside the velocity, in which nothing turns.
    pub motion: Motion,
}

/// Spin and motion are shown where there are any, as [`Motion`] shows its functions.
impl std::fmt::Debug for Driven {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = formatter.debug_struct("Driven");
        shown.field("name", &self.name).field("grains", &self.grains).field("velocity", &self.velocity);
        shown.field("span", &self.span);
        if self.spin != Vector3::zeros() {
            shown.field("spin", &self.spin);
        }
        if !self.motion.is_empty() {
            shown.field("motion", &self.motion);
        }
        shown.finish()
    }
}

impl Driven {
    /// All of the run.
    pub const ALWAYS: [f64; 2] = [0.0, f64::INFINITY];

    /// Whether they are moved over the step that begins at a time (s). A moment that is a whole number of steps is that step.
    #[must_use]
    pub fn is_moved_at(&self, time: f64) -> bool {
        let [start, stop] = self.span.map(|moment| moment * (1.0 - 1e-9));
        (start..stop).contains(&time)
    }

    /// Velocity over the step that begins at a time (m/s; s): what they go in it over its length.
    #[must_use]
    pub fn velocity_over(&self, time: f64, time_step: f64) -> Vector3<f64> {
        if self.motion.is_empty() {
            return self.velocity;
        }
        let at = |time: f64| self.motion.displacement(time, time_step).translation;
        self.velocity + (at(time + time_step) - at(time)) / time_step
    }

    /// Velocity at a time (m/s; s): the mean of those of the steps that end and begin then.
    #[must_use]
    pub fn velocity_at(&self, time: f64, time_step: f64) -> Vector3<f64> {
        if self.motion.is_empty() {
            return self.velocity;
        }
        let before = if time > 0.0 { time - time_step } else { time };
        (self.velocity_over(before, time_step) + self.velocity_over(time, time_step)) * 0.5
    }

    /// A bound of the speed that they ever have (m/s).
    #[must_use]
    pub fn fastest(&self) -> f64 {
        self.velocity.norm() + self.motion.fastest()
    }

    /// Whether they are moved for a part of the run only.
    #[must_use]
    pub fn is_for_a_while(&self) -> bool {
        self.span != Self::ALWAYS
    }
}

/// How long the run lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Duration {
    /// A time (s).
    Seconds(f64),
    /// A number of calculation cycles.
    Cycles(u64),
}

impl Duration {
    /// The time (s), where it is one.
    #[must_use]
    pub const fn seconds(self) -> Option<f64> {
        if let Self::Seconds(seconds) = self { Some(seconds) } else { None }
    }
}

/// How often probes are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// Every so many seconds, rounded to whole cycles.
    Seconds(f64),
    /// Every so many cycles.
    Cycles(u64),
    /// So many samples over the run.
    Count(u64),
}

/// What a probe looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProbeTarget {
    /// A grain, by place in [`Scene::grains`].
    Grain(usize),
    /// A body that is no grain, by place in [`Scene::bodies`].
    Body(usize),
    /// The material at a place, by place among the probes of this kind.
    Point(usize),
    /// A contact between two grains.
    Pair(usize, usize),
    /// A contact between a grain and a wall, by place in [`Scene::walls`].
    GrainWall(usize, usize),
    /// A wall.
    Wall(usize),
    /// How far a wall that is pressed has gone.
    Piston(usize),
    /// A group of driven grains, by place in [`Scene::driven`].
    Driven(usize),
    /// Where energy comes from and goes.
    Budget,
    /// Mean stress and number of contacts of the grains.
    Stress,
    /// How many grains there are.
    Count,
    /// Everything.
    System,
}

/// A place in the material of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Which body.
    pub body: BodyName,
    /// Place at the start (m).
    pub at: Vector3<f64>,
}

/// A grain or another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyName {
    /// A grain, by place in [`Scene::grains`].
    Grain(usize),
    /// Another body, by place in [`Scene::bodies`].
    Body(usize),
}

/// A named time series.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name; columns are called `name.quantity`.
    pub name: String,
    /// What it looks at.
    pub target: ProbeTarget,
}

/// The box of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Lower corner (m); z is −0.5 in two dimensions.
    pub low: Vector3<f64>,
    /// Upper corner (m); z is 0.5 in two dimensions.
    pub high: Vector3<f64>,
    /// Which axes are periodic.
    pub periodic: [bool; 3],
}

/// A scene, checked and complete.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Title, for reports.
    pub title: String,
    /// Number of dimensions.
    pub dimension: Dimension,
    /// What a grain is.
    pub grain_shape: GrainShape,
    /// Gravity (m/s²).
    pub gravity: Vector3<f64>,
    /// The box, where one is given.
    pub domain: Option<Domain>,
    /// Global mass-proportional damping α (1/s).
    pub global_damping: f64,
    /// How long the run lasts.
    pub duration: Duration,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// The pair table: [`Scene::law`] reads it.
    pub laws: Vec<Option<ContactLaw>>,
    /// What deformable materials are made of, in the order of `materials`; none where the scene does not say.
    pub deformable: Vec<Option<Deformable>>,
    /// Grains; the id of a grain is its place here plus one.
    pub grains: Grains,
    /// What their contacts remember at the start; nothing where absent.
    pub springs: Option<Arc<Springs>>,
    /// Which of them come or go.
    pub stays: Stays,
    /// Deformable bodies that are no grains.
    pub bodies: Vec<Block>,
    /// How deformable bodies start.
    pub start: Start,
    /// Length that the cells of a grid refer to (m).
    pub reference_length: f64,
    /// Walls.
    pub walls: Vec<Wall>,
    /// Groups of grains that are moved as walls are.
    pub driven: Vec<Driven>,
    /// How often probes are sampled.
    pub sampling: Sampling,
    /// Number of snapshots between the first and the last.
    pub snapshots: u32,
    /// Times of further snapshots (s).
    pub snapshot_times: Vec<f64>,
    /// Whether snapshots of other programs hold the contacts between grains too.
    pub snapshot_contacts: bool,
    /// What snapshots hold.
    pub columns: Columns,
    /// Named time series.
    pub probes: Vec<Probe>,
    /// Places that [`ProbeTarget::Point`] refers to.
    pub spots: Vec<Spot>,
}

impl Scene {
    /// The step on a grid of cells h (m) at which the shortest wave just stays bounded, of the deformable material for which it
    /// is the least (s); infinite where nothing deforms.
    ///
    /// It is what a longitudinal wave takes through a cell, h/c with c = √(M/ρ) and M = K + 4G/3. A viscosity η_L = 4η/3 + ζ
    /// that acts on the velocities of the step before shortens it: central differences of ẍ + 2ξωẋ + ω²x = 0 whose second term
    /// lags stay bounded up to (2/ω)(√(1 + ξ²) − ξ) (Belytschko, Liu & Moran, *Nonlinear Finite Elements*, 2000, section 6.2),
    /// and for the shortest wave of a grid ω = 2c/h and ξ = η_L/(ρ c h).
    #[must_use]
    pub fn crossing_time(&self, cell: f64) -> f64 {
        let of = |material: u16, density: f64| {
            let deformable = self.deformable.get(usize::from(material)).copied().flatten();
            deformable.map_or(f64::INFINITY, |deformable| {
                let speed = (deformable.longitudinal_modulus() / density).sqrt();
                let damping = deformable.longitudinal_viscosity() / (density * speed * cell);
                cell / speed * ((1.0 + damping * damping).sqrt() - damping)
            })
        };
        let volume = |radius: f64| self.grain_shape.mass(radius, 1.0);
        let grains = self.grains.iter().map(|grain| of(grain.material, grain.mass / volume(grain.radius)));
        let bodies = self.bodies.iter().map(|body| of(body.material, body.density));
        grains.chain(bodies).fold(f64::INFINITY, f64::min)
    }

    /// The group of driven grains that each grain is in, by place in [`Scene::driven`]; none for those that move
    /// freely.
    #[must_use]
    pub fn driven_group_of_grains(&self) -> Vec<Option<u16>> {
        let mut group_of = vec![None; self.grains.len()];
        for (place, driven) in self.driven.iter().enumerate() {
            driven.grains.iter().for_each(|&grain| group_of[grain] = Some(place as u16));
        }
        group_of
    }

    /// Whether a probe asks where energy comes from and goes.
    #[must_use]
    pub fn asks_for_budget(&self) -> bool {
        self.probes.iter().any(|probe| probe.target == ProbeTarget::Budget)
    }

    /// The law between two materials, if the scene has one.
    #[must_use]
    pub fn law(&self, a: u16, b: u16) -> Option<&ContactLaw> {
        self.laws[usize::from(a) * self.materials.len() + usize::from(b)].as_ref()
    }

    /// What is there for a while only, in words, if anything is: not every solver takes grains in or out, or walls away.
    #[must_use]
    pub fn passing(&self) -> Option<&'static str> {
        if !self.stays.entries.is_empty() {
            return Some("grains that are poured");
        }
        if self.stays.removal.is_some() {
            return Some("grains that are taken out");
        }
        if self.walls.iter().any(|wall| wall.piston.is_some()) {
            return Some("a wall that is pressed");
        }
        if self.driven.iter().any(Driven::is_for_a_while) {
            return Some("grains that are driven for a while (`driven.….start`, `stop`)");
        }
        if self.springs.is_some() {
            return Some("contacts that remember at the start (`springs = false` beside the state leaves that out)");
        }
        self.walls.iter().any(|wall| wall.until.is_some()).then_some("walls that are taken away")
    }

    /// What snapshots are asked for that is found during the run, in words, if anything is: not every solver does that.
    #[must_use]
    pub fn gathered(&self) -> Option<&'static str> {
        self.columns.has(Chosen::MeanVirial).then_some("a mean over time in its snapshots (`mean-virial`)")
    }

    /// Walls that are round, in words, if there are any: not every solver has them.
    #[must_use]
    pub fn round_wall(&self) -> Option<String> {
        let round = self.walls.iter().find(|wall| matches!(wall.shape, WallShape::Round { .. }))?;
        Some(format!("wall `{}` is the side of a cylinder or a cone", round.name))
    }

    /// Walls of triangles, in words, if there are any: not every solver has them.
    #[must_use]
    pub fn mesh_wall(&self) -> Option<String> {
        let mesh = self.walls.iter().find(|wall| matches!(wall.shape, WallShape::Mesh(_)))?;
        Some(format!("wall `{}` is a mesh of triangles", mesh.name))
    }

    /// What needs a solver of deformable bodies, in words, if anything does.
    #[must_use]
    pub fn needs_deformable(&self) -> Option<&'static str> {
        if !self.bodies.is_empty() {
            return Some("bodies that are no grains");
        }
        if !self.spots.is_empty() {
            return Some("probes of the material inside grains");
        }
        self.start.needs_deformable()
    }

    /// Applies a change to every law of the pair table.
    pub fn change_laws(&mut self, change: impl Fn(&mut ContactLaw)) {
        self.laws.iter_mut().flatten().for_each(change);
    }

    /// Whether an axis (0, 1, 2) is periodic.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.domain.is_some_and(|domain| domain.periodic.contains(&true))
    }

    /// Critical time step `2√(m_min/k_max)` of a mass on a spring to ground (s), over the contacts that can occur:
    /// the smallest mass and the largest stiffness, normal or tangential (Cundall & Strack 1979, p. 53). It is an
    /// estimate: assemblies need a fraction of it, which users choose. The stiffness of a Hertz contact is taken at an
    /// overlap of a hundredth of the largest radius.
    #[must_use]
    pub fn critical_time_step(&self) -> f64 {
        let mass = self.grains.iter().map(|grain| grain.mass).fold(f64::INFINITY, f64::min);
        let radius = self.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
        let stiffness = self
            .laws
            .iter()
            .flatten()
            .map(|law| {
                let (normal, tangential) = law.springs.stiffness(0.01 * radius, radius);
                normal.max(if law.has_friction() { tangential } else { 0.0 })
            })
            .fold(0.0, f64::max);
        2.0 * (mass / stiffness).sqrt()
    }
}
