//! Resolution levels as text, in the notation of reports: `dt=.1`, `dt=1e-5 s`, `substeps=8 iterations=4`,
//! `cells=8 points=3 courant=.4`.

use grainbench_scene::method::Method;
use grainbench_solver::resolution::Resolution;

/// Expected notation for error messages.
const EXPECTED: &str =
    "`dt=FRACTION`, `dt=SECONDS s`, `substeps=N` with `iterations=N`, or `cells=N` with `points=N` and `courant=N`";

/// Reads a resolution from text.
///
/// # Errors
/// When the text has another notation. The error describes the expected notation.
pub fn read(words: &str) -> Result<Resolution, String> {
    resolution(words).ok_or_else(|| EXPECTED.to_owned())
}

/// Returns true if the solver supports this kind of resolution. External solvers are assumed to support every kind.
#[must_use]
pub fn fits(solver: &str, resolution: &Resolution) -> bool {
    match Method::from_name(solver) {
        Some(Method::Dem) => matches!(resolution, Resolution::CriticalFraction(_) | Resolution::TimeStep(_)),
        Some(Method::Rigid) => matches!(resolution, Resolution::Rigid { .. }),
        Some(Method::Grid) => matches!(resolution, Resolution::Grid { .. }),
        None => true,
    }
}

fn resolution(words: &str) -> Option<Resolution> {
    let words = words.trim();
    if let Some(seconds) = words.strip_prefix("dt=").and_then(|rest| rest.strip_suffix(" s")) {
        return positive(seconds).map(Resolution::TimeStep);
    }
    let mut known: [(&str, Option<f64>); 6] =
        ["dt", "substeps", "iterations", "cells", "points", "courant"].map(|name| (name, None));
    for word in words.split_whitespace() {
        let (name, value) = word.split_once('=')?;
        let place = known.iter_mut().find(|(known, _)| *known == name)?;
        if place.1.replace(positive(value)?).is_some() {
            return None;
        }
    }
    let whole = |value: f64| (value.fract() == 0.0 && value <= 1e6).then_some(value as u32);
    match known.map(|(_, value)| value) {
        [Some(fraction), None, None, None, None, None] => Some(Resolution::CriticalFraction(fraction)),
        [None, Some(substeps), iterations, None, None, None] => Some(Resolution::Rigid {
            step: Resolution::RIGID_STEP,
            substeps: whole(substeps)?,
            iterations: iterations.map_or(Some(Resolution::RIGID_ITERATIONS), whole)?,
        }),
        [None, None, None, Some(cells), points, courant] => Some(Resolution::Grid {
            cells,
            points: points.map_or(Some(Resolution::POINTS), whole).filter(|points| *points <= 64)?,
            courant: courant.unwrap_or(Resolution::COURANT),
        }),
        _ => None,
    }
}

fn positive(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_resolution_are_read_back() {
        for level in [
            Resolution::CriticalFraction(0.05),
            Resolution::TimeStep(1e-5),
            Resolution::substeps(16),
            Resolution::Rigid { step: Resolution::RIGID_STEP, substeps: 4, iterations: 16 },
            Resolution::grid(8.0, 2),
            Resolution::Grid { cells: 2.5, points: 3, courant: 0.2 },
        ] {
            assert_eq!(read(&level.to_string()), Ok(level));
        }
        assert_eq!(read("dt=.1"), Ok(Resolution::CriticalFraction(0.1)));
        assert_eq!(read("cells=4"), Ok(Resolution::grid(4.0, 3)));
    }

    #[test]
    fn other_words_are_refused() {
        let wrong = "|dt|dt=|dt=0|dt=-1|dt=nan|dt=.1 cells=4|points=2|cells=4 cells=5|substeps=1.5|cells=4 points=100|\
                     dt=.1s|fine";
        for words in wrong.split('|') {
            assert!(read(words).is_err(), "{words}");
        }
    }
}
