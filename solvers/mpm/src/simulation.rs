//! One simulation: the cycle points → nodes → points.

use crate::accounts::{Accounts, Flow, Tally};
use crate::bodies::{Body, Material, seed};
use crate::contact::pairs::Pairs;
use crate::contact::penalty::Springs;
use crate::contact::shared::Shared;
use crate::contact::{FrictionTable, Touch, grip};
use crate::damping::Damping;
use crate::driven::Driven;
use crate::gather::Gather;
use crate::gradients::Gradients;
use crate::grid::{Lattice, Node, Window};
use crate::held::Held;
use crate::lanes::Processor;
use crate::material::Law;
use crate::options::{Contact, Setting, StressUpdate, Transfer};
use crate::points::Points;
use crate::runs::{self, Ground, LONGEST, Run};
use crate::scatter::Scatter;
use crate::start::medium;
use crate::stress::{Failure, Update};
use crate::surface::{Carry, Tracers};
use crate::transfer::{self, Apic, Flip, Spin};
use crate::walls::RigidPlane;
use grainbench_scene::record::Cost;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Broken, Cause};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// Compiles a call for the basis that was chosen.
macro_rules! with_basis {
    ($basis:expr, $B:ident => $call:expr) => {
        match $basis {
            $crate::options::Basis::Linear => {
                type $B = $crate::basis::Linear;
                $call
            }
            $crate::options::Basis::Quadratic => {
                type $B = $crate::basis::Quadratic;
                $call
            }
            $crate::options::Basis::Gimp => {
                type $B = $crate::basis::Gimp;
                $call
            }
        }
    };
}

pub(crate) use with_basis;

/// Nodes beyond which a grid is taken for a mistake.
const MOST_NODES: f64 = 5e7;

/// Points are put in order when they make more runs than in order, by one in so many.
const DISORDER: usize = 8;

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
    /// What each node counts for at most at a surface.
    pub(crate) most: Vec<f64>,
    /// Runs of points in the step under way.
    runs: Vec<Run>,
    pub(crate) processor: Processor,
    /// Velocity gradients of the points at hand (1/s).
    gradients: Vec<S::Matrix>,
    /// Nodes in use.
    pub(crate) used: usize,
    pub(crate) friction: FrictionTable,
    pub(crate) held: Held,
    pub(crate) driven: Driven<S>,
    /// The energy budget, where it is asked for.
    pub(crate) accounts: Option<Accounts<S>>,
    pub(crate) springs: Springs<S>,
    pub(crate) shared: Shared<S>,
    pub(crate) pairs: Pairs<S>,
    pub(crate) touches: Vec<Touch<S>>,
    pub(crate) time_step: f64,
    pub(crate) critical: f64,
    pub(crate) step: u64,
    pub(crate) gravity: S::Vector,
    /// Mass-proportional damping α (1/s).
    pub(crate) damping: f64,
    pub(crate) settling: bool,
    /// Velocities of the points a step before those of the last look (m/s): velocities are half a step behind positions.
    pub(crate) before: Vec<S::Vector>,
    /// Step of the last look.
    pub(crate) looked: u64,
    pub(crate) cost: Cost,
}

impl<S: Space> Simulation<S> {
    /// Bodies where a scene has them; not yet settled nor set moving, see [`Simulation::begin`].
    pub(crate) fn new(
        scene: &Scene,
        setting: Setting,
        lattice: Lattice,
        per_cell: u32,
        time_step: f64,
        critical: f64,
    ) -> Self {
        let (bodies, points, tracers) = seed::<S>(scene, &setting, &lattice, per_cell);
        let friction = FrictionTable::of(scene);
        let walls: Vec<RigidPlane<S>> = scene.walls.iter().filter_map(RigidPlane::new).collect();
        Self {
            held: Held::new(&bodies, &lattice),
            driven: Driven::new(scene),
            accounts: None,
            springs: Springs::new(friction.acts() && setting.contact == Contact::Penalty, tracers.len()),
            friction,
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
            most: Vec::new(),
            runs: Vec::new(),
            processor: Processor::new(),
            gradients: vec![S::NO_GRADIENT; LONGEST],
            used: 0,
            touches: Vec::new(),
            time_step,
            critical,
            step: 0,
            settling: false,
            before: Vec::new(),
            looked: 0,
            cost: Cost::default(),
        }
    }

    /// Settles the bodies and sets them moving.
    ///
    /// # Errors
    /// When they reach farther than a grid can, or break while they settle.
    pub(crate) fn begin(&mut self) -> Result<(), Box<Broken>> {
        self.settle()?;
        self.set_moving();
        self.open_accounts();
        Ok(())
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
    pub(crate) fn cycle(&mut self, record: bool) -> Result<(), Box<Broken>> {
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
        self.place_windows()?;
        self.scatter();
        if record {
            self.before.copy_from_slice(&self.points.velocity);
        }
        self.find_driven();
        self.find_shared();
        if self.setting.stress_update == StressUpdate::First {
            self.project_momentum();
            let mut flow = Flow::default();
            for place in 0..self.bodies.len() {
                self.update_stress(place, Velocities::Projected, &mut flow)?;
            }
            self.account_for_flow(flow);
            self.scatter_force_again();
        }
        self.body_force(time);
        self.note_internal_forces();
        self.spring_forces(record);
        self.held.fold(&self.bodies, &mut self.nodes);
        self.note_forces();
        self.step_nodes();
        self.gather();
        self.note_driven();
        self.driven.carry(&self.bodies, &mut self.points, self.time_step);
        self.account_for_nodes();
        let is_projected = self.setting.stress_update == StressUpdate::ModifiedLast;
        if is_projected {
            self.finish_projection();
        }
        self.account_for_contacts();
        self.move_on(if is_projected { Velocities::Projected } else { Velocities::Stepped })?;
        self.step += 1;
        self.cost.steps += 1;
        self.cost.particle_steps += self.points.len() as u64;
        self.cost.bytes = self.cost.bytes.max(self.bytes() as u64);
        Ok(())
    }

    /// Memory that points, tracers, nodes and contacts take up (B), by their numbers.
    fn bytes(&self) -> usize {
        let of_a_node = size_of::<Node<S>>() + size_of::<S::Vector>() + size_of::<f64>();
        // The velocity at the last look is a point's too.
        self.points.bytes()
            + size_of_val(&*self.before)
            + self.tracers.len() * Tracers::<S>::BYTES
            + self.springs.friction.bytes()
            + self.accounts.as_ref().map_or(0, Accounts::bytes)
            + self.used * of_a_node
            + self.shared.bytes()
            + self.pairs.bytes()
            + size_of_val(&*self.runs)
            + self.bodies.len() * size_of::<Body>()
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
            if count >= MOST_NODES || count.is_nan() {
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
            self.most.resize(start + start / 4, 0.0);
        }
        self.nodes[..start].fill(Node::EMPTY);
        self.projected[..start].fill(S::ORIGIN);
        Ok(())
    }

    /// Begins the step for driven bodies and contacts.
    fn find_driven(&mut self) {
        self.accounts.iter_mut().for_each(|accounts| accounts.tally = Tally::default());
        self.driven.begin(self.settling);
        if !self.driven.groups.is_empty() {
            let one_field = self.setting.contact == Contact::NoSlip;
            let Self { driven, lattice, bodies, points, setting, .. } = self;
            driven.find_held(lattice, bodies, points, setting.basis, one_field);
        }
    }

    /// Finds the points of a body that reach the same nodes. Where they no longer follow each other they are put in the order of
    /// their cells.
    fn find_runs(&mut self, place: usize) {
        let Self { lattice, bodies, points, runs, setting, .. } = self;
        let part = &mut bodies[place].part;
        with_basis!(setting.basis, B => {
            part.runs = runs::find::<S, B>(lattice, part.points.clone(), points, runs);
            if part.runs.len() > part.runs_in_order + part.runs_in_order / DISORDER {
                points.sort(part.points.clone(), |position| part.window.slot(lattice.first::<S, B>(position)));
                runs.truncate(part.runs.start);
                part.runs = runs::find::<S, B>(lattice, part.points.clone(), points, runs);
                part.runs_in_order = part.runs.len();
            }
        });
    }

    /// Points bring mass, momentum and internal force to the nodes, body by body: what a body has is in the cache only while it is
    /// worked on.
    fn scatter(&mut self) {
        self.runs.clear();
        for place in 0..self.bodies.len() {
            self.find_runs(place);
            let Self { lattice, bodies, points, nodes, most, runs, setting, processor, .. } = self;
            let part = &bodies[place].part;
            let ground = Ground::new(lattice, part, &runs[part.runs.clone()], points);
            with_basis!(setting.basis, B => match setting.transfer {
                Transfer::Flip { .. } => processor.run(Scatter::<S, B, Flip>::new(ground, points, nodes)),
                Transfer::Apic => processor.run(Scatter::<S, B, Apic>::new(ground, points, nodes)),
                Transfer::Spin => processor.run(Scatter::<S, B, Spin>::new(ground, points, nodes)),
            });
            let window = part.window.slots();
            grip::bear(&nodes[window.clone()], part.cell_mass, &mut most[window]);
        }
    }

    /// For stresses that come first: the velocities of the nodes as the points bring them.
    fn project_momentum(&mut self) {
        for (projected, node) in self.projected[..self.used].iter_mut().zip(&self.nodes) {
            *projected = node.velocity;
        }
        self.finish_projection();
    }

    /// Projected momenta become velocities that contacts and held sides allow.
    fn finish_projection(&mut self) {
        let Self { bodies, nodes, projected, held, driven, used, .. } = self;
        held.fold_projected::<S>(bodies, projected);
        for (projected, node) in projected[..*used].iter_mut().zip(nodes.iter()) {
            *projected = if node.mass > 0.0 { *projected * (1.0 / node.mass) } else { S::ORIGIN };
        }
        held.hold_projected::<S>(bodies, projected);
        driven.hold_projected(projected, nodes);
        self.meet_projected();
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

    /// Momenta and forces of the nodes become velocities after the step and their change.
    fn step_nodes(&mut self) {
        let Damping { keep, gain } = Damping::over(self.damping, self.time_step);
        let gravity = self.gravity;
        let mut stepped = 0;
        for node in &mut self.nodes[..self.used] {
            if node.mass > 0.0 {
                stepped += 1;
                let inverse = 1.0 / node.mass;
                let before = node.velocity * inverse;
                node.velocity = before * keep + (node.change * inverse + gravity) * gain;
                node.change = before;
            } else {
                (node.velocity, node.change) = (S::ORIGIN, S::ORIGIN);
            }
        }
        self.cost.node_updates += stepped;
        self.held.hold(&self.bodies, &mut self.nodes);
        self.driven.hold(&mut self.nodes, self.time_step);
        self.meet_stepped();
        for node in &mut self.nodes[..self.used] {
            node.change = node.velocity - node.change * keep;
        }
    }

    fn gather(&mut self) {
        let project = self.setting.stress_update == StressUpdate::ModifiedLast;
        let Damping { keep, .. } = Damping::over(self.damping, self.time_step);
        let Self { lattice, bodies, points, nodes, projected, runs, setting, processor, time_step, .. } = self;
        let time_step = *time_step;
        macro_rules! gather {
            ($B:ty, $T:ty, $transfer:expr, $part:expr, $project:literal) => {{
                let (transfer, part, basis) = ($transfer, $part, PhantomData::<$B>);
                let runs = &runs[part.runs.clone()];
                let gather: Gather<'_, S, $B, $T, $project> =
                    Gather { lattice, part, runs, transfer, time_step, keep, points, nodes, projected, basis };
                processor.run(gather);
            }};
            ($B:ty, $T:ty, $transfer:expr, $part:expr) => {
                if project { gather!($B, $T, $transfer, $part, true) } else { gather!($B, $T, $transfer, $part, false) }
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

    /// Velocity gradients, then deformation and stress of the points of a body.
    fn update_stress(&mut self, place: usize, velocities: Velocities, flow: &mut Flow) -> Result<(), Box<Broken>> {
        let Self {
            lattice,
            bodies,
            points,
            nodes,
            projected,
            gradients,
            runs,
            processor,
            setting,
            time_step,
            accounts,
            ..
        } = self;
        let spins = setting.transfer == Transfer::Spin;
        let Body { part, law, .. } = &bodies[place];
        let mut failure = None;
        for runs in runs::in_groups(&runs[part.runs.clone()]) {
            let range = runs[0].start..runs[runs.len() - 1].end;
            let ground = Ground::new(lattice, part, runs, points);
            with_basis!(setting.basis, B => match velocities {
                Velocities::Stepped => {
                    let velocity = |node: &Node<S>| node.velocity;
                    processor.run(Gradients::<S, B, _, _>::new(ground, nodes, velocity, gradients));
                }
                Velocities::Projected => {
                    let velocity = |velocity: &S::Vector| *velocity;
                    processor.run(Gradients::<S, B, _, _>::new(ground, projected, velocity, gradients));
                }
            });
            macro_rules! update {
                ($law:ident, $count:literal) => {{
                    let (law, failure, time_step) = ($law, &mut failure, *time_step);
                    let update: Update<'_, S, _, $count> =
                        Update { law, range, gradients, time_step, spins, points, flow, failure };
                    processor.run(update);
                }};
                ($law:ident) => {
                    if accounts.is_some() { update!($law, true) } else { update!($law, false) }
                };
            }
            match *law {
                Material::NeoHookean(law) => update!(law),
                Material::Hypoelastic(law) => update!(law),
                Material::VonMises(law) => update!(law),
            }
        }
        match failure {
            None => Ok(()),
            Some(Failure { point, cause }) => Err(self.broken(place, point, cause)),
        }
    }

    /// Stresses follow, if they do not come first; tracers and points go where they are next, unless that is too far.
    fn move_on(&mut self, velocities: Velocities) -> Result<(), Box<Broken>> {
        let cell = self.lattice.shortest(S::DIMENSION);
        let mut flow = Flow::default();
        let (mut farthest, mut lost) = (0.0_f64, false);
        for place in 0..self.bodies.len() {
            if self.setting.stress_update != StressUpdate::First {
                self.update_stress(place, velocities, &mut flow)?;
            }
            self.move_tracers(place, velocities);
            let Self { bodies, points, .. } = self;
            let range = bodies[place].part.points.clone();
            for (position, next) in points.position[range.clone()].iter_mut().zip(&points.next[range]) {
                let way = *next - *position;
                let squared = S::dot(way, way);
                lost |= squared.is_nan();
                farthest = farthest.max(squared);
                *position = *next;
            }
            self.find_bounds(place);
        }
        if lost || farthest.sqrt() > cell {
            return Err(self.ran_away(cell));
        }
        if self.setting.stress_update != StressUpdate::First {
            self.account_for_flow(flow);
        }
        Ok(())
    }

    /// Carries the tracers of a body with it.
    fn move_tracers(&mut self, place: usize, velocities: Velocities) {
        let Self { lattice, bodies, tracers, nodes, projected, most, setting, time_step, processor, .. } = self;
        let (body, elapsed) = (&bodies[place], *time_step);
        with_basis!(setting.basis, B => {
            let basis = PhantomData::<B>;
            match velocities {
                Velocities::Stepped => {
                    let velocity = |node: &Node<S>| node.velocity;
                    processor.run(Carry { lattice, body, tracers, nodes, most, velocity, elapsed, basis });
                }
                Velocities::Projected => {
                    let (nodes, velocity) = (projected, |velocity: &S::Vector| *velocity);
                    processor.run(Carry { lattice, body, tracers, nodes, most, velocity, elapsed, basis });
                }
            }
        });
    }

    /// The box around a body.
    fn find_bounds(&mut self, place: usize) {
        let Self { bodies, points, tracers, .. } = self;
        let body = &mut bodies[place];
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let around = enclose::<S>(none, &points.position[body.part.points.clone()]);
        let bounds = enclose::<S>(around, &tracers.position[body.tracers.clone()]);
        body.bounds = bounds.map(|[x, y, z]| S::embed(S::restrict(Vector3::new(x, y, z))));
    }

    /// The boxes around all bodies.
    pub(crate) fn find_all_bounds(&mut self) {
        (0..self.bodies.len()).for_each(|place| self.find_bounds(place));
    }
}

/// The box around positions and another box.
fn enclose<S: Space>([mut low, mut high]: [[f64; 3]; 2], positions: &[S::Vector]) -> [[f64; 3]; 2] {
    for &position in positions {
        for axis in 0..S::DIMENSION {
            let at = S::component(position, axis);
            low[axis] = if at < low[axis] { at } else { low[axis] };
            high[axis] = if at > high[axis] { at } else { high[axis] };
        }
    }
    [low, high]
}

/// Elastic energy of a body per volume at the start (J/m³).
pub(crate) fn energy_density(material: &Material, state: &crate::material::State) -> f64 {
    match material {
        Material::NeoHookean(law) => law.energy(state),
        Material::Hypoelastic(law) => law.energy(state),
        Material::VonMises(law) => law.energy(state),
    }
}
