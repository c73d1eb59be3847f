//! Checks of single values of a scene. Each error states the key.

use crate::dimension::Dimension;
use crate::error::{SceneError, did_you_mean};
use crate::shape;
use crate::source::SceneSource;
use nalgebra::{Matrix3, Vector3};
use std::fmt::Display;

/// Checker for the values of one scene.
pub(crate) struct Checker<'a> {
    pub(crate) source: &'a SceneSource,
    pub(crate) dimension: Dimension,
}

impl Checker<'_> {
    pub(crate) fn error(&self, key: &str, expected: impl Display, found: impl Display) -> SceneError {
        self.source.error(key, &expected.to_string(), &found.to_string(), None)
    }

    /// Returns an error about a key unless a condition is true.
    pub(crate) fn require(
        &self,
        is_met: bool,
        key: &str,
        expected: impl Display,
        found: impl Display,
    ) -> Result<(), SceneError> {
        if is_met { Ok(()) } else { Err(self.error(key, expected, found)) }
    }

    pub(crate) fn positive(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        let expected = format_args!("a positive{} {what}", and_finite(value));
        self.require(value.is_finite() && value > 0.0, key, expected, value).map(|()| value)
    }

    pub(crate) fn not_negative(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        let expected = format_args!("a {what} of zero or more{}", and_finite(value));
        self.require(value.is_finite() && value >= 0.0, key, expected, value).map(|()| value)
    }

    pub(crate) fn finite(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        self.require(value.is_finite(), key, format_args!("a finite {what}"), value).map(|()| value)
    }

    /// Reads a vector with one finite component for each dimension of the scene.
    pub(crate) fn vector(&self, key: &str, values: &[f64]) -> Result<Vector3<f64>, SceneError> {
        let count = self.dimension.count();
        self.require(values.len() == count, key, shape::vector(self.dimension), format_args!("{values:?}"))?;
        let is_finite = values.iter().all(|value| value.is_finite());
        self.require(is_finite, key, "finite components", format_args!("{values:?}"))?;
        Ok(Vector3::new(values[0], values[1], values.get(2).copied().unwrap_or(0.0)))
    }

    pub(crate) fn vector_or_zero(&self, key: &str, values: Option<&Vec<f64>>) -> Result<Vector3<f64>, SceneError> {
        values.map_or(Ok(Vector3::zeros()), |values| self.vector(key, values))
    }

    /// Reads a symmetric tensor, row by row, with one row for each dimension of the scene.
    pub(crate) fn symmetric(&self, key: &str, rows: &[Vec<f64>]) -> Result<Matrix3<f64>, SceneError> {
        let count = self.dimension.count();
        let require = |is_met: bool, expected: &str| self.require(is_met, key, expected, format_args!("{rows:?}"));
        let is_square = rows.len() == count && rows.iter().all(|row| row.len() == count);
        require(is_square, shape::symmetric(self.dimension))?;
        let part = |row: usize, column: usize| rows[row][column];
        let inside = |at: usize| at < count;
        let tensor =
            Matrix3::from_fn(|row, column| if inside(row) && inside(column) { part(row, column) } else { 0.0 });
        require(tensor.iter().all(|value| value.is_finite()), "finite components")?;
        require(tensor == tensor.transpose(), "a symmetric tensor, the same above and below its diagonal")?;
        Ok(tensor)
    }

    /// Returns the index of a name in a list of known names.
    pub(crate) fn place_of<'n>(
        &self,
        key: &str,
        name: &str,
        what: &str,
        mut known: impl Iterator<Item = &'n String> + Clone,
    ) -> Result<usize, SceneError> {
        let names: Vec<&str> = known.clone().map(String::as_str).filter(|name| !name.is_empty()).collect();
        known.position(|candidate| candidate == name).ok_or_else(|| {
            let expected = match names[..] {
                [] => format!("{what} (the scene has none)"),
                _ => format!("{what}: one of {}", names.join(", ")),
            };
            self.source.error(key, &expected, &format!("`{name}`"), did_you_mean(name, names.iter().copied()))
        })
    }

    /// Checks that exactly one of several alternatives is given.
    pub(crate) fn exactly_one(&self, key: &str, given: &[(&str, bool)]) -> Result<(), SceneError> {
        let names = |wanted: bool| -> Vec<&str> {
            given.iter().filter(|(_, is)| !wanted || *is).map(|(name, _)| *name).collect()
        };
        let there = names(true);
        let found = if there.is_empty() { "none of them".to_owned() } else { there.join(" and ") };
        self.require(there.len() == 1, key, format_args!("exactly one of {}", names(false).join(", ")), found)
    }
}

/// Returns `, finite` if the value is not finite, for the error message; otherwise an empty string.
fn and_finite(value: f64) -> &'static str {
    if value.is_finite() { "" } else { ", finite" }
}
