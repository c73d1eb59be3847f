//! One simulation: the cycle points → nodes → points.

use crate::basis::{Gimp, Linear, Quadratic};
use crate::bodies::{Body, Material, press, seed};
use crate::contact::nodal;
use crate::contact::pairs::Pairs;
use crate::contact::penalty::{self, Rules, Springs};
use crate::contact::shared::{Projected, Shared, Stepped};
use crate::contact::{FrictionTable, Touch};
use crate::grid::{Lattice, Node, Window};
use crate::held::Held;
use crate::material::Law;
use crate::options::{Basis, Contact, Setting, StressUpdate, Transfer};
use crate::points::Points;
use crate::stress::{self, Failure};
use crate::surface::Tracers;
use crate::transfer::{self, Apic, Flip, Part, Spin};
use crate::walls::RigidPlane;
use grainbench_scene::manufactured::Medium;
use grainbench_scene::record::{Cost, Owner};
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Broken, Cause, Subject};
use grainbench_scene::space::Space;
use nalgebra::Vector3;

/// Compiles a call for the basis that was chosen.
macro_rules! with_basis {
    ($basis:expr, $B:ident => $call:expr) => {
        match $basis {
            Basis::Linear => {
                type $B = Linear;
                $call
            }
            Basis::Quadratic => {
                type $B = Quadratic;
                $call
            }
            Basis::Gimp => {
                type $B = Gimp;
                $call
            }
        }
    };
}

/// Nodes beyond which a grid is taken for a mistake.
const MOST_NODES: f64 = 5e7;

/// Which velocities of the nodes a stage means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Velocities {
    /// Those of the step.
    Stepped,
    /// Those that the points brought to the nodes once more.
    Projected,
}

/// A run.
pub(crate) struct Simulation<S: Space> {
    pub(crate) scene: Scene,
    pub(crate) setting: Setting,
    pub(crate) lattice: Lattice,
    pub(crate) bodies: Vec<Body>,
    pub(crate) points: Points<S>,
    pub(crate) tracers: Tracers<S>,
    pub(crate) walls: Vec<RigidPlane<S>>,
    pub(crate) nodes: Vec<Node<S>>,
    pub(crate) projected: Vec<S::Vector>,
    /// Nodes in use.
    pub(crate) used: usize,
    friction: FrictionTable,
    held: Held,
    springs: Springs<S>,
    shared: Shared<S>,
    pairs: Pairs<S>,
    pub(crate) touches: Vec<Touch<S>>,
    pub(crate) time_step: f64,
    pub(crate) critical: f64,
    pub(crate) step: u64,
    gravity: S::Vector,
    /// Mass-proportional damping α (1/s).
    damping: f64,
    settling: bool,
    /// Way since the points were last put in order, of the fastest (m).
    travelled: f64,
    /// Velocities of the points a step before those of the last look (m/s): velocities are half a step behind positions.
    pub(crate) before: Vec<S::Vector>,
    /// Step of the last look.
    pub(crate) looked: u64,
    pub(crate) cost: Cost,
}

impl<S: Space> Simulation<S> {
    /// Sets up a scene.
    ///
    /// # Errors
    /// When its bodies reach farther than a grid can, or break while they settle.
    pub(crate) fn new(
        scene: &Scene,
        setting: Setting,
        lattice: Lattice,
        per_cell: u32,
        time_step: f64,
        critical: f64,
    ) -> Result<Self, Box<Broken>> {
        let (bodies, points, tracers) = seed::<S>(scene, &setting, &lattice, per_cell);
        let walls: Vec<RigidPlane<S>> = scene.walls.iter().filter_map(RigidPlane::new).collect();
        let mut simulation = Self {
            held: Held::new(&bodies, &lattice),
            friction: FrictionTable::of(scene),
            springs: Springs::new(tracers.len()),
            pairs: Pairs::new(),
            shared: Shared::new(),
            gravity: S::restrict(scene.gravity),
            damping: scene.global_damping,
            scene: scene.clone(),
            setting,
            lattice,
            bodies,
            points,
            tracers,
            walls,
            nodes: Vec::new(),
            projected: Vec::new(),
            used: 0,
            touches: Vec::new(),
            time_step,
            critical,
            step: 0,
            settling: false,
            travelled: f64::INFINITY,
            before: Vec::new(),
            looked: 0,
            cost: Cost::default(),
        };
        simulation.settle()?;
        simulation.set_moving();
        Ok(simulation)
    }

    /// The damped phase before the clock starts.
    fn settle(&mut self) -> Result<(), Box<Broken>> {
        let start = self.scene.start;
        let gravity = start.settle.map_or(self.scene.gravity, |settle| settle.gravity);
        if start.initial_pressure.is_some() {
            press(&self.bodies, &mut self.points, &self.tracers, gravity);
        }
        self.find_bounds();
        if let Some(settle) = start.settle {
            (self.gravity, self.damping, self.settling) = (S::restrict(gravity), settle.damping, true);
            for _ in 0..(settle.duration / self.time_step).ceil() as u64 {
                self.cycle(false)?;
            }
            (self.gravity, self.damping) = (S::restrict(self.scene.gravity), self.scene.global_damping);
            (self.settling, self.step, self.cost) = (false, 0, Cost::default());
            self.touches.clear();
        }
        Ok(())
    }

    /// Gives every point the velocity that the scene asks for, half a step before the clock starts, so that every step is
    /// alike: what balances the bodies at rest does so then too, and gravity beyond that acts from the start.
    fn set_moving(&mut self) {
        let half = 0.5 * self.time_step;
        let balanced = self.scene.start.settle.map_or_else(Vector3::zeros, |settle| settle.gravity);
        let lag = (self.scene.gravity - balanced) * half;
        self.before.resize(self.points.len(), S::ORIGIN);
        for body in &self.bodies {
            let medium = medium(body);
            for at in body.part.points.clone() {
                let position = S::embed(self.points.position[at]);
                let mut velocity = match body.owner {
                    Owner::Grain(id) => {
                        let grain = &self.scene.grains[id as usize - 1];
                        self.points.affine[at] = S::restrict_gradient(grain.spin.cross_matrix());
                        grain.velocity + grain.spin.cross(&(position - grain.position))
                    }
                    Owner::Body(place) => {
                        let block = &self.scene.bodies[place as usize];
                        let wave = block.wave.map_or(0.0, |wave| {
                            let low = body.held.map_or(block.shape.centre().x, |(_, [low, _])| low.x);
                            wave.amplitude * (wave.wave_number * (position.x - low)).sin()
                        });
                        block.velocity + Vector3::new(wave, 0.0, 0.0)
                    }
                };
                let mut behind = velocity - lag;
                if let Some(motion) = &self.scene.start.manufactured {
                    velocity += motion.velocity(&medium, position, 0.0);
                    behind += motion.velocity(&medium, position, -half);
                }
                self.points.velocity[at] = S::restrict(behind);
                self.before[at] = S::restrict(behind * 3.0 - velocity * 2.0);
            }
        }
    }

    /// Takes `steps` steps; after the last one what touches is known.
    ///
    /// # Errors
    /// When a point's state breaks.
    pub(crate) fn advance(&mut self, steps: u64) -> Result<(), Box<Broken>> {
        for left in (0..steps).rev() {
            self.cycle(left == 0)?;
        }
        Ok(())
    }

    /// One cycle.
    fn cycle(&mut self, record: bool) -> Result<(), Box<Broken>> {
        let time = self.step as f64 * self.time_step;
        for wall in &mut self.walls {
            wall.force = S::ORIGIN;
            if self.settling {
                wall.move_to(0.0, self.time_step);
                wall.stop();
            } else {
                wall.move_to(time, self.time_step);
            }
        }
        self.sort();
        if record {
            self.before.copy_from_slice(&self.points.velocity);
        }
        self.place_windows()?;
        self.scatter();
        self.find_shared();
        if self.setting.stress_update == StressUpdate::First {
            self.project_momentum();
            self.update_stress(Velocities::Projected)?;
            self.scatter_force_again();
        }
        self.body_force(time);
        self.spring_forces(record);
        self.held.fold(&self.bodies, &mut self.nodes);
        self.step_nodes();
        self.gather();
        if self.setting.stress_update == StressUpdate::ModifiedLast {
            self.to_velocities();
        }
        match self.setting.stress_update {
            StressUpdate::First => self.move_tracers(Velocities::Stepped),
            StressUpdate::Last => {
                self.update_stress(Velocities::Stepped)?;
                self.move_tracers(Velocities::Stepped);
            }
            StressUpdate::ModifiedLast => {
                self.update_stress(Velocities::Projected)?;
                self.move_tracers(Velocities::Projected);
            }
        }
        self.move_points()?;
        self.step += 1;
        self.cost.steps += 1;
        self.cost.particle_steps += self.points.len() as u64;
        Ok(())
    }

    /// Puts points in the order of their cells when some may have crossed one.
    fn sort(&mut self) {
        if self.travelled < 0.5 * self.lattice.shortest(S::DIMENSION) {
            return;
        }
        let lattice = self.lattice;
        for body in &self.bodies {
            self.points.sort(body.part.points.clone(), |position| {
                let cell = |axis: usize| {
                    if axis < S::DIMENSION { lattice.cells::<S>(position, axis).floor() as i64 } else { 0 }
                };
                [cell(2), cell(1), cell(0)]
            });
        }
        self.travelled = 0.0;
    }

    /// Gives every field its window, and empties the nodes.
    fn place_windows(&mut self) -> Result<(), Box<Broken>> {
        let (mut start, mut count) = (0, 0.0);
        let shared = self.setting.contact == Contact::NoSlip;
        let mut all: Option<[Vector3<f64>; 2]> = None;
        if shared {
            all = self.bodies.iter().map(|body| body.bounds).reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])]);
        }
        for place in 0..self.bodies.len() {
            if shared && place > 0 {
                self.bodies[place].part.window = self.bodies[0].part.window;
                continue;
            }
            let [low, high] = all.unwrap_or(self.bodies[place].bounds);
            let wanted: f64 =
                (0..S::DIMENSION).map(|axis| (high[axis] - low[axis]) / self.lattice.cell[axis] + 3.0).product();
            count += wanted;
            if !(count < MOST_NODES) {
                let cause = if count.is_finite() { Cause::LeftGrid { cells: count } } else { Cause::NotFinite };
                return Err(self.broken(place, self.bodies[place].part.points.start, cause));
            }
            let mut window: Window = self.lattice.window::<S>(S::restrict(low), S::restrict(high));
            window.start = start;
            start += window.len();
            self.bodies[place].part.window = window;
        }
        self.used = start;
        if self.nodes.len() < start {
            self.nodes.resize(start + start / 4, Node::EMPTY);
            self.projected.resize(start + start / 4, S::ORIGIN);
        }
        self.nodes[..start].fill(Node::EMPTY);
        self.projected[..start].fill(S::ORIGIN);
        Ok(())
    }

    fn scatter(&mut self) {
        let Self { lattice, bodies, points, nodes, setting, .. } = self;
        for body in bodies.iter() {
            with_basis!(setting.basis, B => match setting.transfer {
                Transfer::Flip { .. } => transfer::scatter::<S, B, Flip>(lattice, &body.part, points, nodes),
                Transfer::Apic => transfer::scatter::<S, B, Apic>(lattice, &body.part, points, nodes),
                Transfer::Spin => transfer::scatter::<S, B, Spin>(lattice, &body.part, points, nodes),
            });
        }
    }

    /// For stresses that come first: the velocities of the nodes as the points bring them.
    fn project_momentum(&mut self) {
        for (projected, node) in self.projected[..self.used].iter_mut().zip(&self.nodes) {
            *projected = node.velocity;
        }
        self.to_velocities();
    }

    /// Projected momenta become velocities that contacts and held sides allow.
    fn to_velocities(&mut self) {
        let Self { bodies, nodes, projected, held, used, .. } = self;
        held.fold_projected::<S>(bodies, projected);
        for (projected, node) in projected[..*used].iter_mut().zip(nodes.iter()) {
            *projected = if node.mass > 0.0 { *projected * (1.0 / node.mass) } else { S::ORIGIN };
        }
        held.hold_projected::<S>(bodies, projected);
        if self.is_nodal() {
            let Self { lattice, friction, setting, time_step, bodies, shared, walls, projected, .. } = self;
            let rules = nodal::Rules { lattice, friction, contact: setting.contact, time_step: *time_step };
            match setting.contact {
                Contact::Gap => nodal::apply_pairs(&rules, bodies, shared, walls, &mut Projected(projected)),
                _ => nodal::apply(&rules, bodies, shared, walls, &mut Projected(projected)),
            }
        }
    }

    /// Whether contact is a condition at nodes, and anything can touch.
    fn is_nodal(&self) -> bool {
        let several = self.bodies.len() > 1 && self.setting.contact != Contact::NoSlip;
        self.setting.contact != Contact::Penalty && (several || !self.walls.is_empty())
    }

    /// Finds the nodes at which bodies meet, for conditions at nodes.
    fn find_shared(&mut self) {
        if !self.is_nodal() {
            return;
        }
        let cell = self.lattice.shortest(S::DIMENSION);
        let Self { lattice, setting, bodies, shared, pairs, walls, nodes, points, tracers, used, .. } = self;
        let margin = if setting.contact == Contact::Gap { 0.0 } else { 3.0 * cell };
        let fields = if setting.contact == Contact::NoSlip { 1 } else { bodies.len() };
        pairs.found.clear();
        if fields > 1 {
            pairs.find(bodies, lattice, margin);
        }
        if setting.contact == Contact::Gap {
            tracers.find_boxes();
            shared.find_meetings(lattice, bodies, &pairs.found, tracers, walls, nodes);
        } else {
            shared.find(lattice, bodies, fields, &pairs.found, walls, nodes);
        }
        if setting.contact == Contact::NoSlip {
            return;
        }
        shared.find_touching(bodies.len());
        with_basis!(setting.basis, B => shared.find_faces::<B>(lattice, bodies, *used, points));
        if setting.contact == Contact::Kinematic {
            shared.smooth_normals(lattice, bodies, *used, points);
        }
    }

    fn scatter_force_again(&mut self) {
        let Self { lattice, bodies, points, nodes, setting, used, .. } = self;
        nodes[..*used].iter_mut().for_each(|node| node.change = S::ORIGIN);
        for body in bodies.iter() {
            with_basis!(setting.basis, B => transfer::scatter_force::<S, B>(lattice, &body.part, points, nodes));
        }
    }

    /// The force of a manufactured solution.
    fn body_force(&mut self, time: f64) {
        let Some(motion) = self.scene.start.manufactured.filter(|_| !self.settling) else { return };
        let Self { lattice, bodies, points, nodes, setting, .. } = self;
        for body in bodies.iter() {
            let medium = medium(body);
            let force =
                |at: usize| S::restrict(motion.body_force(&medium, S::embed(points.start[at]), time)) * points.mass[at];
            with_basis!(setting.basis, B => {
                transfer::scatter_body_force::<S, B>(lattice, &body.part, points, force, nodes);
            });
        }
    }

    /// Forces of springs between surfaces.
    fn spring_forces(&mut self, record: bool) {
        if self.setting.contact != Contact::Penalty {
            return;
        }
        self.touches.clear();
        self.springs.begin();
        self.pairs.find(&self.bodies, &self.lattice, 0.0);
        let rules = Rules {
            lattice: &self.lattice,
            friction: &self.friction,
            penalty: self.setting.penalty,
            time_step: self.time_step,
        };
        let Self { bodies, tracers, springs, walls, nodes, touches, pairs, setting, cost, .. } = self;
        let mut touches = record.then_some(touches);
        with_basis!(setting.basis, B => {
            penalty::at_walls::<S, B>(&rules, bodies, tracers, springs, walls, nodes, touches.as_deref_mut());
            if !pairs.found.is_empty() {
                tracers.find_boxes();
            }
            for pair in &pairs.found {
                for pair in [*pair, pair.exchanged()] {
                    penalty::between::<S, B>(&rules, bodies, &pair, tracers, springs, nodes, touches.as_deref_mut());
                }
            }
        });
        cost.pair_tests += pairs.found.len() as u64;
    }

    /// Momenta and forces of the nodes become velocities after the step and their change.
    fn step_nodes(&mut self) {
        let half = 0.5 * self.damping * self.time_step;
        let (keep, gain) = ((1.0 - half) / (1.0 + half), self.time_step / (1.0 + half));
        let gravity = self.gravity;
        for node in &mut self.nodes[..self.used] {
            if node.mass > 0.0 {
                let inverse = 1.0 / node.mass;
                let before = node.velocity * inverse;
                node.velocity = before * keep + (node.change * inverse + gravity) * gain;
                node.change = before;
            } else {
                (node.velocity, node.change) = (S::ORIGIN, S::ORIGIN);
            }
        }
        self.held.hold(&self.bodies, &mut self.nodes);
        if self.is_nodal() {
            let Self { lattice, friction, setting, time_step, bodies, shared, walls, nodes, .. } = self;
            let rules = nodal::Rules { lattice, friction, contact: setting.contact, time_step: *time_step };
            match setting.contact {
                Contact::Gap => nodal::apply_pairs(&rules, bodies, shared, walls, &mut Stepped(nodes)),
                _ => nodal::apply(&rules, bodies, shared, walls, &mut Stepped(nodes)),
            }
        }
        for node in &mut self.nodes[..self.used] {
            node.change = node.velocity - node.change;
        }
    }

    fn gather(&mut self) {
        let project = self.setting.stress_update == StressUpdate::ModifiedLast;
        let Self { lattice, bodies, points, nodes, projected, setting, time_step, .. } = self;
        macro_rules! gather {
            ($B:ty, $T:ty, $transfer:expr, $part:expr) => {
                if project {
                    transfer::gather::<S, $B, $T, true>(lattice, $part, $transfer, *time_step, points, nodes, projected)
                } else {
                    transfer::gather::<S, $B, $T, false>(
                        lattice, $part, $transfer, *time_step, points, nodes, projected,
                    )
                }
            };
        }
        for body in bodies.iter() {
            with_basis!(setting.basis, B => match setting.transfer {
                Transfer::Flip { pic } => gather!(B, Flip, Flip { pic }, &body.part),
                Transfer::Apic => gather!(B, Apic, Apic, &body.part),
                Transfer::Spin => gather!(B, Spin, Spin, &body.part),
            });
        }
    }

    /// Velocity gradients, then deformation and stress of every point.
    fn update_stress(&mut self, velocities: Velocities) -> Result<(), Box<Broken>> {
        let Self { lattice, bodies, points, nodes, projected, setting, time_step, .. } = self;
        let mut failure: Option<(usize, Failure)> = None;
        for (place, body) in bodies.iter().enumerate() {
            let part: &Part = &body.part;
            with_basis!(setting.basis, B => match velocities {
                Velocities::Stepped => {
                    transfer::gradients::<S, B>(lattice, part, points, |slot| nodes[slot].velocity);
                }
                Velocities::Projected => transfer::gradients::<S, B>(lattice, part, points, |slot| projected[slot]),
            });
            let found = match body.law {
                Material::NeoHookean(law) => stress::update(law, part.points.clone(), *time_step, points),
                Material::Hypoelastic(law) => stress::update(law, part.points.clone(), *time_step, points),
                Material::VonMises(law) => stress::update(law, part.points.clone(), *time_step, points),
            };
            failure = failure.or(found.map(|failure| (place, failure)));
        }
        match failure {
            None => Ok(()),
            Some((place, Failure { point, cause })) => Err(self.broken(place, point, cause)),
        }
    }

    /// Carries tracers with the bodies they are on.
    fn move_tracers(&mut self, velocities: Velocities) {
        let Self { lattice, bodies, tracers, nodes, projected, setting, time_step, .. } = self;
        for body in bodies.iter() {
            with_basis!(setting.basis, B => match velocities {
                Velocities::Stepped => {
                    tracers.carry::<B>(lattice, body, nodes, |slot| nodes[slot].velocity, *time_step);
                }
                Velocities::Projected => tracers.carry::<B>(lattice, body, nodes, |slot| projected[slot], *time_step),
            });
        }
    }

    /// Points go where they are next, unless that is too far.
    fn move_points(&mut self) -> Result<(), Box<Broken>> {
        let cell = self.lattice.shortest(S::DIMENSION);
        let mut farthest = 0.0_f64;
        for (position, next) in self.points.position.iter_mut().zip(&self.points.next) {
            let way = *next - *position;
            let squared = S::dot(way, way);
            // A way that is not a number counts as too far.
            farthest = if squared <= farthest { farthest } else { squared };
            *position = *next;
        }
        let farthest = farthest.sqrt();
        if !(farthest <= cell) {
            return Err(self.ran_away(cell));
        }
        self.travelled += farthest;
        self.find_bounds();
        Ok(())
    }

    /// Which point went too far.
    fn ran_away(&self, cell: f64) -> Box<Broken> {
        let velocity = |at: usize| S::dot(self.points.velocity[at], self.points.velocity[at]).sqrt();
        for (place, body) in self.bodies.iter().enumerate() {
            for at in body.part.points.clone() {
                let position = self.points.position[at];
                if !S::dot(position, position).is_finite() {
                    return self.broken(place, at, Cause::NotFinite);
                }
            }
        }
        let mut worst = (0, 0, 0.0);
        for (place, body) in self.bodies.iter().enumerate() {
            for at in body.part.points.clone() {
                if velocity(at) > worst.2 {
                    worst = (place, at, velocity(at));
                }
            }
        }
        self.broken(worst.0, worst.1, Cause::LeftCell { moved: worst.2 * self.time_step, cell })
    }

    /// Boxes around bodies.
    fn find_bounds(&mut self) {
        for body in &mut self.bodies {
            let start = [Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)];
            let of = |positions: &[S::Vector], start: [Vector3<f64>; 2]| {
                positions.iter().fold(start, |[low, high], &at| {
                    let at = S::embed(at);
                    [low.inf(&at), high.sup(&at)]
                })
            };
            let points = of(&self.points.position[body.part.points.clone()], start);
            body.bounds = of(&self.tracers.position[body.tracers.clone()], points);
        }
    }

    pub(crate) fn broken(&self, place: usize, point: usize, cause: Cause) -> Box<Broken> {
        let advice = if self.time_step > self.critical {
            format!("the step was above the limit h/c; {:.4e} s is stable for most scenes", 0.5 * self.critical)
        } else {
            "the step is within h/c: look at velocities, at the stress update, or refine the grid".to_owned()
        };
        Box::new(Broken {
            time: self.step as f64 * self.time_step,
            step: self.step,
            subject: match self.bodies[place].owner {
                Owner::Grain(id) => Subject::PointOfGrain(id),
                Owner::Body(at) => Subject::PointOfBody(at + 1),
            },
            position: S::embed(self.points.position[point]),
            cause,
            time_step: self.time_step,
            critical: self.critical,
            advice,
        })
    }
}

fn medium(body: &Body) -> Medium {
    Medium { density: body.density, lame: body.deformable.lame(), shear_modulus: body.deformable.shear_modulus }
}

/// Elastic energy of a body per volume at the start (J/m³).
pub(crate) fn energy_density(material: &Material, state: &crate::material::State) -> f64 {
    match material {
        Material::NeoHookean(law) => law.energy(state),
        Material::Hypoelastic(law) => law.energy(state),
        Material::VonMises(law) => law.energy(state),
    }
}
