//! One simulation: the calculation cycle of Cundall & Strack, compiled for the effects of its scene.
//!
//! A cycle moves the grains by the forces of the last one ([`crate::motion`]), moves the walls, lists the neighbours
//! anew if it must ([`crate::neighbours`]), and finds the forces for the next ([`crate::forces`]).

use crate::accounts::{Accounts, Step};
use crate::contact::Options;
use crate::contact::chain::{Memory, exchanged};
use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::seen::Seen;
use crate::contact::tangential::Tangential;
use crate::forces::{Terms, pairs, wall_contacts};
use crate::grains::Grains;
use crate::laws::Laws;
use crate::motion::Motion;
use crate::neighbours::Neighbours;
use crate::rotation::Rotation;
use crate::stability::stable_fraction;
use crate::walls::{MovingWall, NearWall};
use grainbench_scene::record::Counts;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Broken, Cause, Subject};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// Skin of the neighbour list as a fraction of the mean radius: a tenth of a diameter, as in the stored LAMMPS run. A
/// wider skin tests more pairs in vain and builds fewer lists anew.
const SKIN: f64 = 0.2;

/// A simulation in a space, with a normal, a tangential and a rolling stage.
pub(crate) struct Kernel<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> {
    pub(crate) scene: Scene,
    laws: Laws,
    options: Options,
    /// Gravity, global damping and the time step.
    pub(crate) motion: Motion<S>,
    pub(crate) grains: Grains<S, T::Rotation>,
    pub(crate) neighbours: Neighbours<S, Memory<S, T, R>>,
    pub(crate) walls: Vec<MovingWall<S, Memory<S, T, R>>>,
    /// Every contact of the last force evaluation, if it was recorded.
    pub(crate) seen: Vec<Seen<S>>,
    /// Largest radius of a grain (m).
    largest_radius: f64,
    /// Critical time step 2√(m_min/k_max) of the scene (s).
    critical: f64,
    /// Cycles taken.
    pub(crate) step: u64,
    /// Whether no grain has moved half of the skin since the pairs were listed.
    list_holds: bool,
    /// Bound on the distance from any wall's centre of rotation to any grain (m).
    pub(crate) extent: f64,
    pub(crate) cost: Counts,
    /// Whether the energy budget is asked for.
    pub(crate) accounting: bool,
    pub(crate) accounts: Accounts,
    /// Mass of the grains that are not driven (kg).
    free_mass: f64,
    stage: PhantomData<N>,
}

impl<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> Kernel<S, N, T, R> {
    /// Sets up a scene: the forces at the start, and velocities half a step before it, so that all cycles are alike.
    pub(crate) fn new(scene: &Scene, options: Options, time_step: f64) -> Result<Self, Box<Broken>> {
        let largest_radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
        let mean_radius = scene.grains.iter().map(|grain| grain.radius).sum::<f64>() / scene.grains.len() as f64;
        let mut kernel = Self {
            laws: Laws::new(scene),
            options,
            grains: Grains::new(scene),
            neighbours: Neighbours::new(SKIN * mean_radius),
            walls: scene.walls.iter().map(MovingWall::new).collect(),
            seen: Vec::new(),
            motion: Motion { gravity: S::restrict(scene.gravity), global_damping: scene.global_damping, time_step },
            largest_radius,
            critical: scene.critical_time_step(),
            step: 0,
            list_holds: true,
            extent: 0.0,
            cost: Counts::default(),
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
        kernel.motion.step_back_half(&mut kernel.grains);
        kernel.drive(0.0);
        if kernel.accounting {
            kernel.account();
        }
        Ok(kernel)
    }

    /// Takes `steps` cycles.
    pub(crate) fn take_cycles(&mut self, steps: u64) -> Result<(), Box<Broken>> {
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

    /// One cycle: motion by the forces of the last, walls, and the forces for the next. With `RECORD` its contacts are
    /// kept.
    fn cycle<const RECORD: bool>(&mut self) -> Result<(), Box<Broken>> {
        self.shield_driven();
        let half_skin = 0.5 * self.neighbours.skin;
        self.list_holds = self.motion.advance(&mut self.grains, &self.neighbours.reference, half_skin);
        self.drive(self.motion.time_step);
        self.step += 1;
        let time = self.step as f64 * self.motion.time_step;
        let mut walls_moved = 0.0_f64;
        for wall in &mut self.walls {
            wall.move_to(time, self.motion.time_step);
            walls_moved = walls_moved.max(wall.moved_since_list(self.extent));
        }
        if !(self.list_holds && walls_moved <= half_skin) {
            self.rebuild()?;
        }
        self.evaluate_forces::<RECORD>(self.motion.time_step);
        if RECORD && self.accounting {
            self.account();
        }
        self.cost.steps += 1;
        self.cost.particle_steps += self.grains.len() as u64;
        Ok(())
    }

    /// Finds the forces and torques at all contacts; springs are stretched by what slipped and rolled in `elapsed` (s).
    fn evaluate_forces<const RECORD: bool>(&mut self, elapsed: f64) {
        let terms = Terms { laws: &self.laws, options: self.options, elapsed };
        let (grains, neighbours, walls) = (&mut self.grains, &mut self.neighbours, &mut self.walls);
        let (seen, cost) = (&mut self.seen, &mut self.cost);
        if RECORD {
            seen.clear();
        }
        pairs::<S, N, T, R, RECORD, false>(terms, grains, neighbours, seen, cost);
        pairs::<S, N, T, R, RECORD, true>(terms, grains, neighbours, seen, cost);
        wall_contacts::<S, N, T, R, RECORD>(terms, grains, walls, seen, cost);
    }

    /// Sets the forces and torques on driven grains to zero: nothing that acts on them moves them.
    fn shield_driven(&mut self) {
        let grains = &mut self.grains;
        for &grain in self.scene.driven.iter().flat_map(|driven| &driven.grains) {
            let slot = grains.slot[grain] as usize;
            grains.force[slot] = S::ORIGIN;
            grains.torque[slot] = Default::default();
        }
    }

    /// Gives driven grains the velocity they are driven with and no spin, and takes back what gravity and global
    /// damping have changed in their positions in the time `drifted` (s).
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

    /// Force of the other grains on each group of driven grains (N).
    pub(crate) fn forces_on_driven(&self) -> Vec<Vector3<f64>> {
        self.scene.driven.iter().map(|driven| self.grains.force_on(&driven.grains)).collect()
    }

    /// Adds to the energy budget what the step did whose forces have just been found.
    fn account(&mut self) {
        let (driven, walls) = (&self.scene.driven, &self.walls);
        let mut forces = self.forces_on_driven();
        forces.extend(walls.iter().map(|wall| S::embed(wall.force)));
        let velocities = driven.iter().map(|driven| driven.velocity).chain(walls.iter().map(MovingWall::velocity));
        self.accounts.add(Step {
            forces,
            velocities: velocities.collect(),
            gravity: self.scene.gravity,
            free_mass: self.free_mass,
            friction: self.seen.iter().map(|seen| seen.rubbed).sum(),
            time_step: self.motion.time_step,
        });
    }

    /// Forgets the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.neighbours.forget();
        for wall in &mut self.walls {
            wall.near.iter_mut().for_each(|(_, history)| *history = Memory::<S, T, R>::default());
        }
    }

    /// Lists the neighbours anew, after a look at every grain.
    fn rebuild(&mut self) -> Result<(), Box<Broken>> {
        self.refuse_broken_state()?;
        let domain = self.scene.domain.filter(|_| self.scene.is_periodic());
        let by_wall: Vec<NearWall<Memory<S, T, R>>> = self
            .walls
            .iter()
            .map(|wall| wall.near.iter().map(|&(slot, history)| (self.grains.id[slot as usize], history)).collect())
            .collect();
        self.neighbours.rebuild(&mut self.grains, domain.as_ref(), self.largest_radius, exchanged::<S, T, R>);
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

    /// Refuses a state in which a position or velocity is not finite, or a grain moves by more than its radius in a
    /// step.
    fn refuse_broken_state(&self) -> Result<(), Box<Broken>> {
        for (slot, (place, movement)) in self.grains.place.iter().zip(&self.grains.movement).enumerate() {
            let position = S::embed(place.position);
            let moved = S::embed(movement.velocity).norm() * self.motion.time_step;
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

    /// The error for a grain that broke the run, with advice about the time step.
    fn broken(&self, slot: usize, position: Vector3<f64>, cause: Cause) -> Box<Broken> {
        let stable = stable_fraction(&self.scene);
        let fraction = self.motion.time_step / self.critical;
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
            time: self.step as f64 * self.motion.time_step,
            step: self.step,
            subject: Subject::Grain(self.grains.id[slot] + 1),
            position,
            cause,
            time_step: self.motion.time_step,
            critical: self.critical,
            advice,
        })
    }
}
