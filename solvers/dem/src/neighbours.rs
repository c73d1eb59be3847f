//! The neighbour list: pairs that may touch, with a skin, built anew only when something has moved by half of the skin.
//!
//! The list has a row for each grain, and each pair is in it once. What contacts remember stands beside it, in the order of
//! those that touch. Pairs across a periodic face have a list of their own, with their shift, so that the loop over the
//! others knows nothing of periodic axes.

use crate::cells::Cells;
use crate::contact::chain::Layout;
use crate::geometry::{Geometry, Linear};
use crate::grains::Grains;
use grainbench_lanes::{Quad, WIDEST};
use grainbench_scene::scene::Domain;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Pairs of grains, in rows: a row holds the partners of one grain. Partners, rows and shifts are filled up beyond the last
/// pair, so that registers can be.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Pairs {
    /// Number of the first pair of every row, and of all pairs at the end.
    pub(crate) start: Vec<u32>,
    /// Slot of the first grain of each pair: its row.
    pub(crate) row: Vec<u32>,
    /// Slot of the partner of each pair.
    pub(crate) partner: Vec<u32>,
    /// Shift of each pair across a periodic face: what is added to the position of the first grain (m). Empty where none is.
    pub(crate) shift: Vec<Quad>,
    /// Whether each pair touched when it was looked at last, as bits, the first of eight lowest. Empty where nothing is
    /// remembered.
    pub(crate) touches: Vec<u8>,
    /// What the contacts of those that touched remember, in their order, after nothing: four numbers and four more. Empty
    /// where so many are not remembered.
    pub(crate) memory: [Vec<Quad>; 2],
    /// Room for what they remember next, with no more in it than that.
    #[serde(skip)]
    pub(crate) next: [Vec<Quad>; 2],
}

impl Pairs {
    fn empty() -> Self {
        Self {
            start: vec![0],
            row: vec![0; WIDEST],
            partner: vec![0; WIDEST],
            shift: Vec::new(),
            touches: Vec::new(),
            memory: Default::default(),
            next: Default::default(),
        }
    }

    /// Number of pairs.
    pub(crate) fn len(&self) -> usize {
        self.partner.len() - WIDEST
    }

    /// Lists what `partners` gives of each row, with room for what the contacts remember.
    fn list(grains: usize, layout: Layout, mut partners: impl FnMut(usize, &mut Vec<u32>, &mut Vec<Quad>)) -> Self {
        let mut pairs = Self { partner: Vec::new(), row: Vec::new(), ..Self::empty() };
        for row in 0..grains {
            partners(row, &mut pairs.partner, &mut pairs.shift);
            pairs.row.resize(pairs.partner.len(), row as u32);
            pairs.start.push(pairs.partner.len() as u32);
        }
        let count = pairs.partner.len();
        pairs.touches = vec![0; if layout.numbers > 0 { count.div_ceil(WIDEST) } else { 0 }];
        pairs.memory = [0, 4].map(|from| vec![Quad::default(); usize::from(layout.numbers > from)]);
        pairs.partner.resize(count + WIDEST, 0);
        pairs.row.resize(count + WIDEST, 0);
        if !pairs.shift.is_empty() {
            pairs.shift.resize(count + WIDEST, Quad::default());
        }
        pairs
    }

    /// Whether these are pairs of so many grains: rows that follow one another, and for each pair what it must have.
    fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { start, row, partner, shift, touches, memory, next: _ } = self;
        let Some(count) = partner.len().checked_sub(WIDEST) else { return false };
        let rows = start.len() == grains + 1 || start == &[0];
        let in_order = start.first() == Some(&0) && start.is_sorted();
        let touched = touches.iter().map(|bits| bits.count_ones() as usize).sum::<usize>();
        let remembers = |from: usize, count: usize| if layout.numbers > from && *start != [0] { count } else { 0 };
        rows && in_order
            && start.last().is_some_and(|&last| last as usize == count)
            && row.len() == partner.len()
            && start
                .windows(2)
                .zip(0..)
                .all(|(ends, number)| row[ends[0] as usize..ends[1] as usize].iter().all(|&row| row == number))
            && (shift.is_empty() || shift.len() == partner.len())
            && touches.len() == remembers(0, count.div_ceil(WIDEST))
            && [memory[0].len(), memory[1].len()] == [remembers(0, 1 + touched), remembers(4, 1 + touched)]
            && row.iter().chain(partner).all(|&slot| (slot as usize) < grains)
    }

    /// Number of a pair in the list.
    fn find(&self, row: u32, partner: u32) -> Option<usize> {
        let row = row as usize;
        let range = *self.start.get(row)? as usize..*self.start.get(row + 1)? as usize;
        let at = self.partner[range.clone()].iter().position(|&other| other == partner)?;
        Some(range.start + at)
    }

    /// Place in the memory of every pair that touched when it was looked at last, zero of the others.
    fn places(&self) -> Vec<u32> {
        let mut touched = 0;
        let place = |pair: usize| {
            let touches = self.touches.get(pair / WIDEST).is_some_and(|bits| bits >> (pair % WIDEST) & 1 == 1);
            touched += u32::from(touches);
            if touches { touched } else { 0 }
        };
        (0..self.len()).map(place).collect()
    }

    /// Remembers of the next pair `at` what another list does in a place of its memory; with the roles of first and second
    /// grain exchanged if `exchanged` is given.
    fn take(&mut self, at: usize, other: &Self, place: u32, exchanged: Option<&Layout>) {
        self.touches[at / WIDEST] |= 1 << (at % WIDEST);
        for (number, (mine, other)) in self.memory.iter_mut().zip(&other.memory).enumerate() {
            if let Some(mut quad) = other.get(place as usize).copied() {
                if let Some(layout) = exchanged {
                    (0..4).for_each(|part| quad.0[part] *= layout.exchanged[4 * number + part]);
                }
                mine.push(quad);
            }
        }
    }

    /// Room for what a block of pairs remembers from a place on.
    pub(crate) fn make_room(&mut self, places: usize) {
        for (memory, next) in self.memory.iter().zip(&mut self.next) {
            if !memory.is_empty() && next.len() < places {
                next.resize(places, Quad::default());
            }
        }
    }

    /// What was written as next, of so many contacts, is what is remembered.
    pub(crate) fn remember(&mut self, contacts: usize) {
        for (memory, next) in self.memory.iter_mut().zip(&mut self.next).filter(|(memory, _)| !memory.is_empty()) {
            std::mem::swap(memory, next);
            memory.truncate(1 + contacts);
            memory.resize(1 + contacts, Quad::default());
        }
    }

    fn forget(&mut self) {
        self.memory.iter_mut().for_each(|memory| memory.fill(Quad::default()));
    }
}

/// The neighbour list.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Neighbours {
    /// Pairs that are near in the domain itself.
    pub(crate) near: Pairs,
    /// Pairs that are near across a periodic face.
    pub(crate) across: Pairs,
    /// Positions of the grains when the list was built (m).
    pub(crate) reference: Vec<Quad>,
    /// Skin: pairs are listed whose surfaces are nearer than this (m).
    pub(crate) skin: f64,
    /// How often the list was built.
    pub(crate) builds: u64,
}

impl Neighbours {
    /// Whether this is a list of so many grains.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { near, across, reference, .. } = self;
        let known = reference.len() == grains || reference.is_empty();
        let shifted = across.shift.len() == across.partner.len() || across.len() == 0;
        known && shifted && near.shift.is_empty() && near.is_of(grains, layout) && across.is_of(grains, layout)
    }

    pub(crate) fn new(skin: f64) -> Self {
        Self { near: Pairs::empty(), across: Pairs::empty(), reference: Vec::new(), skin, builds: 0 }
    }

    /// Wraps the positions into the domain, sorts the grains and lists the pairs anew. Contacts go on remembering.
    pub(crate) fn rebuild<S: Geometry>(
        &mut self,
        grains: &mut Grains<S>,
        domain: Option<&Domain>,
        largest: f64,
        layout: Layout,
    ) {
        if let Some(domain) = domain {
            for slot in 0..grains.len() {
                let position = wrapped(grains.position(slot), domain, S::DIMENSION);
                S::put(position, &mut grains.place[slot]);
            }
        }
        let reach = 2.0 * largest + self.skin;
        let (cells, order) = Cells::sort::<S>(&grains.place, reach);
        grains.reorder(&order);

        let near = near_pairs::<S>(&grains.place, &cells, self.skin, layout);
        let shifts = domain.map(half_of_the_shifts).unwrap_or_default();
        let across = pairs_across::<S>(&grains.place, &cells, self.skin, reach, &shifts, layout);
        let old = [std::mem::replace(&mut self.near, near), std::mem::replace(&mut self.across, across)];
        if layout.numbers > 0 && self.builds > 0 {
            let places = old.each_ref().map(Pairs::places);
            for pairs in [&mut self.near, &mut self.across] {
                for at in 0..pairs.len() {
                    let (a, b) = (order[pairs.row[at] as usize], order[pairs.partner[at] as usize]);
                    let found = |a, b| {
                        let mut lists = old.iter().zip(&places);
                        lists.find_map(|(old, places)| old.find(a, b).map(|from| (old, places[from])))
                    };
                    let (found, exchanged) = match found(a, b) {
                        Some(found) => (Some(found), None),
                        None => (found(b, a), Some(&layout)),
                    };
                    if let Some((old, place)) = found.filter(|&(_, place)| place > 0) {
                        pairs.take(at, old, place, exchanged);
                    }
                }
            }
        }
        self.reference.clone_from(&grains.place);
        self.builds += 1;
    }

    /// How far any grain is from where it was when the pairs were listed (m); infinite where that is not a number.
    pub(crate) fn farthest<S: Geometry>(&self, grains: &Grains<S>) -> f64 {
        let away = |(now, then): (&Quad, &Quad)| {
            let away = S::vector(now.0) - S::vector(then.0);
            let squared = away.dot(away);
            if squared.is_nan() { f64::INFINITY } else { squared }
        };
        grains.place.iter().zip(&self.reference).map(away).fold(0.0, f64::max).sqrt()
    }

    /// Forgets what every contact remembers.
    pub(crate) fn forget(&mut self) {
        self.near.forget();
        self.across.forget();
    }
}

/// The periodic image of a position (m) that lies inside the domain of so many dimensions.
pub(crate) fn wrapped(mut position: Vector3<f64>, domain: &Domain, dimension: usize) -> Vector3<f64> {
    for axis in 0..dimension {
        if domain.periodic[axis] {
            let length = domain.high[axis] - domain.low[axis];
            position[axis] -= length * ((position[axis] - domain.low[axis]) / length).floor();
        }
    }
    position
}

/// Whether a grain, shifted, and another are nearer to each other than the skin (m).
#[inline(always)]
fn is_near<S: Geometry>(a: &Quad, b: &Quad, skin: f64) -> bool {
    let between = S::vector(b.0) - S::vector(a.0);
    let reach = a.0[3] + b.0[3] + skin;
    between.dot(between) < reach * reach
}

/// Every pair that is near in the domain itself, once: each grain with those after it in its own cells and in the next.
fn near_pairs<S: Geometry>(place: &[Quad], cells: &Cells, skin: f64, layout: Layout) -> Pairs {
    Pairs::list(place.len(), layout, |slot, partners, _| {
        let grain = &place[slot];
        let [i, j, k] = cells.coordinates(S::vector_in_space(grain));
        let (left, right) = (i.saturating_sub(1), (i + 1).min(cells.count[0] - 1));
        let mut scan = |range: std::ops::Range<usize>| {
            for other in range {
                if is_near::<S>(grain, &place[other], skin) {
                    partners.push(other as u32);
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
    })
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
fn pairs_across<S: Geometry>(
    place: &[Quad],
    cells: &Cells,
    skin: f64,
    reach: f64,
    shifts: &[Vector3<f64>],
    layout: Layout,
) -> Pairs {
    if shifts.is_empty() {
        return Pairs::empty();
    }
    let (low, high) = bounds::<S>(place);
    Pairs::list(place.len(), layout, |slot, partners, shift_of| {
        for shift in shifts {
            let image = S::vector_in_space(&place[slot]) + shift;
            if (0..S::DIMENSION).any(|axis| image[axis] < low[axis] - reach || image[axis] > high[axis] + reach) {
                continue;
            }
            let mut shifted = place[slot];
            S::put(image, &mut shifted);
            let [i, j, k] = cells.coordinates(image);
            let around = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
            for k in around(k, cells.count[2]) {
                for j in around(j, cells.count[1]) {
                    for other in cells.row(i.saturating_sub(1), (i + 1).min(cells.count[0] - 1), j, k) {
                        if other != slot && is_near::<S>(&shifted, &place[other], skin) {
                            partners.push(other as u32);
                            shift_of.push(Quad([shift.x, shift.y, shift.z, 0.0]));
                        }
                    }
                }
            }
        }
    })
}

/// Lowest and highest coordinates of the grains' centres (m).
fn bounds<S: Geometry>(place: &[Quad]) -> (Vector3<f64>, Vector3<f64>) {
    let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    place.iter().map(S::vector_in_space).fold(start, |(low, high), at| (low.inf(&at), high.sup(&at)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::scene::Domain;
    use grainbench_scene::space::{Plane, Solid};
    use std::collections::BTreeSet;

    const NOTHING: Layout = Layout { numbers: 0, exchanged: [1.0; 8] };

    /// A cheap reproducible scatter.
    fn scatter(count: usize, dimension: usize, size: f64) -> Vec<Vector3<f64>> {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            size * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| Vector3::new(next(), next(), if dimension == 3 { next() } else { 0.0 })).collect()
    }

    fn agrees_with_all_pairs<S: Geometry>(periodic: [bool; 3]) {
        let (size, radius, skin) = (10.0, 0.5, 0.3);
        let points = scatter(300, S::DIMENSION, size);
        let domain = Domain { low: Vector3::zeros(), high: Vector3::repeat(size), periodic };
        let mut grains = Grains::<S>::at(&points, radius);
        let mut neighbours = Neighbours::new(skin);
        neighbours.rebuild(&mut grains, Some(&domain), radius, NOTHING);
        let mut listed = BTreeSet::new();
        for pairs in [&neighbours.near, &neighbours.across] {
            for at in 0..pairs.len() {
                let (a, b) = (grains.id[pairs.row[at] as usize], grains.id[pairs.partner[at] as usize]);
                assert!(listed.insert((a.min(b), a.max(b))), "pair {a} {b} listed twice");
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
        let layout = Layout { numbers: 1, ..NOTHING };
        let pairs = Pairs::list(2, layout, |row, partners, _| {
            if row == 0 {
                partners.push(1)
            }
        });
        let of = |pairs: &Pairs, grains: usize| pairs.is_of(grains, layout);
        assert!(of(&pairs, 2) && of(&Pairs::empty(), 2) && !of(&pairs, 1) && !of(&pairs, 3));
        let mut other = pairs.clone();
        other.partner[0] = 2;
        assert!(!of(&other, 2));
        assert!(!of(&Pairs { start: vec![0, 2, 1], ..pairs.clone() }, 2));
        assert!(!of(&Pairs { start: vec![0, 1, 2], ..pairs.clone() }, 2));
        let mut other = pairs.clone();
        other.row[0] = 1;
        assert!(!of(&other, 2));
        assert!(!of(&Pairs { touches: Vec::new(), ..pairs.clone() }, 2));
        assert!(!of(&Pairs { touches: vec![1], ..pairs.clone() }, 2));
        assert!(!of(&Pairs { memory: Default::default(), ..pairs.clone() }, 2));
        assert!(!of(&Pairs { row: vec![0], ..pairs }, 2));
    }
}
