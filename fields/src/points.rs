//! The material of a plane snapshot under the pixels of a view.

use crate::grid::inside;
use crate::paint::View;
use grainbench_scene::record::{Owner, PointState, Snapshot};

/// A place belongs to the material of a point that is nearer than this, in widths √V of the point's square: half a
/// diagonal, and a little for squares that have sheared.
const REACH: f64 = 0.85;
/// Points within this many of their widths share in the value at a place.
const BLUR: f64 = 1.3;

/// The point that is nearest to a pixel.
#[derive(Clone, Copy)]
struct Nearest {
    /// Square of its distance, in widths of the point.
    distance: f64,
    point: u32,
}

/// Material at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    /// The body that it belongs to.
    pub(crate) owner: Owner,
    /// The mean over the body's points around, the nearest counting most.
    pub(crate) mean: [f64; 3],
}

/// The material at every pixel of a view, with the mean there of three numbers of a point. Each point is laid over the pixels
/// around it: once to find whose they are, and once to share in the mean of its own body's.
pub(crate) fn at_pixels(
    snapshot: &Snapshot,
    view: View,
    of: impl Fn(&PointState) -> [f64; 3],
) -> Vec<Option<Material>> {
    let pixels = view.width as usize * view.height as usize;
    let mut nearest = vec![Nearest { distance: REACH * REACH, point: u32::MAX }; pixels];
    lay(snapshot, view, |at, distance, point| {
        if distance < nearest[at].distance {
            nearest[at] = Nearest { distance, point };
        }
    });
    let owner = |at: usize| snapshot.points.get(nearest[at].point as usize).map(|point| point.owner);
    let owners: Vec<Option<Owner>> = (0..pixels).map(owner).collect();
    let mut sums = vec![([0.0; 3], 0.0); pixels];
    let numbers: Vec<[f64; 3]> = snapshot.points.iter().map(of).collect();
    lay(snapshot, view, |at, distance, point| {
        if owners[at] == Some(snapshot.points[point as usize].owner) {
            let weight = (1.0 - distance.sqrt() / BLUR).powi(2);
            let (sum, total) = &mut sums[at];
            *total += weight;
            sum.iter_mut().zip(numbers[point as usize]).for_each(|(sum, number)| *sum += weight * number);
        }
    });
    let material = |(owner, (sum, total)): (Option<Owner>, ([f64; 3], f64))| {
        owner.map(|owner| Material { owner, mean: sum.map(|sum| sum / total) })
    };
    owners.into_iter().zip(sums).map(material).collect()
}

/// Shows every pixel near each point, around periodic sides too, with the square of their distance in widths of the point.
fn lay(snapshot: &Snapshot, view: View, mut show: impl FnMut(usize, f64, u32)) {
    let length = snapshot.bounds.1 - snapshot.bounds.0;
    let shifts = |axis: usize| -> &[f64] { if snapshot.periodic[axis] { &[-1.0, 0.0, 1.0] } else { &[0.0] } };
    for (number, point) in snapshot.points.iter().enumerate() {
        let (place, width) = (inside(snapshot, point.position), point.volume.sqrt());
        let reach = BLUR * width;
        for (i, j) in shifts(0).iter().flat_map(|i| shifts(1).iter().map(move |j| (i, j))) {
            let centre = [place.x + i * length.x, place.y + j * length.y];
            let (columns, rows) = view.pixels_around(centre, reach);
            for row in rows {
                for column in columns.clone() {
                    let seen = view.centre(column, row);
                    let [across, up] = [0, 1].map(|axis| (seen[axis] - centre[axis]) / width);
                    let distance = across * across + up * up;
                    if distance < BLUR * BLUR {
                        show((row * view.width + column) as usize, distance, number as u32);
                    }
                }
            }
        }
    }
}
