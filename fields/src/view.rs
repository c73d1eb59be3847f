//! Visible part of a two-dimensional snapshot.

use grainbench_solver::record::{GrainState, Snapshot};
use nalgebra::{Vector2, Vector3};

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
        let inside =
            |grain: &&GrainState| (0..2).all(|axis| (self.low[axis]..=high[axis]).contains(&grain.position[axis]));
        snapshot.grains.len() - snapshot.grains.iter().filter(inside).count()
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
