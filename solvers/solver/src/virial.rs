//! Contribution of contacts to the stress inside a grain.
//!
//! ```text
//! V σ = Σ Δx⊗F over the contacts of a grain
//! ```
//!
//! The vector Δx points from the centre of the grain to the contact point in the middle of the overlap. The force F
//! acts on the grain at this point. By Gauss' theorem, σ is the mean stress of a grain of volume V in equilibrium.
//! Compression is negative. The symmetric part of V σ (J; J per metre of depth for discs) is stored, because it needs
//! no volume and can be summed over grains.

use crate::record::{ContactState, Partner, Snapshot};

/// Indices of xx, yy, zz, xy, yz, zx.
pub const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

/// Returns the ids of the grains in a contact.
pub fn touching(contact: &ContactState) -> impl Iterator<Item = u32> {
    let other = if let Partner::Grain(id) = contact.partner { Some(id) } else { None };
    [Some(contact.grain), other].into_iter().flatten()
}

/// Adds the contribution of a contact to V σ (J) of one of its grains. `radius` is the radius of this grain (m). The
/// formula is the same for both grains, because lever arm and force change sign together.
pub fn add(sum: &mut [f64; 6], contact: &ContactState, radius: f64) {
    let force = contact.shear_force - contact.normal * contact.normal_force;
    let arm = contact.normal * (radius - 0.5 * contact.overlap);
    for (sum, [row, column]) in sum.iter_mut().zip(COMPONENTS) {
        *sum += 0.5 * (arm[row] * force[column] + arm[column] * force[row]);
    }
}

/// Returns V σ of every grain of a snapshot (J), in the order of the grains; `None` if the snapshot has no list of
/// contacts.
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
