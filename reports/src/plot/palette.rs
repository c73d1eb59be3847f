//! Colours, markers and dashes that stay apart without colour vision and in grey print.

/// Secondary text.
pub const FAINT: &str = "#666";

/// Okabe and Ito's colours without the yellow, which is too pale on white, and without black, which dashed curves
/// have.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// Shades of dashed curves: exact answers and limits stand apart from what was computed.
const SHADES: [&str; 3] = ["#222", "#666", "#999"];

/// Lengths of dash and gap.
const DASHES: [(u32, u32); 4] = [(9, 5), (3, 4), (16, 5), (5, 10)];

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Round.
    Circle,
    /// Four sides, flat.
    Square,
    /// Three sides, pointing up.
    Triangle,
    /// Four sides, on a corner.
    Diamond,
    /// Three sides, pointing down.
    Inverted,
    /// Five sides.
    Pentagon,
    /// Five points.
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
    /// Corners of the shape for a marker of the size of a disc of radius one, y down; empty for the circle.
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

/// Colour of the curve at `place` among those that are not dashed.
#[must_use]
pub fn colour(place: usize) -> &'static str {
    COLOURS[place % COLOURS.len()]
}

/// Marker of the curve at `place` among those that are not dashed. Seven markers on six colours: the pairs repeat
/// only after forty-two curves.
#[must_use]
pub fn marker(place: usize) -> Marker {
    MARKERS[place % MARKERS.len()]
}

/// Shade of the curve at `place` among the dashed ones.
#[must_use]
pub fn shade(place: usize) -> &'static str {
    SHADES[place % SHADES.len()]
}

/// Lengths of dash and gap of the curve at `place` among the dashed ones.
#[must_use]
pub fn dash(place: usize) -> (u32, u32) {
    DASHES[place % DASHES.len()]
}
