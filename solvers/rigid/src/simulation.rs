//! Simulation of one scene. It steps an engine, moves walls, detects failures and reports the state.

use crate::engine::{Engine, GrainMotion, LoadedContact, Placement, Stepping};
use crate::pairs::Side;
use grainbench_scene::dimension::Dimension;
use grainbench_scene::overlap::distance;
use grainbench_scene::scene::{Scene, Wall, WallShape};
use grainbench_solver::drive::Stepper;
use grainbench_solver::failure::{Cause, FailedParticle, RunError, SimulationFailure};
use grainbench_solver::record::{
    ContactState, Counts, GrainState, Partner, Snapshot, StepState, WallState, nearest_turn,
};
use nalgebra::Vector3;

/// Fraction of the Coulomb limit from which a friction impulse counts as slipping.
const AT_LIMIT: f64 = 1.0 - 1e-9;

/// Largest rotation in a step (rad) of a grain that spins in place on a contact.
///
/// The engine rotates the contact points with the grain. Beyond this angle a part of the friction impulse is missing. A
/// disc that spins on a floor should reach the velocity μ g t. For spins of 100 to 31,600 rad/s, rapier gave half of
/// this velocity at .066 rad per step and more. At .02 rad per step and less it was right within 1 %.
const LARGEST_TURN: f64 = 0.05;
/// Ratio of surface speed to speed of the centre above which a grain counts as spinning in place.
const IN_PLACE: f64 = 10.0;

/// Scene, engine and current state of a run.
pub(crate) struct Simulation<'a> {
    scene: &'a Scene,
    stepping: Stepping,
    engine: Box<dyn Engine>,
    moving: Vec<usize>,
    state: Vec<GrainMotion>,
    /// Rotation in the plane since the start, including full turns (rad).
    angles: Vec<f64>,
    step: u64,
    /// Work counters since the start.
    cost: Counts,
}

impl<'a> Simulation<'a> {
    pub(crate) fn new(scene: &'a Scene, stepping: Stepping) -> Self {
        let engine: Box<dyn Engine> = match scene.dimension {
            Dimension::Two => Box::new(crate::plane::world::World::new(scene, &stepping)),
            Dimension::Three => Box::new(crate::solid::world::World::new(scene, &stepping)),
        };
        let state: Vec<GrainMotion> = (0..scene.grains.len()).map(|at| engine.grain(at)).collect();
        Self {
            scene,
            stepping,
            engine,
            moving: (0..scene.walls.len()).filter(|&at| scene.walls[at].motion.is_moving()).collect(),
            angles: vec![0.0; state.len()],
            state,
            step: 0,
            cost: Counts::default(),
        }
    }

    fn time(&self) -> f64 {
        self.step as f64 * self.stepping.time_step
    }

    /// Takes a step.
    ///
    /// # Errors
    /// When the state of a grain is not finite, or a grain moves so far that contacts may be missed. Also when a grain
    /// that spins in place on a contact rotates by more than [`LARGEST_TURN`].
    fn take_step(&mut self) -> Result<(), Box<SimulationFailure>> {
        self.step += 1;
        let time = self.time();
        let place = |&wall: &usize| {
            let motion = &self.scene.walls[wall].motion;
            let displacement = motion.displacement(time, self.stepping.time_step);
            Placement { wall, centre: motion.centre + displacement.translation, rotation: displacement.rotation }
        };
        let walls: Vec<Placement> = self.moving.iter().map(place).collect();
        self.engine.step(&walls);
        for at in 0..self.state.len() {
            let now = self.engine.grain(at);
            self.check(at, &now)?;
            if self.scene.dimension == Dimension::Two {
                let turned = now.spin.z * self.stepping.time_step;
                self.angles[at] += nearest_turn(now.orientation - self.state[at].orientation, turned);
            }
            self.state[at] = now;
        }
        let (tested, solved) = self.engine.counts();
        self.cost.steps += 1;
        self.cost.particle_steps += self.state.len() as u64;
        self.cost.pair_tests += tested;
        self.cost.contact_evaluations += solved * self.stepping.iterations as u64;
        Ok(())
    }

    fn check(&self, at: usize, now: &GrainMotion) -> Result<(), Box<SimulationFailure>> {
        let radius = self.scene.grains[at].radius;
        let moved = (now.position - self.state[at].position).norm();
        let turned = self.state[at].spin.norm() * self.stepping.time_step;
        let in_place = turned * radius > IN_PLACE * moved;
        let touches = || self.engine.touches().iter().any(|touch| touch.sides.contains(&Side::Grain(at)));
        let finite = [now.position, now.velocity, now.spin].iter().flatten().all(|value: &f64| value.is_finite());
        let cause = if !finite {
            Cause::NotFinite
        } else if moved > radius {
            // Contacts are detected once a step within a small margin, so contacts may be missed after a longer
            // displacement.
            Cause::Runaway { moved, radius }
        } else if turned > LARGEST_TURN && in_place && touches() {
            Cause::Spun { turned }
        } else {
            return Ok(());
        };
        Err(Box::new(SimulationFailure {
            time: self.time(),
            step: self.step,
            subject: FailedParticle::Grain(at as u32 + 1),
            position: self.state[at].position,
            cause,
            time_step: self.stepping.time_step,
            // Rigid contacts have no critical time step.
            critical: f64::INFINITY,
            advice: match cause {
                Cause::Runaway { .. } => format!("{:.0} times as many substeps are enough", (moved / radius).ceil()),
                Cause::Spun { turned } => {
                    format!("{:.0} times as many substeps are enough", (turned / LARGEST_TURN).ceil())
                }
                _ => "more substeps may help".to_owned(),
            },
        }))
    }

    fn shape(&self, wall: &Wall) -> WallShape {
        let motion = &wall.motion;
        let displacement = motion.displacement(self.time(), self.stepping.time_step);
        wall.shape.moved(motion, &displacement)
    }

    /// Returns a grain with the resultant force (N) and torque (N m) on it.
    fn grain(&self, at: usize, (force, torque): (Vector3<f64>, Vector3<f64>)) -> GrainState {
        let (start, now) = (&self.scene.grains[at], &self.state[at]);
        GrainState {
            position: now.position,
            velocity: now.velocity,
            spin: now.spin,
            force: Some(force),
            torque: Some(torque),
            angle: (self.scene.dimension == Dimension::Two).then_some(self.angles[at]),
            ..GrainState::start(at as u32 + 1, start)
        }
    }

    /// Returns the state of a contact with the current overlap, or `None` for two walls. The forces act on the grain;
    /// between two grains, they act on the grain with the lower index.
    fn contact(&self, touch: &LoadedContact, walls: &[WallShape]) -> Option<ContactState> {
        let (grain, other, sign) = match touch.sides {
            [Side::Grain(a), Side::Grain(b)] if a > b => (b, Side::Grain(a), -1.0),
            [Side::Grain(a), other] => (a, other, 1.0),
            [other, Side::Grain(b)] => (b, other, -1.0),
            [Side::Wall(_), Side::Wall(_)] => return None,
        };
        let radius = self.scene.grains[grain].radius;
        let position = self.state[grain].position;
        let (partner, overlap) = match other {
            Side::Grain(b) => {
                let gap = (self.state[b].position - position).norm() - radius - self.scene.grains[b].radius;
                (Partner::Grain(b as u32 + 1), -gap)
            }
            Side::Wall(at) => (Partner::Wall(at as u16), radius - distance(position, &walls[at])),
        };
        let normal = touch.normal * sign;
        let limit = touch.friction * touch.push;
        Some(ContactState {
            grain: grain as u32 + 1,
            partner,
            point: position + normal * (radius - 0.5 * overlap),
            normal,
            overlap,
            normal_force: touch.push / self.stepping.time_step,
            shear_force: touch.shear * (sign / self.stepping.time_step),
            slipping: limit > 0.0 && touch.shear.norm() >= AT_LIMIT * limit,
        })
    }
}

impl Stepper for Simulation<'_> {
    fn step(&self) -> u64 {
        self.step
    }

    fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        Ok((0..steps).try_for_each(|_| self.take_step())?)
    }

    /// Returns the current state. Forces are impulses of the last step divided by the time step.
    fn look(&mut self, _snapshot: bool) -> StepState {
        let displaced: Vec<WallShape> = self.scene.walls.iter().map(|wall| self.shape(wall)).collect();
        let mut contacts: Vec<ContactState> =
            self.engine.touches().iter().filter_map(|touch| self.contact(touch, &displaced)).collect();
        let order = |contact: &ContactState| match contact.partner {
            Partner::Grain(id) => (contact.grain, 0, id),
            Partner::Body(at) => (contact.grain, 1, at),
            Partner::Wall(at) => (contact.grain, 2, u32::from(at)),
        };
        contacts.sort_by_key(order);
        let mut on_grains = vec![(Vector3::zeros(), Vector3::zeros()); self.state.len()];
        let mut on_walls = vec![Vector3::zeros(); displaced.len()];
        for contact in &contacts {
            let force = contact.shear_force - contact.normal * contact.normal_force;
            let mut push = |id: u32, force: Vector3<f64>| {
                let at = id as usize - 1;
                let (forces, torques): &mut (Vector3<f64>, Vector3<f64>) = &mut on_grains[at];
                *forces += force;
                *torques += (contact.point - self.state[at].position).cross(&force);
            };
            push(contact.grain, force);
            match contact.partner {
                Partner::Grain(id) => push(id, -force),
                Partner::Wall(at) => on_walls[usize::from(at)] -= force,
                Partner::Body(_) => {}
            }
        }
        let grains: Vec<GrainState> = (0..).zip(on_grains).map(|(at, acting)| self.grain(at, acting)).collect();
        let shapes = self.scene.walls.iter().zip(&displaced);
        let walls = shapes.zip(on_walls).map(|((wall, shape), force)| {
            let (corners, infinite) = shape.corners();
            WallState { name: wall.name.clone(), corners, infinite, force: Some(force) }
        });
        let (walls, contacts) = (walls.collect(), Some(contacts));
        StepState::of_rigid(Snapshot::new(self.scene, self.step, self.time(), grains, walls, contacts), 0.0)
    }

    fn counts(&self) -> Counts {
        self.cost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// An engine that reports one contact.
    struct OneContactEngine(LoadedContact);

    impl Engine for OneContactEngine {
        fn step(&mut self, _: &[Placement]) {}
        fn grain(&self, at: usize) -> GrainMotion {
            let position = Vector3::x() * (0.9 * at as f64);
            GrainMotion { position, velocity: Vector3::zeros(), spin: Vector3::zeros(), orientation: 0.0 }
        }
        fn touches(&self) -> Vec<LoadedContact> {
            vec![self.0]
        }
        fn counts(&self) -> (u64, u64) {
            (1, 1)
        }
    }

    /// The forces on grains and walls do not depend on which contact partner the engine lists first. The forces on the
    /// two partners are opposite.
    #[test]
    fn a_contact_is_the_same_from_both_sides() {
        let text = "title = 't'\ndimension = 2\nduration = 1.0\nlargest_initial_overlap = 0.3\nmaterials.m.density = 1.0\n\
            contacts.m = { between = ['m', 'm'], normal_stiffness = 1.0 }\n\
            [grains.g]\nmaterial = 'm'\nradius = 0.5\nlattice = { origin = [0.0, 0.0], spacing = [0.9, 1.0], count = [2, 1] }\n\
            [walls.w]\nmaterial = 'm'\nplane = { point = [-0.4, 0.0], normal = [1.0, 0.0] }\n";
        let scene = Scene::from_text("t", text).unwrap();
        let settings = Settings::default();
        let stepping = Stepping { time_step: 0.1, iterations: 4, length: 1.0, mass: 1.0, settings };
        for (other, normal) in [(Side::Grain(1), Vector3::x()), (Side::Wall(0), -Vector3::x())] {
            let shear = Vector3::y() * 0.3;
            let touch = LoadedContact { sides: [Side::Grain(0), other], normal, push: 2.0, shear, friction: 1.0 };
            let turned = LoadedContact { sides: [other, Side::Grain(0)], normal: -normal, shear: -shear, ..touch };
            for touch in [touch, turned] {
                let mut simulation = Simulation::new(&scene, stepping);
                simulation.engine = Box::new(OneContactEngine(touch));
                let snapshot = simulation.look(true).snapshot;
                let force = (shear - normal * 2.0) / 0.1;
                let on_other = if other == Side::Wall(0) { snapshot.walls[0].force } else { snapshot.grains[1].force };
                let off = [snapshot.grains[0].force.unwrap() - force, on_other.unwrap() + force].map(|off| off.norm());
                assert!(off.iter().all(|off| *off < 1e-12 * force.norm()), "{touch:?}: off by {off:?} N");
            }
        }
    }
}
