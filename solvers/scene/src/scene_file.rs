//! Keys of a scene file as typed values.

use crate::dimension::Dimension;
use crate::error::SceneError;
use crate::file::SceneFile;
use crate::shape;
use crate::source::{SceneSource, describe, value_at, variant_names};
use crate::toml_error::expected_and_found;
use std::path::Path;

impl SceneSource {
    /// Reads a scene file.
    ///
    /// # Errors
    /// When the file cannot be read or is not UTF-8, or a variant has an unknown key or a value of the wrong type.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let source = Self::from_file(path)?;
        // All variants are checked, so that an error in an unused variant is found too.
        let table = source.parse()?;
        let mut varied = source.clone();
        for variant in variant_names(table) {
            varied = varied.variant(&variant);
            varied.scene_file_of(table)?;
        }
        Ok(source)
    }

    /// Returns the scene file with its variant and overrides applied.
    ///
    /// # Errors
    /// When the text is not TOML, the variant is unknown, or a key is unknown, missing or of the wrong type.
    pub fn scene_file(&self) -> Result<SceneFile, SceneError> {
        self.scene_file_of(self.parse()?)
    }

    /// Deserialises a scene file from its table, with the variant and the overrides applied.
    fn scene_file_of(&self, text: &toml::Table) -> Result<SceneFile, SceneError> {
        let table = self.laid_over(text)?;
        serde_path_to_error::deserialize(toml::Value::Table(table.clone())).map_err(|error| {
            let path = error.path().to_string();
            self.explain(&path, error.inner().message(), &table)
        })
    }

    /// Converts an error message of serde to a scene error.
    fn explain(&self, path: &str, message: &str, table: &toml::Table) -> SceneError {
        let message = message.trim();
        let path = if path == "." { "" } else { path };
        let dimension = match table.get("dimension").and_then(toml::Value::as_integer) {
            Some(3) => Dimension::Three,
            _ => Dimension::Two,
        };
        let shape = shape::expected(path, dimension);
        let word = message.split('`').nth(1).unwrap_or_default();
        let (expected, found) = expected_and_found(message);
        if message.starts_with("unknown variant") {
            return self.error(path, &expected, &found, None);
        }
        if message.starts_with("unknown field") {
            let is_last = path == word || path.ends_with(&format!(".{word}"));
            let key = if path.is_empty() || is_last { path.to_owned() } else { format!("{path}.{word}") };
            return self.error(if key.is_empty() { word } else { &key }, &expected, &found, None);
        }
        if message.starts_with("missing field") {
            let key = if path.is_empty() { word.to_owned() } else { format!("{path}.{word}") };
            let help = shape.filter(|(_, shape)| shape.starts_with('{')).map(|(_, shape)| format!("as in {shape}"));
            return self.error(&key, &expected, &found, help);
        }
        if let Some((key, shape)) = shape {
            let found = value_at(table, key).map_or_else(|| message.to_owned(), describe);
            return self.error(key, &shape, &found, None);
        }
        if message.contains(", expected ") {
            return self.error(path, &expected, &found, None);
        }
        let found = value_at(table, path).map_or_else(|| "something else".to_owned(), describe);
        self.error(path, message, &found, None)
    }
}
