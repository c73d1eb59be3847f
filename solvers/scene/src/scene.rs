//! Resolved scene, with every grain, wall and contact law in SI units. All values are checked. Solvers read only this
//! scene, not the scene file.

pub use crate::body::Block;
use crate::body::Start;
use crate::columns::{Chosen, Columns};
use crate::contact_law::ContactLaw;
use crate::dimension::{Dimension, GrainShape};
use crate::end_state::Springs;
pub use crate::file::Piston;
pub use crate::grain::{Grain, Grains};
use crate::material::Deformable;
use crate::mesh::Mesh;
use crate::motion::{Displacement, Motion};
use crate::stays::Stays;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;
use std::sync::Arc;

/// Initial shape of a wall.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// Half-space behind the plane through `point` with unit `normal`.
    Plane {
        /// Point on the plane (m).
        point: Vector3<f64>,
        /// Unit vector out of the solid.
        normal: Vector3<f64>,
    },
    /// Segment between two points (m), in two dimensions.
    Segment {
        /// Ends of the segment (m).
        ends: [Vector3<f64>; 2],
    },
    /// Rectangle, in three dimensions.
    Rectangle {
        /// Corner (m).
        corner: Vector3<f64>,
        /// Perpendicular edges from the corner (m).
        edges: [Vector3<f64>; 2],
    },
    /// Lateral surface of a cylinder or a truncated cone, in three dimensions.
    Round {
        /// Ends of the axis (m).
        axis: [Vector3<f64>; 2],
        /// Radius at each end (m).
        radii: [f64; 2],
    },
    /// Surface of triangles, in three dimensions.
    Mesh(Mesh),
}

impl WallShape {
    /// Returns the shape after a displacement of its wall.
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

    /// Returns the reference points of the shape, and true for a plane.
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

/// Returns a unit vector perpendicular to a direction. If the direction is parallel to an axis, the result is parallel
/// to another axis.
pub(crate) fn across(direction: Vector3<f64>) -> Vector3<f64> {
    let least = (0..3).min_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs())).unwrap_or(0);
    let axis = Vector3::ith(least, 1.0);
    (axis - direction * (direction.dot(&axis) / direction.norm_squared())).normalize()
}

/// Wall with its prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Name in the file.
    pub name: String,
    /// Index in [`Scene::materials`].
    pub material: u16,
    /// Initial shape.
    pub shape: WallShape,
    /// Prescribed motion.
    pub motion: Motion,
    /// Piston that presses the wall; `None` if the wall has no piston.
    pub piston: Option<Piston>,
    /// Time at which the wall is removed (s); `None` if it is never removed.
    pub until: Option<f64>,
}

/// Group of grains with prescribed motion, which forces do not change. The motion is the sum of a constant velocity, a
/// constant spin and a further motion.
#[derive(Clone, PartialEq)]
pub struct Driven {
    /// Name in the file.
    pub name: String,
    /// Indices in [`Scene::grains`].
    pub grains: Vec<usize>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Start and end of the prescribed motion (s). Outside this span, the grains move freely.
    pub span: [f64; 2],
    /// Angular velocity of each grain about its own centre (rad/s).
    pub spin: Vector3<f64>,
    /// Further motion, without rotation, in addition to `velocity`.
    pub motion: Motion,
}

/// Prints spin and motion only if they are not zero, so that fingerprints of scenes without them stay the same.
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
    /// Time span of the whole run (s).
    pub const ALWAYS: [f64; 2] = [0.0, f64::INFINITY];

    /// Returns true if the motion is prescribed over the step that begins at a time (s). Apart from rounding, a step
    /// that begins at the start of the motion is included, and a step that begins at its end is not.
    #[must_use]
    pub fn is_moved_at(&self, time: f64) -> bool {
        let [start, stop] = self.span.map(|moment| moment * (1.0 - 1e-9));
        (start..stop).contains(&time)
    }

    /// Returns the mean velocity (m/s) over the step that begins at a time (s): displacement divided by time step (s).
    #[must_use]
    pub fn velocity_over(&self, time: f64, time_step: f64) -> Vector3<f64> {
        if self.motion.is_empty() {
            return self.velocity;
        }
        let at = |time: f64| self.motion.displacement(time, time_step).translation;
        self.velocity + (at(time + time_step) - at(time)) / time_step
    }

    /// Returns the velocity (m/s) at a time (s): the mean of the velocities over the steps before and after this time.
    #[must_use]
    pub fn velocity_at(&self, time: f64, time_step: f64) -> Vector3<f64> {
        if self.motion.is_empty() {
            return self.velocity;
        }
        let before = if time > 0.0 { time - time_step } else { time };
        (self.velocity_over(before, time_step) + self.velocity_over(time, time_step)) * 0.5
    }

    /// Returns an upper bound of the speed (m/s).
    #[must_use]
    pub fn fastest(&self) -> f64 {
        self.velocity.norm() + self.motion.fastest()
    }

    /// Returns true if the motion is prescribed for only a part of the run.
    #[must_use]
    pub fn is_for_a_while(&self) -> bool {
        self.span != Self::ALWAYS
    }
}

/// Duration of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Duration {
    /// Time (s).
    Seconds(f64),
    /// Number of calculation cycles.
    Cycles(u64),
}

impl Duration {
    /// Returns the time (s); `None` for cycles.
    #[must_use]
    pub const fn seconds(self) -> Option<f64> {
        if let Self::Seconds(seconds) = self { Some(seconds) } else { None }
    }
}

/// Sampling interval of the probes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// Interval (s), rounded to whole cycles.
    Seconds(f64),
    /// Interval in cycles.
    Cycles(u64),
    /// Number of samples over the run.
    Count(u64),
}

/// Object whose quantities a probe records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProbeTarget {
    /// Grain, by index in [`Scene::grains`].
    Grain(usize),
    /// Body other than a grain, by index in [`Scene::bodies`].
    Body(usize),
    /// Material at a position, by index in [`Scene::spots`].
    Point(usize),
    /// Contact between two grains, by index in [`Scene::grains`].
    Pair(usize, usize),
    /// Contact between a grain and a wall, by index in [`Scene::grains`] and in [`Scene::walls`].
    GrainWall(usize, usize),
    /// Wall, by index in [`Scene::walls`].
    Wall(usize),
    /// Displacement of a wall with a piston, by index in [`Scene::walls`].
    Piston(usize),
    /// Group of grains with prescribed motion, by index in [`Scene::driven`].
    Driven(usize),
    /// Energy budget.
    Budget,
    /// Mean stress and coordination number of the grains.
    Stress,
    /// Number of grains.
    Count,
    /// Whole system.
    System,
}

/// Position in the material of a grain or other body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Body that contains the position.
    pub body: BodyName,
    /// Initial position (m).
    pub at: Vector3<f64>,
}

/// Grain or other body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyName {
    /// Grain, by index in [`Scene::grains`].
    Grain(usize),
    /// Other body, by index in [`Scene::bodies`].
    Body(usize),
}

/// Probe: a named time series.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name. Columns are called `name.quantity`.
    pub name: String,
    /// Object whose quantities are recorded.
    pub target: ProbeTarget,
}

/// Domain of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(description = "Box of a scene.")]
pub struct Domain {
    /// Lower corner (m); z is −0.5 in two dimensions.
    #[schemars(with = "[f64; 3]", description = "Lower corner (m).")]
    pub low: Vector3<f64>,
    /// Upper corner (m); z is 0.5 in two dimensions.
    #[schemars(with = "[f64; 3]", description = "Upper corner (m).")]
    pub high: Vector3<f64>,
    /// True for each periodic axis.
    pub periodic: [bool; 3],
}

/// Resolved scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Title, for reports.
    pub title: String,
    /// Number of dimensions.
    pub dimension: Dimension,
    /// Shape of the grains.
    pub grain_shape: GrainShape,
    /// Gravity (m/s²).
    pub gravity: Vector3<f64>,
    /// Domain, if one is given.
    pub domain: Option<Domain>,
    /// Global mass-proportional damping α (1/s).
    pub global_damping: f64,
    /// Duration of the run.
    pub duration: Duration,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Table of contact laws for all pairs of materials, row by row; [`Scene::law`] reads it.
    pub laws: Vec<Option<ContactLaw>>,
    /// Properties of deformable materials, in the order of `materials`; `None` if the scene gives none.
    pub deformable: Vec<Option<Deformable>>,
    /// Grains. The id of a grain is its index plus one.
    pub grains: Grains,
    /// Initial contact history; absent if there is none.
    pub springs: Option<Arc<Springs>>,
    /// Insertion and removal of grains.
    pub stays: Stays,
    /// Deformable bodies other than grains.
    pub bodies: Vec<Block>,
    /// Initial conditions of deformable bodies.
    pub start: Start,
    /// Reference length (m) for the cell size of solvers with a grid.
    pub reference_length: f64,
    /// Walls in the order of the scene file.
    pub walls: Vec<Wall>,
    /// Groups of grains with prescribed motion.
    pub driven: Vec<Driven>,
    /// Sampling interval of the probes.
    pub sampling: Sampling,
    /// Number of snapshots between the first and the last.
    pub snapshots: u32,
    /// Times of further snapshots (s).
    pub snapshot_times: Vec<f64>,
    /// True if external solvers also write the contacts between grains to snapshots.
    pub snapshot_contacts: bool,
    /// Contents of snapshots.
    pub columns: Columns,
    /// Named time series.
    pub probes: Vec<Probe>,
    /// Positions to which [`ProbeTarget::Point`] refers.
    pub spots: Vec<Spot>,
}

impl Scene {
    /// Returns the largest stable time step (s) on a grid with cells of length h = `cell` (m). It is the smallest one
    /// of the materials of all grains and bodies, and infinite if no material is deformable.
    ///
    /// Without viscosity, it is the time h/c in which a longitudinal wave crosses a cell, with c = √(M/ρ) and M = K +
    /// 4G/3. A viscosity η_L = 4η/3 + ζ reduces it, because viscous forces depend on the velocities of the previous
    /// step. Central differences of ẍ + 2ξωẋ + ω²x = 0, with the second term from the previous step, are stable up to
    /// the time step (2/ω)(√(1 + ξ²) − ξ) (Belytschko, Liu & Moran, *Nonlinear Finite Elements*, 2000, section 6.2).
    /// The shortest wave of a grid has ω = 2c/h and ξ = η_L/(ρ c h).
    #[must_use]
    pub fn crossing_time(&self, cell: f64) -> f64 {
        let material_time = |material: u16, density: f64| {
            let deformable = self.deformable.get(usize::from(material)).copied().flatten();
            deformable.map_or(f64::INFINITY, |deformable| {
                let (modulus, viscosity) = (deformable.longitudinal_modulus(), deformable.longitudinal_viscosity());
                crossing_time(modulus, viscosity, density, cell)
            })
        };
        let volume = |radius: f64| self.grain_shape.mass(radius, 1.0);
        let grains = self.grains.iter().map(|grain| material_time(grain.material, grain.mass / volume(grain.radius)));
        let bodies = self.bodies.iter().map(|body| material_time(body.material, body.density));
        grains.chain(bodies).fold(f64::INFINITY, f64::min)
    }

    /// Returns, for each grain, the index of its group in [`Scene::driven`]; `None` for grains that always move freely.
    #[must_use]
    pub fn driven_group_of_grains(&self) -> Vec<Option<u16>> {
        let mut group_of = vec![None; self.grains.len()];
        for (place, driven) in self.driven.iter().enumerate() {
            driven.grains.iter().for_each(|&grain| group_of[grain] = Some(place as u16));
        }
        group_of
    }

    /// Returns true if a probe requests the energy budget.
    #[must_use]
    pub fn asks_for_budget(&self) -> bool {
        self.probes.iter().any(|probe| probe.target == ProbeTarget::Budget)
    }

    /// Returns the law between two materials; `None` if the scene has none.
    #[must_use]
    pub fn law(&self, a: u16, b: u16) -> Option<&ContactLaw> {
        self.laws[usize::from(a) * self.materials.len() + usize::from(b)].as_ref()
    }

    /// Returns a description of a feature that not every solver supports; `None` if the scene has none. These features
    /// are insertion and removal of grains, pistons, motion of grains that is prescribed for only a part of the run,
    /// initial contact history, and removal of walls.
    #[must_use]
    pub fn passing(&self) -> Option<&'static str> {
        let is_driven_for_a_while = self.driven.iter().any(Driven::is_for_a_while);
        let features = [
            (!self.stays.entries.is_empty(), "grains that are poured"),
            (self.stays.removal.is_some(), "grains that are removed"),
            (self.walls.iter().any(|wall| wall.piston.is_some()), "a piston"),
            (is_driven_for_a_while, "grains that are driven for a part of the run (`driven.….start`, `stop`)"),
            (
                self.springs.is_some(),
                "contacts with springs at the start (`springs = false` next to the state omits them)",
            ),
            (self.walls.iter().any(|wall| wall.until.is_some()), "walls that are removed"),
        ];
        features.into_iter().find_map(|(is_used, words)| is_used.then_some(words))
    }

    /// Returns a description of a snapshot quantity that is an average over time; `None` if the scene requests none.
    /// Not every solver computes it.
    #[must_use]
    pub fn gathered(&self) -> Option<&'static str> {
        self.columns.has(Chosen::MeanVirial).then_some("a mean over time in its snapshots (`mean-virial`)")
    }

    /// Returns a description of the first cylindrical or conical wall; `None` if there is none. Not every solver
    /// supports these walls.
    #[must_use]
    pub fn round_wall(&self) -> Option<String> {
        let round = self.walls.iter().find(|wall| matches!(wall.shape, WallShape::Round { .. }))?;
        Some(format!("wall `{}` is the side of a cylinder or a cone", round.name))
    }

    /// Returns a description of the first wall of triangles; `None` if there is none. Not every solver supports these
    /// walls.
    #[must_use]
    pub fn mesh_wall(&self) -> Option<String> {
        let mesh = self.walls.iter().find(|wall| matches!(wall.shape, WallShape::Mesh(_)))?;
        Some(format!("wall `{}` is a mesh of triangles", mesh.name))
    }

    /// Returns a description of a feature that needs a solver for deformable bodies; `None` if there is none.
    #[must_use]
    pub fn needs_deformable(&self) -> Option<&'static str> {
        if !self.bodies.is_empty() {
            return Some("bodies that are not grains");
        }
        if !self.spots.is_empty() {
            return Some("probes of the material inside grains");
        }
        self.start.needs_deformable()
    }

    /// Applies a change to every contact law.
    pub fn change_laws(&mut self, change: impl Fn(&mut ContactLaw)) {
        self.laws.iter_mut().flatten().for_each(change);
    }

    /// Returns true if any axis is periodic.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.domain.is_some_and(|domain| domain.periodic.contains(&true))
    }

    /// Returns the critical time step `2√(m_min/k_max)` of a mass on a spring to ground (s), from the smallest mass and
    /// the largest normal or tangential stiffness (Cundall & Strack 1979, p. 53). It is an estimate. Simulations of
    /// many grains need a fraction of it, which the user chooses. The stiffness of a Hertz contact is taken at an
    /// overlap of 0.01 of the largest radius. Without springs, the result is infinite.
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

    /// Returns true if a time step (s) is at or above the critical one. Central differences are stable only below it.
    #[must_use]
    pub fn is_unstable_at(&self, time_step: f64) -> bool {
        let critical = self.critical_time_step();
        time_step >= critical && critical.is_finite()
    }
}

/// Returns the largest stable time step (s) of [`Scene::crossing_time`] for a material with a longitudinal modulus (Pa), a
/// longitudinal viscosity (Pa s) and a density (kg/m³).
#[must_use]
pub fn crossing_time(modulus: f64, viscosity: f64, density: f64, cell: f64) -> f64 {
    let speed = (modulus / density).sqrt();
    let damping = viscosity / (density * speed * cell);
    cell / speed * ((1.0 + damping * damping).sqrt() - damping)
}
