//! Contacts as the last force evaluation saw them: what a snapshot and the energy budget are made of.

use crate::contact::chain::Answer;
use crate::geometry::Geometry;
use crate::listed::reserve;
use grainbench_lanes::Number;
use grainbench_scene::record::{ContactState, Partner};
use nalgebra::Vector3;

/// Contacts as the last force evaluation that was recorded saw them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    /// As a snapshot shows them, where they are kept one by one. Whoever looks takes them away.
    pub(crate) contacts: Vec<ContactState>,
    /// Whether they are.
    one_by_one: bool,
    /// How many slip.
    pub(crate) slipping: usize,
    /// What each does to the energy.
    pub(crate) energies: Vec<Energies>,
}

/// What a contact does to the energy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energies {
    /// Energy in the springs (J).
    pub(crate) elastic: f64,
    /// Work of friction in the step (J).
    pub(crate) rubbed: f64,
    /// Energy released by a change of stiffness in the step (J).
    pub(crate) released: f64,
}

impl Seen {
    /// Begins anew; contacts are kept `one_by_one`, or what they come to.
    pub(crate) fn begin(&mut self, one_by_one: bool) {
        (self.one_by_one, self.slipping) = (one_by_one, 0);
        if one_by_one {
            self.contacts.clear();
        } else {
            self.contacts = Vec::new();
        }
        self.energies.clear();
    }

    /// Makes room for more contacts.
    pub(crate) fn make_room(&mut self, more: usize) {
        if self.one_by_one {
            reserve(&mut self.contacts, more);
        }
        reserve(&mut self.energies, more);
    }

    /// Adds what is seen of an answer, the first if there are several, at the contact of a grain whose centre (m) and radius
    /// (m) are given.
    pub(crate) fn add<S: Geometry, X: Number>(
        &mut self,
        answer: &Answer<S, X>,
        grain: u32,
        partner: Partner,
        centre: Vector3<f64>,
        radius: f64,
    ) {
        let zero = answer.overlap.like(0.0);
        let slipping = X::choose(answer.slipping, zero.like(1.0), zero).first() > 0.0;
        self.slipping += usize::from(slipping);
        let [elastic, rubbed, released] = [answer.elastic_energy, answer.rubbed, answer.released].map(X::first);
        self.energies.push(Energies { elastic, rubbed, released });
        if !self.one_by_one {
            return;
        }
        let vector = |of: S::Vectors<X>| Vector3::from(S::whole(of, zero).map(X::first));
        let (normal, overlap) = (vector(answer.normal), answer.overlap.first());
        self.contacts.push(ContactState {
            grain,
            partner,
            point: centre + normal * (radius - 0.5 * overlap),
            normal,
            overlap,
            normal_force: answer.normal_force.first(),
            shear_force: vector(S::along(answer.shear, answer.normal)),
            slipping,
        });
    }
}
