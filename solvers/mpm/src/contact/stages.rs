//! Contact stages of a cycle: spring forces between surfaces, and conditions on node velocities.

use crate::boundary::Boundary;
use crate::contact::friction::Coulomb;
use crate::contact::nodal::{self, ReactionReceivers};
use crate::contact::pairs::Pairs;
use crate::contact::penalty::{Push, Springs};
use crate::contact::search::{Search, SearchResults};
use crate::contact::shared::{Field, SharedNodes};
use crate::contact::{ContactPoint, FrictionTable, Rules};
use crate::energy::accounts::Accounts;
use crate::grid::basis::with_basis;
use crate::grid::lattice::Lattice;
use crate::grid::nodes::Grid;
use crate::options::{Contact, StressUpdate};
use crate::points::state::State;
use crate::scheme::Scheme;
use crate::surface::motion::TracerMotion;
use crate::surface::tracers::Tracers;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Counts;
use grainbench_solver::space::Space;
use std::marker::PhantomData;
use std::slice;

/// Number of subranges of pairs per thread. The cost of subranges varies strongly, so several are needed for load
/// balance.
const SHARES: usize = 8;

/// Requested outputs of springs in a step.
pub(crate) struct ContactRequest<'a, S: Space> {
    /// Energy budget, if requested.
    pub(crate) accounts: Option<&'a mut Accounts<S>>,
    /// True if contact points are recorded.
    pub(crate) touches: bool,
}

/// Surface tracers and contacts of all bodies.
#[derive(Clone, Debug)]
pub(crate) struct Contacts<S: Space> {
    pub(crate) tracers: Tracers<S>,
    /// Tangential springs of tracers; `None` if μ = 0 for all laws, or contact acts at nodes.
    pub(crate) springs: Option<Coulomb<S>>,
    pub(crate) touches: Vec<ContactPoint<S>>,
    /// Penetrating tracers, with one list for each subrange of pairs.
    found: Vec<SearchResults<S>>,
    friction: FrictionTable,
    pairs: Pairs<S>,
    shared: SharedNodes<S>,
}

impl<S: Space> Contacts<S> {
    pub(crate) fn new(scene: &Scene, contact: Contact, tracers: Tracers<S>) -> Self {
        let friction = FrictionTable::from_scene(scene);
        let springs = (friction.acts() && contact == Contact::Penalty).then(|| Coulomb::new(tracers.len()));
        let (pairs, shared) = (Pairs::default(), SharedNodes::default());
        Self { tracers, springs, touches: Vec::new(), found: Vec::new(), friction, pairs, shared }
    }

    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        self.tracers.len() * Tracers::<S>::BYTES
            + self.springs.as_ref().map_or(0, Coulomb::bytes)
            + self.shared.bytes()
            + self.pairs.bytes()
    }

    /// Returns true if any contact is possible.
    fn can_touch(state: &State<S>, boundary: &Boundary<S>) -> bool {
        state.bodies.len() > 1 || !boundary.walls.is_empty()
    }

    /// Returns true if contact acts at nodes and any contact is possible.
    fn is_nodal(contact: Contact, state: &State<S>, boundary: &Boundary<S>) -> bool {
        let several = state.bodies.len() > 1 && contact != Contact::NoSlip;
        contact != Contact::Penalty && (several || !boundary.walls.is_empty())
    }

    /// Removes tracers if no contact is possible or the contact method does not need them.
    ///
    /// The initial pressure needs the tracers even in these cases, so it must be applied before this call.
    pub(crate) fn drop_idle_surfaces(&mut self, contact: Contact, state: &mut State<S>, boundary: &Boundary<S>) {
        if Self::can_touch(state, boundary) && matches!(contact, Contact::Penalty | Contact::Gap) {
            return;
        }
        (self.tracers, self.springs) = (Tracers::default(), None);
        for body in &mut state.bodies {
            (body.tracers, body.chunks) = (0..0, 0..0);
        }
    }

    /// Finds the shared nodes for nodal contact.
    pub(crate) fn find_shared(
        &mut self,
        scheme: &Scheme,
        state: &State<S>,
        grid: &Grid<S>,
        boundary: &Boundary<S>,
        cost: &mut Counts,
    ) {
        let setting = &scheme.setting;
        if !Self::is_nodal(setting.contact, state, boundary) {
            return;
        }
        let Grid { lattice, nodes, used, .. } = grid;
        let State { bodies, points, .. } = state;
        let walls = &boundary.walls;
        let Self { shared, pairs, tracers, .. } = self;
        let cell = lattice.shortest(S::DIMENSION);
        let margin = if setting.contact == Contact::Gap { 0.0 } else { 3.0 * cell };
        let fields = if setting.contact == Contact::NoSlip { 1 } else { bodies.len() };
        pairs.clear();
        if fields > 1 {
            pairs.find(bodies, lattice, margin);
        }
        if setting.contact == Contact::Gap {
            shared.find_meetings(lattice, bodies, &pairs.found, tracers, walls, nodes);
        } else {
            shared.find(lattice, bodies, fields, &pairs.found, walls, nodes);
        }
        cost.pair_tests += pairs.tests;
        // Contact applies to the velocities of the step, and also to the projected velocities if the stress uses these.
        let times = if setting.stress_update == StressUpdate::Last { 1 } else { 2 };
        cost.contact_evaluations += times * (shared.members.len() + shared.meetings.len()) as u64;
        if setting.contact == Contact::NoSlip {
            return;
        }
        shared.find_touching(bodies.len());
        with_basis!(setting.basis, B => shared.find_faces::<B>(lattice, bodies, *used, points));
        if setting.contact == Contact::Kinematic {
            shared.smooth_normals(lattice, bodies, *used, points);
        }
    }

    /// Adds the forces of springs between surfaces to the nodes.
    pub(crate) fn push(
        &mut self,
        scheme: &Scheme,
        state: &State<S>,
        grid: &mut Grid<S>,
        boundary: &mut Boundary<S>,
        ContactRequest { accounts, touches: record }: ContactRequest<'_, S>,
        cost: &mut Counts,
    ) {
        let &Scheme { ref setting, time_step, processor } = scheme;
        if setting.contact != Contact::Penalty || !Self::can_touch(state, boundary) {
            return;
        }
        let Grid { lattice, nodes, most, .. } = grid;
        let (bodies, walls) = (&state.bodies, &mut boundary.walls);
        let Self { tracers, springs, touches, found, friction, pairs, .. } = self;
        touches.clear();
        springs.iter_mut().for_each(Coulomb::begin);
        pairs.find(bodies, lattice, 0.0);
        let rules = Rules { lattice, friction, setting, time_step };
        let shares = if state.team.members() > 1 { SHARES * state.team.members() } else { 1 };
        found.resize(shares, SearchResults::default());
        let (all, tracers) = (&pairs.found[..], &*tracers);
        state.team.each(found.iter_mut(), |number, found| {
            let pairs = &all[number * all.len() / shares..(number + 1) * all.len() / shares];
            with_basis!(setting.basis, B => {
                let basis = PhantomData::<B>;
                processor.run_by_four(Search { rules, bodies, tracers, nodes, most, pairs, found, basis });
            });
        });
        let springs = Springs {
            friction: springs.as_mut(),
            tally: accounts.map(|accounts| &mut accounts.tally),
            touches: record.then_some(touches),
            touched: &mut cost.contact_evaluations,
        };
        with_basis!(setting.basis, B => {
            let basis = PhantomData::<B>;
            processor.run_by_four(Push { rules, bodies, found, tracers, walls, nodes, most, springs, basis });
        });
        cost.pair_tests += pairs.tests;
    }

    /// Applies nodal contact to the velocities of `field`. The energy budget includes the impulses on velocities after the
    /// step, but not those on projected velocities.
    pub(crate) fn meet(
        &mut self,
        scheme: &Scheme,
        state: &State<S>,
        lattice: &Lattice,
        boundary: &mut Boundary<S>,
        accounts: Option<&mut Accounts<S>>,
        field: &mut Field<'_, S>,
    ) {
        let setting = &scheme.setting;
        if !Self::is_nodal(setting.contact, state, boundary) {
            return;
        }
        let Self { friction, shared, .. } = self;
        let rules = Rules { lattice, friction, setting, time_step: scheme.time_step };
        let (walls, driven, bodies) = (&mut *boundary.walls, &mut *boundary.driven.groups, &state.bodies);
        let tally = accounts.map(|accounts| &mut accounts.tally);
        nodal::meet(&rules, bodies, shared, &mut ReactionReceivers { walls, driven, tally }, field);
    }

    /// Moves the tracers of all bodies with the projected velocities; each thread handles a range of bodies.
    pub(crate) fn move_tracers(&mut self, scheme: &Scheme, state: &State<S>, grid: &Grid<S>) {
        let Scheme { setting, time_step: elapsed, processor } = *scheme;
        let Grid { lattice, projected: velocities, most, .. } = grid;
        let (count, members) = (self.tracers.len(), state.team.members());
        let mut left = self.tracers.lent();
        let mut bodies = &state.bodies[..];
        let parts = (1..=members).map(|member| {
            let some = bodies.iter().take_while(|body| body.tracers.end <= member * count / members).count();
            let (own, others) = bodies.split_at(if member == members { bodies.len() } else { some });
            bodies = others;
            (own, left.take_off(own))
        });
        state.team.each(parts, |_, (bodies, mut tracers)| {
            for body in bodies {
                let view = tracers.take_off(slice::from_ref(body));
                with_basis!(setting.basis, B => {
                    let basis = PhantomData::<B>;
                    processor.run_by_four(TracerMotion { lattice, body, of: view, velocities, most, elapsed, basis });
                });
            }
        });
    }
}
