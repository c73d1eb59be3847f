//! `SWEEP.toml`: a design over the keys of a scene, solvers and their levels, and what is looked at.

use grainbench_cases::folder::Over;
use indexmap::IndexMap;
use serde::Deserialize;
use toml::{Table, Value};

/// The file.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    /// Title.
    pub(super) title: String,
    /// What it shows, in a sentence or two.
    #[serde(default)]
    pub(super) about: String,
    /// `CASE`, `CASE/VARIANT`, or the path of a scene from the file.
    pub(super) scene: String,
    /// How points are laid out.
    #[serde(default)]
    pub(super) design: Design,
    /// How many points a design by lot has.
    pub(super) points: Option<u32>,
    /// What the lot begins with.
    #[serde(default)]
    pub(super) seed: u64,
    /// How often each point is run; more than once where it is timed.
    #[serde(default = "once")]
    pub(super) repetitions: u32,
    /// Whether times are wanted, so that nothing may run beside.
    #[serde(default)]
    pub(super) timed: bool,
    /// What is varied.
    #[serde(default)]
    pub(super) factors: IndexMap<String, Factor>,
    /// Keys of the scene that are otherwise in all points.
    #[serde(default)]
    pub(super) set: Table,
    /// Keys of the scene that follow from the factors, by arithmetic over their names.
    #[serde(default)]
    pub(super) formulas: Table,
    /// Who is asked.
    pub(super) solvers: Vec<Asked>,
    /// Claims of the case that are looked at.
    #[serde(default)]
    pub(super) gates: Vec<Gate>,
    /// Quantities that are looked at beside.
    #[serde(default)]
    pub(super) record: Vec<Recorded>,
    /// The factors over which the map is drawn.
    pub(super) map: Option<[String; 2]>,
    /// A line on it, such as the limit between two kinds of motion.
    pub(super) line: Option<Line>,
}

/// A line on the map.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Line {
    /// The second factor of the map, by arithmetic over the first.
    pub(super) formula: String,
    /// What it parts.
    pub(super) label: String,
}

const fn once() -> u32 {
    1
}

/// How points are laid out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Design {
    /// Every value with every other.
    #[default]
    Grid,
    /// By lot, each by itself.
    Random,
    /// By lot, each value of each factor in its own slice of the range.
    LatinHypercube,
}

/// What is varied.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    /// The key that takes its value; none where only formulas do.
    pub(super) key: Option<String>,
    /// What figures call it.
    pub(super) label: Option<String>,
    /// Its values,
    pub(super) values: Option<Vec<Value>>,
    /// or a range of them.
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    pub(super) count: Option<u32>,
    #[serde(default)]
    pub(super) spacing: Spacing,
}

/// How values of a range follow one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Spacing {
    /// By equal differences.
    #[default]
    Linear,
    /// By equal ratios.
    Log,
}

/// A solver with its levels.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Asked {
    /// Its name, or the manifest of a program.
    pub(super) solver: String,
    /// Its levels, in words.
    pub(super) levels: Vec<String>,
    /// Keys of the scene that are otherwise for it.
    #[serde(default)]
    pub(super) set: Table,
    /// The same by arithmetic over the factors.
    #[serde(default)]
    pub(super) formulas: Table,
}

/// A claim of the case.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Gate {
    /// Its words.
    pub(super) quantity: String,
    /// How far it may be off, where that is not what the claim says.
    pub(super) allowed: Option<f64>,
}

/// A quantity.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Recorded {
    /// What it is, in words.
    pub(super) quantity: String,
    /// Its unit.
    pub(super) unit: String,
    /// Arithmetic over columns of the record and numbers of the scene.
    pub(super) value: String,
    /// The moment at which it is read (s); the end where none is named.
    pub(super) at: Option<f64>,
    /// How samples are read, where it is not one of them.
    pub(super) over: Option<Over>,
    /// What is expected, by arithmetic over the factors, numbers of the scene and the time `t`.
    pub(super) equals: Option<Formula>,
    /// What the difference is divided by; what is expected where nothing is said.
    pub(super) scale: Option<Formula>,
    /// How far it may be off.
    pub(super) allowed: Option<f64>,
}

/// A number, or arithmetic.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Formula {
    Number(f64),
    Text(String),
}

impl Formula {
    /// As arithmetic.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Text(text) => text.clone(),
        }
    }
}
