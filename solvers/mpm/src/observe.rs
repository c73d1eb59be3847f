//! Output of a simulation at a step: bodies, contacts, material points and energies.

use crate::contact::{ContactPartner, ContactPoint};
use crate::energy::accounts::Accounts;
use crate::material::stress::embed_deformation;
use crate::material::{self, Law, with_law};
use crate::points::body::Body;
use crate::simulation::Simulation;
use grainbench_scene::scene::{BodyName, WallShape};
use grainbench_solver::record::{
    BodyState, ContactState, GrainState, Owner, Partner, PointState, Snapshot, StepState, WallState, nearest_turn,
};
use grainbench_solver::space::Space;
use nalgebra::{Matrix3, Vector3};

/// Motion and moments of a whole body.
struct WholeBodyMotion {
    mass: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    /// Angular momentum about the centre of mass (kg m²/s).
    angular_momentum: Vector3<f64>,
    /// Angular velocity ω of a rigid body with the same angular momentum L, from I ω = L (rad/s).
    spin: Vector3<f64>,
    /// Moment of inertia about the centre of mass, averaged over the possible axes of rotation (kg m²).
    inertia: f64,
    /// Kinetic energy of all points (J).
    kinetic: f64,
    angle: f64,
    /// Mass-weighted mean of the equivalent plastic strain.
    plastic_strain: f64,
}

impl<S: Space> Simulation<S> {
    /// Returns the state at this step. With `with_points`, it includes every material point.
    pub(crate) fn observed(&mut self, with_points: bool) -> StepState {
        let wholes: Vec<WholeBodyMotion> = (0..self.state.bodies.len()).map(|body| self.whole(body)).collect();
        let mut elastic_energy = 0.0;
        let mut inner_kinetic_energy = 0.0;
        let (mut uneven_rotational_energy, mut uneven_angular_momentum) = (0.0, Vector3::zeros());
        let (mut grains, mut bodies) = (Vec::new(), Vec::new());
        let forces = self.forces(&wholes);
        for ((body, whole), (force, torque)) in self.state.bodies.iter().zip(wholes).zip(forces) {
            elastic_energy += self.elastic_energy(body);
            let WholeBodyMotion { mass, position, velocity, spin, mut inertia, angle, plastic_strain, .. } = whole;
            match body.owner {
                Owner::Grain(id) => {
                    let grain = &self.scene.grains[id as usize - 1];
                    inertia = grain.inertia;
                    grains.push(GrainState {
                        position: self.inside(position),
                        velocity,
                        spin,
                        angle: (S::DIMENSION == 2).then_some(angle),
                        force: Some(force),
                        torque: Some(torque),
                        plastic_strain,
                        ..GrainState::start(id, grain)
                    });
                }
                Owner::Body(at) => {
                    let name = self.scene.bodies[at as usize].name.clone();
                    bodies.push(BodyState { name, mass, inertia, position, velocity, spin, angle, force });
                }
            }
            let turning = spin.dot(&whole.angular_momentum);
            let rigid = mass * velocity.norm_squared() + turning;
            inner_kinetic_energy += whole.kinetic - 0.5 * rigid;
            uneven_rotational_energy += 0.5 * (turning - inertia * spin.norm_squared());
            uneven_angular_momentum += whole.angular_momentum - spin * inertia;
        }
        let points = if with_points {
            self.state.bodies.iter().flat_map(|body| body.points.clone().map(|at| self.point(body, at))).collect()
        } else {
            Vec::new()
        };
        let (time, walls) = (self.step as f64 * self.scheme.time_step, self.wall_states());
        let rigid = Snapshot::new(&self.scene, self.step, time, grains, walls, Some(self.contacts()));
        let springs: f64 = self.contacts.touches.iter().map(|touch| touch.energy).sum();
        let Self { scene, scheme, state, grid, .. } = &*self;
        let budget = |accounts: &Accounts<S>| {
            accounts.budget(&scheme.setting, scene.gravity, state, &grid.lattice, elastic_energy)
        };
        StepState {
            inner_kinetic_energy,
            uneven_rotational_energy,
            uneven_angular_momentum,
            spots: self.spots(),
            driven: self.boundary.driven.groups.iter().map(|group| S::embed(group.contact_force())).collect(),
            budget: self.accounts.as_ref().map(budget),
            ..StepState::of_rigid(Snapshot { bodies, points, ..rigid }, elastic_energy + springs)
        }
    }

    /// Returns the resultant contact force (N) and torque (N m) on each body.
    fn forces(&self, wholes: &[WholeBodyMotion]) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let mut sums = vec![(Vector3::zeros(), Vector3::zeros()); wholes.len()];
        for touch in &self.contacts.touches {
            let mut push = |body: u32, force: Vector3<f64>| {
                let arm = S::embed(touch.point) - wholes[body as usize].position;
                let (forces, torques) = &mut sums[body as usize];
                *forces += force;
                *torques += arm.cross(&force);
            };
            let force = S::embed(touch.push + touch.shear);
            push(touch.body, force);
            if let ContactPartner::Body(other) = touch.other {
                push(other, -force);
            }
        }
        sums
    }

    /// Wraps a position into the domain along periodic axes.
    fn inside(&self, mut position: Vector3<f64>) -> Vector3<f64> {
        if let Some(domain) = self.scene.domain {
            for axis in (0..3).filter(|&axis| domain.periodic[axis]) {
                let length = domain.high[axis] - domain.low[axis];
                position[axis] = domain.low[axis] + (position[axis] - domain.low[axis]).rem_euclid(length);
            }
        }
        position
    }

    fn whole(&mut self, body: usize) -> WholeBodyMotion {
        let points = &self.state.points;
        let range = self.state.bodies[body].points.clone();
        let (mass, position) = points.centre_of_mass(range.clone());
        let momentum: Vector3<f64> = range.clone().map(|at| self.velocity(at) * points.mass[at]).sum();
        let velocity = momentum / mass;
        let (mut angular, mut inertia, mut kinetic) = (Vector3::zeros(), Matrix3::zeros(), 0.0);
        let mut flowed = 0.0;
        let mut mean = Matrix3::zeros();
        for at in range {
            let arm = S::embed(points.position[at]) - position;
            let own = self.velocity(at);
            let share = points.mass[at];
            angular += arm.cross(&own) * share;
            inertia += (Matrix3::from_diagonal_element(arm.norm_squared()) - arm * arm.transpose()) * share;
            kinetic += 0.5 * share * own.norm_squared();
            flowed += points.plastic_strain_of(at) * share;
            mean += S::embed_gradient(points.deformation[at]) * share;
        }
        let (spin, inertia) = if S::DIMENSION == 2 {
            (Vector3::new(0.0, 0.0, angular.z / inertia.m33), inertia.m33)
        } else {
            (inertia.try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * angular), inertia.trace() / 3.0)
        };
        let angle = if S::DIMENSION == 2 {
            // The deformation gives the angle up to full turns. The result is the angle nearest to the previous angle
            // plus spin times elapsed time.
            let expected =
                self.state.bodies[body].angle + spin.z * self.scheme.time_step * (self.step - self.looked) as f64;
            nearest_turn(rotation_of(mean), expected)
        } else {
            0.0
        };
        self.state.bodies[body].angle = angle;
        if body + 1 == self.state.bodies.len() {
            self.looked = self.step;
        }
        let (angular_momentum, plastic_strain) = (angular, flowed / mass);
        WholeBodyMotion { mass, position, velocity, angular_momentum, spin, inertia, kinetic, angle, plastic_strain }
    }

    /// Returns the velocity of a point at the time of the observation, half a step later than its stored velocity.
    fn velocity(&self, at: usize) -> Vector3<f64> {
        let now = self.state.points.velocity[at];
        S::embed(now + (now - self.state.before[at]) * 0.5)
    }

    fn state_of(&self, at: usize) -> material::State {
        material::State {
            deformation: embed_deformation::<S>(self.state.points.deformation[at]),
            stress: S::embed_symmetric(self.state.points.stress[at]),
            plastic_strain: self.state.points.plastic_strain_of(at),
        }
    }

    pub(crate) fn elastic_energy(&self, body: &Body) -> f64 {
        let range = body.points.clone();
        with_law!(&body.law, law => range.map(|at| self.state.points.reference_volume[at] * law.energy(&self.state_of(at))).sum())
    }

    fn point(&self, body: &Body, at: usize) -> PointState {
        let points = &self.state.points;
        let stress = S::embed_symmetric(points.stress[at]);
        PointState {
            owner: body.owner,
            position: S::embed(points.position[at]),
            displacement: S::embed(points.position[at] - points.start[at]),
            velocity: self.velocity(at),
            stress: [stress.m11, stress.m22, stress.m33, stress.m12, stress.m23, stress.m31],
            plastic_strain: points.plastic_strain_of(at),
            rotation: if S::DIMENSION == 2 {
                nearest_turn(rotation_of(S::embed_gradient(points.deformation[at])), body.angle)
            } else {
                0.0
            },
            volume: points.volume[at],
        }
    }

    /// Returns the state at each spot: the mean over the points that were nearest to the spot at the start.
    fn spots(&self) -> Vec<PointState> {
        let mut spots = Vec::with_capacity(self.scene.spots.len());
        for spot in &self.scene.spots {
            let owner = match spot.body {
                BodyName::Grain(grain) => Owner::Grain(grain as u32 + 1),
                BodyName::Body(body) => Owner::Body(body as u32),
            };
            let Some(body) = self.state.bodies.iter().find(|body| body.owner == owner) else { continue };
            let away = |at: usize| (S::embed(self.state.points.start[at]) - spot.at).norm();
            let nearest = body.points.clone().map(away).fold(f64::INFINITY, f64::min);
            let reach = nearest + 1e-6 * self.grid.lattice.shortest(S::DIMENSION);
            let mut found: Vec<(u32, PointState)> = body
                .points
                .clone()
                .filter(|&at| away(at) <= reach)
                .map(|at| (self.state.points.id[at], self.point(body, at)))
                .collect();
            // The points are sorted by id, so that the result does not depend on their current order.
            found.sort_by_key(|(id, _)| *id);
            spots.extend(mean(&found));
        }
        spots
    }

    fn wall_states(&self) -> Vec<WallState> {
        let walls = self.scene.walls.iter().zip(&self.boundary.walls);
        walls
            .map(|(wall, plane)| {
                let shape = WallShape::Plane { point: S::embed(plane.point), normal: S::embed(plane.normal) };
                let (corners, infinite) = shape.corners();
                WallState { name: wall.name.clone(), corners, infinite, force: Some(S::embed(plane.force)) }
            })
            .collect()
    }

    /// Returns one contact for each pair of a grain and another body or a wall. Its force is the sum of the forces on all
    /// tracers. It acts at the mean of their contact points, weighted by the normal forces.
    fn contacts(&self) -> Vec<ContactState> {
        let mut touches = self.contacts.touches.clone();
        for touch in &mut touches {
            if let ContactPartner::Body(other) = touch.other
                && other < touch.body
            {
                (touch.body, touch.other) = (other, ContactPartner::Body(touch.body));
                (touch.push, touch.shear) = (-touch.push, -touch.shear);
            }
        }
        touches.sort_by_key(|touch| (touch.body, touch.other));
        touches
            .chunk_by(|a, b| (a.body, a.other) == (b.body, b.other))
            .filter_map(|group| {
                let ContactPoint { body, other, .. } = group[0];
                let Owner::Grain(grain) = self.state.bodies[body as usize].owner else { return None };
                let partner = match other {
                    ContactPartner::Wall(wall) => Partner::Wall(wall),
                    ContactPartner::Body(body) => match self.state.bodies[body as usize].owner {
                        Owner::Grain(id) => Partner::Grain(id),
                        Owner::Body(place) => Partner::Body(place),
                    },
                };
                let size = |touch: &ContactPoint<S>| S::dot(touch.push, touch.push).sqrt();
                let total: f64 = group.iter().map(size).sum();
                let push: Vector3<f64> = group.iter().map(|touch| S::embed(touch.push)).sum();
                let shear = group.iter().map(|touch| S::embed(touch.shear)).sum();
                let point: Vector3<f64> = group.iter().map(|touch| S::embed(touch.point) * size(touch)).sum();
                let sliding: f64 = group.iter().filter(|touch| touch.slipping).map(size).sum();
                let normal_force = push.norm();
                (total > 0.0 && normal_force > 0.0).then(|| ContactState {
                    grain,
                    partner,
                    point: point / total,
                    normal: -push / normal_force,
                    overlap: group.iter().map(|touch| touch.depth).fold(0.0, f64::max),
                    normal_force,
                    shear_force: shear,
                    slipping: sliding > 0.5 * total,
                })
            })
            .collect()
    }
}

/// Returns the rotation about z (rad, from −π to π) of a deformation gradient in the plane, from R of F = R U.
fn rotation_of(deformation: Matrix3<f64>) -> f64 {
    libm::atan2(deformation.m21 - deformation.m12, deformation.m11 + deformation.m22)
}

/// Returns the mean of the states of several points, with the sum of their volumes; `None` without points.
fn mean(found: &[(u32, PointState)]) -> Option<PointState> {
    let mut all = found.iter().map(|(_, point)| *point);
    let first = all.next()?;
    let mut sum = all.fold(first, |mut sum, point| {
        sum.position += point.position;
        sum.displacement += point.displacement;
        sum.velocity += point.velocity;
        sum.stress.iter_mut().zip(point.stress).for_each(|(sum, stress)| *sum += stress);
        sum.plastic_strain += point.plastic_strain;
        sum.rotation += point.rotation;
        sum.volume += point.volume;
        sum
    });
    let share = 1.0 / found.len() as f64;
    sum.position *= share;
    sum.displacement *= share;
    sum.velocity *= share;
    sum.stress.iter_mut().for_each(|stress| *stress *= share);
    sum.plastic_strain *= share;
    sum.rotation *= share;
    Some(sum)
}
