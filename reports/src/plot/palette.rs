//! Colours, markers and dashes that are distinct without colour vision and in grey print.

/// Colours of Okabe and Ito without yellow and black. Yellow is too pale on white, and dashed curves are black.
pub(super) const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// Solvers whose colour and marker are the same in all figures.
pub(crate) const SOLVERS: [&str; 5] = ["dem", "rigid", "mpm", "lammps", "liggghts"];

/// Shades of dashed curves: exact solutions and limits.
const SHADES: [&str; 3] = ["#222", "#666", "#999"];

/// Lengths of dash and gap (drawing units).
const DASHES: [(u32, u32); 4] = [(9, 5), (3, 4), (16, 5), (5, 10)];

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Inverted,
    Pentagon,
    Star,
}

impl Marker {
    const ALL: [Self; 7] = {
        use Marker::{Circle, Diamond, Inverted, Pentagon, Square, Star, Triangle};
        [Circle, Square, Triangle, Diamond, Inverted, Pentagon, Star]
    };

    /// Returns the corners of the shape, with y downwards. The shape is about as large as a disc of radius 1; the
    /// circle has no corners.
    pub(crate) fn corners(self) -> Vec<(f64, f64)> {
        let polygon = |count: u32, radii: &[f64], first: f64| {
            let corner = |(corner, radius): (u32, &f64)| {
                let turn = first + 360.0 * f64::from(corner) / f64::from(count);
                let (sine, cosine) = turn.to_radians().sin_cos();
                (radius * cosine, -radius * sine)
            };
            (0..count).zip(radii.iter().cycle()).map(corner).collect()
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

/// Returns the indices of the styles of all curves that are not dashed. If a solver in [`SOLVERS`] has exactly one curve, the
/// curve has the index of the solver. All other curves have indices of no solver in the graph. A label is the name of the
/// solver, alone or followed by ` (` or `: `.
pub(crate) fn places(labels: &[&str]) -> Vec<usize> {
    let solver = |label: &&str| {
        let name = label.split(" (").next()?.split(": ").next()?;
        SOLVERS.iter().position(|solver| *solver == name)
    };
    let solvers: Vec<Option<usize>> = labels.iter().map(solver).collect();
    let is_only = |place: &usize| solvers.iter().filter(|other| **other == Some(*place)).count() == 1;
    let mut free = (0..).filter(|place| !solvers.contains(&Some(*place)));
    let place = |solver: &Option<usize>| solver.filter(is_only).or_else(|| free.next()).unwrap_or_default();
    solvers.iter().map(place).collect()
}

/// Returns the colour and the marker of a curve that is not dashed. `place` is an index from [`places`]. With seven markers
/// and six colours, combinations repeat after 42 curves.
pub(super) fn solid(place: usize) -> (&'static str, Marker) {
    (COLOURS[place % COLOURS.len()], Marker::ALL[place % Marker::ALL.len()])
}

/// Returns the shade, the marker, and the lengths of dash and gap (drawing units) of a dashed curve. `place` is its index
/// among the dashed curves.
pub(super) fn dashed(place: usize) -> (&'static str, Marker, (u32, u32)) {
    (SHADES[place % SHADES.len()], Marker::ALL[place % Marker::ALL.len()], DASHES[place % DASHES.len()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solver_has_the_same_colour_in_all_figures() {
        assert_eq!(places(&["lammps", "dem (not asked)", "yade", "mpm: bias 1 %"]), [3, 0, 1, 2]);
        assert_eq!(places(&["Δt = .1", "Δt = .2"]), [0, 1]);
        // Two curves of one solver have two different colours.
        assert_eq!(places(&["dem (μ = .3)", "dem (μ = .6)"]), [1, 2]);
    }
}
