//! The stages of a cycle at which bodies meet: springs as forces, conditions at nodes on velocities.

use crate::accounts::Accounts;
use crate::contact::friction::Friction;
use crate::contact::nodal::{self, Felt};
use crate::contact::penalty::{Push, Rules, Springs, Told};
use crate::contact::shared::{Projected, Stepped};
use crate::off::Off;
use crate::options::{Contact, StressUpdate};
use crate::simulation::{Simulation, with_basis};
use grainbench_scene::space::Space;
use std::marker::PhantomData;

impl<S: Space> Simulation<S> {
    /// Whether there is anything to touch.
    pub(crate) fn can_touch(&self) -> bool {
        self.bodies.len() > 1 || !self.walls.is_empty()
    }

    /// Whether contact is a condition at nodes, and anything can touch.
    pub(crate) fn is_nodal(&self) -> bool {
        let several = self.bodies.len() > 1 && self.setting.contact != Contact::NoSlip;
        self.setting.contact != Contact::Penalty && (several || !self.walls.is_empty())
    }

    /// Finds the nodes at which bodies meet, for conditions at nodes.
    pub(crate) fn find_shared(&mut self) {
        if !self.is_nodal() {
            return;
        }
        let cell = self.lattice.shortest(S::DIMENSION);
        let Self { lattice, setting, bodies, shared, pairs, walls, nodes, points, tracers, used, cost, .. } = self;
        let margin = if setting.contact == Contact::Gap { 0.0 } else { 3.0 * cell };
        let fields = if setting.contact == Contact::NoSlip { 1 } else { bodies.len() };
        pairs.clear();
        if fields > 1 {
            pairs.find(bodies, lattice, margin);
        }
        if setting.contact == Contact::Gap {
            tracers.find_boxes();
            shared.find_meetings(lattice, bodies, &pairs.found, tracers, walls, nodes);
        } else {
            shared.find(lattice, bodies, fields, &pairs.found, walls, nodes);
        }
        cost.pair_tests += pairs.tests;
        // Velocities of the step and, where the stress comes from projected ones, those too.
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

    /// Forces of springs between surfaces.
    pub(crate) fn spring_forces(&mut self, record: bool) {
        if self.setting.contact != Contact::Penalty || !self.can_touch() {
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
        let Self {
            bodies,
            tracers,
            springs,
            walls,
            nodes,
            most,
            touches,
            pairs,
            setting,
            cost,
            accounts,
            processor,
            ..
        } = self;
        let Springs { friction, near, touched } = springs;
        let pairs_found = &pairs.found;
        macro_rules! push {
            ($B:ty, $friction:expr, $ledger:expr) => {{
                let (pairs, friction, basis) = (pairs_found, $friction, PhantomData::<$B>);
                let told = Told { ledger: $ledger, touches: record.then_some(touches), touched };
                processor.run(Push { rules, bodies, pairs, tracers, friction, walls, nodes, most, near, told, basis });
            }};
        }
        with_basis!(setting.basis, B => match (friction, accounts) {
            (Friction::Absent, None) => push!(B, Off, Off),
            (Friction::Absent, Some(accounts)) => push!(B, Off, &mut accounts.tally),
            (Friction::Present(friction), None) => push!(B, friction, Off),
            (Friction::Present(friction), Some(accounts)) => push!(B, friction, &mut accounts.tally),
        });
        cost.pair_tests += pairs.tests;
        cost.contact_evaluations += springs.touched;
    }

    /// Velocities of the step that contact at nodes allows.
    pub(crate) fn meet_stepped(&mut self) {
        if !self.is_nodal() {
            return;
        }
        let Self { lattice, friction, setting, time_step, bodies, shared, walls, nodes, driven, accounts, .. } = self;
        let rules = nodal::Rules { lattice, friction, contact: setting.contact, time_step: *time_step };
        let (driven, field) = (&mut driven.groups, &mut Stepped(nodes));
        match accounts {
            None => nodal::meet(&rules, bodies, shared, &mut Felt { walls, driven, ledger: Off }, field),
            Some(Accounts { tally, .. }) => {
                nodal::meet(&rules, bodies, shared, &mut Felt { walls, driven, ledger: tally }, field);
            }
        }
    }

    /// Projected velocities that contact at nodes allows.
    pub(crate) fn meet_projected(&mut self) {
        if !self.is_nodal() {
            return;
        }
        let Self { lattice, friction, setting, time_step, bodies, shared, walls, projected, driven, .. } = self;
        let rules = nodal::Rules { lattice, friction, contact: setting.contact, time_step: *time_step };
        // Of these the budget is not told.
        let mut felt = Felt { walls, driven: &mut driven.groups, ledger: Off };
        nodal::meet(&rules, bodies, shared, &mut felt, &mut Projected(projected));
    }
}
