//! Grains at a triangulated wall, with the nearby triangles and the contact history of each grain.
//!
//! A contact belongs to a patch, a ridge or a corner of the surface ([`grainbench_scene::mesh`]). If a grain moves from
//! one part to another at nearly the same point, as when it rolls over a ridge, the contact continues with its history.

use crate::contact::Memory;
use crate::geometry::Geometry;
use crate::grains::Grains;
use grainbench_scene::mesh::{Mesh, SphereContact};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Largest distance, in grain radii, at which a contact continues on another part of the surface. In one step, a grain
/// moves by only a small fraction of its radius.
const GOES_ON: f64 = 0.1;

/// Contact between a grain and the mesh in the last force evaluation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct PreviousContact {
    pub(crate) slot: u32,
    /// Index of the patch, ridge or corner of the surface.
    pub(crate) group: u32,
    /// Contact point in the coordinates of the surface (m).
    pub(crate) point: Vector3<f64>,
    pub(crate) memory: Memory<f64>,
}

/// Grains near a mesh.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct MeshContacts {
    /// Slot of every nearby grain, and the end of its range in `triangles`, sorted by slot.
    near: Vec<(u32, u32)>,
    /// Indices of the triangles near each grain, grain by grain.
    pub(crate) triangles: Vec<u32>,
    /// Contacts of the last force evaluation, sorted by slot.
    pub(crate) held: Vec<PreviousContact>,
    /// Buffer for the contacts of one grain.
    #[serde(skip)]
    found: Vec<SphereContact>,
    /// Buffer for the contacts of the present force evaluation.
    #[serde(skip)]
    next: Vec<PreviousContact>,
}

impl MeshContacts {
    /// Returns true if the lists are consistent and valid for `grains` grains and this surface.
    pub(crate) fn is_of(&self, grains: usize, mesh: &Mesh) -> bool {
        let (faces, mut from) = (mesh.surface.triangles().len(), 0);
        let ends_rise = self.near.iter().all(|&(_, end)| {
            let rises = from <= end;
            from = end;
            rises
        });
        ends_rise
            && from as usize == self.triangles.len()
            && self.near.is_sorted_by(|a, b| a.0 < b.0)
            && self.near.last().is_none_or(|&(slot, _)| (slot as usize) < grains)
            && self.triangles.iter().all(|&face| (face as usize) < faces)
            && self.held.is_sorted_by_key(|held| held.slot)
            && self.held.iter().all(|held| (held.slot as usize) < grains)
    }

    /// Returns true if there are neither nearby grains nor contacts.
    pub(crate) fn is_empty(&self) -> bool {
        self.near.is_empty() && self.triangles.is_empty() && self.held.is_empty()
    }

    /// Clears the list of nearby triangles, and moves out the contacts of the last force evaluation.
    pub(crate) fn begin_list(&mut self) -> Vec<PreviousContact> {
        self.near.clear();
        self.triangles.clear();
        std::mem::take(&mut self.held)
    }

    /// Appends the triangles within a distance `reach` (m) of a grain centre. Grains must be appended in order of their
    /// slots.
    pub(crate) fn list(&mut self, mesh: &Mesh, slot: usize, place: Vector3<f64>, reach: f64) {
        mesh.surface.near(mesh.within(place), reach, &mut self.triangles);
        let end = self.triangles.len() as u32;
        if self.near.last().map_or(0, |&(_, end)| end) < end {
            self.near.push((slot as u32, end));
        }
    }

    /// Finds the contacts of every nearby grain and evaluates each with its history. Returns the number of contacts.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        mesh: &Mesh,
        grains: &mut Grains<S>,
        mut contact: impl FnMut(&mut Grains<S>, usize, &SphereContact, &mut Memory<f64>),
    ) -> u64 {
        let Self { near, triangles, held, found, next, .. } = self;
        next.clear();
        let (mut from, mut before) = (0, 0);
        for &(slot, end) in near.iter() {
            let (place, radius) = (grains.position(slot as usize), grains.radius(slot as usize));
            mesh.surface.touched(mesh.within(place), radius, &triangles[from as usize..end as usize], found);
            from = end;
            // Previous contacts of grains that are no longer near are skipped.
            before += held[before..].iter().take_while(|other| other.slot < slot).count();
            let count = held[before..].iter().take_while(|other| other.slot == slot).count();
            let own = &held[before..before + count];
            before += count;
            for touched in found.iter() {
                let mut memory = remembered(own, found, touched, radius);
                contact(grains, slot as usize, touched, &mut memory);
                next.push(PreviousContact { slot, group: touched.group, point: touched.point, memory });
            }
        }
        std::mem::swap(held, next);
        held.len() as u64
    }
}

/// Returns the history with which a contact is evaluated. It is that of the previous contact on the same part of the
/// surface. A contact on a new part continues the nearest previous contact whose part the grain has left. It must be at
/// most `GOES_ON` radii away, and no other new contact may be nearer to it. Otherwise the history is zero.
fn remembered(own: &[PreviousContact], found: &[SphereContact], touched: &SphereContact, radius: f64) -> Memory<f64> {
    if let Some(same) = own.iter().find(|held| held.group == touched.group) {
        return same.memory;
    }
    let is_new = |contact: &SphereContact| own.iter().all(|held| held.group != contact.group);
    let left = own.iter().filter(|held| found.iter().all(|other| other.group != held.group));
    let away = |held: &PreviousContact, contact: &SphereContact| (held.point - contact.point).norm();
    let nearest = left.min_by(|a, b| away(a, touched).total_cmp(&away(b, touched)));
    nearest.filter(|held| away(held, touched) <= GOES_ON * radius).map_or_else(Default::default, |held| {
        let nearer = |other: &&SphereContact| is_new(other) && away(held, other) < away(held, touched);
        if found.iter().any(|other| nearer(&other)) { Default::default() } else { held.memory }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::MEMORY;

    /// A contact continues on another part of the surface if its new contact point is at most a tenth of the radius away.
    /// If two parts are so close, it continues on the nearer one. At a larger distance, a new contact begins.
    #[test]
    fn a_contact_goes_on_where_it_can_have_gone() {
        let at = |x: f64| Vector3::new(x, 0.0, 0.0);
        let touched = |group, x| SphereContact { group, point: at(x), direction: -Vector3::z(), distance: 0.9 };
        let (gone_on, new) = ([0.3; MEMORY], [0.0; MEMORY]);
        let own = [PreviousContact { slot: 0, group: 1, point: at(0.0), memory: gone_on }];
        assert_eq!(remembered(&own, &[touched(1, 0.5)], &touched(1, 0.5), 1.0), gone_on);
        assert_eq!(remembered(&own, &[touched(2, 0.09)], &touched(2, 0.09), 1.0), gone_on);
        assert_eq!(remembered(&own, &[touched(2, 0.11)], &touched(2, 0.11), 1.0), new);
        let two = [touched(2, 0.09), touched(3, -0.05)];
        assert_eq!([0, 1].map(|number| remembered(&own, &two, &two[number], 1.0)), [new, gone_on]);
    }
}
