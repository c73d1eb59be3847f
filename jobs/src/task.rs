//! Tasks of a plan.

pub use grainbench_store::key::Id;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// Run or measurement of a plan, with the inputs that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Id of the task in result files.
    pub id: Id,
    /// Case and variant (`CASE/VARIANT`), path of the scene file, or another name, such as `conformance`.
    pub scene: String,
    /// Scene keys with changed values.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Value>,
    /// Solver name. In a sweep, the path of the manifest of an external program.
    pub solver: String,
    /// Resolution level as text.
    pub level: String,
    /// Quantity that the task determines, or a description of the task, such as `figures`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub what: String,
    /// Number of repetitions of the run; above 1 only for timed tasks.
    pub repetitions: u32,
    /// Expected time (s) of all repetitions.
    pub seconds: f64,
    /// Group number. Tasks of a group are consecutive, and one worker runs their repetitions in alternation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<u32>,
}

impl Task {
    /// Returns a task without a description, which is expected to take `seconds`.
    #[must_use]
    pub const fn new(id: Id, seconds: f64) -> Self {
        Self {
            id,
            scene: String::new(),
            set: BTreeMap::new(),
            solver: String::new(),
            level: String::new(),
            what: String::new(),
            repetitions: 1,
            seconds,
            group: None,
        }
    }
}
