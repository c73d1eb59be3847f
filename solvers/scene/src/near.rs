//! Search for pairs of nearby spheres of any sizes, in a time almost proportional to the number of spheres.

use crate::scene::Domain;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::ops::{ControlFlow, Range};

/// Bound of the cell indices, so that the indices of adjacent cells are valid integers.
const FARTHEST: f64 = 1e18;

/// Calls `visit` at least once for each pair (a, b), a ≠ b, of spheres with a gap below `skin` (m). Some pairs with
/// larger gaps are visited too. Along the periodic axes of `domain`, the gap is that of the nearest images. The search
/// ends when `visit` returns `Break`.
///
/// Spheres are sorted into classes of radii within a factor of two. The cells of a class are as wide as the largest
/// diameter in the class plus `skin`. Each sphere is compared with the spheres of its own class and of the classes of
/// larger spheres, in the cells around it.
pub(crate) fn near_pairs(
    centres: &[Vector3<f64>],
    radii: &[f64],
    skin: f64,
    domain: Option<&Domain>,
    mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let places: Vec<Vector3<f64>> = centres.iter().map(|&centre| wrapped(centre, domain)).collect();
    let mut classes: HashMap<i32, Vec<u32>> = HashMap::new();
    for (number, radius) in (0..).zip(radii) {
        classes.entry(libm::ilogb(*radius)).or_default().push(number);
    }
    let mut classes: Vec<(i32, Vec<u32>)> = classes.into_iter().collect();
    classes.sort_unstable_by_key(|class| class.0);
    for (at, (_, larger)) in classes.iter().enumerate() {
        let largest = larger.iter().map(|&b| radii[b as usize]).fold(0.0, f64::max);
        let cells = Cells::new(&places, larger, 2.0 * largest + skin);
        for (class, (_, smaller)) in classes[..=at].iter().enumerate() {
            for &a in smaller {
                // Only images at most one cell width beyond a periodic face can be near another sphere.
                for image in images(places[a as usize], domain, cells.width) {
                    for row in cells.rows_around(image) {
                        for &(_, b) in &cells.sorted[row] {
                            if class < at || a < b {
                                visit(a as usize, b as usize)?;
                            }
                        }
                    }
                }
            }
        }
    }
    ControlFlow::Continue(())
}

/// Spheres sorted by cell.
struct Cells {
    /// Edge of a cell (m).
    width: f64,
    /// Cell index along x and index of each sphere, sorted by row and then by cell.
    sorted: Vec<(i64, u32)>,
    /// Range in `sorted` of each row of cells. The keys are the cell indices of the row along y and z.
    rows: HashMap<[i64; 2], Range<usize>>,
}

impl Cells {
    fn new(places: &[Vector3<f64>], some: &[u32], width: f64) -> Self {
        let mut keyed: Vec<([i64; 3], u32)> = some
            .iter()
            .map(|&number| {
                let [x, y, z] = cell(places[number as usize], width);
                ([z, y, x], number)
            })
            .collect();
        keyed.sort_unstable();
        let mut rows = HashMap::new();
        let mut start = 0;
        for row in keyed.chunk_by(|a, b| a.0[..2] == b.0[..2]) {
            let [z, y, _] = row[0].0;
            rows.insert([y, z], start..start + row.len());
            start += row.len();
        }
        Self { width, sorted: keyed.into_iter().map(|([_, _, x], number)| (x, number)).collect(), rows }
    }

    /// Returns the spheres in the cells around a position, as one range of `sorted` per row of cells.
    fn rows_around(&self, place: Vector3<f64>) -> impl Iterator<Item = Range<usize>> {
        let [x, y, z] = cell(place, self.width);
        let around = (-1..=1).flat_map(move |k| (-1..=1).map(move |j| [y + j, z + k]));
        around.filter_map(move |row| self.rows.get(&row)).map(move |row| {
            let of_row = &self.sorted[row.clone()];
            row.start + of_row.partition_point(|&(at, _)| at < x - 1)
                ..row.start + of_row.partition_point(|&(at, _)| at <= x + 1)
        })
    }
}

fn cell(place: Vector3<f64>, width: f64) -> [i64; 3] {
    [0, 1, 2].map(|axis| (place[axis] / width).floor().clamp(-FARTHEST, FARTHEST) as i64)
}

/// Returns a position wrapped into the domain along its periodic axes.
fn wrapped(mut place: Vector3<f64>, domain: Option<&Domain>) -> Vector3<f64> {
    if let Some(domain) = domain {
        for axis in (0..3).filter(|&axis| domain.periodic[axis]) {
            let length = domain.high[axis] - domain.low[axis];
            place[axis] = domain.low[axis] + (place[axis] - domain.low[axis]).rem_euclid(length);
        }
    }
    place
}

/// Returns a position in the domain, and its periodic images at most `reach` (m) outside the periodic faces.
pub(crate) fn images(place: Vector3<f64>, domain: Option<&Domain>, reach: f64) -> Vec<Vector3<f64>> {
    let mut images = vec![place];
    if let Some(domain) = domain {
        for axis in (0..3).filter(|&axis| domain.periodic[axis]) {
            let length = domain.high[axis] - domain.low[axis];
            for at in 0..images.len() {
                for shift in [-length, length] {
                    let mut image = images[at];
                    image[axis] += shift;
                    if (domain.low[axis] - reach..=domain.high[axis] + reach).contains(&image[axis]) {
                        images.push(image);
                    }
                }
            }
        }
    }
    images
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;
    use std::collections::BTreeSet;

    /// Returns random centres in a cube with edges of `spread` (m), and random radii from 0.05 m to 0.4 m.
    fn scatter(count: usize, spread: f64) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let mut lot = Pcg64::seed_from_u64(7);
        let radii = (0..count).map(|_| 0.05 * 8.0_f64.powf(lot.random::<f64>())).collect();
        let place = |lot: &mut Pcg64| Vector3::from_fn(|_, _| spread * (lot.random::<f64>() - 0.5));
        ((0..count).map(|_| place(&mut lot)).collect(), radii)
    }

    fn visited(
        centres: &[Vector3<f64>],
        radii: &[f64],
        skin: f64,
        domain: Option<&Domain>,
    ) -> BTreeSet<(usize, usize)> {
        let mut found = BTreeSet::new();
        let done = near_pairs(centres, radii, skin, domain, |a, b| {
            assert_ne!(a, b);
            found.insert((a.min(b), a.max(b)));
            ControlFlow::Continue(())
        });
        assert!(done.is_continue());
        found
    }

    #[test]
    fn every_near_pair_is_visited() {
        let (centres, radii) = scatter(300, 6.0);
        for periodic in [[false; 3], [true, false, false], [true; 3]] {
            let domain = Domain { low: Vector3::repeat(-1.5), high: Vector3::new(1.5, 2.5, 1.0), periodic };
            for skin in [0.0, 0.1] {
                let found = visited(&centres, &radii, skin, Some(&domain));
                for a in 0..centres.len() {
                    for b in a + 1..centres.len() {
                        let mut apart = centres[b] - centres[a];
                        for axis in (0..3).filter(|&axis| periodic[axis]) {
                            let length = domain.high[axis] - domain.low[axis];
                            apart[axis] -= length * (apart[axis] / length).round();
                        }
                        let is_near = apart.norm() < radii[a] + radii[b] + skin;
                        assert!(!is_near || found.contains(&(a, b)), "{a} and {b} are {} m apart", apart.norm());
                    }
                }
            }
        }
    }

    /// The number of visited pairs grows linearly with the number of spheres, even with one distant sphere and one very
    /// large sphere.
    #[test]
    fn visits_are_as_many_as_spheres() {
        let visits = |count: usize| {
            let (mut centres, mut radii) = scatter(count, 0.5 * (count as f64).cbrt());
            (centres[0], centres[1], radii[1]) = (Vector3::repeat(1e12), Vector3::repeat(-1e3), 400.0);
            visited(&centres, &radii, 0.0, None).len() as f64 / count as f64
        };
        let [few, many] = [visits(1_000), visits(30_000)];
        assert!(many < 1.5 * few, "{few} and {many} for each sphere");
    }
}
