//! Rasters of two-dimensional snapshots: for each pixel, the body and a quantity of its material.

use crate::disc::LoadedDisc;
use crate::grid::{image_shifts, inside};
use crate::quantity::Quantity;
use grainbench_harness::raster::{RIM, Raster, VOID, level};
use grainbench_solver::record::{Owner, PointState, Snapshot};
use nalgebra::{Vector2, Vector3};

/// Largest distance from a pixel to its nearest material point, in units of the point's width √V.
///
/// Pixels farther away are empty. The value is half the diagonal of a unit square, 0.71, plus a margin for sheared
/// squares.
const REACH: f64 = 0.85;
/// Radius within which material points contribute to the mean at a pixel, in units of the point's width.
const BLUR: f64 = 1.3;

/// Visible part of the plane, in square pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Lower left corner (m).
    pub low: [f64; 2],
    /// Side of a pixel (m).
    pub pixel: f64,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl View {
    /// Returns the number of grains whose centre is outside the view.
    #[must_use]
    pub fn outside(&self, snapshot: &Snapshot) -> usize {
        let high = self.high();
        let places = snapshot.grains.iter().map(|grain| inside(snapshot, grain.position));
        places.filter(|place| (0..2).any(|axis| !(self.low[axis]..=high[axis]).contains(&place[axis]))).count()
    }

    /// Returns a view between two corners, with `longest` pixels along the longer side.
    #[must_use]
    pub fn new(low: [f64; 2], high: [f64; 2], longest: u32) -> Self {
        let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
        let pixel = size[0].max(size[1]) / f64::from(longest.max(1));
        let [width, height] = size.map(|size| (size / pixel).round().clamp(1.0, f64::from(longest.max(1))) as u32);
        Self { low, pixel, width, height }
    }

    /// Returns a view of a snapshot. Along periodic axes the view is the domain. Along other axes it is the bounding
    /// box of grains and material points, without a few distant outliers.
    #[must_use]
    pub fn from_snapshot(snapshot: &Snapshot, longest: u32) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let grains = snapshot.grains.iter().map(|grain| (grain.position, grain.radius));
        let points = snapshot.points.iter().map(|point| (point.position, 0.5 * point.volume.sqrt()));
        let all: Vec<(Vector3<f64>, f64)> =
            grains.chain(points).filter(|(place, _)| place.iter().all(|part| part.is_finite())).collect();
        for axis in 0..2 {
            (low[axis], high[axis]) =
                window(all.iter().map(|(place, reach)| (place[axis] - reach, place[axis] + reach)));
            if snapshot.periodic[axis] || low[axis] > high[axis] {
                (low[axis], high[axis]) = (snapshot.bounds.0[axis], snapshot.bounds.1[axis]);
            }
        }
        let margin = 0.01 * (high[0] - low[0]).max(high[1] - low[1]);
        for axis in (0..2).filter(|&axis| !snapshot.periodic[axis]) {
            low[axis] -= margin;
            high[axis] += margin;
        }
        Self::new(low, high, longest)
    }

    /// Returns the upper right corner (m).
    #[must_use]
    pub fn high(&self) -> [f64; 2] {
        [self.low[0] + f64::from(self.width) * self.pixel, self.low[1] + f64::from(self.height) * self.pixel]
    }

    /// Visits the visible pixels of the square around a position (m) with half width `reach` (m), with the rows from the
    /// top. The arguments of `visit` are the index of the pixel and the vector from the position to its centre (m).
    pub(crate) fn visit_around(&self, place: [f64; 2], reach: f64, mut visit: impl FnMut(usize, Vector2<f64>)) {
        let range = |axis: usize, count: u32| {
            let at = |place: f64| ((place - self.low[axis]) / self.pixel).floor().clamp(0.0, f64::from(count)) as u32;
            at(place[axis] - reach)..(at(place[axis] + reach) + 1).min(count)
        };
        let centre = |axis: usize, number: u32| self.low[axis] + (f64::from(number) + 0.5) * self.pixel;
        let columns = range(0, self.width);
        for up in range(1, self.height).rev() {
            for column in columns.clone() {
                let row = self.height - 1 - up;
                let arm = Vector2::new(centre(0, column) - place[0], centre(1, up) - place[1]);
                visit((row * self.width + column) as usize, arm);
            }
        }
    }
}

/// Returns the visible range (m) along an axis for a set of intervals.
///
/// The core range omits the outermost hundredth of the intervals on each side. The result covers all intervals, but
/// extends the core range by at most half its length on each side.
fn window(spans: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let (mut lows, mut highs): (Vec<f64>, Vec<f64>) = spans.unzip();
    lows.sort_by(f64::total_cmp);
    highs.sort_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (lows.first(), highs.last()) else { return (f64::INFINITY, f64::NEG_INFINITY) };
    let few = lows.len() / 100;
    let (from, to) = (lows[few], highs[highs.len() - 1 - few]);
    let room = 0.5 * (to - from);
    (low.max(from - room), high.min(to + room))
}

/// Pixels with their body and value.
#[derive(Clone, Debug, PartialEq)]
pub struct Painting {
    view: View,
    /// Body at each pixel: the id of a grain, `u32::MAX` minus the index of a body, or zero for an empty pixel.
    owners: Vec<u32>,
    values: Vec<f64>,
}

impl Painting {
    /// Draws the material points of a snapshot, or the discs if there are no material points.
    #[must_use]
    pub fn new(snapshot: &Snapshot, quantity: Quantity, view: View) -> Self {
        let pixels = view.width as usize * view.height as usize;
        let mut painting = Self { view, owners: vec![0; pixels], values: vec![f64::NAN; pixels] };
        if snapshot.points.is_empty() {
            painting.discs(snapshot, quantity);
        } else {
            painting.points(snapshot, quantity);
        }
        painting
    }

    fn points(&mut self, snapshot: &Snapshot, quantity: Quantity) {
        let seen = at_pixels(snapshot, self.view, |point| quantity.parts(point));
        for (at, material) in seen.into_iter().enumerate() {
            let Some(Material { owner, mean }) = material else { continue };
            self.owners[at] = match owner {
                Owner::Grain(id) => id,
                Owner::Body(place) => u32::MAX - place,
            };
            self.values[at] = quantity.of_parts(mean);
        }
    }

    fn discs(&mut self, snapshot: &Snapshot, quantity: Quantity) {
        let loaded = match quantity {
            Quantity::StressDifference | Quantity::Fringes(_) => LoadedDisc::of_snapshot(snapshot),
            Quantity::PlasticStrain | Quantity::Rotation | Quantity::Speed => Vec::new(),
        };
        // A pixel in the overlap of two discs shows the disc in which it lies deeper.
        let mut depth = vec![f64::NEG_INFINITY; self.owners.len()];
        let (shifts, view) = (image_shifts(snapshot, 0..2), self.view);
        for (place, grain) in snapshot.grains.iter().enumerate() {
            let position = inside(snapshot, grain.position);
            for shift in &shifts {
                let centre = [position.x + shift.x, position.y + shift.y];
                view.visit_around(centre, grain.radius, |at, arm| {
                    let depth_here = grain.radius - arm.norm();
                    if depth_here < 0.0 || depth_here <= depth[at] {
                        return;
                    }
                    depth[at] = depth_here;
                    self.owners[at] = grain.id;
                    self.values[at] = match quantity {
                        Quantity::StressDifference | Quantity::Fringes(_) => {
                            quantity.of_stress(&loaded[place].stress(arm))
                        }
                        Quantity::PlasticStrain => 0.0,
                        Quantity::Rotation => grain.angle.unwrap_or(f64::NAN),
                        Quantity::Speed => {
                            let turning = Vector2::new(-arm.y, arm.x) * grain.spin.z;
                            (grain.velocity.xy() + turning).norm()
                        }
                    };
                });
            }
        }
    }

    /// Returns the value below which a fraction `part` of the pixel values lies; zero if there are no values.
    #[must_use]
    pub fn quantile(&self, part: f64) -> f64 {
        let mut values: Vec<f64> = self.values.iter().copied().filter(|value| value.is_finite()).collect();
        let at = (part * values.len().saturating_sub(1) as f64).round() as usize;
        if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(at, f64::total_cmp).1 }
    }

    /// Returns the picture: values as grey levels between the ends of `range`, and a rim around every body.
    #[must_use]
    pub fn raster(&self, range: (f64, f64)) -> Raster {
        let View { width, height, .. } = self.view;
        let across = width as usize;
        let levels = (0..self.owners.len()).map(|at| {
            let right = if (at + 1).is_multiple_of(across) { at } else { at + 1 };
            let below = if at + across < self.owners.len() { at + across } else { at };
            let own = self.owners[at];
            if own != self.owners[right] || own != self.owners[below] {
                RIM
            } else if own == 0 {
                VOID
            } else {
                level(self.values[at], range)
            }
        });
        Raster { width, height, levels: levels.collect() }
    }
}

/// Material point that is nearest to a pixel.
#[derive(Clone, Copy)]
struct NearestPoint {
    /// Squared distance in units of the point's width.
    distance: f64,
    point: u32,
}

/// Material at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Material {
    owner: Owner,
    /// Weighted means of three numbers over the surrounding points of the same body. The nearest point has the largest
    /// weight.
    mean: [f64; 3],
}

/// Returns the material at every pixel of a view; `None` for empty pixels. `value` returns the three numbers of a point
/// that are averaged.
///
/// The pixels around each point are visited twice. The first pass finds the body of each pixel, and the second averages
/// over the points of this body.
fn at_pixels(snapshot: &Snapshot, view: View, value: impl Fn(&PointState) -> [f64; 3]) -> Vec<Option<Material>> {
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
    let shifts = image_shifts(snapshot, 0..2);
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

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_harness::raster::{HIGH, LOW};
    use grainbench_scene::scene::Grain;
    use grainbench_solver::record::GrainState;

    #[test]
    fn a_disc_that_rolled_away_does_not_shrink_the_others() {
        let mut many = snapshot(Vec::new());
        many.periodic = [false; 3];
        let grain = GrainState { radius: 0.05, ..many.grains[0].clone() };
        let place = |at: u32| Vector3::new(0.1 * f64::from(at % 20), 0.1 * f64::from(at / 20), 0.0);
        many.grains = (0..200).map(|at| GrainState { position: place(at), ..grain.clone() }).collect();
        let all = View::from_snapshot(&many, 200);
        assert_eq!(all.outside(&many), 0);
        many.grains[7].position.x = 100.0;
        let view = View::from_snapshot(&many, 200);
        assert!(view.high()[0] < 3.5 && view.outside(&many) == 1, "{view:?}");
        // A grain at a moderate distance is still visible.
        many.grains[7].position.x = 2.5;
        assert_eq!(View::from_snapshot(&many, 200).outside(&many), 0);
    }

    fn snapshot(points: Vec<PointState>) -> Snapshot {
        let (position, velocity, spin) = (Vector3::new(0.0, 0.5, 0.0), Vector3::zeros(), Vector3::new(0.0, 0.0, 2.0));
        let grain = Grain { material: 0, radius: 0.4, mass: 1.0, inertia: 0.08, position, velocity, spin };
        let grain = GrainState { angle: Some(0.3), ..GrainState::start(1, &grain) };
        Snapshot {
            bounds: (Vector3::zeros(), Vector3::new(2.0, 1.0, 0.0)),
            periodic: [true, false, false],
            grains: vec![grain],
            contacts: Some(Vec::new()),
            points,
            ..Snapshot::default()
        }
    }

    /// Returns a square lattice of points at a spacing `width` that fills the unit square around (0, ½).
    fn points(width: f64) -> Vec<PointState> {
        let count = (1.0 / width).round() as i32;
        let point = |i: i32, j: i32| {
            let x = (f64::from(i) + 0.5) * width - 0.5;
            PointState {
                owner: if x < 0.0 { Owner::Grain(1) } else { Owner::Grain(2) },
                position: Vector3::new(x, (f64::from(j) + 0.5) * width, 0.0),
                stress: [3.0 * x, x, 0.0, 0.0, 0.0, 0.0],
                plastic_strain: 0.5,
                volume: width * width,
                ..PointState::default()
            }
        };
        (0..count * count).map(|at| point(at % count, at / count)).collect()
    }

    #[test]
    fn a_disc_across_a_periodic_side_is_seen_on_both() {
        let view = View::new([0.0, 0.0], [2.0, 1.0], 200);
        let painting = Painting::new(&snapshot(Vec::new()), Quantity::Rotation, view);
        let area = painting.owners.iter().filter(|&&owner| owner == 1).count() as f64 * view.pixel * view.pixel;
        assert!((area / (std::f64::consts::PI * 0.16) - 1.0).abs() < 5e-3, "{area}");
        let raster = painting.raster((0.0, 0.3));
        let middle = |column: usize| raster.levels[50 * 200 + column];
        assert_eq!([middle(5), middle(100), middle(195)], [HIGH, VOID, HIGH]);
        assert!((39..=40).any(|column| middle(column) == RIM));
        // The speed |ω| r is largest at the rim: 2 rad/s times 0.4 m.
        let speed = Painting::new(&snapshot(Vec::new()), Quantity::Speed, view);
        assert!((speed.quantile(1.0) - 0.8).abs() < 0.02);
        // Some programs print positions that are not wrapped into the periodic box.
        let mut unwrapped = snapshot(Vec::new());
        unwrapped.grains[0].position.x -= 4.0;
        assert_eq!(Painting::new(&unwrapped, Quantity::Speed, view).owners, speed.owners);
        assert_eq!(view.outside(&unwrapped), 0);
    }

    #[test]
    fn points_fill_their_bodies_and_blur_over_no_contact() {
        let view = View::new([0.0, -0.2], [2.0, 1.2], 200);
        let painting = Painting::new(&snapshot(points(0.05)), Quantity::StressDifference, view);
        let area =
            |owner: u32| painting.owners.iter().filter(|&&found| found == owner).count() as f64 * view.pixel.powi(2);
        // Each body covers half of the unit square, with a margin of (.85 − .5) point widths around it.
        for owner in [1, 2] {
            assert!((0.5..0.56).contains(&area(owner)), "{}", area(owner));
        }
        // |σ_xx − σ_yy| = 2|x| is linear, so averaging changes nothing inside.
        let at = |column: usize, row: usize| painting.values[row * 200 + column];
        let x = 25.5 * view.pixel;
        assert!((at(25, 70) - 2.0 * x).abs() < 0.01, "{}", at(25, 70));
        assert!((at(174, 70) - 2.0 * x).abs() < 0.01, "{}", at(174, 70));
        // Near the contact, the value in one body does not depend on the second body.
        assert!((at(0, 70) - 2.0 * 0.025).abs() < 0.03 && at(0, 70) > 0.0);
        let strain = Painting::new(&snapshot(points(0.05)), Quantity::PlasticStrain, view);
        assert!((strain.quantile(0.0) - 0.5).abs() < 1e-12 && (strain.quantile(1.0) - 0.5).abs() < 1e-12);
        assert_eq!(strain.raster((0.5, 1.0)).levels[70 * 200 + 25], LOW);
    }
}
