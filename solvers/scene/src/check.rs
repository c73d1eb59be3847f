//! Checks of single values of a scene. Each error states the key.

use crate::dimension::Dimension;
use crate::error::{SceneError, did_you_mean};
use crate::shape;
use crate::source::SceneSource;
use nalgebra::{Matrix3, Vector3};

/// Checker for the values of one scene.
pub(crate) struct Checker<'a> {
    pub(crate) source: &'a SceneSource,
    pub(crate) dimension: Dimension,
}

impl Checker<'_> {
    pub(crate) fn error(&self, key: &str, expected: &str, found: &str) -> SceneError {
        self.source.error(key, expected, found, None)
    }

    pub(crate) fn positive(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(self.error(key, &format!("a positive{} {what}", and_finite(value)), &value.to_string()))
        }
    }

    pub(crate) fn not_negative(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        if value.is_finite() && value >= 0.0 {
            Ok(value)
        } else {
            Err(self.error(key, &format!("a {what} of zero or more{}", and_finite(value)), &value.to_string()))
        }
    }

    pub(crate) fn finite(&self, key: &str, value: f64, what: &str) -> Result<f64, SceneError> {
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(key, &format!("a finite {what}"), &value.to_string()))
        }
    }

    /// Reads a vector with one finite component for each dimension of the scene.
    pub(crate) fn vector(&self, key: &str, values: &[f64]) -> Result<Vector3<f64>, SceneError> {
        let count = self.dimension.count();
        if values.len() != count {
            return Err(self.error(key, shape::vector(self.dimension), &format!("{values:?}")));
        }
        if values.iter().any(|value| !value.is_finite()) {
            return Err(self.error(key, "finite components", &format!("{values:?}")));
        }
        Ok(Vector3::new(values[0], values[1], values.get(2).copied().unwrap_or(0.0)))
    }

    pub(crate) fn vector_or_zero(&self, key: &str, values: Option<&Vec<f64>>) -> Result<Vector3<f64>, SceneError> {
        values.map_or(Ok(Vector3::zeros()), |values| self.vector(key, values))
    }

    /// Reads a symmetric tensor, row by row, with one row for each dimension of the scene.
    pub(crate) fn symmetric(&self, key: &str, rows: &[Vec<f64>]) -> Result<Matrix3<f64>, SceneError> {
        let count = self.dimension.count();
        let found = || format!("{rows:?}");
        if rows.len() != count || rows.iter().any(|row| row.len() != count) {
            return Err(self.error(key, shape::symmetric(self.dimension), &found()));
        }
        let part = |row: usize, column: usize| rows[row][column];
        let inside = |at: usize| at < count;
        let tensor =
            Matrix3::from_fn(|row, column| if inside(row) && inside(column) { part(row, column) } else { 0.0 });
        if !tensor.iter().all(|value| value.is_finite()) {
            return Err(self.error(key, "finite components", &found()));
        }
        if tensor != tensor.transpose() {
            return Err(self.error(key, "a symmetric tensor, the same above and below its diagonal", &found()));
        }
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
        if there.len() == 1 {
            return Ok(());
        }
        let found = if there.is_empty() { "none of them".to_owned() } else { there.join(" and ") };
        Err(self.error(key, &format!("exactly one of {}", names(false).join(", ")), &found))
    }
}

/// Returns `, finite` if the value is not finite, for the error message; otherwise an empty string.
fn and_finite(value: f64) -> &'static str {
    if value.is_finite() { "" } else { ", finite" }
}
