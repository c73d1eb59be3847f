//! Simulation of one scene by the calculation cycle of Cundall & Strack.
//!
//! A cycle moves the grains by the forces of the previous cycle ([`crate::motion`]) and moves the walls. It rebuilds
//! the neighbour list if necessary ([`crate::neighbours`]). Then it computes the forces for the next cycle
//! ([`crate::forces`]).

use crate::accounts::{Accounts, Step};
use crate::contact::MEMORY;
use crate::contact::options::Options;
use crate::forces::Forces;
use crate::geometry::Geometry;
use crate::grains::{ABSENT, Grains};
use crate::joints::Joints;
use crate::laws::Laws;
use crate::listed::Pairs;
use crate::mean_virial::MeanVirial;
use crate::motion::{Motion, MotionData};
use crate::neighbours::Neighbours;
use crate::seen::{Energies, RecordedContacts};
use crate::share::{Evaluation, FEWEST, ThreadPartition};
use crate::skin;
use crate::stability::stable_fraction;
use crate::terms::Terms;
use crate::walls::{MovingWall, WallNeighbours};
use grainbench_lanes::{Processor, Team};
use grainbench_scene::columns::{Chosen, Columns};
use grainbench_scene::overlap::nearest_image;
use grainbench_scene::scene::{Driven, Probe, Scene};
use grainbench_solver::failure::{Cause, FailedParticle, LARGEST_ENTRY_OVERLAP, SimulationFailure};
use grainbench_solver::record::{ContactState, Counts};
use nalgebra::Vector3;

/// Radius above which a grain has no cell in the search grid, in mean radii. Cells as large as such a grain would contain
/// hundreds of other grains.
const FAR_LARGER: f64 = 4.0;

/// Number of steps between two checks of the contact stiffness. At a tenth of the critical time step, a collision takes
/// about thirty steps. A check costs about as much as a step.
const STEPS_BETWEEN_LOOKS: u64 = 32;

/// Simulation in two or three dimensions.
pub(crate) struct DemSimulation<S: Geometry> {
    pub(crate) scene: Scene,
    laws: Laws,
    options: Options,
    /// Gravity, global damping and time step.
    pub(crate) motion: Motion,
    pub(crate) grains: Grains<S>,
    pub(crate) neighbours: Neighbours,
    pub(crate) walls: Vec<MovingWall>,
    joints: Joints,
    /// Loops over contacts, compiled for the laws of the scene.
    pub(crate) forces: Box<dyn Forces<S>>,
    /// Instruction set of the loops over contacts.
    pub(crate) processor: Processor,
    /// Threads of the run.
    team: Team,
    /// Smallest number of grains in a thread partition.
    pub(crate) fewest_in_a_share: usize,
    /// Contacts with walls in the last force evaluation that recorded contacts.
    seen_at_walls: RecordedContacts,
    /// Step at which contacts were last recorded; `None` before the first recording and after `take_contacts` has moved
    /// the contacts out.
    seen_at: Option<u64>,
    /// Largest sum of the numbers of grains and contacts for which individual contacts are recorded.
    most_rows: u64,
    /// True if a probe or the mean stress of grains needs individual contacts at every recorded step.
    looks_at_contacts: bool,
    /// True if the last recording contains individual contacts, not only their energies.
    one_by_one: bool,
    /// Number of contacts in the last force evaluation.
    contacts: u64,
    /// Largest radius of a grain (m).
    largest_radius: f64,
    /// Mean radius of the grains (m).
    mean_radius: f64,
    /// Critical time step 2√(m_min/k_max) of the scene (s).
    pub(crate) critical: f64,
    /// True if the stiffness of contacts is checked against the time step.
    pub(crate) follows_critical: bool,
    /// Number of cycles taken.
    pub(crate) step: u64,
    /// Upper bound of the displacement of any grain since the neighbour list was built (m).
    pub(crate) travelled: f64,
    /// Largest prescribed speed of a group of grains (m/s).
    driven_speed: f64,
    /// Upper bound of the distance from any wall's centre of rotation to any grain (m).
    pub(crate) extent: f64,
    pub(crate) cost: Counts,
    /// True if the energy budget is requested.
    pub(crate) accounting: bool,
    pub(crate) accounts: Accounts,
    /// Sums for the time average of V σ (volume times stress) of each grain; `None` unless snapshots contain this
    /// average.
    pub(crate) mean_virial: Option<Box<MeanVirial>>,
    /// Mass of the grains without prescribed motion (kg).
    free_mass: f64,
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
        let largest_radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
        let mean_radius = scene.grains.iter().map(|grain| grain.radius).sum::<f64>() / scene.grains.len() as f64;
        let gravity = S::embed(S::restrict(scene.gravity));
        let mut simulation = Self {
            laws: Laws::new(scene, &options),
            options,
            grains: Grains::new(scene, forces.turn()),
            neighbours: Neighbours::new(skin::first(mean_radius)),
            walls: scene.walls.iter().map(|wall| MovingWall::new(wall, options.mid_step)).collect(),
            joints: Joints::new(&scene.walls),
            forces,
            processor: Processor::new(),
            team,
            fewest_in_a_share: FEWEST,
            seen_at_walls: RecordedContacts::default(),
            seen_at: None,
            most_rows,
            looks_at_contacts: {
                scene.columns.has(Chosen::MeanVirial) || scene.probes.iter().any(Probe::looks_at_contacts)
            },
            one_by_one: false,
            contacts: 0,
            motion: Motion { gravity, global_damping: scene.global_damping, time_step },
            largest_radius,
            mean_radius,
            critical: scene.critical_time_step(),
            follows_critical: false,
            step: 0,
            travelled: 0.0,
            driven_speed: scene.driven.iter().map(Driven::fastest).fold(0.0, f64::max),
            extent: 0.0,
            cost: Counts::default(),
            accounting: scene.asks_for_budget(),
            accounts: Accounts::default(),
            mean_virial: {
                let empty_mean_virial = |columns: &Columns| MeanVirial::new(scene.grains.len(), columns.mean_every);
                scene.columns.has(Chosen::MeanVirial).then(|| Box::new(empty_mean_virial(&scene.columns)))
            },
            free_mass: {
                let groups = scene.driven_group_of_grains();
                let free = scene.grains.iter().zip(groups).filter(|(_, group)| group.is_none());
                free.map(|(grain, _)| grain.mass).sum()
            },
            entered: scene.stays.entered_by(0.0),
            scene: scene.clone(),
        };
        if let Some(springs) = &scene.springs {
            simulation.begin_with(springs);
        }
        simulation.rebuild()?;
        simulation.contacts = simulation.touching_at_start() as u64;
        simulation.evaluate_forces(true, 0.0, false);
        let all = 0..simulation.grains.len();
        simulation.motion.step_back_half(&mut simulation.grains, all);
        simulation.walls.iter_mut().for_each(|wall| wall.step_back_half(time_step));
        simulation.drive(0.0);
        if simulation.accounting {
            simulation.account();
        }
        Ok(simulation)
    }

    /// Returns the number of thread partitions: one per thread, or fewer for few grains.
    pub(crate) fn shares(&self) -> usize {
        self.team.members().min(self.grains.len() / self.fewest_in_a_share).max(1)
    }

    /// Returns the energies of the contacts in the last recorded force evaluation.
    pub(crate) fn energies(&self) -> impl Iterator<Item = &Energies> {
        let list_energies =
            |list: usize| self.neighbours.shares.iter().flat_map(move |share| &share.seen()[list].energies);
        self.seen_at_walls.energies.iter().chain(list_energies(0)).chain(list_energies(1))
    }

    /// Returns the number of rows of a snapshot: the number of grains plus the number of contacts in the last force
    /// evaluation.
    pub(crate) fn rows(&self) -> u64 {
        self.grains.len() as u64 + self.contacts
    }

    /// Returns true if the last recording contains individual contacts and a snapshot has at most `most_rows` rows.
    pub(crate) fn shows(&self, most_rows: u64) -> bool {
        self.one_by_one && self.rows() <= most_rows
    }

    /// Returns an upper bound of the number of contacts, before the first force evaluation. It counts overlapping pairs of
    /// grains, and all pairs listed at walls, even without overlap.
    fn touching_at_start(&self) -> usize {
        let touch = |a: usize, b: usize, shift: Vector3<f64>| {
            let apart = self.grains.position(b) - self.grains.position(a) - shift;
            apart.norm() < self.grains.radius(a) + self.grains.radius(b)
        };
        let pairs_in_contact = |pairs: &Pairs| {
            pairs
                .own()
                .filter(|&at| {
                    let shift = pairs.shift.get(at).map_or_else(Vector3::zeros, S::vector_in_space);
                    touch(pairs.row[at] as usize, pairs.partner[at] as usize, shift)
                })
                .count()
        };
        let pairs =
            self.neighbours.shares.iter().map(|share| pairs_in_contact(&share.near) + pairs_in_contact(&share.across));
        pairs.sum::<usize>() + self.walls.iter().map(MovingWall::pairs).sum::<usize>()
    }

    /// Returns the number of contacts and the number of slipping contacts in this step; `None` if contacts were not
    /// recorded, or if `take_contacts` has moved them out.
    pub(crate) fn touching(&self) -> Option<[usize; 2]> {
        self.seen_at.filter(|&at| at == self.step)?;
        let lists = self.neighbours.shares.iter().flat_map(ThreadPartition::seen).chain([&self.seen_at_walls]);
        Some(lists.fold([0, 0], |[count, slipping], seen| [count + seen.energies.len(), slipping + seen.slipping]))
    }

    /// Moves the individual contacts of this step out of the simulation; `None` if they were not recorded or were moved
    /// out before. The contacts are sorted by the id of their first grain. For each grain, contacts with walls come
    /// first, then contacts across periodic faces, then all other contacts.
    pub(crate) fn take_contacts(&mut self) -> Option<Vec<ContactState>> {
        self.seen_at.take().filter(|&at| at == self.step && self.one_by_one)?;
        let [mut before, mut contacts] = [std::mem::take(&mut self.seen_at_walls.contacts), Vec::new()];
        for share in &mut self.neighbours.shares {
            before.append(&mut share.seen_mut()[0].contacts);
        }
        // With a single partition, the largest list is moved, not copied.
        for share in &mut self.neighbours.shares {
            let mut others = std::mem::take(&mut share.seen_mut()[1].contacts);
            if contacts.is_empty() {
                contacts = others;
            } else {
                contacts.reserve_exact(others.len());
                contacts.append(&mut others);
            }
        }
        let first = before.len();
        contacts.reserve_exact(first);
        contacts.append(&mut before);
        contacts.rotate_right(first);
        contacts.sort_by_cached_key(|contact| contact.grain);
        Some(contacts)
    }

    /// Adds the recorded contacts of this step to the sums of V σ, if this step is sampled.
    fn add_virials(&mut self) {
        let Self { mean_virial, neighbours, seen_at_walls, scene, step, .. } = self;
        if let Some(mean) = mean_virial.as_mut().filter(|mean| mean.is_due(*step)) {
            let list_contacts =
                |list: usize| neighbours.shares.iter().flat_map(move |share| &share.seen()[list].contacts);
            mean.add(seen_at_walls.contacts.iter().chain(list_contacts(0)).chain(list_contacts(1)), &scene.grains);
        }
    }

    /// Runs `steps` cycles.
    pub(crate) fn take_cycles(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>> {
        let team = self.team.clone();
        team.lead(|| self.cycles(steps))
    }

    fn cycles(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>> {
        // Without an energy budget and without grains of prescribed motion, nothing happens between the force evaluation
        // and the motion of the grains. The grains are then moved directly after their forces are computed.
        let at_once = !self.accounting && self.scene.driven.is_empty();
        let mut has_moved = false;
        for left in (0..steps).rev() {
            // Contacts are recorded for the energy budget, for output after the last cycle, and for the mean of V σ.
            let looked_at = self.mean_virial.as_ref().is_some_and(|mean| mean.is_due(self.step + 1));
            let (record, move_on) = (self.accounting || left == 0 || looked_at, at_once && left > 0);
            self.cycle(record, has_moved, move_on)?;
            if self.follows_critical && self.step % STEPS_BETWEEN_LOOKS == 1 {
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
        let half_skin = 0.5 * self.neighbours.skin;
        if !has_moved {
            self.shield_driven();
            self.move_grains();
        }
        self.drive(self.motion.time_step);
        self.step += 1;
        let time = self.step as f64 * self.motion.time_step;
        self.begin_and_end_driving();
        let mut walls_moved = 0.0_f64;
        let mut changed = self.has_comers(time) || self.has_leavers();
        for wall in &mut self.walls {
            wall.move_to(time, self.motion.time_step);
            changed |= wall.take_away(time);
            walls_moved = walls_moved.max(wall.moved_since_list(self.extent));
        }
        if self.travelled > half_skin {
            self.travelled = self.neighbours.farthest(&self.grains);
        }
        let worn_out = self.travelled.max(walls_moved) > half_skin;
        if worn_out {
            self.fit_skin();
        }
        if changed || worn_out {
            self.rebuild()?;
        }
        self.evaluate_forces(record, self.motion.time_step, move_on);
        self.let_go();
        if record {
            self.add_virials();
        }
        if record && self.accounting {
            self.account();
        }
        self.cost.steps += 1;
        self.cost.particle_steps += self.grains.len() as u64;
        Ok(())
    }

    /// Moves all grains over one step by the forces on them.
    fn move_grains(&mut self) {
        let Self { motion, grains, neighbours, team, processor, .. } = self;
        let all = 0..grains.len();
        let mut left = MotionData::new(grains, all);
        let parts = neighbours.shares.iter().map(|share| left.take_off(share.rows.len()));
        let fastest = team.fold(parts, |_, part| motion.advance::<S>(*processor, part), 0.0, f64::max);
        self.travel(fastest);
    }

    /// Computes the forces and torques at all contacts. `elapsed` is the time since the last evaluation (s); springs
    /// are displaced by the slip and the rolling during this time. `record` and `move_on` are as in `cycle`.
    fn evaluate_forces(&mut self, record: bool, elapsed: f64, move_on: bool) {
        let Self {
            laws,
            options,
            motion,
            grains,
            neighbours,
            walls,
            joints,
            forces,
            processor,
            seen_at_walls,
            seen_at,
            step,
            cost,
            team,
            most_rows,
            looks_at_contacts,
            one_by_one,
            contacts,
            ..
        } = self;
        let terms = Terms { laws, options, elapsed };
        if record {
            *one_by_one = *looks_at_contacts || grains.len() as u64 + *contacts <= *most_rows;
            seen_at_walls.begin(*one_by_one);
            *seen_at = Some(*step);
        }
        let (one_by_one, before) = (*one_by_one, cost.contact_evaluations);
        joints.look(walls, grains);
        for (number, wall) in walls.iter_mut().enumerate() {
            cost.pair_tests += wall.pairs() as u64;
            let seen = record.then_some(&mut *seen_at_walls);
            cost.contact_evaluations += forces.at_wall(terms, grains, wall, number as u16, seen);
        }
        cost.pair_tests += neighbours.shares.iter().map(|share| share.pairs() as u64).sum::<u64>();
        let evaluation = Evaluation { forces: &**forces, processor: *processor, terms, record, one_by_one };
        if let [whole] = &mut neighbours.shares[..] {
            let (found, fastest) = evaluate_and_move(whole, &evaluation, grains, move_on.then_some(&*motion));
            cost.contact_evaluations += found;
            *contacts = cost.contact_evaluations - before;
            if move_on {
                self.travel(fastest);
            }
            return;
        }
        let (read, mut left) = grains.parts();
        let parts = neighbours.shares.iter_mut().map(|share| (left.take_off(share.rows.len()), share));
        let evaluate = |_, (sums, share): (_, &mut ThreadPartition)| share.evaluate(&evaluation, read, sums);
        cost.contact_evaluations += team.fold(parts, evaluate, 0, |sum, found| sum + found);
        *contacts = cost.contact_evaluations - before;
        if move_on {
            self.move_grains();
        }
    }

    /// Adds the displacement of one step to the upper bound `travelled`. `fastest` is the square of the largest speed (m²/s²).
    fn travel(&mut self, fastest: f64) {
        self.travelled += fastest.sqrt().max(self.driven_speed) * self.motion.time_step;
    }

    /// Returns the time to which the positions belong (s). The velocities belong to a time half a step earlier.
    pub(crate) fn time(&self) -> f64 {
        self.step as f64 * self.motion.time_step
    }

    /// Adds the step of the last force evaluation to the energy budget.
    fn account(&mut self) {
        let (driven, walls) = (&self.scene.driven, &self.walls);
        let mut forces = self.forces_on_driven();
        forces.extend(walls.iter().map(|wall| wall.force));
        let velocities = driven.iter().map(|driven| driven.velocity).chain(walls.iter().map(MovingWall::velocity));
        self.accounts.add(Step {
            forces,
            velocities: velocities.collect(),
            gravity: self.scene.gravity,
            free_mass: self.free_mass,
            friction: self.energies().map(|energies| energies.rubbed).sum(),
            released: self.energies().map(|energies| energies.released).sum(),
            time_step: self.motion.time_step,
        });
    }

    /// Clears the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.neighbours.forget();
        self.walls.iter_mut().for_each(MovingWall::forget);
    }

    /// Returns true if grains are due for insertion at a time (s).
    fn has_comers(&self, time: f64) -> bool {
        self.scene.stays.entered_by(time) > self.entered
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
        let time = self.step as f64 * self.motion.time_step;
        let coming = self.entered..self.scene.stays.entered_by(time);
        let leave = self.has_leavers();
        if coming.is_empty() && !leave {
            return None;
        }
        let mut slots: Vec<u32> = (0..self.grains.len() as u32).collect();
        if let Some(removal) = self.scene.stays.removal.filter(|_| leave) {
            slots.retain(|&slot| !removal.takes(self.grains.position(slot as usize), S::DIMENSION));
            self.grains.keep(&slots);
        }
        let rotate = self.forces.turn();
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

    /// Adjusts the skin by the cost model of [`crate::skin`], from the number of pairs and the number of steps since the
    /// neighbour list was built.
    fn fit_skin(&mut self) {
        let Self { neighbours, grains, mean_radius, step, .. } = self;
        let pairs = neighbours.pairs();
        let steps = (*step - neighbours.built_at).max(1);
        let counts = [pairs as f64, grains.len() as f64, steps as f64];
        neighbours.skin = skin::next(neighbours.skin, *mean_radius, counts, S::DIMENSION);
    }

    /// Checks the state of every grain, inserts and removes grains, and rebuilds the neighbour lists of grains and walls.
    fn rebuild(&mut self) -> Result<(), Box<SimulationFailure>> {
        self.refuse_broken_state()?;
        let domain = self.scene.domain.filter(|_| self.scene.is_periodic());
        let by_wall: Vec<WallNeighbours> = self
            .walls
            .iter()
            .map(|wall| wall.near.iter().map(|&(slot, memory)| (self.grains.id[slot as usize], memory)).collect())
            .collect();
        let any_mesh = self.walls.iter().any(|wall| wall.mesh().is_some());
        let ids = if any_mesh { self.grains.id.clone() } else { Vec::new() };
        let layout = self.forces.layout();
        let slots = self.come_and_go();
        if let Some(slots) = &slots {
            self.refuse_crowded(slots)?;
        }
        let shares = self.shares();
        let radii = self.radii_of_cells();
        let Self { neighbours, grains, team, .. } = self;
        neighbours.rebuild(team, shares, (grains, slots.as_deref()), domain.as_ref(), radii, layout);
        let mut remembered = vec![[0.0; MEMORY]; self.scene.grains.len()];
        self.extent = 0.0;
        for (wall, before) in self.walls.iter_mut().zip(&by_wall) {
            if wall.list_triangles(&self.grains, &ids, self.neighbours.skin) {
                (0..self.grains.len()).for_each(|slot| {
                    self.extent = self.extent.max(wall.distance_to_centre(self.grains.position(slot)));
                });
                continue;
            }
            before.iter().for_each(|&(id, memory)| remembered[id as usize] = memory);
            wall.begin_list();
            if wall.is_gone() {
                continue;
            }
            for slot in 0..self.grains.len() {
                let position = self.grains.position(slot);
                if wall.facing(position).distance < self.grains.radius(slot) + self.neighbours.skin {
                    wall.near.push((slot as u32, remembered[self.grains.id[slot] as usize]));
                }
                self.extent = self.extent.max(wall.distance_to_centre(position));
            }
            before.iter().for_each(|&(id, _)| remembered[id as usize] = [0.0; MEMORY]);
        }
        self.extent += self.largest_radius + self.neighbours.skin;
        self.travelled = 0.0;
        self.neighbours.built_at = self.step;
        self.cost.neighbour_builds = self.neighbours.builds;
        Ok(())
    }

    /// Returns two radii (m): the largest radius of a grain with a cell in the search grid, and the radius above which
    /// grains have no cell. With a periodic axis, all grains have cells.
    fn radii_of_cells(&self) -> [f64; 2] {
        let limit = if self.scene.is_periodic() { f64::MAX } else { FAR_LARGER * self.mean_radius };
        if self.largest_radius <= limit {
            return [self.largest_radius, f64::MAX];
        }
        let radii = self.scene.grains.iter().map(|grain| grain.radius);
        [radii.filter(|radius| *radius <= limit).fold(0.0, f64::max), limit]
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
                (!wall.is_gone() && ratio > LARGEST_ENTRY_OVERLAP)
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
            let last = self.neighbours.reference.get(slot).map_or(position, S::vector_in_space);
            return Err(self.broken(slot, if finite { position } else { last }, cause));
        }
        Ok(())
    }

    /// Returns the error for a grain with an invalid state, with advice on the time step or on the insertion of grains.
    fn broken(&self, slot: usize, position: Vector3<f64>, cause: Cause) -> Box<SimulationFailure> {
        let stable = stable_fraction(&self.scene);
        let fraction = self.motion.time_step / self.critical;
        let advice = if matches!(cause, Cause::CameIntoGrain { .. } | Cause::CameIntoWall { .. }) {
            "pour fewer grains, at a lower rate or from a higher place".to_owned()
        } else if fraction > stable {
            format!(
                "{stable:.3} of the critical time step ({:.4e} s) is stable for any packing of equal grains",
                stable * self.critical
            )
        } else {
            "the time step is stable for any packing of equal grains: check velocities, wall motion and initial \
             overlaps"
                .to_owned()
        };
        Box::new(SimulationFailure {
            time: self.step as f64 * self.motion.time_step,
            step: self.step,
            subject: FailedParticle::Grain(self.grains.id[slot] + 1),
            position,
            cause,
            time_step: self.motion.time_step,
            critical: self.critical,
            advice,
        })
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
    let [mut across, mut near] = whole.lists();
    for block in across.blocks(evaluation.one_by_one) {
        let (read, sums) = grains.parts();
        across.evaluate(evaluation, read, sums, block);
    }
    let (mut moved, mut fastest) = (0, 0.0_f64);
    for block in near.blocks(evaluation.one_by_one) {
        let (read, sums) = grains.parts();
        near.evaluate(evaluation, read, sums, block.clone());
        if let (Some(motion), Some(row)) = (motion, near.row_after(&block)) {
            fastest = fastest.max(motion.advance::<S>(evaluation.processor, MotionData::new(grains, moved..row)));
            moved = row;
        }
    }
    if let Some(motion) = motion {
        let left = moved..grains.len();
        fastest = fastest.max(motion.advance::<S>(evaluation.processor, MotionData::new(grains, left)));
    }
    (across.own() + near.own(), fastest)
}
