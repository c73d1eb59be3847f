//! The neighbour list: pairs that may touch, with a skin, built anew only when something has moved by half of the skin.
//!
//! The list has a row for each grain, and each pair is in it once. The history of a contact stands beside its pair.
//! Pairs across a periodic face have a list of their own, with their shift, so that the loop over the others knows
//! nothing of periodic axes.

use crate::cells::Cells;
use crate::grains::{Grains, Place};
use crate::rotation::Rotation;
use grainbench_scene::scene::Domain;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Pairs of grains, in rows: a row holds the partners of one grain.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Pairs<H> {
    /// Number of the first pair of every row, and of all pairs at the end.
    pub(crate) start: Vec<u32>,
    /// Slot of the partner of each pair.
    pub(crate) partner: Vec<u32>,
    /// History of the contact of each pair, the default while it does not touch.
    pub(crate) history: Vec<H>,
}

impl<H: Copy + Default> Pairs<H> {
    fn empty() -> Self {
        Self { start: vec![0], partner: Vec::new(), history: Vec::new() }
    }

    fn push(&mut self, partner: usize) {
        self.partner.push(partner as u32);
        self.history.push(H::default());
    }

    fn end_row(&mut self) {
        self.start.push(self.partner.len() as u32);
    }

    /// Whether these are pairs of so many grains: rows that follow one another, and a history for each pair.
    fn is_of(&self, grains: usize) -> bool {
        let count = self.partner.len();
        let rows = self.start.len() == grains + 1 || self.start == [0];
        let in_order = self.start.first() == Some(&0) && self.start.is_sorted();
        rows && in_order
            && self.start.last().is_some_and(|&last| last as usize == count)
            && self.history.len() == count
            && self.partner.iter().all(|&partner| (partner as usize) < grains)
    }

    fn find(&self, row: u32, partner: u32) -> Option<H> {
        let row = row as usize;
        let range = *self.start.get(row)? as usize..*self.start.get(row + 1)? as usize;
        let at = self.partner[range.clone()].iter().position(|&other| other == partner)?;
        Some(self.history[range.start + at])
    }
}

/// The neighbour list.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "H: Serialize", deserialize = "H: Deserialize<'de>"))]
pub(crate) struct Neighbours<S: Space, H> {
    /// Pairs that are near in the domain itself.
    pub(crate) near: Pairs<H>,
    /// Pairs that are near across a periodic face.
    pub(crate) across: Pairs<H>,
    /// Shift of each pair across a periodic face: what is added to the position of the first grain (m).
    pub(crate) shift: Vec<S::Vector>,
    /// Positions of the grains when the list was built (m).
    pub(crate) reference: Vec<S::Vector>,
    /// Skin: pairs are listed whose surfaces are nearer than this (m).
    pub(crate) skin: f64,
    /// How often the list was built.
    pub(crate) builds: u64,
}

impl<S: Space, H: Copy + Default> Neighbours<S, H> {
    /// Whether this is a list of so many grains.
    pub(crate) fn is_of(&self, grains: usize) -> bool {
        let Self { near, across, shift, reference, .. } = self;
        let known = reference.len() == grains || reference.is_empty();
        known && near.is_of(grains) && across.is_of(grains) && shift.len() == across.partner.len()
    }

    pub(crate) fn new(skin: f64) -> Self {
        Self { near: Pairs::empty(), across: Pairs::empty(), shift: Vec::new(), reference: Vec::new(), skin, builds: 0 }
    }

    /// Wraps the positions into the domain, sorts the grains and lists the pairs anew. Contacts keep their history;
    /// `exchange` gives a history with the roles of first and second grain exchanged.
    pub(crate) fn rebuild<R: Rotation<S>>(
        &mut self,
        grains: &mut Grains<S, R>,
        domain: Option<&Domain>,
        largest: f64,
        exchange: fn(H) -> H,
    ) {
        if let Some(domain) = domain {
            grains.place.iter_mut().for_each(|place| place.position = wrapped::<S>(place.position, domain));
        }
        let reach = 2.0 * largest + self.skin;
        let (cells, order) = Cells::sort(&grains.place, reach);
        grains.reorder(&order);
        let mut old_slot = vec![0_u32; grains.len()];
        order.iter().enumerate().for_each(|(slot, &from)| old_slot[slot] = from);

        let near = near_pairs(&grains.place, &cells, self.skin);
        let shifts = domain.map(half_of_the_shifts).unwrap_or_default();
        let (across, shift) = pairs_across::<S, H>(&grains.place, &cells, self.skin, reach, &shifts);
        let old_near = std::mem::replace(&mut self.near, near);
        let old_across = std::mem::replace(&mut self.across, across);
        self.shift = shift;
        if size_of::<H>() > 0 && self.builds > 0 {
            let recall = |a: u32, b: u32| old_near.find(a, b).or_else(|| old_across.find(a, b));
            for pairs in [&mut self.near, &mut self.across] {
                for row in 0..old_slot.len().min(pairs.start.len() - 1) {
                    for at in pairs.start[row] as usize..pairs.start[row + 1] as usize {
                        let (a, b) = (old_slot[row], old_slot[pairs.partner[at] as usize]);
                        if let Some(history) = recall(a, b).or_else(|| recall(b, a).map(exchange)) {
                            pairs.history[at] = history;
                        }
                    }
                }
            }
        }
        self.reference.clear();
        self.reference.extend(grains.place.iter().map(|place| place.position));
        self.builds += 1;
    }

    /// Forgets every contact's history.
    pub(crate) fn forget(&mut self) {
        self.near.history.fill(H::default());
        self.across.history.fill(H::default());
    }
}

/// The periodic image of a position (m) that lies inside the domain.
pub(crate) fn wrapped<S: Space>(position: S::Vector, domain: &Domain) -> S::Vector {
    let mut full = S::embed(position);
    for axis in 0..S::DIMENSION {
        if domain.periodic[axis] {
            let length = domain.high[axis] - domain.low[axis];
            full[axis] -= length * ((full[axis] - domain.low[axis]) / length).floor();
        }
    }
    S::restrict(full)
}

/// Whether a grain's centre is nearer to the position `a` than `reach` (m).
fn is_near<S: Space>(a: S::Vector, b: &Place<S>, reach: f64) -> bool {
    let between = b.position - a;
    S::dot(between, between) < reach * reach
}

/// Every pair that is near in the domain itself, once: each grain with those after it in its own cells and in the next.
fn near_pairs<S: Space, H: Copy + Default>(place: &[Place<S>], cells: &Cells, skin: f64) -> Pairs<H> {
    let mut pairs = Pairs::empty();
    for (slot, grain) in place.iter().enumerate() {
        let [i, j, k] = cells.coordinates(S::embed(grain.position));
        let (left, right) = (i.saturating_sub(1), (i + 1).min(cells.count[0] - 1));
        let mut scan = |range: std::ops::Range<usize>| {
            for other in range {
                if is_near(grain.position, &place[other], grain.radius + place[other].radius + skin) {
                    pairs.push(other);
                }
            }
        };
        scan(slot + 1..cells.row(i, right, j, k).end);
        if j + 1 < cells.count[1] {
            scan(cells.row(left, right, j + 1, k));
        }
        if k + 1 < cells.count[2] {
            for above in j.saturating_sub(1)..=(j + 1).min(cells.count[1] - 1) {
                scan(cells.row(left, right, above, k + 1));
            }
        }
        pairs.end_row();
    }
    pairs
}

/// One of each pair of opposite periodic shifts (m).
fn half_of_the_shifts(domain: &Domain) -> Vec<Vector3<f64>> {
    let steps = |axis: usize| if domain.periodic[axis] { -1..=1 } else { 0..=0 };
    let length = domain.high - domain.low;
    let mut shifts = Vec::new();
    for k in steps(2) {
        for j in steps(1) {
            for i in steps(0) {
                if (k, j, i) > (0, 0, 0) {
                    shifts.push(length.component_mul(&Vector3::new(f64::from(i), f64::from(j), f64::from(k))));
                }
            }
        }
    }
    shifts
}

/// Every pair that is near across a periodic face, once, with its shift (m).
fn pairs_across<S: Space, H: Copy + Default>(
    place: &[Place<S>],
    cells: &Cells,
    skin: f64,
    reach: f64,
    shifts: &[Vector3<f64>],
) -> (Pairs<H>, Vec<S::Vector>) {
    let mut pairs = Pairs::empty();
    let mut shift_of = Vec::new();
    if shifts.is_empty() {
        return (pairs, shift_of);
    }
    let (low, high) = bounds(place);
    for (slot, grain) in place.iter().enumerate() {
        for shift in shifts {
            let image = S::embed(grain.position) + shift;
            if (0..S::DIMENSION).any(|axis| image[axis] < low[axis] - reach || image[axis] > high[axis] + reach) {
                continue;
            }
            let [i, j, k] = cells.coordinates(image);
            let around = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
            for k in around(k, cells.count[2]) {
                for j in around(j, cells.count[1]) {
                    for other in cells.row(i.saturating_sub(1), (i + 1).min(cells.count[0] - 1), j, k) {
                        let near =
                            is_near(S::restrict(image), &place[other], grain.radius + place[other].radius + skin);
                        if other != slot && near {
                            pairs.push(other);
                            shift_of.push(S::restrict(*shift));
                        }
                    }
                }
            }
        }
        pairs.end_row();
    }
    (pairs, shift_of)
}

/// Lowest and highest coordinates of the grains' centres (m).
fn bounds<S: Space>(place: &[Place<S>]) -> (Vector3<f64>, Vector3<f64>) {
    let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    place.iter().map(|grain| S::embed(grain.position)).fold(start, |(low, high), at| (low.inf(&at), high.sup(&at)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::Rigid;
    use grainbench_scene::scene::Domain;
    use grainbench_scene::space::{Plane, Solid};
    use std::collections::BTreeSet;

    /// A cheap reproducible scatter.
    fn scatter(count: usize, dimension: usize, size: f64) -> Vec<Vector3<f64>> {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            size * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| Vector3::new(next(), next(), if dimension == 3 { next() } else { 0.0 })).collect()
    }

    fn agrees_with_all_pairs<S: Space>(periodic: [bool; 3]) {
        let (size, radius, skin) = (10.0, 0.5, 0.3);
        let points = scatter(300, S::DIMENSION, size);
        let domain = Domain { low: Vector3::zeros(), high: Vector3::repeat(size), periodic };
        let mut grains: Grains<S, Rigid> = Grains {
            place: points.iter().map(|&at| Place { position: S::restrict(at), radius }).collect(),
            movement: vec![crate::grains::Movement { velocity: S::ORIGIN, inverse_mass: 1.0 }; points.len()],
            rotation: vec![Rigid; points.len()],
            force: vec![S::ORIGIN; points.len()],
            torque: vec![Default::default(); points.len()],
            material: vec![0; points.len()],
            id: (0..points.len() as u32).collect(),
            slot: (0..points.len() as u32).collect(),
        };
        let mut neighbours = Neighbours::<S, ()>::new(skin);
        neighbours.rebuild(&mut grains, Some(&domain), radius, |()| ());
        let mut listed = BTreeSet::new();
        for pairs in [&neighbours.near, &neighbours.across] {
            for row in 0..pairs.start.len() - 1 {
                for at in pairs.start[row] as usize..pairs.start[row + 1] as usize {
                    let (a, b) = (grains.id[row], grains.id[pairs.partner[at] as usize]);
                    assert!(listed.insert((a.min(b), a.max(b))), "pair {a} {b} listed twice");
                }
            }
        }
        let mut expected = BTreeSet::new();
        for a in 0..points.len() {
            for b in a + 1..points.len() {
                let mut between = points[b] - points[a];
                for axis in 0..3 {
                    if periodic[axis] {
                        between[axis] -= size * (between[axis] / size).round();
                    }
                }
                if between.norm() < 2.0 * radius + skin {
                    expected.insert((a as u32, b as u32));
                }
            }
        }
        assert_eq!(listed, expected);
    }

    #[test]
    fn lists_every_near_pair_once() {
        agrees_with_all_pairs::<Plane>([false; 3]);
        agrees_with_all_pairs::<Plane>([true, false, false]);
        agrees_with_all_pairs::<Plane>([true, true, false]);
        agrees_with_all_pairs::<Solid>([false; 3]);
        agrees_with_all_pairs::<Solid>([false, true, false]);
        agrees_with_all_pairs::<Solid>([true; 3]);
    }

    /// What a checkpoint may hold that some other program wrote.
    #[test]
    fn lists_of_other_grains_are_told() {
        let pairs = Pairs { start: vec![0, 1, 1], partner: vec![1], history: vec![()] };
        assert!(pairs.is_of(2) && Pairs::<()>::empty().is_of(2) && !pairs.is_of(1) && !pairs.is_of(3));
        assert!(!Pairs { partner: vec![2], ..pairs.clone() }.is_of(2));
        assert!(!Pairs { start: vec![0, 2, 1], ..pairs.clone() }.is_of(2));
        assert!(!Pairs { start: vec![0, 1, 2], ..pairs.clone() }.is_of(2));
        assert!(!Pairs { history: Vec::new(), ..pairs }.is_of(2));
    }
}
