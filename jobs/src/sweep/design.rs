//! Sweep points, generated from the design of a sweep file.

use super::file::{Design, Factor, File, Spacing};
use crate::fault::Fault;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::Value;
use std::path::Path;

/// Maximum number of points, summed over all solvers and levels.
pub const MOST: usize = 10_000_000;

/// Returns the factor values of each sweep point. Factors are in the order of the file.
///
/// # Errors
/// When a factor is invalid or does not fit the design. The error names the key, the expected and the actual content.
pub(super) fn points(path: &Path, file: &File) -> Result<Vec<Vec<Value>>, Fault> {
    if let (Design::Grid, Some(points)) = (file.design, file.points) {
        let expected = "no `points` for a grid, because its factors set the number of points";
        return Err(Fault::at_key(path, "points", expected, points));
    }
    for (name, factor) in &file.factors {
        let is_range = factor.from.is_some() || factor.to.is_some() || factor.count.is_some();
        let wrong = |key: &str, expected: &str, found: String| {
            Err(Fault::at_key(path, format_args!("factors.{name}{key}"), expected, found))
        };
        if factor.values.is_some() == is_range {
            return wrong("", "`values`, or `from` and `to`", if is_range { "both" } else { "neither" }.to_owned());
        }
        if let Some(values) = &factor.values {
            if values.is_empty() {
                return wrong(".values", "at least one value", "none".to_owned());
            }
            if let Some((_, value)) = values.iter().enumerate().find(|(at, value)| values[..*at].contains(value)) {
                return wrong(".values", "each value once", format!("{value} again"));
            }
            continue;
        }
        match (factor.from, factor.to) {
            (Some(from), Some(to)) if from.is_finite() && to.is_finite() && from < to => {
                if factor.spacing == Spacing::Log && from <= 0.0 {
                    return wrong(".from", "a number above zero, because the spacing is logarithmic", from.to_string());
                }
            }
            (from, to) => return wrong("", "`from` below `to`", format!("{from:?} and {to:?}")),
        }
        match (file.design, factor.count) {
            (Design::Grid, Some(2..)) | (Design::Random | Design::LatinHypercube, None) => {}
            (Design::Grid, count) => return wrong(".count", "at least two values", format!("{count:?}")),
            (_, Some(count)) => {
                return wrong(".count", "no `count`, because `points` sets the number of values", count.to_string());
            }
        }
    }
    match file.design {
        Design::Grid => grid(path, file),
        Design::Random | Design::LatinHypercube => by_lot(path, file),
    }
}

/// Returns the value of a factor at the fraction `part`, from 0 to 1, of its range.
fn at(factor: &Factor, part: f64) -> Value {
    let (from, to) = (factor.from.unwrap_or_default(), factor.to.unwrap_or_default());
    let value = match factor.spacing {
        Spacing::Linear => from + (to - from) * part,
        Spacing::Log => (from.ln() + (to.ln() - from.ln()) * part).exp(),
    };
    // Both ends of the range are exact. Values between them are rounded to twelve digits, because tables should not
    // show 0.30000000000000004.
    let value = if part <= 0.0 {
        from
    } else if part >= 1.0 {
        to
    } else {
        format!("{value:.11e}").parse().unwrap_or(value)
    };
    Value::from(value)
}

/// Returns all values of a factor in a grid design.
fn values(factor: &Factor) -> Vec<Value> {
    match (&factor.values, factor.count) {
        (Some(values), _) => values.iter().map(json).collect(),
        (None, Some(count)) => (0..count).map(|place| at(factor, f64::from(place) / f64::from(count - 1))).collect(),
        (None, None) => Vec::new(),
    }
}

/// Converts a TOML value to JSON.
pub(super) fn json(value: &toml::Value) -> Value {
    serde_json::to_value(value).unwrap_or(Value::Null)
}

fn grid(path: &Path, file: &File) -> Result<Vec<Vec<Value>>, Fault> {
    // The points are counted before they are created, because they may not fit into memory.
    let length = |factor: &Factor| factor.values.as_ref().map_or(factor.count.unwrap_or(0) as usize, Vec::len);
    let count = file.factors.values().try_fold(1_usize, |count, factor| count.checked_mul(length(factor)));
    if count.is_none_or(|count| count > MOST) {
        let found = count.map_or_else(|| "more than can be counted".to_owned(), |count| count.to_string());
        return Err(Fault::in_file(path, format!("at most {MOST} points"), found));
    }
    let mut points = vec![Vec::new()];
    for factor in file.factors.values() {
        // The last factor changes fastest.
        let values = &values(factor);
        let further = |point: &Vec<Value>| {
            values.iter().map(|value| [&point[..], std::slice::from_ref(value)].concat()).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(further).collect();
    }
    Ok(points)
}

fn by_lot(path: &Path, file: &File) -> Result<Vec<Vec<Value>>, Fault> {
    let count = match file.points {
        Some(count) if count > 0 && count as usize <= MOST => count as usize,
        found => {
            let expected = format!("a whole number from 1 to {MOST}");
            return Err(Fault::at_key(path, "points", expected, format!("{found:?}")));
        }
    };
    let mut lot = Pcg64Mcg::seed_from_u64(file.seed);
    let mut points: Vec<Vec<Value>> = vec![Vec::with_capacity(file.factors.len()); count];
    for factor in file.factors.values() {
        let mut slices: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            slices.swap(last, lot.random_range(0..=last));
        }
        for (point, slice) in points.iter_mut().zip(slices) {
            let lot: f64 = lot.random();
            let part = match file.design {
                Design::LatinHypercube => (slice as f64 + lot) / count as f64,
                Design::Grid | Design::Random => lot,
            };
            point.push(match &factor.values {
                Some(values) => json(&values[((part * values.len() as f64) as usize).min(values.len() - 1)]),
                None => at(factor, part),
            });
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "title = 't'\nscene = 'squash'\nsolvers = []\n";

    fn design_points(text: &str) -> Result<Vec<Vec<Value>>, String> {
        let file: File = toml::from_str(&(HEAD.to_owned() + text)).map_err(|error| error.to_string())?;
        points(Path::new("s.toml"), &file).map_err(|fault| fault.to_string())
    }

    #[test]
    fn a_grid_has_every_value_with_every_other() {
        let text = "factors.a = { values = [1, 2] }\n\
                    factors.b = { from = 0.1, to = 10.0, count = 3, spacing = 'log' }\n";
        let found = design_points(text).unwrap();
        let rows: Vec<(f64, f64)> =
            found.iter().map(|row| (row[0].as_f64().unwrap(), row[1].as_f64().unwrap())).collect();
        assert_eq!(rows, [(1.0, 0.1), (1.0, 1.0), (1.0, 10.0), (2.0, 0.1), (2.0, 1.0), (2.0, 10.0)]);
        assert_eq!(design_points("").unwrap(), [Vec::<Value>::new()], "without factors there is one point");
    }

    #[test]
    fn a_latin_hypercube_has_a_point_in_every_slice() {
        let text = "design = 'latin-hypercube'\npoints = 50\nfactors.a = { from = 0.0, to = 1.0 }\n\
                    factors.b = { from = 1.0, to = 1e4, spacing = 'log' }\n";
        let found = design_points(text).unwrap();
        let mut slices: Vec<usize> = found.iter().map(|row| (row[0].as_f64().unwrap() * 50.0) as usize).collect();
        slices.sort_unstable();
        assert_eq!(slices, (0..50).collect::<Vec<_>>());
        assert_eq!(design_points(text).unwrap(), found, "the lot is the same again");
        assert_ne!(design_points(&("seed = 2\n".to_owned() + text)).unwrap(), found);
    }

    #[test]
    fn what_is_no_design_is_refused() {
        for text in [
            "factors.a = {}",
            "factors.a = { values = [] }",
            "factors.a = { values = [1, 1] }",
            "factors.a = { values = [1], from = 0.0 }",
            "factors.a = { from = 1.0, to = 0.0, count = 2 }",
            "factors.a = { from = 0.0, to = 1.0, count = 1 }",
            "factors.a = { from = 0.0, to = 1.0 }",
            "factors.a = { from = 0.0, to = 1.0, count = 3, spacing = 'log' }",
            "factors.a = { from = nan, to = 1.0, count = 3 }",
            "points = 3",
            "design = 'random'",
            "design = 'random'\npoints = 0",
            "design = 'random'\npoints = 9\nfactors.a = { from = 0.0, to = 1.0, count = 3 }",
            "design = 'spiral'",
            "factors.a = { from = 0.0, to = 1.0, count = 4000000000 }",
        ] {
            assert!(design_points(text).is_err(), "{text}");
        }
    }
}
