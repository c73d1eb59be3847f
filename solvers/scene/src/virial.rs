//! What contacts do to the stress inside a grain.
//!
//! ```text
//! V σ = Σ Δx⊗F over the contacts of a grain
//! ```
//!
//! Δx goes from the centre of the grain to the contact, halfway through the overlap, and F acts on the grain there; σ is the
//! mean stress of a grain of volume V in equilibrium, by Gauss' theorem. Compression is negative. What is kept is the symmetric
//! part of V σ (J; J per metre of depth for discs): no volume need be known for it, and it adds up over grains.

use crate::record::{ContactState, Partner, Snapshot};

/// xx, yy, zz, xy, yz, zx.
pub const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

/// The grains that touch at a contact, by id.
pub fn touching(contact: &ContactState) -> impl Iterator<Item = u32> {
    let other = if let Partner::Grain(id) = contact.partner { Some(id) } else { None };
    [Some(contact.grain), other].into_iter().flatten()
}

/// Adds what a contact does to the V σ (J) of one of its grains, which has a radius (m). It is the same formula for both: arm
/// and force both turn about from one to the other.
pub fn add(sum: &mut [f64; 6], contact: &ContactState, radius: f64) {
    let force = contact.shear_force - contact.normal * contact.normal_force;
    let arm = contact.normal * (radius - 0.5 * contact.overlap);
    for (sum, [row, column]) in sum.iter_mut().zip(COMPONENTS) {
        *sum += 0.5 * (arm[row] * force[column] + arm[column] * force[row]);
    }
}

/// V σ of every grain of a snapshot (J), in their order; none where contacts were not told, for that is not zero.
#[must_use]
pub fn virials(snapshot: &Snapshot) -> Option<Vec<[f64; 6]>> {
    let mut sums = vec![[0.0; 6]; snapshot.grains.len()];
    for contact in snapshot.contacts.as_ref()? {
        for place in touching(contact).filter_map(|id| snapshot.place_of(id)) {
            add(&mut sums[place], contact, snapshot.grains[place].radius);
        }
    }
    Some(sums)
}
