//! Names of numbers in a claim: keys of the scene file, and under `scene.` those of the scene as programs are given it.

use grainbench_reference::deck::Stepping;
use grainbench_reference::outside::Resolved;
use grainbench_scene::scene::Scene;
use toml::{Table, Value};

/// The prefix of what the scene makes definite: masses, moments of inertia, springs by restitution.
const DEFINITE: &str = "scene.";

/// Numbers by their names.
pub(super) struct Numbers {
    file: Value,
    definite: Value,
    /// Columns of the record.
    pub(super) columns: Vec<String>,
}

impl Numbers {
    /// Of a scene and its file.
    ///
    /// # Errors
    /// When the scene cannot be written down, in words.
    pub(super) fn of(file: Table, scene: &Scene) -> Result<Self, String> {
        // Steps belong to a run and not to a claim: they are taken out again.
        let stepping = Stepping { time_step: 1.0, steps: 1, interval: 1 };
        let resolved = Resolved::of(scene, &stepping);
        let columns = resolved.columns.clone();
        let mut definite = Value::try_from(resolved).map_err(|error| error.to_string())?;
        if let Some(table) = definite.as_table_mut() {
            table.remove("steps");
        }
        Ok(Self { file: Value::Table(file), definite, columns })
    }

    /// The number of a name, a path of keys with places in lists counted from 0.
    pub(super) fn get(&self, name: &str) -> Option<f64> {
        let (root, path) = match name.strip_prefix(DEFINITE) {
            Some(path) => (&self.definite, path),
            None => (&self.file, name),
        };
        let step = |value: &'_ Value, key: &str| -> Option<Value> {
            match value {
                Value::Table(table) => table.get(key).cloned(),
                Value::Array(list) => list.get(key.parse::<usize>().ok()?).cloned(),
                _ => None,
            }
        };
        let mut found = None;
        for key in path.split('.') {
            found = Some(step(found.as_ref().unwrap_or(root), key)?);
        }
        match found? {
            Value::Float(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            _ => None,
        }
    }
}
