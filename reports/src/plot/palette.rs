//! Colours, markers and dashes that are distinct without colour vision and in grey print.

/// Colour of secondary text.
pub const FAINT: &str = "#666";

/// Colours of Okabe and Ito, without yellow, which is too pale on white, and without black, which dashed curves have.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// Shades of dashed curves, which are exact solutions and limits.
const SHADES: [&str; 3] = ["#222", "#666", "#999"];

/// Lengths of dash and gap.
const DASHES: [(u32, u32); 4] = [(9, 5), (3, 4), (16, 5), (5, 10)];

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Disc.
    Circle,
    /// Square with horizontal edges.
    Square,
    /// Triangle pointing up.
    Triangle,
    /// Square on a corner.
    Diamond,
    /// Triangle pointing down.
    Inverted,
    /// Pentagon.
    Pentagon,
    /// Star with five points.
    Star,
}

const MARKERS: [Marker; 7] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Inverted,
    Marker::Pentagon,
    Marker::Star,
];

impl Marker {
    /// Returns the corners of the shape, with y downwards, for a marker as large as a disc of radius 1. Empty for the
    /// circle.
    #[must_use]
    pub fn corners(self) -> Vec<(f64, f64)> {
        let polygon = |count: u32, radii: &[f64], first: f64| {
            (0..count)
                .zip(radii.iter().cycle())
                .map(|(corner, radius)| {
                    let turn = first + 360.0 * f64::from(corner) / f64::from(count);
                    let (sine, cosine) = turn.to_radians().sin_cos();
                    (radius * cosine, -radius * sine)
                })
                .collect()
        };
        match self {
            Self::Circle => Vec::new(),
            Self::Square => polygon(4, &[1.25], 45.0),
            Self::Triangle => polygon(3, &[1.4], 90.0),
            Self::Diamond => polygon(4, &[1.35], 0.0),
            Self::Inverted => polygon(3, &[1.4], -90.0),
            Self::Pentagon => polygon(5, &[1.2], 90.0),
            Self::Star => polygon(10, &[1.5, 0.65], 90.0),
        }
    }
}

/// Returns the colour of a curve; `place` is its index among the curves that are not dashed.
#[must_use]
pub fn colour(place: usize) -> &'static str {
    COLOURS[place % COLOURS.len()]
}

/// Returns the marker of a curve; `place` is its index among the curves that are not dashed. With seven markers and six
/// colours, pairs repeat after 42 curves.
#[must_use]
pub fn marker(place: usize) -> Marker {
    MARKERS[place % MARKERS.len()]
}

/// Returns the shade of a curve; `place` is its index among the dashed curves.
#[must_use]
pub fn shade(place: usize) -> &'static str {
    SHADES[place % SHADES.len()]
}

/// Returns the lengths of dash and gap of a curve; `place` is its index among the dashed curves.
#[must_use]
pub fn dash(place: usize) -> (u32, u32) {
    DASHES[place % DASHES.len()]
}
