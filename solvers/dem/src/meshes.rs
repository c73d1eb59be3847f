//! Grains at a wall of triangles: which triangles are near each, and what each contact remembers.
//!
//! A contact belongs to a patch, a ridge or a corner of the surface ([`grainbench_scene::mesh`]). Where a grain leaves one for
//! another in the same place, as when it rolls over a ridge, the contact goes on, and what it remembers with it.

use crate::contact::Memory;
use crate::geometry::Geometry;
use crate::grains::Grains;
use grainbench_scene::mesh::{Mesh, Touched};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// How far a contact may go in a step from one part of the surface to another, over the radius of the grain: grains go no
/// farther than a part of their radius in a step.
const GOES_ON: f64 = 0.1;

/// A contact as it was when it was looked at last.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Held {
    /// Slot of the grain.
    pub(crate) slot: u32,
    /// The patch, ridge or corner.
    pub(crate) group: u32,
    /// The point, in the coordinates of the surface (m).
    pub(crate) point: Vector3<f64>,
    /// What it remembers.
    pub(crate) memory: Memory<f64>,
}

/// What a mesh knows of the grains.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct AtMesh {
    /// Slot of every grain that is near, and where its triangles end, in order of slots.
    near: Vec<(u32, u32)>,
    /// The triangles that are near each.
    triangles: Vec<u32>,
    /// Contacts, in order of slots.
    pub(crate) held: Vec<Held>,
    /// Room for the contacts of a grain, and for those of the next evaluation.
    #[serde(skip)]
    found: Vec<Touched>,
    #[serde(skip)]
    next: Vec<Held>,
}

impl AtMesh {
    /// Whether it is of so many grains and of this surface.
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

    /// Whether nothing is known.
    pub(crate) fn is_empty(&self) -> bool {
        self.near.is_empty() && self.triangles.is_empty() && self.held.is_empty()
    }

    /// Number of pairs of a grain and a triangle that are near.
    pub(crate) fn pairs(&self) -> usize {
        self.triangles.len()
    }

    /// Begins the list anew. Gives the contacts that there were.
    pub(crate) fn begin_list(&mut self) -> Vec<Held> {
        self.near.clear();
        self.triangles.clear();
        std::mem::take(&mut self.held)
    }

    /// Lists the triangles within a distance (m) of a grain at a place. Grains come in order of slots.
    pub(crate) fn list(&mut self, mesh: &Mesh, slot: usize, place: Vector3<f64>, reach: f64) {
        mesh.surface.near(mesh.within(place), reach, &mut self.triangles);
        let end = self.triangles.len() as u32;
        if self.near.last().map_or(0, |&(_, end)| end) < end {
            self.near.push((slot as u32, end));
        }
    }

    /// Forgets what every contact remembers.
    pub(crate) fn forget(&mut self) {
        self.held.clear();
    }

    /// Finds what every near grain touches, and has each contact looked at with what it remembers. Gives how many there are.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        mesh: &Mesh,
        grains: &mut Grains<S>,
        mut contact: impl FnMut(&mut Grains<S>, usize, &Touched, &mut Memory<f64>),
    ) -> u64 {
        let Self { near, triangles, held, found, next, .. } = self;
        next.clear();
        let (mut from, mut before) = (0, 0);
        for &(slot, end) in near.iter() {
            let (place, radius) = (grains.position(slot as usize), grains.radius(slot as usize));
            mesh.surface.touched(mesh.within(place), radius, &triangles[from as usize..end as usize], found);
            from = end;
            // Grains that are no longer near touch nothing.
            before += held[before..].iter().take_while(|other| other.slot < slot).count();
            let count = held[before..].iter().take_while(|other| other.slot == slot).count();
            let own = &held[before..before + count];
            before += count;
            for touched in found.iter() {
                let mut memory = remembered(own, found, touched, radius);
                contact(grains, slot as usize, touched, &mut memory);
                next.push(Held { slot, group: touched.group, point: touched.point, memory });
            }
        }
        std::mem::swap(held, next);
        held.len() as u64
    }
}

/// What a contact remembers: of the same part of the surface; or of the nearest part that the grain has just left, unless
/// another contact is nearer to that.
fn remembered(own: &[Held], found: &[Touched], touched: &Touched, radius: f64) -> Memory<f64> {
    if let Some(same) = own.iter().find(|held| held.group == touched.group) {
        return same.memory;
    }
    let is_new = |of: &Touched| own.iter().all(|held| held.group != of.group);
    let left = own.iter().filter(|held| found.iter().all(|other| other.group != held.group));
    let away = |held: &Held, of: &Touched| (held.point - of.point).norm();
    let nearest = left.min_by(|a, b| away(a, touched).total_cmp(&away(b, touched)));
    nearest.filter(|held| away(held, touched) <= GOES_ON * radius).map_or_else(Default::default, |held| {
        let nearer = |other: &&Touched| is_new(other) && away(held, other) < away(held, touched);
        if found.iter().any(|other| nearer(&other)) { Default::default() } else { held.memory }
    })
}
