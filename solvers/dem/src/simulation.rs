//! One simulation: the calculation cycle of Cundall & Strack, compiled for the effects of its scene.

use crate::accounts::Accounts;
use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::tangential::{Rotation, Tangential};
use crate::contact::{Options, Touch};
use crate::grains::Grains;
use crate::neighbours::Neighbours;
use crate::walls::{MovingWall, NearWall};
use grainbench_scene::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_scene::record::{Cost, Look, Partner};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::{ContactLaw, Scene};
use grainbench_scene::solver::{Broken, Cause, Subject};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// A contact as the last force evaluation saw it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<S: Space> {
    /// Id of the first grain, from 1.
    pub(crate) grain: u32,
    pub(crate) partner: Partner,
    pub(crate) point: S::Vector,
    pub(crate) normal: S::Vector,
    pub(crate) overlap: f64,
    pub(crate) normal_force: f64,
    pub(crate) shear: S::Tangent,
    pub(crate) slipping: bool,
    pub(crate) elastic_energy: f64,
    pub(crate) rubbed: f64,
}

/// Global damping of the equation of motion, or its absence.
pub(crate) trait Drag: Copy + Send + 'static {
    /// What is kept of a velocity in a step, and what the acceleration is multiplied by.
    fn factors(rate: f64, time_step: f64) -> (f64, f64);
    /// `keep · velocity`, without arithmetic where nothing is lost.
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, keep: f64) -> V;
}

/// No global damping.
#[derive(Clone, Copy)]
pub(crate) struct NoDrag;

impl Drag for NoDrag {
    fn factors(_rate: f64, time_step: f64) -> (f64, f64) {
        (1.0, time_step)
    }
    #[inline(always)]
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, _keep: f64) -> V {
        velocity
    }
}

/// A force −α m v, taken at mid-step: v ← [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2) (Cundall & Strack 1979, eq. 35).
#[derive(Clone, Copy)]
pub(crate) struct MassProportional;

impl Drag for MassProportional {
    fn factors(rate: f64, time_step: f64) -> (f64, f64) {
        let half = 0.5 * rate * time_step;
        ((1.0 - half) / (1.0 + half), time_step / (1.0 + half))
    }
    #[inline(always)]
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, keep: f64) -> V {
        velocity * keep
    }
}

/// What the edge needs of a simulation, whatever it was compiled for.
pub trait Simulation: Send {
    /// Takes `steps` cycles.
    ///
    /// # Errors
    /// When a grain's state is no longer finite or it runs away.
    fn advance(&mut self, steps: u64) -> Result<(), Box<Broken>>;
    /// Forgets the history of every contact, as a restart without it would.
    fn forget_history(&mut self);
    /// The state after the last step, with the record so far.
    ///
    /// # Errors
    /// When it cannot be written down.
    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError>;
    /// Goes to the state that a run of the same identity left; the record so far.
    ///
    /// # Errors
    /// When the checkpoint is of another run or damaged.
    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError>;
    /// What the simulation was compiled for, in words.
    fn layout(&self) -> &'static str;
    /// Counts so far; no times.
    fn cost(&self) -> Cost;
    /// Cycles taken.
    fn step(&self) -> u64;
    /// The scene at this moment.
    fn look(&self) -> Look;
}

/// What a contact remembers: the histories of its stages.
pub(crate) type Memory<S, T, R> = (<T as Tangential<S>>::History, <R as Rolling<S>>::History);

/// A simulation in a space, with a normal, a tangential and a rolling stage.
pub(crate) struct Kernel<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> {
    pub(crate) scene: Scene,
    laws: Vec<ContactLaw>,
    material_count: usize,
    options: Options,
    pub(crate) grains: Grains<S, T::Rotation>,
    pub(crate) neighbours: Neighbours<S, Memory<S, T, R>>,
    pub(crate) walls: Vec<MovingWall<S, Memory<S, T, R>>>,
    pub(crate) seen: Vec<Seen<S>>,
    gravity: S::Vector,
    largest_radius: f64,
    pub(crate) time_step: f64,
    critical: f64,
    pub(crate) step: u64,
    /// Whether no grain has moved half of the skin since the pairs were listed.
    list_holds: bool,
    /// Bound on the distance from any wall's centre of rotation to any grain (m).
    pub(crate) extent: f64,
    pub(crate) cost: Cost,
    /// Whether the energy budget is asked for.
    pub(crate) accounting: bool,
    pub(crate) accounts: Accounts,
    /// Mass of the grains that are not driven (kg).
    pub(crate) free_mass: f64,
    stage: PhantomData<N>,
}

impl<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> Kernel<S, N, T, R> {
    /// Sets up a scene: forces at the start, and velocities half a step back, so that every cycle is alike.
    pub(crate) fn new(scene: &Scene, options: Options, time_step: f64) -> Result<Self, Box<Broken>> {
        let largest_radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
        let mean_radius = scene.grains.iter().map(|grain| grain.radius).sum::<f64>() / scene.grains.len() as f64;
        let mut kernel = Self {
            laws: scene.laws.iter().map(|law| law.map(without_idle_shear).unwrap_or_default()).collect(),
            material_count: scene.materials.len(),
            options,
            grains: Grains::new(scene),
            neighbours: Neighbours::new(SKIN * mean_radius),
            walls: scene.walls.iter().map(MovingWall::new).collect(),
            seen: Vec::new(),
            gravity: S::restrict(scene.gravity),
            largest_radius,
            time_step,
            critical: scene.critical_time_step(),
            step: 0,
            list_holds: true,
            extent: 0.0,
            cost: Cost::default(),
            accounting: scene.asks_for_budget(),
            accounts: Accounts::default(),
            free_mass: {
                let groups = scene.driven_group_of_grains();
                let free = scene.grains.iter().zip(groups).filter(|(_, group)| group.is_none());
                free.map(|(grain, _)| grain.mass).sum()
            },
            stage: PhantomData,
            scene: scene.clone(),
        };
        kernel.rebuild()?;
        kernel.evaluate_forces::<true>(0.0);
        kernel.step_back_half();
        kernel.drive(0.0);
        if kernel.accounting {
            kernel.account();
        }
        Ok(kernel)
    }

    /// From the velocity at the start to that half a step before it, so that the first cycle ends at half a step after.
    fn step_back_half(&mut self) {
        let half = 0.5 * self.time_step;
        let drag = 1.0 + self.scene.global_damping * half;
        let grains = &mut self.grains;
        for slot in 0..grains.len() {
            let movement = &mut grains.movement[slot];
            let acceleration = grains.force[slot] * movement.inverse_mass + self.gravity;
            movement.velocity = movement.velocity * drag - acceleration * half;
            let rotation = &mut grains.rotation[slot];
            if let Some(spin) = rotation.spin() {
                let acceleration = rotation.acceleration(grains.torque[slot]);
                rotation.set_spin(spin * drag - acceleration * half);
            }
        }
    }

    /// Nothing that acts on driven grains moves them.
    fn shield_driven(&mut self) {
        let grains = &mut self.grains;
        for &grain in self.scene.driven.iter().flat_map(|driven| &driven.grains) {
            let slot = grains.slot[grain] as usize;
            grains.force[slot] = S::ORIGIN;
            grains.torque[slot] = Default::default();
        }
    }

    /// Driven grains keep their velocity and do not turn, whatever gravity and drag have made of them in `drifted` (s).
    fn drive(&mut self, drifted: f64) {
        let grains = &mut self.grains;
        for driven in &self.scene.driven {
            let velocity = S::restrict(driven.velocity);
            for &grain in &driven.grains {
                let slot = grains.slot[grain] as usize;
                let movement = &mut grains.movement[slot];
                grains.place[slot].position += (velocity - movement.velocity) * drifted;
                movement.velocity = velocity;
                grains.rotation[slot].set_spin(S::NO_SPIN);
            }
        }
    }

    /// One cycle: motion from the forces of the last, walls, and the forces for the next.
    fn cycle<const RECORD: bool>(&mut self) -> Result<(), Box<Broken>> {
        self.shield_driven();
        match (self.scene.global_damping == 0.0, self.gravity == S::ORIGIN) {
            (true, true) => self.drift::<NoDrag, false>(),
            (true, false) => self.drift::<NoDrag, true>(),
            (false, true) => self.drift::<MassProportional, false>(),
            (false, false) => self.drift::<MassProportional, true>(),
        }
        self.drive(self.time_step);
        self.step += 1;
        let time = self.step as f64 * self.time_step;
        let mut walls_moved = 0.0_f64;
        for wall in &mut self.walls {
            wall.move_to(time, self.time_step);
            walls_moved = walls_moved.max(wall.moved_since_list(self.extent));
        }
        let half_skin = 0.5 * self.neighbours.skin;
        if !(self.list_holds && walls_moved <= half_skin) {
            self.rebuild()?;
        }
        self.evaluate_forces::<RECORD>(self.time_step);
        if RECORD && self.accounting {
            self.account();
        }
        self.cost.steps += 1;
        self.cost.particle_steps += self.grains.len() as u64;
        Ok(())
    }

    /// Kick and drift of every grain (eqs. 22 and 22a); forces are taken up and set to zero.
    fn drift<D: Drag, const GRAVITY: bool>(&mut self) {
        let (keep, gain) = D::factors(self.scene.global_damping, self.time_step);
        let (gravity, time_step) = (self.gravity, self.time_step);
        let half_skin = 0.5 * self.neighbours.skin;
        let near_enough = half_skin * half_skin;
        let grains = &mut self.grains;
        let mut stayed = true;
        let linear = grains.place.iter_mut().zip(&mut grains.movement).zip(&mut grains.force);
        for (((place, movement), force), reference) in linear.zip(&self.neighbours.reference) {
            let mut acceleration = *force * movement.inverse_mass;
            if GRAVITY {
                acceleration += gravity;
            }
            *force = S::ORIGIN;
            movement.velocity = D::keep(movement.velocity, keep) + acceleration * gain;
            place.position += movement.velocity * time_step;
            let away = place.position - *reference;
            // A position that is not a number has not stayed: listing anew looks at every grain.
            stayed &= S::dot(away, away) <= near_enough;
        }
        self.list_holds = stayed;
        if T::ACTIVE {
            for (rotation, torque) in grains.rotation.iter_mut().zip(&mut grains.torque) {
                rotation.advance(*torque, keep, gain, time_step);
                *torque = Default::default();
            }
        }
    }

    /// Lists neighbours anew, after a look at every grain.
    fn rebuild(&mut self) -> Result<(), Box<Broken>> {
        self.refuse_broken_state()?;
        let domain = self.scene.domain.filter(|_| self.scene.is_periodic());
        let by_wall: Vec<NearWall<Memory<S, T, R>>> = self
            .walls
            .iter()
            .map(|wall| wall.near.iter().map(|&(slot, history)| (self.grains.id[slot as usize], history)).collect())
            .collect();
        let exchange = |(shear, rolling): Memory<S, T, R>| (T::exchange(shear), R::exchange(rolling));
        self.neighbours.rebuild(&mut self.grains, domain.as_ref(), self.largest_radius, exchange);
        let mut remembered = vec![Memory::<S, T, R>::default(); self.grains.len()];
        self.extent = 0.0;
        for (wall, before) in self.walls.iter_mut().zip(&by_wall) {
            before.iter().for_each(|&(id, history)| remembered[id as usize] = history);
            wall.begin_list();
            for (slot, place) in self.grains.place.iter().enumerate() {
                if wall.facing(place.position).distance < place.radius + self.neighbours.skin {
                    wall.near.push((slot as u32, remembered[self.grains.id[slot] as usize]));
                }
                self.extent = self.extent.max(wall.distance_to_centre(S::embed(place.position)));
            }
            before.iter().for_each(|&(id, _)| remembered[id as usize] = Memory::<S, T, R>::default());
        }
        self.extent += self.largest_radius + self.neighbours.skin;
        self.list_holds = true;
        self.cost.neighbour_builds = self.neighbours.builds;
        Ok(())
    }

    fn refuse_broken_state(&self) -> Result<(), Box<Broken>> {
        for (slot, (place, movement)) in self.grains.place.iter().zip(&self.grains.movement).enumerate() {
            let position = S::embed(place.position);
            let moved = S::embed(movement.velocity).norm() * self.time_step;
            let finite = position.iter().all(|value| value.is_finite()) && moved.is_finite();
            let cause = match (finite, moved > place.radius) {
                (false, _) => Cause::NotFinite,
                (true, true) => Cause::Runaway { moved, radius: place.radius },
                (true, false) => continue,
            };
            let last = self.neighbours.reference.get(slot).map_or(position, |&at| S::embed(at));
            return Err(self.broken(slot, if finite { position } else { last }, cause));
        }
        Ok(())
    }

    fn broken(&self, slot: usize, position: Vector3<f64>, cause: Cause) -> Box<Broken> {
        let stable = crate::stability::stable_fraction(&self.scene);
        let fraction = self.time_step / self.critical;
        let advice = if fraction > stable {
            format!(
                "{stable:.3} of the critical step ({:.4e} s) is stable for any packing of equal grains",
                stable * self.critical
            )
        } else {
            "the step is within what is stable for any packing of equal grains: look at velocities, wall motion and \
             initial overlaps"
                .to_owned()
        };
        Box::new(Broken {
            time: self.step as f64 * self.time_step,
            step: self.step,
            subject: Subject::Grain(self.grains.id[slot] + 1),
            position,
            cause,
            time_step: self.time_step,
            critical: self.critical,
            advice,
        })
    }

    /// Forces and torques at all contacts; tangential springs are stretched by what slipped in `elapsed` (s).
    fn evaluate_forces<const RECORD: bool>(&mut self, elapsed: f64) {
        if RECORD {
            self.seen.clear();
        }
        self.pairs::<RECORD, false>(elapsed);
        self.pairs::<RECORD, true>(elapsed);
        self.wall_contacts::<RECORD>(elapsed);
    }

    /// The pairs of one list; with `ACROSS`, those across a periodic face.
    fn pairs<const RECORD: bool, const ACROSS: bool>(&mut self, elapsed: f64) {
        let (grains, neighbours) = (&mut self.grains, &mut self.neighbours);
        let pairs = if ACROSS { &mut neighbours.across } else { &mut neighbours.near };
        if pairs.partner.is_empty() {
            return;
        }
        self.cost.pair_tests += pairs.partner.len() as u64;
        let mut touching = 0_u64;
        for (row, ends) in pairs.start.windows(2).enumerate() {
            let range = ends[0] as usize..ends[1] as usize;
            if ACROSS && range.is_empty() {
                continue;
            }
            let (place, movement, rotation) = (grains.place[row], grains.movement[row], grains.rotation[row]);
            let laws = &self.laws[usize::from(grains.material[row]) * self.material_count..];
            let shifts = if ACROSS { &neighbours.shift[range.clone()] } else { &[] };
            let mut force = S::ORIGIN;
            let mut torque = <T::Rotation as Rotation<S>>::Torque::default();
            let listed = pairs.partner[range.clone()].iter().zip(&mut pairs.history[range]);
            for (at, (&partner, history)) in listed.enumerate() {
                let other = partner as usize;
                let other_place = &grains.place[other];
                let mut between = other_place.position - place.position;
                if ACROSS {
                    between -= shifts[at];
                }
                let squared = S::dot(between, between);
                let reach = place.radius + other_place.radius;
                if squared < reach * reach {
                    touching += 1;
                    let other_movement = &grains.movement[other];
                    let pair = Pair {
                        law: &laws[usize::from(grains.material[other])],
                        between,
                        squared,
                        radii: [place.radius, other_place.radius],
                        velocity: movement.velocity - other_movement.velocity,
                        inverse_masses: [movement.inverse_mass, other_movement.inverse_mass],
                        spins: [rotation.spin(), grains.rotation[other].spin()],
                        inertia: if R::ACTIVE {
                            [rotation.inertia(), grains.rotation[other].inertia()]
                        } else {
                            [0.0; 2]
                        },
                    };
                    let answer = respond::<S, N, T, R, RECORD>(&pair, &self.options, elapsed, history);
                    force += answer.force;
                    grains.force[other] -= answer.force;
                    if T::ACTIVE {
                        T::Rotation::add(&mut torque, answer.twist * answer.arms[0]);
                        T::Rotation::add(&mut grains.torque[other], answer.twist * answer.arms[1]);
                    }
                    if R::ACTIVE {
                        T::Rotation::add(&mut torque, answer.rolling);
                        T::Rotation::add(&mut grains.torque[other], -answer.rolling);
                    }
                    if RECORD {
                        let id = |slot: usize| grains.id[slot] + 1;
                        let point = place.position + answer.normal * (place.radius - 0.5 * answer.overlap);
                        self.seen.push(answer.seen(id(row), Partner::Grain(id(other)), point));
                    }
                } else {
                    *history = Memory::<S, T, R>::default();
                }
            }
            grains.force[row] += force;
            if T::ACTIVE {
                T::Rotation::add(&mut grains.torque[row], T::Rotation::torque(torque));
            }
        }
        self.cost.contact_evaluations += touching;
    }

    fn wall_contacts<const RECORD: bool>(&mut self, elapsed: f64) {
        let grains = &mut self.grains;
        for (number, wall) in self.walls.iter_mut().enumerate() {
            let mut near = std::mem::take(&mut wall.near);
            wall.force = S::ORIGIN;
            self.cost.pair_tests += near.len() as u64;
            for (slot, history) in &mut near {
                let slot = *slot as usize;
                let place = grains.place[slot];
                let facing = wall.facing(place.position);
                if facing.distance >= place.radius {
                    *history = Memory::<S, T, R>::default();
                    continue;
                }
                let law_at = usize::from(grains.material[slot]) * self.material_count;
                let law = &self.laws[law_at + usize::from(wall.material())];
                let movement = grains.movement[slot];
                let touch = Touch {
                    law,
                    between: facing.normal,
                    inverse_distance: 1.0,
                    normal: facing.normal,
                    overlap: place.radius - facing.distance,
                    velocity: movement.velocity - facing.velocity,
                    effective_mass: 1.0 / movement.inverse_mass,
                    effective_radius: place.radius,
                };
                let arms = [place.radius - self.options.arm_reduction * touch.overlap, 0.0];
                let spin = grains.rotation[slot].spin();
                let rolling = if R::ACTIVE && self.options.rolls_by_surface { arms[0] / facing.distance } else { 1.0 };
                let turning = spin.map(|spin| Turning {
                    surface: spin * arms[0],
                    relative: spin * rolling,
                    inertia: grains.rotation[slot].inertia() + touch.effective_mass * place.radius * place.radius,
                });
                let answer = stages::<S, N, T, R, RECORD>(&touch, arms, turning, &self.options, elapsed, history);
                grains.force[slot] += answer.force;
                wall.force -= answer.force;
                if T::ACTIVE {
                    T::Rotation::add(&mut grains.torque[slot], answer.twist * answer.arms[0]);
                }
                if R::ACTIVE {
                    T::Rotation::add(&mut grains.torque[slot], answer.rolling);
                }
                self.cost.contact_evaluations += 1;
                if RECORD {
                    let point = place.position + facing.normal * (place.radius - 0.5 * answer.overlap);
                    let partner = Partner::Wall(number as u16);
                    self.seen.push(answer.seen(grains.id[slot] + 1, partner, point));
                }
            }
            wall.near = near;
        }
    }
}

/// Skin of the neighbour list as a fraction of the mean radius: a tenth of a diameter, as in the stored LAMMPS run. It costs
/// pairs that are tested in vain and saves lists that are built anew.
const SKIN: f64 = 0.2;

/// A law without friction has no tangential spring or dashpot either, also in a scene that has friction elsewhere.
fn without_idle_shear(law: ContactLaw) -> ContactLaw {
    if law.has_friction() { law } else { ContactLaw { tangential_stiffness: 0.0, tangential_damping: 0.0, ..law } }
}

/// Two grains that touch, as the loop over pairs finds them.
struct Pair<'a, S: Space> {
    law: &'a ContactLaw,
    between: S::Vector,
    squared: f64,
    radii: [f64; 2],
    velocity: S::Vector,
    inverse_masses: [f64; 2],
    spins: [Option<S::Spin>; 2],
    /// Moments of inertia, only set for rolling resistance.
    inertia: [f64; 2],
}

/// How two bodies turn at their contact.
struct Turning<S: Space> {
    /// ω₁a₁ + ω₂a₂ (m/s).
    surface: S::Spin,
    /// ω₁ − ω₂ (rad/s), or what rolls in its place at walls.
    relative: S::Spin,
    /// Moment of inertia of the pair about the contact, [1/(I₁ + m₁R₁²) + 1/(I₂ + m₂R₂²)]⁻¹ (kg m²).
    inertia: f64,
}

/// What the stages answer.
struct Answer<S: Space> {
    normal: S::Vector,
    overlap: f64,
    /// Force on the first body (N).
    force: S::Vector,
    /// `e × F_s`: a torque when multiplied by an arm.
    twist: S::Spin,
    /// Moment against rolling on the first body (N m).
    rolling: S::Spin,
    arms: [f64; 2],
    normal_force: f64,
    shear: S::Tangent,
    slipping: bool,
    /// Energy in the springs (J), only when it is recorded.
    elastic_energy: f64,
    /// Work of friction in the step (J), only when it is recorded.
    rubbed: f64,
}

impl<S: Space> Answer<S> {
    fn seen(&self, grain: u32, partner: Partner, point: S::Vector) -> Seen<S> {
        Seen {
            grain,
            partner,
            point,
            normal: self.normal,
            overlap: self.overlap,
            normal_force: self.normal_force,
            shear: self.shear,
            slipping: self.slipping,
            elastic_energy: self.elastic_energy,
            rubbed: self.rubbed,
        }
    }
}

#[inline(always)]
fn respond<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>, const RECORD: bool>(
    pair: &Pair<'_, S>,
    options: &Options,
    elapsed: f64,
    history: &mut Memory<S, T, R>,
) -> Answer<S> {
    let distance = pair.squared.sqrt();
    let inverse_distance = 1.0 / distance;
    let [first, second] = pair.radii;
    let overlap = first + second - distance;
    let touch = Touch {
        law: pair.law,
        between: pair.between,
        inverse_distance,
        normal: pair.between * inverse_distance,
        overlap,
        velocity: pair.velocity,
        effective_mass: if N::DAMPED { 1.0 / (pair.inverse_masses[0] + pair.inverse_masses[1]) } else { 0.0 },
        effective_radius: if N::CURVED || R::ACTIVE { first * second / (first + second) } else { 0.0 },
    };
    let arms = pair.radii.map(|radius| radius - options.arm_reduction * overlap);
    let turning = match pair.spins {
        [Some(a), Some(b)] => {
            let about = |k: usize| pair.inertia[k] + pair.radii[k] * pair.radii[k] / pair.inverse_masses[k];
            let inertia = if R::ACTIVE { 1.0 / (1.0 / about(0) + 1.0 / about(1)) } else { 0.0 };
            Some(Turning { surface: a * arms[0] + b * arms[1], relative: a - b, inertia })
        }
        _ => None,
    };
    stages::<S, N, T, R, RECORD>(&touch, arms, turning, options, elapsed, history)
}

/// The chain of stages at one contact.
#[inline(always)]
fn stages<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>, const RECORD: bool>(
    touch: &Touch<'_, S>,
    arms: [f64; 2],
    turning: Option<Turning<S>>,
    options: &Options,
    elapsed: f64,
    history: &mut Memory<S, T, R>,
) -> Answer<S> {
    let normal = N::force(touch, options);
    let mut answer = Answer {
        normal: touch.normal,
        overlap: touch.overlap,
        force: touch.between * -(normal.total * touch.inverse_distance),
        twist: S::NO_SPIN,
        rolling: S::NO_SPIN,
        arms,
        normal_force: normal.total,
        shear: S::NO_TANGENT,
        slipping: false,
        elastic_energy: 0.0,
        rubbed: 0.0,
    };
    if let (true, Some(turning)) = (T::ACTIVE, turning) {
        let slip = S::slip_velocity(touch.velocity, turning.surface, touch.normal);
        let before = history.0;
        let shear = T::respond::<N>(touch, normal, slip, elapsed, &mut history.0);
        let force = S::along(shear.force, touch.normal);
        answer.force += force;
        answer.twist = S::torque(touch.normal, force);
        if RECORD {
            answer.rubbed = T::rubbed::<N>(touch, slip, elapsed, before, history.0);
        }
        (answer.shear, answer.slipping) = (shear.force, shear.slipping);
        if R::ACTIVE {
            answer.rolling = R::moment::<N>(touch, normal, turning.relative, elapsed, turning.inertia, &mut history.1);
        }
    }
    if RECORD {
        let shear = T::energy(history.0, N::tangential_stiffness(touch));
        answer.elastic_energy = N::energy(touch) + shear + R::energy::<N>(touch, history.1);
    }
    answer
}

impl<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> Simulation for Kernel<S, N, T, R> {
    fn advance(&mut self, steps: u64) -> Result<(), Box<Broken>> {
        for _ in 1..steps {
            if self.accounting {
                self.cycle::<true>()?;
            } else {
                self.cycle::<false>()?;
            }
        }
        // The last cycle leaves its contacts to be looked at.
        if steps > 0 { self.cycle::<true>() } else { Ok(()) }
    }

    fn forget_history(&mut self) {
        self.neighbours.forget();
        for wall in &mut self.walls {
            wall.near.iter_mut().for_each(|(_, history)| *history = Memory::<S, T, R>::default());
        }
    }

    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        self.kept(identity, recorder)
    }

    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError> {
        self.recalled(identity, checkpoint)
    }

    fn layout(&self) -> &'static str {
        std::any::type_name::<Self>()
    }

    fn cost(&self) -> Cost {
        self.cost
    }

    fn step(&self) -> u64 {
        self.step
    }

    fn look(&self) -> Look {
        crate::observe::look(self)
    }
}
