//! Names of numbers in a claim. A name is a key of the scene file, or `scene.` followed by a key of the resolved scene
//! that external solvers receive.

use grainbench_reference::deck::Stepping;
use grainbench_reference::outside::{DiscretizedScene, Resolved};
use grainbench_scene::scene::Scene;
use toml::{Table, Value};

/// Name of the time in expressions.
pub(super) const TIME: &str = "t";
/// Prefix of numbers of the resolved scene, such as masses, moments of inertia and spring stiffnesses from restitution.
const DEFINITE: &str = "scene.";

/// Named numbers of a scene and of its file.
pub struct Numbers {
    file: Value,
    definite: Value,
    /// Names of the columns of the record.
    pub columns: Vec<String>,
}

impl Numbers {
    /// Collects the numbers of a scene and its file.
    ///
    /// # Errors
    /// When the scene cannot be serialised. The error is a message.
    pub fn new(file: Table, scene: &Scene) -> Result<Self, String> {
        // The number of steps depends on the resolution of a run, so these placeholder steps are removed below.
        let stepping = Stepping { time_step: 1.0, steps: 1, interval: 1 };
        let resolved = Resolved::new(&DiscretizedScene { scene, stepping, grid: None });
        let columns = resolved.columns.clone();
        let mut definite = Value::try_from(resolved).map_err(|error| error.to_string())?;
        if let Some(steps) = definite.get_mut("steps").and_then(Value::as_table_mut) {
            steps.retain(|key, _| key == "critical_time_step");
        }
        Ok(Self { file: Value::Table(file), definite, columns })
    }

    /// Returns true if a name belongs to the record and not to the scene. A name that is neither a column nor a number of
    /// the scene counts as a missing column.
    pub fn is_of_record(&self, name: &str) -> bool {
        name != TIME && (self.columns.iter().any(|column| column == name) || self.get(name).is_none())
    }

    /// Returns the number with this name. A name is a path of keys; list indices start at 0.
    pub fn get<'n>(&'n self, name: &str) -> Option<f64> {
        let (root, path) = match name.strip_prefix(DEFINITE) {
            Some(path) => (&self.definite, path),
            None => (&self.file, name),
        };
        let step = |value: &'n Value, key: &str| match value {
            Value::Table(table) => table.get(key),
            Value::Array(list) => list.get(key.parse::<usize>().ok()?),
            _ => None,
        };
        match path.split('.').try_fold(root, step)? {
            Value::Float(value) => Some(*value),
            Value::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }
}
