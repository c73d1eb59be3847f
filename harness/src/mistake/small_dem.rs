//! A small DEM solver, independent of the project's solvers, in which one mistake can be planted.
//!
//! If the solver under test fails with the error that a planted mistake gives, the mistake explains the failure. The tests
//! also check claims with it: claims pass with the correct method, and selected claims fail by their value with a mistake.
//! The solver checks every pair of grains and integrates by central differences. The slip velocity is computed from the
//! normals, lever arms and wall positions at mid-step.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::overlap::{nearest_on_rectangle, nearest_on_round, nearest_on_segment};
use grainbench_scene::release::no_tension_ratio;
use grainbench_scene::scene::{Grain, Scene, Wall, WallShape};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::{ContactState, Cost, GrainState, Partner, Provenance, Record, Snapshot, StepState};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;
use nalgebra::{Rotation3, Vector3};

type V = Vector3<f64>;

/// Mistake in the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodMistake {
    /// The tangential spring keeps its direction in space when its contact rotates.
    SpringNotTurned,
    /// The tangential spring is projected on the tangent plane and does not follow the rotation about the normal.
    TwistNotFollowed,
    /// Both grains of a pair have the lever arm (R₁ + R₂)/2.
    MeanArm,
    /// Both grains of a pair have the lever arm of the first grain.
    OneArm,
    /// The slip velocity includes the spins with the wrong sign.
    WrongSpin,
    /// The slip velocity leaves out the spins.
    NoSpin,
    /// Friction exerts a torque only on the first grain of a pair.
    NoSecondTorque,
    /// Torques have the wrong sign.
    TorqueReversed,
    /// The rolling moment neglects the spin of walls.
    WallSpinDropped,
    /// The tangential force of a Mindlin contact is the present stiffness times the whole displacement since the contact began.
    SecantSpring,
    /// The tangential force of a Mindlin contact is not reduced during unloading.
    NotRescaled,
    /// The rolling angle grows beyond the limit of the rolling moment.
    RollingNotCut,
    /// The initial spins of grains are zero.
    SpinsDropped,
    /// The tangential spring is reset after each step.
    SpringForgotten,
    /// The Coulomb limit applies to the force, but the spring displacement grows beyond it.
    SpringNotCut,
    /// The Coulomb limit applies only to the spring force. The force of the tangential dashpot is added without a limit.
    LimitOnSpring,
    /// The Coulomb limit is proportional to the elastic part of the normal force.
    LimitOfElastic,
    /// The normal dashpot exerts a tensile force on separating grains.
    Pulls,
    /// Dashpots use the mass of the first grain instead of the reduced mass.
    WholeMass,
    /// Hertz contacts use the radius of the first grain instead of the effective radius.
    WholeRadius,
    /// Velocities in the output are half a step old.
    HalfStepOld,
    /// Positions are integrated with the velocities before the step.
    OldVelocity,
}

impl MethodMistake {
    /// All mistakes in a fixed order, with their descriptions.
    pub const ALL: [(Self, &str); 22] = [
        (Self::SpringNotTurned, "tangential springs do not rotate with their contact"),
        (Self::TwistNotFollowed, "tangential springs do not rotate about the normal with their grains"),
        (Self::MeanArm, "the lever arm (R₁ + R₂)/2 for both grains"),
        (Self::OneArm, "the lever arm of the first grain for both grains"),
        (Self::WrongSpin, "spins with the wrong sign in the slip"),
        (Self::NoSpin, "no spins in the slip"),
        (Self::NoSecondTorque, "no torque on the second grain of a pair"),
        (Self::TorqueReversed, "torques with the wrong sign"),
        (Self::WallSpinDropped, "no spin of walls in the rolling moment"),
        (Self::SecantSpring, "Mindlin's force as the current stiffness times the total displacement"),
        (Self::NotRescaled, "Mindlin's force not reduced while a contact is unloaded"),
        (Self::RollingNotCut, "a rolling angle that grows beyond its limit"),
        (Self::SpinsDropped, "no spins at the start"),
        (Self::SpringForgotten, "tangential springs reset after each step"),
        (Self::SpringNotCut, "a tangential spring that grows beyond Coulomb's limit"),
        (Self::LimitOnSpring, "Coulomb's limit on the spring alone, with the dashpot added"),
        (Self::LimitOfElastic, "Coulomb's limit from the elastic normal force alone"),
        (Self::Pulls, "a normal dashpot that pulls separating grains together"),
        (Self::WholeMass, "dashpots with the mass of one grain instead of the reduced mass"),
        (Self::WholeRadius, "Hertz contacts with the radius of one grain instead of the effective radius"),
        (Self::HalfStepOld, "velocities reported half a step early"),
        (Self::OldVelocity, "positions moved with the velocity before the step"),
    ];
}

/// Small DEM solver, with or without a mistake.
#[derive(Clone, Copy, Debug, Default)]
pub struct SmallDem {
    /// Mistake; none for the correct method.
    pub mistake: Option<MethodMistake>,
}

/// Second side of a contact over one step: a grain or a wall.
struct Side {
    /// Vector from the centre of the first grain to the second side, before and after the step (m). It ends at the
    /// centre of the second grain, or at the nearest point of the wall.
    between: [V; 2],
    /// Velocity of the second grain's centre, or of the wall at its nearest point (m/s).
    velocity: V,
    spin: V,
    radius: Option<f64>,
    mass: f64,
    partner: Partner,
}

/// Contact with its history.
struct Contact {
    /// State after the last step, without the contact point.
    state: ContactState,
    /// Tangential spring force on the first grain (N).
    spring: V,
    /// Rolling angle (rad).
    rolled: V,
    seen: u64,
}

struct Body {
    /// Grain with its present position, velocity and spin.
    grain: Grain,
    before: V,
    force: V,
    torque: V,
}

struct State<'a> {
    scene: &'a Scene,
    solver: SmallDem,
    step: f64,
    count: u64,
    bodies: Vec<Body>,
    contacts: Vec<Contact>,
    wall_forces: Vec<V>,
}

fn nearest(wall: &WallShape, at: V) -> Option<V> {
    Some(match wall {
        WallShape::Plane { point, normal } => at - normal * (at - point).dot(normal),
        WallShape::Segment { ends } => nearest_on_segment(at, ends),
        WallShape::Rectangle { corner, edges } => nearest_on_rectangle(at, corner, edges),
        WallShape::Round { axis, radii } => nearest_on_round(at, axis, radii),
        WallShape::Mesh(_) => return None,
    })
}

impl State<'_> {
    fn time(&self) -> f64 {
        self.count as f64 * self.step
    }

    /// Returns a wall as the second side of a contact with a grain over the last step. None for a mesh.
    fn facing(&self, place: usize, wall: &Wall, body: &Body) -> Option<Side> {
        let now = self.time();
        let at = |time: f64| {
            let displacement = wall.motion.displacement(time.max(0.0), self.step);
            (wall.shape.moved(&wall.motion, &displacement), displacement)
        };
        let (after, gone) = at(now);
        let (before, was) = at(now - self.step);
        let (spot, past) = (nearest(&after, body.grain.position)?, nearest(&before, body.before)?);
        let (spin, speed) =
            ((gone.rotation - was.rotation) / self.step, (gone.translation - was.translation) / self.step);
        let centre = wall.motion.centre + (gone.translation + was.translation) * 0.5;
        let middle = nearest(&at(now - 0.5 * self.step).0, (body.before + body.grain.position) * 0.5)?;
        Some(Side {
            between: [past - body.before, spot - body.grain.position],
            velocity: speed + spin.cross(&(middle - centre)),
            spin,
            radius: None,
            mass: f64::INFINITY,
            partner: Partner::Wall(place as u16),
        })
    }

    fn sides(&self, first: usize) -> Vec<Side> {
        let body = &self.bodies[first];
        let later = self.bodies.iter().enumerate().skip(first + 1).map(|(id, other)| Side {
            between: [other.before - body.before, other.grain.position - body.grain.position],
            velocity: other.grain.velocity,
            spin: other.grain.spin,
            radius: Some(other.grain.radius),
            mass: other.grain.mass,
            partner: Partner::Grain(id as u32 + 1),
        });
        let walls = self.scene.walls.iter().enumerate().filter_map(|(place, wall)| self.facing(place, wall, body));
        later.chain(walls).collect()
    }

    /// Computes all forces and torques. `elapsed` is the time step (s), or zero at the start.
    fn evaluate(&mut self, elapsed: f64) {
        for body in &mut self.bodies {
            (body.force, body.torque) = (V::zeros(), V::zeros());
        }
        self.wall_forces.iter_mut().for_each(|force| *force = V::zeros());
        for first in 0..self.bodies.len() {
            for side in self.sides(first) {
                self.contact(first, &side, elapsed);
            }
        }
        let count = self.count;
        self.contacts.retain(|contact| contact.seen == count);
    }

    fn contact(&mut self, first: usize, side: &Side, elapsed: f64) {
        let body = &self.bodies[first];
        let radius = body.grain.radius;
        let distance = side.between[1].norm();
        let overlap = radius + side.radius.unwrap_or(0.0) - distance;
        let material = match side.partner {
            Partner::Grain(id) => self.bodies[id as usize - 1].grain.material,
            Partner::Wall(place) => self.scene.walls[usize::from(place)].material,
            Partner::Body(_) => return,
        };
        let Some(law) = self.scene.law(body.grain.material, material).copied().filter(|_| overlap > 0.0) else {
            return;
        };
        let normal = side.between[1] / distance;
        let (grain, partner) = (first as u32 + 1, side.partner);
        let found = self.contacts.iter().position(|old| old.state.grain == grain && old.state.partner == partner);
        let place = found.unwrap_or_else(|| {
            let (point, normal_force, shear_force, slipping) = (V::zeros(), 0.0, V::zeros(), false);
            let state = ContactState { grain, partner, point, normal, overlap, normal_force, shear_force, slipping };
            self.contacts.push(Contact { state, spring: V::zeros(), rolled: V::zeros(), seen: 0 });
            self.contacts.len() - 1
        });
        let contact = &mut self.contacts[place];
        contact.seen = self.count;
        let [force, torque, opposite] = self.solver.respond(&law, body, side, [distance, overlap, elapsed], contact);
        let (torque, opposite) = match self.solver.mistake {
            Some(MethodMistake::NoSecondTorque) => (torque, V::zeros()),
            Some(MethodMistake::TorqueReversed) => (-torque, -opposite),
            _ => (torque, opposite),
        };
        let body = &mut self.bodies[first];
        body.force += force;
        body.torque += torque;
        match side.partner {
            Partner::Grain(id) => {
                let other = &mut self.bodies[id as usize - 1];
                other.force -= force;
                other.torque += opposite;
            }
            Partner::Wall(wall) => self.wall_forces[usize::from(wall)] -= force,
            Partner::Body(_) => {}
        }
    }

    fn advance(&mut self) {
        let (scene, step, time) = (self.scene, self.step, self.time());
        for body in &mut self.bodies {
            body.before = body.grain.velocity;
            body.grain.velocity += (body.force / body.grain.mass + scene.gravity) * step;
            body.grain.spin += body.torque / body.grain.inertia * step;
        }
        for driven in scene.driven.iter().filter(|driven| driven.is_moved_at(time)) {
            for &grain in &driven.grains {
                self.bodies[grain].grain.velocity = driven.velocity_over(time, step);
                self.bodies[grain].grain.spin = driven.spin;
            }
        }
        for body in &mut self.bodies {
            let velocity = if self.solver.has(MethodMistake::OldVelocity) { body.before } else { body.grain.velocity };
            body.before = body.grain.position;
            body.grain.position += velocity * step;
        }
        self.count += 1;
        self.evaluate(step);
    }

    fn look(&self) -> StepState {
        let half = 0.5 * self.step;
        let is_driven = |id: usize| self.scene.driven.iter().any(|driven| driven.grains.contains(&id));
        let grains = self.bodies.iter().enumerate().map(|(id, body)| {
            let is_old = self.solver.has(MethodMistake::HalfStepOld);
            let free = if is_driven(id) || is_old { 0.0 } else { half };
            GrainState {
                velocity: body.grain.velocity + (body.force / body.grain.mass + self.scene.gravity) * free,
                spin: body.grain.spin + body.torque / body.grain.inertia * free,
                force: Some(body.force),
                torque: Some(body.torque),
                ..GrainState::start(id as u32 + 1, &body.grain)
            }
        });
        let mut snapshot = Snapshot::of_grains(self.scene, self.count, self.time(), grains.collect());
        for (wall, force) in snapshot.walls.iter_mut().zip(&self.wall_forces) {
            wall.force = Some(*force);
        }
        let place = |state: &ContactState| self.bodies[state.grain as usize - 1].grain.position;
        let shown = self.contacts.iter().map(|Contact { state, .. }| ContactState { point: place(state), ..*state });
        snapshot.contacts = Some(shown.collect());
        let driven =
            self.scene.driven.iter().map(|group| group.grains.iter().map(|&grain| self.bodies[grain].force).sum());
        StepState { driven: driven.collect(), ..StepState::of_rigid(snapshot, 0.0) }
    }
}

impl SmallDem {
    /// Returns true if the solver makes a mistake.
    fn has(self, mistake: MethodMistake) -> bool {
        self.mistake == Some(mistake)
    }

    /// Returns the lever arms of both sides (m). For two grains, their sum is the distance of the centres. At a wall, the
    /// first is the distance from the wall, and the second is zero.
    fn arms(self, radii: [f64; 2], wall: bool, distance: f64, overlap: f64) -> [f64; 2] {
        if wall {
            return [distance, 0.0];
        }
        let [first, second] = radii.map(|radius| radius - 0.5 * overlap);
        match self.mistake {
            Some(MethodMistake::MeanArm) => [0.5 * (first + second); 2],
            Some(MethodMistake::OneArm) => [first; 2],
            _ => [first, second],
        }
    }

    /// Returns the rotation of a contact during a step: the rotation of its normal, followed by the mean rotation of both
    /// sides about the normal.
    fn turn(self, from: V, to: V, spins: [V; 2], elapsed: f64) -> Rotation3<f64> {
        if self.has(MethodMistake::SpringNotTurned) {
            return Rotation3::identity();
        }
        let across = from.cross(&to);
        let sine = across.norm();
        let tilt = if sine > 0.0 {
            Rotation3::from_scaled_axis(across * (sine.atan2(from.dot(&to)) / sine))
        } else {
            Rotation3::identity()
        };
        if self.has(MethodMistake::TwistNotFollowed) {
            return tilt;
        }
        let twist = (spins[0] + spins[1]).dot(&to) * 0.5 * elapsed;
        Rotation3::from_scaled_axis(to * twist) * tilt
    }

    /// Returns the force (N) and the torque (N m) on the first grain, and the torque on the second side. Updates the history of
    /// the contact.
    fn respond(
        self,
        law: &ContactLaw,
        body: &Body,
        side: &Side,
        [distance, overlap, elapsed]: [f64; 3],
        contact: &mut Contact,
    ) -> [V; 3] {
        let radii = [body.grain.radius, side.radius.unwrap_or(0.0)];
        let normal = side.between[1] / distance;
        let middle = (side.between[0] + side.between[1]).normalize();
        let wall = side.radius.is_none();
        let is_whole = wall || self.has(MethodMistake::WholeRadius);
        let effective = if is_whole { radii[0] } else { radii[0] * radii[1] / (radii[0] + radii[1]) };
        let is_whole = self.has(MethodMistake::WholeMass);
        let mass = if is_whole { body.grain.mass } else { 1.0 / (1.0 / body.grain.mass + 1.0 / side.mass) };
        let [first, second] = self.arms(radii, wall, distance, overlap);
        let between = 0.5 * (side.between[0].norm() + side.between[1].norm());
        let moving = self.arms(radii, wall, between, radii[0] + radii[1] - between);
        let second_spin = if wall { V::zeros() } else { side.spin };
        let sign = match self.mistake {
            Some(MethodMistake::WrongSpin) => -1.0,
            Some(MethodMistake::NoSpin) => 0.0,
            _ => 1.0,
        };
        let relative = body.grain.velocity - side.velocity
            + (body.grain.spin * moving[0] + second_spin * moving[1]).cross(&middle) * sign;
        let slip = relative - middle * relative.dot(&middle);
        let (stiff, _) = law.springs.stiffness(overlap, effective);
        let ratio =
            if self.has(MethodMistake::Pulls) { law.damping_ratio } else { no_tension_ratio(law.damping_ratio) };
        let damped_share = if law.is_hertz() { 5.0 / 6.0 } else { 1.0 };
        let damping = law.normal_damping * mass + 2.0 * ratio * (stiff * mass * damped_share).sqrt();
        let secant = law.springs.secant_stiffness(overlap, effective);
        let push = secant * overlap + damping * (body.grain.velocity - side.velocity).dot(&normal);
        let push = if self.has(MethodMistake::Pulls) { push } else { push.max(0.0) };
        let base = if self.has(MethodMistake::LimitOfElastic) { secant * overlap } else { push.max(0.0) };
        let limit = law.friction * base + law.cohesion;
        self.shear(law, [effective, overlap, elapsed, limit], (slip, normal, [body.grain.spin, side.spin]), contact);
        let dashpot = slip * (law.tangential_damping * mass);
        contact.state.shear_force = if self.has(MethodMistake::LimitOnSpring) {
            contact.spring - dashpot
        } else {
            (contact.spring - dashpot).cap_magnitude(limit)
        };
        if self.has(MethodMistake::SpringForgotten) {
            contact.spring = V::zeros();
        }
        let spin = if wall && self.has(MethodMistake::WallSpinDropped) { V::zeros() } else { side.spin };
        let moment = self.roll(law, [effective, secant, elapsed, push], (body.grain.spin - spin, normal), contact);
        let state = &mut contact.state;
        (state.normal, state.overlap, state.normal_force) = (normal, overlap, push);
        let force = state.shear_force - normal * push;
        let lever = normal.cross(&state.shear_force);
        [force, lever * first + moment, lever * second - moment]
    }

    /// Updates the force of the tangential spring over one step.
    fn shear(
        self,
        law: &ContactLaw,
        [effective, overlap, elapsed, limit]: [f64; 4],
        (slip, normal, spins): (V, V, [V; 2]),
        contact: &mut Contact,
    ) {
        // The slip velocity belongs to mid-step, so the slip must be rotated over the second half of the step.
        let half = self.turn(normal, normal, spins, 0.5 * elapsed);
        let along = half * slip * elapsed;
        let along = along - normal * along.dot(&normal);
        let turned = self.turn(contact.state.normal, normal, spins, elapsed) * contact.spring;
        let stiffness = |overlap: f64| law.springs.stiffness(overlap, effective).1;
        let (was, is) = (contact.state.overlap, overlap);
        let is_rescaled =
            is < was && !self.has(MethodMistake::NotRescaled) || was > 0.0 && self.has(MethodMistake::SecantSpring);
        let kept = if law.is_hertz() && is_rescaled { (is / was).sqrt() } else { 1.0 };
        contact.spring = turned * kept - along * stiffness(0.5 * (was + is));
        contact.state.slipping = contact.spring.norm() > limit;
        if !self.has(MethodMistake::SpringNotCut) {
            contact.spring = contact.spring.cap_magnitude(limit);
        }
    }

    /// Returns the moment on the first grain that resists rolling (N m). Updates the rolling angle.
    fn roll(
        self,
        law: &ContactLaw,
        [effective, secant, elapsed, push]: [f64; 4],
        (spin, normal): (V, V),
        contact: &mut Contact,
    ) -> V {
        let arm = law.rolling_friction * effective;
        if arm == 0.0 {
            return V::zeros();
        }
        let rate = spin - normal * spin.dot(&normal);
        let stiffness = 2.25 * secant * arm * arm;
        contact.rolled += rate * elapsed;
        contact.rolled -= normal * contact.rolled.dot(&normal);
        let most = arm * push;
        let moment = (-contact.rolled * stiffness).cap_magnitude(most);
        if !self.has(MethodMistake::RollingNotCut) {
            contact.rolled = -moment / stiffness;
        }
        moment
    }
}

impl Solver for SmallDem {
    fn name(&self) -> String {
        "small-dem".to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let refuse = |reason: String| RunError::Unsupported { solver: self.name(), reason };
        if let Some(what) = scene.needs_deformable().or_else(|| scene.passing()) {
            return Err(refuse(what.to_owned()));
        }
        if scene.laws.iter().flatten().any(|law| law.rolling_damping > 0.0 && law.rolling_friction > 0.0) {
            return Err(refuse("it has no rolling dashpot".to_owned()));
        }
        let (step, steps) = resolution.steps(scene).map_err(refuse)?;
        let spin = |grain: &Grain| if self.has(MethodMistake::SpinsDropped) { V::zeros() } else { grain.spin };
        let bodies = scene.grains.iter().map(|grain| Body {
            grain: Grain { spin: spin(grain), ..*grain },
            before: grain.position,
            force: V::zeros(),
            torque: V::zeros(),
        });
        let walls = vec![V::zeros(); scene.walls.len()];
        let (solver, bodies) = (*self, bodies.collect());
        let mut state = State { scene, solver, step, count: 0, bodies, contacts: Vec::new(), wall_forces: walls };
        state.evaluate(0.0);
        for body in &mut state.bodies {
            body.grain.velocity -= (body.force / body.grain.mass + scene.gravity) * (0.5 * step);
            body.grain.spin -= body.torque / body.grain.inertia * (0.5 * step);
        }
        let mut recorder = Recorder::new(scene, step, steps);
        for count in 0..=steps {
            if count > 0 {
                state.advance();
            }
            if recorder.is_due(count) {
                let due = recorder.take(scene, state.look());
                due.into_iter().for_each(|snapshot| recorder.keep(snapshot));
            }
        }
        observer.progress(steps, steps);
        let (series, snapshots) = recorder.finish();
        let provenance = Provenance::new(scene, self.name(), resolution, step, Vec::new());
        Ok(Record { provenance, series, snapshots, cost: Cost::of_program(steps, scene.grains.len(), f64::NAN) })
    }
}
