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
    /// As a snapshot shows them. Whoever looks takes them away.
    pub(crate) contacts: Vec<ContactState>,
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
}

impl Seen {
    pub(crate) fn clear(&mut self) {
        self.contacts.clear();
        self.energies.clear();
    }

    /// Makes room for more contacts.
    pub(crate) fn make_room(&mut self, more: usize) {
        reserve(&mut self.contacts, more);
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
            slipping: X::choose(answer.slipping, zero.like(1.0), zero).first() > 0.0,
        });
        self.energies.push(Energies { elastic: answer.elastic_energy.first(), rubbed: answer.rubbed.first() });
    }
}
