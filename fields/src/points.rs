//! Material of a two-dimensional snapshot at each pixel of a view.

use crate::grid::{image_shifts, inside};
use crate::view::View;
use grainbench_solver::record::{Owner, PointState, Snapshot};

/// Largest distance from a pixel to its nearest material point, in units of the point's width √V.
///
/// Pixels farther away are empty. The value is half the diagonal of a unit square, 0.71, plus a margin for sheared
/// squares.
const REACH: f64 = 0.85;
/// Radius within which material points contribute to the mean at a pixel, in units of the point's width.
const BLUR: f64 = 1.3;

/// Material point that is nearest to a pixel.
#[derive(Clone, Copy)]
struct NearestPoint {
    /// Squared distance in units of the point's width.
    distance: f64,
    point: u32,
}

/// Material at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    pub(crate) owner: Owner,
    /// Weighted means of three numbers over the surrounding points of the same body. The nearest point has the largest
    /// weight.
    pub(crate) mean: [f64; 3],
}

/// Returns the material at every pixel of a view; `None` for empty pixels. `value` returns the three numbers of a point
/// that are averaged.
///
/// The pixels around each point are visited twice. The first pass finds the body of each pixel, and the second averages
/// over the points of this body.
pub(crate) fn at_pixels(
    snapshot: &Snapshot,
    view: View,
    value: impl Fn(&PointState) -> [f64; 3],
) -> Vec<Option<Material>> {
    let pixels = view.width as usize * view.height as usize;
    let mut nearest = vec![NearestPoint { distance: REACH * REACH, point: u32::MAX }; pixels];
    lay(snapshot, view, |at, distance, point| {
        if distance < nearest[at].distance {
            nearest[at] = NearestPoint { distance, point };
        }
    });
    let owner = |at: usize| snapshot.points.get(nearest[at].point as usize).map(|point| point.owner);
    let owners: Vec<Option<Owner>> = (0..pixels).map(owner).collect();
    let mut sums = vec![([0.0; 3], 0.0); pixels];
    let numbers: Vec<[f64; 3]> = snapshot.points.iter().map(value).collect();
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

/// Visits the pixels near each point and its periodic images. The arguments of `show` are the pixel, the squared
/// distance in units of the point's width, and the index of the point.
fn lay(snapshot: &Snapshot, view: View, mut show: impl FnMut(usize, f64, u32)) {
    let shifts = image_shifts(snapshot, 2);
    for (number, point) in snapshot.points.iter().enumerate() {
        let (place, width) = (inside(snapshot, point.position), point.volume.sqrt());
        for shift in &shifts {
            let centre = [place.x + shift.x, place.y + shift.y];
            view.visit_around(centre, BLUR * width, |at, arm| {
                let (across, up) = (arm.x / width, arm.y / width);
                let distance = across * across + up * up;
                if distance < BLUR * BLUR {
                    show(at, distance, number as u32);
                }
            });
        }
    }
}
