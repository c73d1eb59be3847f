//! Moving walls, with their position at a step, their motion over the step, and nearby grains.

use crate::contact::{MEMORY, Memory};
use crate::geometry::Geometry;
use crate::grains::{ABSENT, Grains};
use crate::meshes::MeshContacts;
use grainbench_scene::mesh::{Mesh, SphereContact};
use grainbench_scene::motion::Displacement;
use grainbench_scene::overlap::{nearest_on_rectangle, nearest_on_round, nearest_on_segment};
use grainbench_scene::scene::{Piston, Wall, WallShape};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Wall with its present position, its motion over the last step, and nearby grains.
#[derive(Clone, Debug)]
pub(crate) struct MovingWall {
    /// Wall of the scene, at its initial position.
    pub(crate) initial: Wall,
    /// Shape at the present position.
    pub(crate) shape: WallShape,
    centre: Vector3<f64>,
    /// Mean velocity of the centre over the last step (m/s).
    pub(crate) velocity: Vector3<f64>,
    /// Angular velocity about the centre over the last step (rad/s).
    pub(crate) spin: Vector3<f64>,
    /// True if velocities of wall points are means over the last step; false if they are velocities at the end of the step.
    mid_step: bool,
    /// Factors c₁ (dimensionless) and c₂ (s) of the velocity V + c₁ Ω×r − c₂ Ω×(Ω×r) of a point at r from the centre,
    /// with velocity V of the centre and angular velocity Ω.
    swing: [f64; 2],
    /// True for each entry of `near` whose contact belongs to a joined wall; empty without joints.
    pub(crate) covered: Vec<bool>,
    /// State between two steps.
    pub(crate) kept: WallMemory,
}

/// State of a wall between two steps. All other data of the wall follow from its prescribed motion.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct WallMemory {
    displacement: Displacement,
    at_list: Displacement,
    /// Slots of the grains near the wall, with contact history.
    pub(crate) near: Vec<(u32, Memory<f64>)>,
    /// Nearby grains and contacts of a mesh. A mesh uses them instead of `near`.
    pub(crate) at_mesh: MeshContacts,
    /// Force of the grains on the wall in the last force evaluation (N).
    pub(crate) force: Vector3<f64>,
    /// For a piston: displacement along its normal (m), and speed half a step earlier (m/s).
    pressed: [f64; 2],
    /// True if the wall has been removed.
    pub(crate) gone: bool,
}

impl WallMemory {
    /// Returns true if the state fits this wall and the number of grains.
    pub(crate) fn is_of(&self, grains: usize, wall: &MovingWall) -> bool {
        let of_mesh = match wall.mesh() {
            Some(mesh) => self.near.is_empty() && self.at_mesh.is_of(grains, mesh),
            None => self.at_mesh.is_empty(),
        };
        of_mesh && self.near.iter().all(|&(slot, _)| (slot as usize) < grains)
    }
}

/// View from a grain to the nearest point of a wall: direction, distance, and velocity of the point.
pub(crate) struct WallView {
    /// Unit vector from the grain to the wall.
    pub(crate) normal: Vector3<f64>,
    /// Distance from the grain's centre to the wall (m), negative inside the solid of a plane.
    pub(crate) distance: f64,
    /// Velocity of the wall at the nearest point (m/s).
    pub(crate) velocity: Vector3<f64>,
}

impl MovingWall {
    /// Creates the wall at its initial position. With `mid_step`, velocities of wall points are means over a step,
    /// otherwise velocities at the end of the step.
    pub(crate) fn new(wall: &Wall, mid_step: bool) -> Self {
        Self {
            shape: wall.shape.clone(),
            centre: wall.motion.centre,
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            mid_step,
            swing: [1.0, 0.0],
            covered: Vec::new(),
            kept: WallMemory::default(),
            initial: wall.clone(),
        }
    }

    /// Returns the mesh; `None` if the wall is not a mesh.
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        if let WallShape::Mesh(mesh) = &self.shape { Some(mesh) } else { None }
    }

    /// Returns the number of listed pairs of a grain and the wall, or of a grain and a triangle.
    pub(crate) fn pairs(&self) -> usize {
        self.kept.near.len() + self.kept.at_mesh.triangles.len()
    }

    /// Clears the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.kept.near.iter_mut().for_each(|(_, memory)| *memory = [0.0; MEMORY]);
        self.kept.at_mesh.held.clear();
    }

    /// Restores the state between two steps.
    pub(crate) fn recall(&mut self, memory: WallMemory) {
        if self.kept.displacement != memory.displacement {
            self.displaced_to(memory.displacement);
        }
        self.kept = memory;
    }

    /// Removes the wall if `time` (s) has reached its removal time. Returns true if this call removes it.
    pub(crate) fn take_away(&mut self, time: f64) -> bool {
        let now = !self.kept.gone && self.initial.until.is_some_and(|until| time >= until * (1.0 - 1e-9));
        self.kept.gone |= now;
        now
    }

    /// Returns the data of a piston: its parameters, its acceleration along the normal due to the piston force and the
    /// grains (m/s²), and its normal. Returns `None` for a wall without piston.
    fn pressure(&self) -> Option<(Piston, f64, Vector3<f64>)> {
        let (Some(piston), WallShape::Plane { normal, .. }) = (self.initial.piston, &self.shape) else { return None };
        Some((piston, (piston.force + self.kept.force.dot(normal)) / piston.mass, *normal))
    }

    /// Sets the speed of a piston to its value half a step before the start. A piston is at rest at the start.
    pub(crate) fn step_back_half(&mut self, time_step: f64) {
        if let Some((_, acceleration, _)) = self.pressure() {
            self.kept.pressed[1] = -0.5 * acceleration * time_step;
        }
    }

    /// Moves the wall to its position at `time` (s), over one step. The motion of a piston is integrated like that of a
    /// grain, with the force of the grains in the last force evaluation.
    pub(crate) fn move_to(&mut self, time: f64, time_step: f64) {
        let motion = &self.initial.motion;
        let pressure = self.pressure();
        if !motion.is_moving() && pressure.is_none() {
            return;
        }
        let mut now = motion.displacement(time, time_step);
        if let Some((piston, acceleration, normal)) = pressure {
            let half = 0.5 * piston.damping * time_step;
            let [way, speed] = &mut self.kept.pressed;
            *speed = (*speed * (1.0 - half) + acceleration * time_step) / (1.0 + half);
            *way += *speed * time_step;
            now.translation += normal * *way;
        }
        self.velocity = (now.translation - self.kept.displacement.translation) / time_step;
        self.spin = (now.rotation - self.kept.displacement.rotation) / time_step;
        self.swing = swing(self.spin.norm() * time_step, time_step, self.mid_step);
        self.displaced_to(now);
    }

    fn displaced_to(&mut self, displacement: Displacement) {
        let motion = &self.initial.motion;
        self.kept.displacement = displacement;
        self.centre = motion.centre + displacement.translation;
        self.shape = self.initial.shape.moved(motion, &displacement);
    }

    /// Returns an upper bound of the displacement since the neighbour list was built (m), for points within `extent` (m) of
    /// the centre of rotation.
    pub(crate) fn moved_since_list(&self, extent: f64) -> f64 {
        let translation = (self.kept.displacement.translation - self.kept.at_list.translation).norm();
        translation + (self.kept.displacement.rotation - self.kept.at_list.rotation).norm() * extent
    }

    /// Starts a new list of nearby grains at the present position.
    pub(crate) fn begin_list(&mut self) {
        self.kept.at_list = self.kept.displacement;
        self.kept.near.clear();
    }

    /// Lists the triangles near each grain, and moves the contacts of the last force evaluation to the new slots of their
    /// grains. `ids` holds the id of the grain in each old slot. Returns false if the wall is not a mesh.
    pub(crate) fn list_triangles<S: Geometry>(&mut self, grains: &Grains<S>, ids: &[u32], skin: f64) -> bool {
        if self.mesh().is_none() {
            return false;
        }
        self.begin_list();
        let mut held = self.kept.at_mesh.begin_list();
        let WallShape::Mesh(mesh) = &self.shape else { return false };
        if self.kept.gone {
            return true;
        }
        for slot in 0..grains.len() {
            self.kept.at_mesh.list(mesh, slot, grains.position(slot), grains.radius(slot) + skin);
        }
        held.retain_mut(|held| {
            let id = ids[held.slot as usize];
            held.slot = grains.slot[id as usize];
            held.slot != ABSENT
        });
        // The sort is stable, so contacts of a grain keep their order.
        held.sort_by_key(|held| held.slot);
        self.kept.at_mesh.held = held;
        true
    }

    /// Returns the slot of each nearby grain and its distance from the wall (m). For a mesh, it returns the grains in
    /// contact in the last force evaluation.
    pub(crate) fn distances<S: Geometry>(&self, grains: &Grains<S>) -> impl Iterator<Item = (usize, f64)> {
        let near = self.kept.near.iter().map(|&(slot, _)| {
            let slot = slot as usize;
            (slot, self.facing(grains.position(slot)).distance)
        });
        let held = self.mesh().into_iter().flat_map(move |mesh| {
            self.kept.at_mesh.held.iter().map(move |held| {
                let slot = held.slot as usize;
                (slot, (mesh.within(grains.position(slot)) - held.point).norm())
            })
        });
        near.chain(held)
    }

    /// Returns the distance from a point to the wall's centre of rotation (m).
    pub(crate) fn distance_to_centre(&self, point: Vector3<f64>) -> f64 {
        (point - self.centre).norm()
    }

    /// Returns direction, distance and velocity of the point of the wall nearest to a grain whose centre is at `at` (m).
    #[inline(always)]
    pub(crate) fn facing(&self, at: Vector3<f64>) -> WallView {
        let (nearest, normal, distance) = match &self.shape {
            WallShape::Plane { point, normal } => {
                let distance = (at - point).dot(normal);
                (at - normal * distance, -normal, distance)
            }
            WallShape::Segment { ends } => facing_point(at, nearest_on_segment(at, ends)),
            WallShape::Rectangle { corner, edges } => facing_point(at, nearest_on_rectangle(at, corner, edges)),
            WallShape::Round { axis, radii } => facing_point(at, nearest_on_round(at, axis, radii)),
            WallShape::Mesh(mesh) => facing_point(at, mesh.nearest(at)),
        };
        WallView { normal, distance, velocity: self.velocity_at(nearest) }
    }

    /// Returns direction, distance and velocity of the contact point `touched` on a mesh, for a grain whose centre is at
    /// `at` (m).
    pub(crate) fn facing_part(&self, mesh: &Mesh, at: Vector3<f64>, touched: &SphereContact) -> WallView {
        let normal = mesh.turn * touched.direction;
        WallView { normal, distance: touched.distance, velocity: self.velocity_at(at + normal * touched.distance) }
    }

    /// Returns the velocity at a point of the wall (m/s).
    #[inline(always)]
    fn velocity_at(&self, point: Vector3<f64>) -> Vector3<f64> {
        if self.spin == Vector3::zeros() {
            return self.velocity;
        }
        let [turning, inward] = self.swing;
        let around = self.spin.cross(&(point - self.centre));
        self.velocity + around * turning - self.spin.cross(&around) * inward
    }
}

/// Returns the factors c₁ = sin θ/θ and c₂ = Δt (1 − cos θ)/θ² (s) of the mean velocity of a wall point. θ (rad) is the
/// angle by which the wall rotates in a step Δt (s). The mean velocity is (r − r₀)/Δt. The vector r₀ = r − sin θ n×r + (1
/// − cos θ) n×(n×r) is r rotated back by θ about n. Without `mid_step`, c₁ = 1 and c₂ = 0.
fn swing(angle: f64, time_step: f64, mid_step: bool) -> [f64; 2] {
    if !mid_step || angle == 0.0 {
        return [1.0, 0.0];
    }
    let (sine, half) = (libm::sin(angle), libm::sin(0.5 * angle));
    [sine / angle, 2.0 * half * half / (angle * angle) * time_step]
}

fn facing_point(at: Vector3<f64>, nearest: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>, f64) {
    let to_wall = nearest - at;
    let distance = to_wall.norm();
    (nearest, to_wall / distance, distance)
}
