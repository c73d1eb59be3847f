//! Simulation of one scene by the calculation cycle of Cundall & Strack.
//!
//! A cycle moves the grains by the forces of the previous cycle ([`crate::motion`]) and moves the walls. It rebuilds
//! the neighbour list if necessary ([`crate::neighbours`]). Then it computes the forces for the next cycle
//! ([`crate::forces`]).

use crate::accounts::EnergyBudget;
use crate::contact::MEMORY;
use crate::contact::options::Options;
use crate::forces::Forces;
use crate::geometry::Geometry;
use crate::grains::{ABSENT, Grains};
use crate::joints::Joints;
use crate::listed::Pairs;
use crate::motion::{Motion, MotionData};
use crate::neighbours::NeighbourSearch;
use crate::recording::Recording;
use crate::share::{ContactModel, Evaluation, FEWEST, ThreadPartition, Threads};
use crate::stability::CriticalStep;
use crate::walls::MovingWall;
use grainbench_lanes::Team;
use grainbench_scene::overlap::nearest_image;
use grainbench_scene::scene::Scene;
use grainbench_solver::Defect;
use grainbench_solver::failure::{Cause, FailedParticle, LARGEST_ENTRY_OVERLAP, SimulationFailure};
use grainbench_solver::record::Counts;
use nalgebra::Vector3;

/// Simulation in two or three dimensions.
pub(crate) struct DemSimulation<S: Geometry> {
    pub(crate) scene: Scene,
    pub(crate) model: ContactModel<S>,
    /// Gravity, global damping and time step.
    pub(crate) motion: Motion,
    pub(crate) grains: Grains<S>,
    pub(crate) neighbours: NeighbourSearch,
    pub(crate) walls: Vec<MovingWall>,
    joints: Joints,
    pub(crate) threads: Threads,
    pub(crate) recording: Recording,
    pub(crate) critical: CriticalStep,
    /// Number of cycles taken.
    pub(crate) step: u64,
    pub(crate) cost: Counts,
    pub(crate) budget: EnergyBudget,
    /// Defect, for negative controls only.
    pub(crate) defect: Option<Defect>,
    /// Number of grains inserted so far.
    pub(crate) entered: usize,
}

impl<S: Geometry> DemSimulation<S> {
    /// Sets up the simulation of a scene. It computes the initial forces and shifts all velocities back by half a step,
    /// so that the first cycle does not differ from later ones.
    pub(crate) fn new(
        scene: &Scene,
        forces: Box<dyn Forces<S>>,
        options: Options,
        time_step: f64,
        (team, most_rows): (Team, u64),
    ) -> Result<Self, Box<SimulationFailure>> {
        let gravity = S::embed(S::restrict(scene.gravity));
        let mut simulation = Self {
            grains: Grains::new(scene, forces.turn()),
            neighbours: NeighbourSearch::new(scene),
            walls: scene.walls.iter().map(|wall| MovingWall::new(wall, options.mid_step)).collect(),
            joints: Joints::new(&scene.walls),
            model: ContactModel::new(scene, forces, options),
            motion: Motion { gravity, global_damping: scene.global_damping, time_step },
            threads: Threads { team, fewest: FEWEST },
            recording: Recording::new(scene, most_rows),
            critical: CriticalStep::new(scene),
            step: 0,
            cost: Counts::default(),
            budget: EnergyBudget::new(scene),
            defect: None,
            entered: scene.stays.entered_by(0.0),
            scene: scene.clone(),
        };
        if let Some(springs) = &scene.springs {
            simulation.begin_with(springs);
        }
        simulation.rebuild()?;
        simulation.recording.contacts = simulation.touching_at_start() as u64;
        simulation.evaluate_forces(true, 0.0, false);
        let all = 0..simulation.grains.len();
        simulation.motion.step_back_half(&mut simulation.grains, all);
        simulation.walls.iter_mut().for_each(|wall| wall.step_back_half(time_step));
        simulation.drive(0.0);
        if simulation.budget.is_requested {
            simulation.account();
        }
        Ok(simulation)
    }

    /// Returns an upper bound of the number of contacts, before the first force evaluation. It counts overlapping pairs of
    /// grains, and all pairs listed at walls, even without overlap.
    fn touching_at_start(&self) -> usize {
        let in_contact = |pairs: &Pairs, at: usize| {
            let [one, other] = [pairs.row[at], pairs.partner[at]].map(|slot| slot as usize);
            let shift = pairs.shift.get(at).map_or_else(Vector3::zeros, S::vector_in_space);
            let apart = self.grains.position(other) - self.grains.position(one) - shift;
            apart.norm() < self.grains.radius(one) + self.grains.radius(other)
        };
        let lists = self.neighbours.list.shares.iter().flat_map(|share| [&share.near.pairs, &share.across.pairs]);
        let pairs = lists.map(|pairs| pairs.own().filter(|&at| in_contact(pairs, at)).count());
        pairs.sum::<usize>() + self.walls.iter().map(MovingWall::pairs).sum::<usize>()
    }

    /// Runs `steps` cycles.
    pub(crate) fn take_cycles(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>> {
        let team = self.threads.team.clone();
        team.lead(|| self.cycles(steps))
    }

    fn cycles(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>> {
        // Without an energy budget and without grains of prescribed motion, nothing happens between the force evaluation
        // and the motion of the grains. The grains are then moved directly after their forces are computed.
        let at_once = !self.budget.is_requested && self.scene.driven.is_empty();
        let mut has_moved = false;
        for left in (0..steps).rev() {
            // Contacts are recorded for the energy budget, for output after the last cycle, and for the mean of V σ.
            let record = self.budget.is_requested || left == 0 || self.recording.is_sampled(self.step + 1);
            let move_on = at_once && left > 0;
            self.cycle(record, has_moved, move_on)?;
            if self.critical.is_checked_at(self.step) {
                self.refuse_stiff_contacts()?;
            }
            has_moved = move_on;
        }
        Ok(())
    }

    /// Runs one cycle. It moves the grains by the forces of the last evaluation (unless `has_moved`), moves the walls,
    /// and computes the new forces. With `move_on`, the grains move again directly after the force evaluation. With
    /// `record`, the contacts are recorded.
    fn cycle(&mut self, record: bool, has_moved: bool, move_on: bool) -> Result<(), Box<SimulationFailure>> {
        if !has_moved {
            self.shield_driven();
            self.move_grains();
        }
        self.drive(self.motion.time_step);
        self.step += 1;
        let time = self.time();
        self.begin_and_end_driving();
        let mut walls_moved = 0.0_f64;
        let mut changed = self.scene.stays.entered_by(time) > self.entered || self.has_leavers();
        for wall in &mut self.walls {
            wall.move_to(time, self.motion.time_step);
            changed |= wall.take_away(time);
            walls_moved = walls_moved.max(wall.moved_since_list(self.neighbours.extent));
        }
        let worn_out = self.neighbours.is_worn_out(&self.grains, walls_moved);
        if worn_out {
            self.neighbours.fit_skin(self.step, self.grains.len(), S::DIMENSION);
        }
        if changed || worn_out {
            self.rebuild()?;
        }
        self.evaluate_forces(record, self.motion.time_step, move_on);
        self.let_go();
        if record {
            self.recording.add_virials(self.step, &self.neighbours.list.shares, &self.scene.grains);
        }
        if record && self.budget.is_requested {
            self.account();
        }
        self.cost.steps += 1;
        self.cost.particle_steps += self.grains.len() as u64;
        Ok(())
    }

    /// Moves all grains over one step by the forces on them.
    fn move_grains(&mut self) {
        let Self { model, motion, grains, neighbours, threads, .. } = self;
        let all = 0..grains.len();
        let mut left = MotionData::new(grains, all);
        let parts = neighbours.list.shares.iter().map(|share| left.take_off(share.rows.len()));
        let fastest = threads.team.fold(parts, |_, part| motion.advance::<S>(model.processor, part), 0.0, f64::max);
        neighbours.travel(fastest, motion.time_step);
    }

    /// Computes the forces and torques at all contacts. `elapsed` is the time since the last evaluation (s); springs
    /// are displaced by the slip and the rolling during this time. `record` and `move_on` are as in `cycle`.
    fn evaluate_forces(&mut self, record: bool, elapsed: f64, move_on: bool) {
        let Self { model, motion, grains, neighbours, walls, joints, threads, recording, step, cost, .. } = self;
        let (model, terms) = (&*model, model.terms(elapsed, record));
        if record {
            recording.begin(*step, grains.len());
        }
        let (one_by_one, before) = (recording.one_by_one, cost.contact_evaluations);
        joints.look(walls, grains);
        for (number, wall) in walls.iter_mut().enumerate() {
            cost.pair_tests += wall.pairs() as u64;
            let seen = record.then_some(&mut recording.at_walls);
            cost.contact_evaluations += model.loops.at_wall(terms, grains, wall, number as u16, seen);
        }
        cost.pair_tests += neighbours.list.pairs() as u64;
        let evaluation = Evaluation { model, terms, one_by_one };
        if let [whole] = &mut neighbours.list.shares[..] {
            let (found, fastest) = evaluate_and_move(whole, &evaluation, grains, move_on.then_some(&*motion));
            cost.contact_evaluations += found;
            if move_on {
                neighbours.travel(fastest, motion.time_step);
            }
            recording.contacts = cost.contact_evaluations - before;
            return;
        }
        let (read, mut left) = grains.parts();
        let parts = neighbours.list.shares.iter_mut().map(|share| (left.take_off(share.rows.len()), share));
        let evaluate = |_, (sums, share): (_, &mut ThreadPartition)| share.evaluate(&evaluation, read, sums);
        cost.contact_evaluations += threads.team.fold(parts, evaluate, 0, |sum, found| sum + found);
        recording.contacts = cost.contact_evaluations - before;
        if move_on {
            self.move_grains();
        }
    }

    /// Returns the time to which the positions belong (s). The velocities belong to a time half a step earlier.
    pub(crate) fn time(&self) -> f64 {
        self.step as f64 * self.motion.time_step
    }

    /// Adds the step of the last force evaluation to the energy budget.
    fn account(&mut self) {
        let (driven, walls) = (&self.scene.driven, &self.walls);
        let mut forces = self.forces_on_driven();
        forces.extend(walls.iter().map(|wall| wall.kept.force));
        let velocities = driven.iter().map(|driven| driven.velocity).chain(walls.iter().map(|wall| wall.velocity));
        let energies = || self.recording.energies(&self.neighbours.list.shares);
        let EnergyBudget { accounts, free_mass, .. } = &mut self.budget;
        accounts.add_work(forces, velocities, self.motion.time_step);
        accounts.impulse += self.scene.gravity * (*free_mass * self.motion.time_step);
        accounts.friction += energies().map(|energies| energies.rubbed).sum::<f64>();
        accounts.released += energies().map(|energies| energies.released).sum::<f64>();
    }

    /// Returns true if grains are due for removal at this step.
    fn has_leavers(&self) -> bool {
        let Some(removal) = self.scene.stays.removal.filter(|removal| self.step.is_multiple_of(removal.every)) else {
            return false;
        };
        (0..self.grains.len()).any(|slot| removal.takes(self.grains.position(slot), S::DIMENSION))
    }

    /// Inserts and removes the grains that are due at this step. Returns, for the grain in each slot, its previous slot,
    /// or [`ABSENT`] for an inserted grain. Returns `None` if nothing changed.
    fn come_and_go(&mut self) -> Option<Vec<u32>> {
        let time = self.time();
        let coming = self.entered..self.scene.stays.entered_by(time);
        let leave = self.has_leavers();
        if coming.is_empty() && !leave {
            return None;
        }
        let mut slots: Vec<u32> = (0..self.grains.len() as u32).collect();
        if let Some(removal) = self.scene.stays.removal.filter(|_| leave) {
            slots.retain(|&slot| !removal.takes(self.grains.position(slot as usize), S::DIMENSION));
            self.grains.slot.fill(ABSENT);
            self.grains.reorder(&slots);
        }
        let rotate = self.model.loops.turn();
        for entry in coming {
            let id = self.scene.stays.entries[entry].grain;
            let mut grain = self.scene.grains[id];
            grain.velocity = self.motion.half_before(grain.velocity);
            self.grains.enter(id as u32, &grain, rotate);
            slots.push(ABSENT);
            self.entered += 1;
        }
        Some(slots)
    }

    /// Checks the state of every grain, inserts and removes grains, and rebuilds the neighbour lists of grains and walls.
    fn rebuild(&mut self) -> Result<(), Box<SimulationFailure>> {
        self.refuse_broken_state()?;
        let domain = self.scene.domain.filter(|_| self.scene.is_periodic());
        let ids = self.grains.id.clone();
        let layout = self.model.loops.layout();
        let slots = self.come_and_go();
        if let Some(slots) = &slots {
            self.refuse_crowded(slots)?;
        }
        let Self { neighbours, grains, threads, .. } = self;
        let (shares, radii) = (threads.partitions(grains.len()), neighbours.radii_of_cells(&self.scene));
        let moved = (grains, slots.as_deref());
        neighbours.list.rebuild(&threads.team, shares, moved, domain.as_ref(), radii, layout);
        let mut remembered = vec![[0.0; MEMORY]; self.scene.grains.len()];
        let (mut extent, skin) = (0.0_f64, self.neighbours.list.skin);
        for wall in &mut self.walls {
            if wall.list_triangles(&self.grains, &ids, skin) {
                (0..self.grains.len()).for_each(|slot| {
                    extent = extent.max(wall.distance_to_centre(self.grains.position(slot)));
                });
                continue;
            }
            let before = wall.kept.near.clone();
            wall.begin_list();
            if wall.kept.gone {
                continue;
            }
            before.iter().for_each(|&(slot, memory)| remembered[ids[slot as usize] as usize] = memory);
            for slot in 0..self.grains.len() {
                let position = self.grains.position(slot);
                if wall.facing(position).distance < self.grains.radius(slot) + skin {
                    wall.kept.near.push((slot as u32, remembered[self.grains.id[slot] as usize]));
                }
                extent = extent.max(wall.distance_to_centre(position));
            }
            before.iter().for_each(|&(slot, _)| remembered[ids[slot as usize] as usize] = [0.0; MEMORY]);
        }
        self.neighbours.begin(extent, self.step);
        self.cost.neighbour_builds = self.neighbours.list.builds;
        Ok(())
    }

    /// Returns an error if an inserted grain overlaps another grain or a wall by more than `LARGEST_ENTRY_OVERLAP`.
    /// `slots` holds the previous slot of each grain, or [`ABSENT`] for an inserted grain.
    fn refuse_crowded(&self, slots: &[u32]) -> Result<(), Box<SimulationFailure>> {
        let domain = self.scene.domain.filter(|_| self.scene.is_periodic());
        for slot in (0..slots.len()).filter(|&slot| slots[slot] == ABSENT) {
            let (position, radius) = (self.grains.position(slot), self.grains.radius(slot));
            let into_grain = |other: usize| {
                let between = nearest_image(self.grains.position(other) - position, domain.as_ref());
                let smaller = radius.min(self.grains.radius(other));
                let ratio = (radius + self.grains.radius(other) - between.norm()) / smaller;
                (ratio > LARGEST_ENTRY_OVERLAP)
                    .then(|| Cause::CameIntoGrain { other: self.grains.id[other] + 1, ratio })
            };
            let into_wall = |(number, wall): (usize, &MovingWall)| {
                let ratio = 1.0 - wall.facing(position).distance / radius;
                (!wall.kept.gone && ratio > LARGEST_ENTRY_OVERLAP)
                    .then_some(Cause::CameIntoWall { wall: number as u16 + 1, ratio })
            };
            let cause = (0..slot).find_map(into_grain).or_else(|| self.walls.iter().enumerate().find_map(into_wall));
            if let Some(cause) = cause {
                return Err(self.broken(slot, position, cause));
            }
        }
        Ok(())
    }

    /// Returns an error if a position or velocity is not finite, or if a grain moves by more than its radius in a step.
    fn refuse_broken_state(&self) -> Result<(), Box<SimulationFailure>> {
        for slot in 0..self.grains.len() {
            let (position, radius) = (self.grains.position(slot), self.grains.radius(slot));
            let moved = self.grains.velocity(slot).norm() * self.motion.time_step;
            let finite = position.iter().all(|value| value.is_finite()) && moved.is_finite();
            let cause = match (finite, moved > radius) {
                (false, _) => Cause::NotFinite,
                (true, true) => Cause::Runaway { moved, radius },
                (true, false) => continue,
            };
            let last = self.neighbours.list.reference.get(slot).map_or(position, S::vector_in_space);
            return Err(self.broken(slot, if finite { position } else { last }, cause));
        }
        Ok(())
    }

    /// Returns the error for a grain with an invalid state, with advice on the time step or on the insertion of grains.
    fn broken(&self, slot: usize, position: Vector3<f64>, cause: Cause) -> Box<SimulationFailure> {
        let advice = if matches!(cause, Cause::CameIntoGrain { .. } | Cause::CameIntoWall { .. }) {
            "pour fewer grains, at a lower rate or from a higher place".to_owned()
        } else {
            self.critical.advice(&self.scene, self.motion.time_step)
        };
        self.failure(slot, position, cause, self.critical.time_step, advice)
    }

    /// Returns the error for a grain, with the critical time step (s) that it names.
    pub(crate) fn failure(
        &self,
        slot: usize,
        position: Vector3<f64>,
        cause: Cause,
        critical: f64,
        advice: String,
    ) -> Box<SimulationFailure> {
        let subject = FailedParticle::Grain(self.grains.id[slot] + 1);
        let (time, step, time_step) = (self.time(), self.step, self.motion.time_step);
        Box::new(SimulationFailure { time, step, subject, position, cause, time_step, critical, advice })
    }
}

/// Computes the forces of all pairs. With `motion`, the grains of each block are moved as soon as their forces are
/// complete. Returns the number of contacts and the square of the largest speed (m²/s²; zero without `motion`).
fn evaluate_and_move<S: Geometry>(
    whole: &mut ThreadPartition,
    evaluation: &Evaluation<'_, S>,
    grains: &mut Grains<S>,
    motion: Option<&Motion>,
) -> (u64, f64) {
    let ThreadPartition { rows, near, across } = whole;
    let (mut contacts, mut moved, mut fastest) = (0, 0, 0.0_f64);
    for block in across.blocks(evaluation.one_by_one) {
        let (read, sums) = grains.parts();
        contacts += across.evaluate(rows, evaluation, read, sums, block);
    }
    for block in near.blocks(evaluation.one_by_one) {
        let (read, sums) = grains.parts();
        contacts += near.evaluate(rows, evaluation, read, sums, block.clone());
        if let (Some(motion), Some(row)) = (motion, near.row_after(&block)) {
            fastest = fastest.max(motion.advance::<S>(evaluation.model.processor, MotionData::new(grains, moved..row)));
            moved = row;
        }
    }
    if let Some(motion) = motion {
        let left = moved..grains.len();
        fastest = fastest.max(motion.advance::<S>(evaluation.model.processor, MotionData::new(grains, left)));
    }
    (contacts, fastest)
}
