//! Neighbour list of pairs that may come into contact. Pairs are listed if their gap is smaller than a skin. The list
//! is rebuilt when a grain or wall has moved by half of the skin, when grains are inserted or removed, and when a wall
//! is removed.
//!
//! The list has one row per grain and contains each pair once. Contact history is stored beside the list, in the order of
//! the pairs in contact. Pairs across periodic faces are in a separate list with their shifts, so that the main loop
//! needs no periodic shifts. Each thread has a partition of the rows ([`crate::share`]).

use crate::cells::Cells;
use crate::contact::chain::Layout;
use crate::geometry::{Geometry, Linear};
use crate::grains::Grains;
use crate::listed::Pairs;
use crate::share::{ThreadPartition, rows_of};
use crate::skin;
use grainbench_lanes::{Quad, Team};
use grainbench_scene::scene::{Domain, Driven, Scene};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Radius above which a grain has no cell in the search grid, in mean radii. Cells as large as such a grain would contain
/// hundreds of other grains.
const FAR_LARGER: f64 = 4.0;

/// Neighbour list of all grains, divided into thread partitions.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Neighbours {
    /// Partitions, in the order of their rows. Checkpoints and runs with one thread have a single partition.
    pub(crate) shares: Vec<ThreadPartition>,
    /// Positions of the grains when the list was built (m).
    pub(crate) reference: Vec<Quad>,
    /// Skin (m): pairs with gaps smaller than the skin are listed.
    pub(crate) skin: f64,
    /// Step at which the list was built.
    pub(crate) built_at: u64,
    /// Number of builds.
    pub(crate) builds: u64,
}

impl Neighbours {
    /// Returns true if the list has a single partition that is valid for `grains` grains and this layout of the contact
    /// history.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        self.reference.len() == grains && matches!(&self.shares[..], [whole] if whole.is_of(grains, layout))
    }

    /// Returns the number of listed pairs.
    pub(crate) fn pairs(&self) -> usize {
        self.shares.iter().map(ThreadPartition::pairs).sum()
    }

    /// Creates an empty list with this skin (m).
    pub(crate) fn new(skin: f64) -> Self {
        Self { shares: Vec::new(), reference: Vec::new(), skin, built_at: 0, builds: 0 }
    }

    /// Returns a copy of the list, divided into `count` partitions.
    pub(crate) fn in_shares(&self, count: usize) -> Self {
        let Self { reference, skin, built_at, builds, .. } = self;
        let rows = rows_of(reference.len(), count);
        let shares = rows.into_iter().map(|rows| ThreadPartition::reaching(&self.shares, rows)).collect();
        Self { shares, reference: reference.clone(), skin: *skin, built_at: *built_at, builds: *builds }
    }

    /// Wraps positions into the periodic domain, sorts the grains by cell, and lists the pairs in `count` partitions.
    /// Contacts keep their history.
    ///
    /// `slots` holds, for the grain in each slot before the sort, its slot in the previous list;
    /// [`crate::grains::ABSENT`] if the grain was inserted later. Without insertions and removals, `slots` is `None`.
    /// `largest` is the largest radius that does not exceed `limit` (m). The few grains with radii above `limit` have no
    /// cell and search all cells within their reach. This search requires that no axis is periodic.
    pub(crate) fn rebuild<S: Geometry>(
        &mut self,
        team: &Team,
        count: usize,
        (grains, slots): (&mut Grains<S>, Option<&[u32]>),
        domain: Option<&Domain>,
        [largest, limit]: [f64; 2],
        layout: Layout,
    ) {
        if let Some(domain) = domain {
            for slot in 0..grains.len() {
                let position = wrapped(grains.position(slot), domain, S::DIMENSION);
                S::put(position, &mut grains.place[slot]);
            }
        }
        let reach = 2.0 * largest + self.skin;
        let (cells, mut order) = Cells::sort::<S>(&grains.place, reach, limit);
        grains.reorder(&order);
        if let Some(slots) = slots {
            order.iter_mut().for_each(|slot| *slot = slots[*slot as usize]);
        }

        let shifts = domain.map(half_of_the_shifts).unwrap_or_default();
        let mut old = std::mem::take(&mut self.shares);
        if layout.numbers == 0 {
            old.clear();
        }
        team.each(old.iter_mut(), |_, share| share.find_places());
        let mut shares: Vec<ThreadPartition> =
            rows_of(grains.len(), count).into_iter().map(ThreadPartition::new).collect();
        team.each(shares.iter_mut(), |_, share| {
            share.near.pairs = near_pairs::<S>(&grains.place, &cells, self.skin, share.rows.clone(), layout);
            share.across.pairs =
                pairs_across::<S>(&grains.place, &cells, [self.skin, reach], &shifts, share.rows.clone(), layout);
            share.take_over(&old, &order, &layout);
        });
        if shares.len() > 1 {
            let mut complete: Vec<ThreadPartition> =
                shares.iter().map(|share| ThreadPartition::new(share.rows.clone())).collect();
            team.each(complete.iter_mut(), |_, share| *share = ThreadPartition::reaching(&shares, share.rows.clone()));
            shares = complete;
        }
        self.shares = shares;
        self.reference.clone_from(&grains.place);
        self.builds += 1;
    }

    /// Returns the largest displacement of a grain since the list was built (m); infinite if any displacement is NaN.
    pub(crate) fn farthest<S: Geometry>(&self, grains: &Grains<S>) -> f64 {
        let away = |(now, then): (&Quad, &Quad)| {
            let away = S::vector(now.0) - S::vector(then.0);
            let squared = away.dot(away);
            if squared.is_nan() { f64::INFINITY } else { squared }
        };
        grains.place.iter().zip(&self.reference).map(away).fold(0.0, f64::max).sqrt()
    }

    /// Clears the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.shares
            .iter_mut()
            .flat_map(|share| [&mut share.near.pairs, &mut share.across.pairs])
            .for_each(Pairs::forget);
    }
}

/// Neighbour list of a simulation, with the displacements since the list was built.
pub(crate) struct NeighbourSearch {
    pub(crate) list: Neighbours,
    /// Largest radius of a grain (m).
    largest_radius: f64,
    /// Mean radius of the grains (m).
    mean_radius: f64,
    /// Largest prescribed speed of a group of grains (m/s).
    driven_speed: f64,
    /// Upper bound of the displacement of any grain since the list was built (m).
    pub(crate) travelled: f64,
    /// Upper bound of the distance from any wall's centre of rotation to any grain (m).
    pub(crate) extent: f64,
}

impl NeighbourSearch {
    /// Creates an empty list for the grains of a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let radii = || scene.grains.iter().map(|grain| grain.radius);
        let mean_radius = radii().sum::<f64>() / scene.grains.len() as f64;
        Self {
            list: Neighbours::new(skin::first(mean_radius)),
            largest_radius: radii().fold(0.0, f64::max),
            mean_radius,
            driven_speed: scene.driven.iter().map(Driven::fastest).fold(0.0, f64::max),
            travelled: 0.0,
            extent: 0.0,
        }
    }

    /// Resets the bounds after a build at a step. `distance` is the largest distance from any wall's centre of rotation
    /// to the centre of any grain (m).
    pub(crate) fn begin(&mut self, distance: f64, step: u64) {
        self.extent = distance + (self.largest_radius + self.list.skin);
        self.travelled = 0.0;
        self.list.built_at = step;
    }

    /// Adds the displacement of one step to the upper bound `travelled`. `fastest` is the square of the largest speed
    /// (m²/s²).
    pub(crate) fn travel(&mut self, fastest: f64, time_step: f64) {
        self.travelled += fastest.sqrt().max(self.driven_speed) * time_step;
    }

    /// Returns true if a grain, or a wall that has moved by `walls_moved` (m), may have moved by half of the skin.
    pub(crate) fn is_worn_out<S: Geometry>(&mut self, grains: &Grains<S>, walls_moved: f64) -> bool {
        let half_skin = 0.5 * self.list.skin;
        if self.travelled > half_skin {
            self.travelled = self.list.farthest(grains);
        }
        self.travelled.max(walls_moved) > half_skin
    }

    /// Adjusts the skin by the cost model of [`crate::skin`], from the number of pairs and the number of steps since the
    /// neighbour list was built.
    pub(crate) fn fit_skin(&mut self, step: u64, grains: usize, dimension: usize) {
        let steps = (step - self.list.built_at).max(1);
        let counts = [self.list.pairs() as f64, grains as f64, steps as f64];
        self.list.skin = skin::next(self.list.skin, self.mean_radius, counts, dimension);
    }

    /// Returns two radii (m): the largest radius of a grain with a cell in the search grid, and the radius above which
    /// grains have no cell. With a periodic axis, all grains have cells.
    pub(crate) fn radii_of_cells(&self, scene: &Scene) -> [f64; 2] {
        let limit = if scene.is_periodic() { f64::MAX } else { FAR_LARGER * self.mean_radius };
        if self.largest_radius <= limit {
            return [self.largest_radius, f64::MAX];
        }
        let radii = scene.grains.iter().map(|grain| grain.radius);
        [radii.filter(|radius| *radius <= limit).fold(0.0, f64::max), limit]
    }
}

/// Returns the periodic image of a position (m) inside the domain.
pub(crate) fn wrapped(mut position: Vector3<f64>, domain: &Domain, dimension: usize) -> Vector3<f64> {
    for axis in 0..dimension {
        if domain.periodic[axis] {
            let length = domain.high[axis] - domain.low[axis];
            let along = (position[axis] - domain.low[axis]) / length;
            if !(0.0..1.0).contains(&along) {
                position[axis] -= length * along.floor();
            }
        }
    }
    position
}

/// Returns true if the gap between two grains is smaller than the skin (m). The position of the first grain must
/// include the periodic shift.
#[inline(always)]
fn is_near<S: Geometry>(a: &Quad, b: &Quad, skin: f64) -> bool {
    let between = S::vector(b.0) - S::vector(a.0);
    let reach = a.0[3] + b.0[3] + skin;
    between.dot(between) < reach * reach
}

/// Lists the near pairs of the grains in `rows` inside the domain. Each pair is listed once, in the row of the grain with
/// the lower slot. A grain may thus move as soon as its row has been processed. Each grain is tested against later grains
/// in its own cell and in the adjacent cells that follow.
fn near_pairs<S: Geometry>(place: &[Quad], cells: &Cells, skin: f64, rows: Range<usize>, layout: Layout) -> Pairs {
    let without = cells.without();
    let mut cell = if without < place.len() { cells.cell(rows.start.clamp(without, place.len() - 1)) } else { 0 };
    let mut at = cells.place(cell);
    Pairs::list(rows, layout, |slot, partners, _| {
        let grain = &place[slot];
        if slot < without {
            return beside_a_large_one::<S>(place, cells, skin, slot, partners);
        }
        while cells.start[cell + 1] as usize <= slot {
            cell += 1;
            at = cells.place(cell);
        }
        let [i, j, k] = at;
        let (left, right) = (i.saturating_sub(1), (i + 1).min(cells.count[0] - 1));
        let mut scan = |range: Range<usize>| {
            // A branch here would be mispredicted often. Therefore every candidate is written, and the next one
            // overwrites a candidate that is not near.
            let mut count = partners.len();
            partners.resize(count + range.len(), 0);
            for other in range {
                partners[count] = other as u32;
                count += usize::from(is_near::<S>(grain, &place[other], skin));
            }
            partners.truncate(count);
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

/// Finds the partners of a grain that is too large for a cell. Candidates are all grains in the cells within its reach,
/// and later grains without a cell.
fn beside_a_large_one<S: Geometry>(place: &[Quad], cells: &Cells, skin: f64, slot: usize, partners: &mut Vec<u32>) {
    let (grain, without) = (&place[slot], cells.without());
    let mut take = |range: Range<usize>| {
        partners.extend(range.filter(|&other| is_near::<S>(grain, &place[other], skin)).map(|other| other as u32));
    };
    let reach = Vector3::repeat(grain.0[3] + cells.reach);
    let middle = S::vector_in_space(grain);
    let (low, high) = (cells.coordinates(middle - reach), cells.coordinates(middle + reach));
    take(slot + 1..without);
    if without < place.len() {
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                take(cells.row(low[0], high[0], j, k));
            }
        }
    }
}

/// Returns one of each pair of opposite periodic shifts (m).
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

/// Lists the near pairs of the grains in `rows` across periodic faces. Each pair is listed once, with its shift (m).
fn pairs_across<S: Geometry>(
    place: &[Quad],
    cells: &Cells,
    [skin, reach]: [f64; 2],
    shifts: &[Vector3<f64>],
    rows: Range<usize>,
    layout: Layout,
) -> Pairs {
    if shifts.is_empty() {
        return Pairs::empty();
    }
    // With a periodic axis, all grains have cells.
    let [low, high] = cells.bounds;
    Pairs::list(rows, layout, |slot, partners, shift_of| {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::MEMORY;
    use grainbench_scene::scene::Domain;
    use grainbench_solver::space::{Plane, Solid};
    use std::collections::BTreeSet;

    const NOTHING: Layout = Layout { numbers: 0, exchanged: [1.0; MEMORY] };

    /// Returns reproducible pseudo-random positions.
    fn scatter(count: usize, dimension: usize, size: f64) -> Vec<Vector3<f64>> {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            size * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| Vector3::new(next(), next(), if dimension == 3 { next() } else { 0.0 })).collect()
    }

    /// Tests that each pair of near grains is listed once. In the list of pairs inside the domain, the index of the
    /// row is below the index of the partner.
    fn assert_lists<S: Geometry>(neighbours: &Neighbours, grains: &Grains<S>, is_near: impl Fn(usize, usize) -> bool) {
        let mut listed = BTreeSet::new();
        for pairs in neighbours.shares.iter().flat_map(|share| [&share.near.pairs, &share.across.pairs]) {
            for at in pairs.own() {
                let [row, partner] = [pairs.row[at], pairs.partner[at]];
                assert!(row < partner || !pairs.shift.is_empty(), "a grain moves before its row is reached");
                let (a, b) = (grains.id[row as usize], grains.id[partner as usize]);
                assert!(listed.insert((a.min(b), a.max(b))), "pair {a} {b} listed twice");
            }
        }
        let all = (0..grains.len()).flat_map(|a| (a + 1..grains.len()).map(move |b| (a, b)));
        let expected: BTreeSet<_> = all.filter(|&(a, b)| is_near(a, b)).map(|(a, b)| (a as u32, b as u32)).collect();
        assert_eq!(listed, expected);
    }

    fn agrees_with_all_pairs<S: Geometry>(periodic: [bool; 3], shares: usize) {
        let (size, radius, skin) = (10.0, 0.5, 0.3);
        let points = scatter(300, S::DIMENSION, size);
        let domain = Domain { low: Vector3::zeros(), high: Vector3::repeat(size), periodic };
        let mut grains = Grains::<S>::at(&points, radius);
        let mut neighbours = Neighbours::new(skin);
        neighbours.rebuild(&Team::new(1), shares, (&mut grains, None), Some(&domain), [radius, f64::MAX], NOTHING);
        assert_lists(&neighbours, &grains, |a, b| {
            let mut between = points[b] - points[a];
            for axis in (0..3).filter(|&axis| periodic[axis]) {
                between[axis] -= size * (between[axis] / size).round();
            }
            between.norm() < 2.0 * radius + skin
        });
    }

    /// The domain from 1 to 4 m has the length 3 m.
    #[test]
    fn positions_outside_a_periodic_domain_move_by_its_length() {
        let domain = Domain { low: Vector3::repeat(1.0), high: Vector3::repeat(4.0), periodic: [true, true, false] };
        let inside = wrapped(Vector3::new(4.5, 0.5, 4.5), &domain, 3);
        assert_eq!(inside, Vector3::new(1.5, 3.5, 4.5));
    }

    #[test]
    fn lists_every_near_pair_once() {
        for shares in [1, 4] {
            agrees_with_all_pairs::<Plane>([false; 3], shares);
            agrees_with_all_pairs::<Plane>([true, false, false], shares);
            agrees_with_all_pairs::<Plane>([true, true, false], shares);
            agrees_with_all_pairs::<Solid>([false; 3], shares);
            agrees_with_all_pairs::<Solid>([false, true, false], shares);
            agrees_with_all_pairs::<Solid>([true; 3], shares);
        }
    }

    /// Each near pair is listed once, although three grains are ten times as large as all others and have no cell. One of
    /// the three is far from all cells.
    #[test]
    fn lists_what_is_near_to_large_grains_once() {
        let (radius, large, skin) = (0.1, 1.0, 0.05);
        let mut points = scatter(400, 3, 4.0);
        points.extend([Vector3::new(2.0, 1.5, 4.5), Vector3::new(2.0, 3.0, 3.5), Vector3::new(2.0, 2.0, 40.0)]);
        let radius_of = |id: usize| if id < 400 { radius } else { large };
        for shares in [1, 3] {
            let mut grains = Grains::<Solid>::at(&points, radius);
            (400..points.len()).for_each(|slot| grains.place[slot].0[3] = large);
            let mut neighbours = Neighbours::new(skin);
            for _ in 0..2 {
                let slots: Vec<u32> = (0..points.len() as u32).collect();
                let grains = (&mut grains, Some(&slots[..]));
                neighbours.rebuild(&Team::new(1), shares, grains, None, [radius, 0.4], NOTHING);
            }
            assert_lists(&neighbours, &grains, |a, b| {
                (points[b] - points[a]).norm() < radius_of(a) + radius_of(b) + skin
            });
        }
    }
}
