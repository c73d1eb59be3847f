//! Simulation of one scene by the cycle points → nodes → points.
//!
//! Each stage uses only the parts that it needs: the state of bodies and points ([`State`]), the grid ([`Grid`]),
//! boundaries ([`Boundary`]), contact ([`Contacts`]) and the energy budget ([`Accounts`]). The sums over points and
//! nodes are in [`crate::transfer::scatter`] and [`crate::transfer::gather`].

use crate::boundary::Boundary;
use crate::contact::shared::Field;
use crate::contact::stages::{ContactRequest, Contacts};
use crate::energy::accounts::{Accounts, work_of};
use crate::energy::ledger::{EnergyGuard, Tally};
use crate::failure::Failure;
use crate::grid::basis::{Basis, with_basis};
use crate::grid::lattice::Lattice;
use crate::grid::nodes::Grid;
use crate::material::stress;
use crate::options::Setting;
use crate::points::bodies::seed;
use crate::points::share::{FEWEST, cut_nodes};
use crate::points::state::State;
use crate::scheme::{Scheme, Surroundings};
use crate::transfer::gather::gather;
use crate::transfer::scatter::scatter;
use grainbench_lanes::{Processor, Team};
use grainbench_scene::scene::Scene;
use grainbench_solver::failure::SimulationFailure;
use grainbench_solver::record::Counts;
use grainbench_solver::space::Space;

/// Bodies, grid, boundaries and contacts of a run, with the current step.
pub(crate) struct Simulation<S: Space> {
    pub(crate) scene: Scene,
    pub(crate) scheme: Scheme,
    pub(crate) surroundings: Surroundings<S>,
    pub(crate) state: State<S>,
    pub(crate) grid: Grid<S>,
    pub(crate) boundary: Boundary<S>,
    pub(crate) contacts: Contacts<S>,
    /// Energy budget, if requested.
    pub(crate) accounts: Option<Accounts<S>>,
    /// Monitored energy of a closed run; `None` for other runs and before monitoring starts.
    pub(crate) watched: Option<EnergyGuard>,
    /// True before the first step.
    pub(crate) is_fresh: bool,
    /// Time in which the fastest wave crosses a cell (s).
    pub(crate) critical: f64,
    pub(crate) step: u64,
    pub(crate) settling: bool,
    /// Step of the last observation.
    pub(crate) looked: u64,
    pub(crate) cost: Counts,
}

impl<S: Space> Simulation<S> {
    /// Creates the bodies of a scene, before their relaxation and without initial velocities.
    pub(crate) fn new(
        scene: &Scene,
        setting: Setting,
        lattice: Lattice,
        per_cell: u32,
        [time_step, critical]: [f64; 2],
        threads: usize,
    ) -> Self {
        let (bodies, points, tracers) = seed::<S>(scene, &setting, &lattice, per_cell, time_step);
        let team = Team::new(threads.min(points.len() / FEWEST));
        Self {
            scheme: Scheme { setting, time_step, processor: Processor::new() },
            surroundings: Surroundings::new(scene.gravity, scene.global_damping, time_step),
            boundary: Boundary::new(scene, &bodies, &lattice),
            contacts: Contacts::new(scene, setting.contact, tracers),
            state: State::new(bodies, points, team),
            grid: Grid::new(lattice),
            scene: scene.clone(),
            accounts: None,
            watched: None,
            is_fresh: true,
            critical,
            step: 0,
            settling: false,
            looked: 0,
            cost: Counts::default(),
        }
    }

    /// Opens the energy budget, if requested.
    pub(crate) fn open_accounts(&mut self) {
        let Self { scene, scheme, state, grid, .. } = self;
        self.accounts = scene.asks_for_budget().then(|| Accounts::open(scheme.setting.basis, state, &grid.lattice));
    }

    /// Takes one step. With `record`, contact points are recorded.
    ///
    /// # Errors
    /// Returns an error if the state of a point becomes invalid or a check fails.
    pub(crate) fn cycle(&mut self, record: bool) -> Result<(), Box<SimulationFailure>> {
        let Self { critical, step, scheme, .. } = *self;
        self.stages(record).map_err(|failure| failure.into_simulation_failure(step, scheme.time_step, critical))?;
        self.step += 1;
        self.cost.steps += 1;
        self.cost.particle_steps += self.state.points.len() as u64;
        self.cost.bytes = self.cost.bytes.max(self.bytes() as u64);
        self.check()
    }

    /// Executes the stages of a cycle.
    fn stages(&mut self, record: bool) -> Result<(), Failure> {
        let time = self.step as f64 * self.scheme.time_step;
        self.boundary.move_walls(time, self.scheme.time_step, self.settling);
        self.place_windows()?;
        self.scatter();
        if record {
            self.state.before.copy_from_slice(&self.state.points.velocity);
        }
        self.begin_meeting();
        if self.scheme.has_stress_first() {
            self.stress_first()?;
        }
        self.body_force(time);
        self.spring_forces(record || self.wants_touches());
        self.step_nodes();
        self.gather();
        self.move_on()
    }

    /// Returns the memory (bytes) of points, tracers, nodes, contacts and the energy budget.
    fn bytes(&self) -> usize {
        let Self { state, grid, contacts, accounts, .. } = self;
        state.bytes() + grid.bytes() + contacts.bytes() + accounts.as_ref().map_or(0, Accounts::bytes)
    }

    /// Assigns a window of nodes to every velocity field.
    pub(crate) fn place_windows(&mut self) -> Result<(), Failure> {
        let Self { scheme, state, grid, .. } = self;
        let placed = grid.place_windows(&mut state.bodies, scheme.has_one_field());
        placed.map_err(|(place, cause)| state.failure(place, state.bodies[place].points.start, cause))
    }

    /// Partitions the points among threads and scatters them to the nodes.
    pub(crate) fn scatter(&mut self) {
        let Self { scheme, state, grid, contacts, .. } = self;
        state.find_runs(scheme.setting.basis, &grid.lattice);
        cut_nodes(&mut state.shares, &state.bodies, grid.used, scheme.has_one_field());
        scatter(scheme, state, grid, contacts.tracers.len() > 0);
    }

    /// Sets the velocities of driven bodies for the step, and finds the shared nodes for contact.
    fn begin_meeting(&mut self) {
        let Self { scheme, surroundings, state, grid, boundary, contacts, accounts, settling, cost, step, .. } = self;
        if let Some(accounts) = accounts {
            accounts.tally = Tally::default();
        }
        boundary.driven.begin(*settling, *step as f64 * scheme.time_step, scheme.time_step);
        if !boundary.driven.groups.is_empty() {
            let State { bodies, points, .. } = state;
            boundary.driven.note_own_forces(bodies, points, surroundings, scheme.time_step);
            boundary.driven.find_held(&grid.lattice, bodies, points, scheme.setting.basis, scheme.has_one_field());
        }
        contacts.find_shared(scheme, state, grid, boundary, cost);
    }

    /// Updates stresses from the velocities scattered by points, before nodes are integrated.
    fn stress_first(&mut self) -> Result<(), Failure> {
        self.grid.project(&self.state);
        self.finish_projection();
        let Self { scheme, state, grid, accounts, .. } = self;
        let (flow, _) = stress::follow(scheme, state, grid, accounts.is_some(), None)?;
        if let Some(accounts) = accounts {
            accounts.add_flow(flow);
        }
        let Grid { lattice, nodes, used, .. } = grid;
        nodes[..*used].iter_mut().for_each(|node| node.change = S::ORIGIN);
        for body in &state.bodies {
            let points = &state.points;
            with_basis!(scheme.setting.basis, B => body.each_stencil::<S, B>(lattice, points, |at, stencil| {
                let (stress, volume) = (points.stress[at], -points.volume[at]);
                stencil.each::<S, B>(&body.window, |node| {
                    nodes[node.slot].change += S::apply(stress, stencil.gradient::<S>(&node)) * volume;
                });
            }));
        }
        Ok(())
    }

    /// Converts projected momenta to velocities that satisfy boundary and contact conditions.
    fn finish_projection(&mut self) {
        let Self { scheme, state, grid, boundary, contacts, .. } = self;
        boundary.hold_projected(state, grid);
        let Grid { lattice, projected, .. } = grid;
        contacts.meet(scheme, state, lattice, boundary, None, &mut Field::Projected(projected));
    }

    /// Adds the body force of a manufactured solution.
    fn body_force(&mut self, time: f64) {
        let Some(motion) = self.scene.start.manufactured.filter(|_| !self.settling) else { return };
        let Self { scheme, state: State { bodies, points, .. }, grid: Grid { lattice, nodes, .. }, .. } = self;
        for body in bodies.iter() {
            let medium = body.medium();
            with_basis!(scheme.setting.basis, B => body.each_stencil::<S, B>(lattice, points, |at, stencil| {
                let force = S::restrict(motion.body_force(&medium, S::embed(points.start[at]), time)) * points.mass[at];
                stencil.each::<S, B>(&body.window, |node| nodes[node.slot].change += force * node.weight);
            }));
        }
    }

    /// Adds spring forces, then folds mirror images at fixed or symmetry boundaries. After this stage all forces are known.
    fn spring_forces(&mut self, record: bool) {
        let Self { scheme, surroundings, state, grid, boundary, contacts, accounts, cost, .. } = self;
        if let Some(accounts) = accounts {
            accounts.note_internal_forces(&state.team, grid);
        }
        let asked = ContactRequest { accounts: accounts.as_mut(), touches: record };
        contacts.push(scheme, state, grid, boundary, asked, cost);
        boundary.held.fold(&state.bodies, &mut grid.nodes, surroundings.gravity);
        if let Some(accounts) = accounts {
            accounts.note_forces(&state.team, grid);
            if surroundings.keep < 1.0 {
                accounts.brought = state.kinetic_energy(scheme.setting.basis, &grid.lattice);
            }
        }
    }

    /// Computes node velocities after the step under boundary and contact conditions, and their changes.
    fn step_nodes(&mut self) {
        let Self { scheme, surroundings, state, grid, boundary, contacts, accounts, cost, .. } = self;
        cost.node_updates += grid.step(state, surroundings);
        boundary.held.hold(&state.bodies, &mut grid.nodes);
        boundary.driven.hold(&mut grid.nodes, scheme.time_step);
        let Grid { lattice, nodes, .. } = grid;
        contacts.meet(scheme, state, lattice, boundary, accounts.as_mut(), &mut Field::Stepped(nodes));
        grid.find_changes(state, surroundings.keep);
    }

    /// Gathers velocities and displacements of points from nodes. Driven points get their prescribed velocity. With MUSL,
    /// boundary and contact conditions are applied to the projected velocities.
    fn gather(&mut self) {
        let Self { scheme, surroundings, state, grid, boundary, accounts, .. } = self;
        gather(scheme, surroundings.keep, state, grid);
        if let Some(accounts) = accounts {
            accounts.held = work_of(&boundary.driven, scheme.time_step);
        }
        boundary.driven.carry(&state.bodies, &mut state.points, scheme.time_step);
        if let Some(accounts) = accounts {
            accounts.add_nodes(&state.team, scheme, surroundings, grid, boundary);
        }
        if self.scheme.is_projected() {
            self.finish_projection();
        } else {
            self.grid.project(&self.state);
        }
        let Self { scheme, surroundings, state, grid, accounts, .. } = self;
        if let Some(accounts) = accounts {
            accounts.add_contacts(&state.team, scheme.time_step, surroundings.keep, grid);
        }
    }

    /// Moves tracers and points, and updates stresses unless they were updated first. Rejects displacements above one
    /// cell.
    fn move_on(&mut self) -> Result<(), Failure> {
        let Self { scheme, state, grid, contacts, accounts, .. } = self;
        let cell = grid.lattice.shortest(S::DIMENSION);
        contacts.move_tracers(scheme, state, grid);
        let start = with_basis!(scheme.setting.basis, B => B::START);
        let way = if scheme.has_stress_first() {
            state.move_points(&grid.lattice, start)
        } else {
            let (flow, way) = stress::follow(scheme, state, grid, accounts.is_some(), Some(start))?;
            if let Some(accounts) = accounts {
                accounts.add_flow(flow);
            }
            way
        };
        state.gather_bounds(&contacts.tracers);
        if way.is_lost || way.squared.sqrt() > cell {
            return Err(state.ran_away(scheme.time_step, cell));
        }
        Ok(())
    }
}
