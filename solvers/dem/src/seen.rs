//! Contacts recorded in a force evaluation, for snapshots and the energy budget.

use crate::contact::chain::{Answer, Energies};
use crate::geometry::Geometry;
use crate::listed::reserve;
use grainbench_lanes::Number;
use grainbench_solver::record::{ContactState, Partner};
use nalgebra::Vector3;

/// Contacts of the last force evaluation in which contacts were recorded.
#[derive(Clone, Debug, Default)]
pub(crate) struct RecordedContacts {
    /// Individual contacts as in a snapshot; empty if only energies are recorded. Output moves them out of this list.
    pub(crate) contacts: Vec<ContactState>,
    /// True if individual contacts are recorded.
    one_by_one: bool,
    /// Number of slipping contacts.
    pub(crate) slipping: usize,
    /// Energies of each contact.
    pub(crate) energies: Vec<Energies<f64>>,
}

impl RecordedContacts {
    /// Starts a new recording, of individual contacts if `one_by_one` is set.
    pub(crate) fn begin(&mut self, one_by_one: bool) {
        (self.one_by_one, self.slipping) = (one_by_one, 0);
        if one_by_one {
            self.contacts.clear();
        } else {
            self.contacts = Vec::new();
        }
        self.energies.clear();
    }

    /// Reserves memory for more contacts.
    pub(crate) fn make_room(&mut self, more: usize) {
        if self.one_by_one {
            reserve(&mut self.contacts, more);
        }
        reserve(&mut self.energies, more);
    }

    /// Records the result of a contact of the grain with id `grain`, whose centre is `centre` (m) and whose radius is
    /// `radius` (m). If the result contains several contacts in lanes, only the first one is recorded.
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
        let Energies { elastic, rubbed, released } = answer.energies;
        let (elastic, rubbed, released) = (elastic.first(), rubbed.first(), released.first());
        self.energies.push(Energies { elastic, rubbed, released });
        if !self.one_by_one {
            return;
        }
        let vector = |vectors: S::Vectors<X>| Vector3::from(S::whole(vectors, zero).map(X::first));
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
