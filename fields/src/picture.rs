//! Figures of a field from snapshots: panels with a common scale, or films.

use crate::paint::{Painting, View};
use crate::quantity::Quantity;
use grainbench_harness::figure::{Field, Panel, Shades};
use grainbench_harness::raster::{HIGH, LOW, Raster};
use grainbench_solver::record::Snapshot;

/// A panel: its title, and a snapshot for each frame.
pub struct Shot<'a> {
    /// Title above the panel.
    pub title: String,
    /// Snapshots, one for each frame; a single snapshot for a still figure.
    pub frames: Vec<&'a Snapshot>,
}

impl<'a> Shot<'a> {
    /// Creates a panel with one frame.
    #[must_use]
    pub fn new(title: impl Into<String>, snapshot: &'a Snapshot) -> Self {
        Self { title: title.into(), frames: vec![snapshot] }
    }
}

/// Returns panels of a quantity, with `longest` pixels along the longer side of the common view.
///
/// If `range` is `None`, the scale extends from zero to the 98th percentile of the values. For rotations it is
/// symmetric about zero, and for fringes it extends from −1 to 1.
#[must_use]
pub fn pictures(quantity: Quantity, shots: &[Shot<'_>], longest: u32, range: Option<(f64, f64)>) -> Field {
    film(quantity, shots, ("", &[0.0]), longest, range)
}

/// Returns a film of a quantity, with panels and scale as in [`pictures`]. `clock` is the label of the times, and
/// `times` contains the time of each frame.
#[must_use]
pub fn film(
    quantity: Quantity,
    shots: &[Shot<'_>],
    (clock, times): (&str, &[f64]),
    longest: u32,
    range: Option<(f64, f64)>,
) -> Field {
    let view = common_view(shots, longest);
    let paintings: Vec<Vec<Painting>> = shots
        .iter()
        .map(|shot| shot.frames.iter().map(|snapshot| Painting::new(snapshot, quantity, view)).collect())
        .collect();
    let range = range.unwrap_or_else(|| own_range(quantity, paintings.iter().flatten()));
    let panels = shots.iter().zip(&paintings).map(|(shot, paintings)| Panel {
        title: title(shot, view),
        frames: paintings.iter().map(|painting| of_few_levels(painting.raster(range), times.len())).collect(),
        own: None,
    });
    let (label, unit) = quantity.label();
    Field {
        label: label.to_owned(),
        unit: unit.to_owned(),
        range,
        shades: match quantity {
            Quantity::StressDifference => Shades::Glow,
            Quantity::Fringes(_) => Shades::Fringes,
            Quantity::PlasticStrain | Quantity::Speed => Shades::Amount,
            Quantity::Rotation => Shades::Signed,
        },
        pixel: view.pixel,
        length: "m".to_owned(),
        panels: panels.collect(),
        clock: clock.to_owned(),
        times: times.to_vec(),
    }
}

/// Returns the stress f (Pa) of [`Quantity::Fringes`] at which the largest stress difference has the fringe order
/// `fringes`.
///
/// The largest stress difference is the largest of the 98th percentiles of σ₁ − σ₂ over the pixels of each snapshot.
#[must_use]
pub fn fringe_constant<'a>(snapshots: impl IntoIterator<Item = &'a Snapshot>, fringes: f64) -> f64 {
    let quantity = Quantity::StressDifference;
    let high = |snapshot| Painting::new(snapshot, quantity, View::from_snapshot(snapshot, 200)).quantile(0.98);
    snapshots.into_iter().map(high).fold(0.0, f64::max) / (fringes * std::f64::consts::TAU)
}

/// Returns the title of a panel, with the number of grains outside the view in its last frame.
fn title(shot: &Shot<'_>, view: View) -> String {
    match shot.frames.last().map_or(0, |last| view.outside(last)) {
        0 => shot.title.clone(),
        1 => format!("{}, 1 grain outside", shot.title),
        some => format!("{}, {some} grains outside", shot.title),
    }
}

/// Reduces the number of grey levels of film frames to a quarter, which saves space in a page. The difference is not
/// visible.
fn of_few_levels(mut raster: Raster, frames: usize) -> Raster {
    if frames > 1 {
        let values = raster.levels.iter_mut().filter(|level| (LOW..=HIGH).contains(level));
        values.for_each(|level| *level = (LOW + (*level - LOW + 2) / 4 * 4).min(HIGH));
    }
    raster
}

/// Returns the smallest view that contains the views of all snapshots, with `longest` pixels along the longer side.
fn common_view(shots: &[Shot<'_>], longest: u32) -> View {
    let views = shots.iter().flat_map(|shot| &shot.frames).map(|snapshot| View::from_snapshot(snapshot, longest));
    let both = |extreme: fn(f64, f64) -> f64, a: [f64; 2], b: [f64; 2]| [extreme(a[0], b[0]), extreme(a[1], b[1])];
    let corners = views.map(|view| (view.low, view.high()));
    let corners = corners.reduce(|a, b| (both(f64::min, a.0, b.0), both(f64::max, a.1, b.1)));
    let (low, high) = corners.unwrap_or(([0.0; 2], [1.0; 2]));
    View::new(low, high, longest)
}

fn own_range<'a>(quantity: Quantity, paintings: impl Iterator<Item = &'a Painting>) -> (f64, f64) {
    if let Quantity::Fringes(_) = quantity {
        return (-1.0, 1.0);
    }
    let ends = paintings.map(|painting| (painting.quantile(0.02), painting.quantile(0.98)));
    let (low, high) = ends.fold((f64::INFINITY, 0.0_f64), |(low, high), ends| (low.min(ends.0), high.max(ends.1)));
    if quantity == Quantity::Rotation {
        let largest = two_digits(high.abs().max(low.abs()));
        (-largest, largest)
    } else {
        (0.0, two_digits(high))
    }
}

/// Rounds a value up to two significant digits. Returns 1 if the value is not positive and finite.
#[must_use]
pub fn two_digits(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    (value / unit * (1.0 - 1e-12)).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_end_at_a_number_one_can_read() {
        for (value, end) in [(0.123, 0.13), (1.2, 1.2), (98.7, 99.0), (99.2, 100.0), (0.0, 1.0), (f64::NAN, 1.0)] {
            assert!((two_digits(value) / end - 1.0).abs() < 1e-9, "{value}");
        }
    }
}
