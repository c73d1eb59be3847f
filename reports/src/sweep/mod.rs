//! Reports of sweeps: a scene over a design of its keys, by solvers at their levels.

mod figures;
mod map;
mod page;
mod table;

use crate::report::Provenance;
use crate::staged::StagedDir;
use crate::store::SaveError;
use crate::study::point::Timing;
use crate::{page as shared, plot};
use grainbench_harness::expect::Expected;
use grainbench_harness::verdict::{Outcome, Severity};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::io;
use std::path::Path;

/// What a sweep left: enough to make every output.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What ran, where and when.
    pub provenance: Provenance,
    /// Title.
    pub title: String,
    /// What it shows.
    pub about: String,
    /// Case and variant, or file of the scene.
    pub scene: String,
    /// What was varied.
    pub factors: Vec<Factor>,
    /// What was looked at.
    pub quantities: Vec<Quantity>,
    /// Every point of every solver at every level that is finished.
    pub points: Vec<Point>,
    /// How many are not.
    pub missing: usize,
    /// Places of the factors over which the map is drawn.
    pub map: Option<[usize; 2]>,
    /// A line on it.
    pub line: Option<Line>,
}

/// A line on the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it parts.
    pub label: String,
    /// Values of the two factors.
    pub points: Vec<(f64, f64)>,
}

/// What was varied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// Its name, a column of tables.
    pub name: String,
    /// What figures call it.
    pub label: String,
}

/// What was looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// In words.
    pub words: String,
    /// Its unit.
    pub unit: String,
    /// How far it may be off in every point; none where each point says it.
    pub allowed: Option<f64>,
    /// Where what is expected comes from.
    pub source: String,
}

/// A point by a solver at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Values of the factors.
    pub factors: Vec<Value>,
    /// The solver.
    pub solver: String,
    /// Its resolution, in words.
    pub resolution: String,
    /// What came out.
    pub left: Left,
}

/// What came out of a point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// What the run did; none where there is no record.
    pub ran: Option<Ran>,
    /// What was looked at, in the order of the quantities.
    pub looked: Vec<Looked>,
    /// Every repetition, where times were wanted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub timings: Vec<Timing>,
    /// Why there is no record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

/// What a run did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ran {
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains or material points.
    pub particle_steps: u64,
    /// Contact laws evaluated.
    pub contact_evaluations: Option<u64>,
    /// Nodes that took a step, in all steps.
    pub node_updates: Option<u64>,
    /// Time step (s).
    pub time_step: f64,
    /// Wall-clock time of the stepping loop (s).
    pub wall_seconds: f64,
}

/// What was seen of a quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Looked {
    /// Its value.
    pub value: Option<f64>,
    /// What it should be.
    pub expected: Option<Expected>,
    /// What the difference is divided by.
    pub scale: Option<f64>,
    /// Signed (value − expected)/scale.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: Option<f64>,
    /// How it ended; none where nothing was judged.
    pub verdict: Option<Outcome>,
    /// Why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

impl Sweep {
    /// How many points ended how in any quantity that is judged: those where all pass, where one fails, and the rest.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for point in &self.points {
            counts[point.standing() as usize] += 1;
        }
        counts
    }
}

/// How a point stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// All that is judged passes, or nothing is judged.
    Within,
    /// Something does not, or the run broke.
    Outside,
    /// The solver cannot express it, or is not there.
    Amber,
}

impl Point {
    /// How it stands.
    #[must_use]
    pub fn standing(&self) -> Standing {
        let severities = self.left.looked.iter().filter_map(|looked| looked.verdict).map(Outcome::severity);
        match severities.max() {
            Some(Severity::Red) => Standing::Outside,
            Some(Severity::Amber) => Standing::Amber,
            Some(Severity::Green) | None => Standing::Within,
        }
    }

    /// The largest |error| of what is looked at; none where there is none.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.left.looked.iter().filter_map(|looked| looked.error).map(f64::abs).reduce(f64::max)
    }
}

/// Writes `index.html`, `results.json`, `rows.csv`, `rows.parquet` and `figures/*.svg` into a directory, all of them or none.
///
/// # Errors
/// When the disk refuses or a figure cannot be drawn.
pub fn write_sweep(dir: impl AsRef<Path>, sweep: &Sweep) -> Result<(), SaveError> {
    let encode = |file: &'static str| move |reason: String| SaveError::Encode { file, reason };
    let mut out = StagedDir::new(dir.as_ref())?;
    let columns = table::columns(sweep);
    out.write("rows.csv", crate::rows::csv(&columns).map_err(|error| encode("rows.csv")(error.to_string()))?)?;
    let mut bytes = Vec::new();
    crate::parts::whole("rows", &columns, &mut bytes).map_err(|error| encode("rows.parquet")(error.to_string()))?;
    out.write("rows.parquet", bytes)?;
    drop(columns);
    out.write_with("results.json", |file| table::write_results(sweep, file))?;
    let mut drawings: Vec<(String, String, String)> = Vec::new();
    for (name, caption, svg) in map::draw(sweep) {
        drawings.push((name, caption, plot::markup(&svg)));
    }
    for figure in figures::all(sweep) {
        drawings.push((shared::slug(&figure.name), figure.caption.clone(), plot::draw(&figure)?));
    }
    for (name, _, svg) in &drawings {
        out.write(format!("figures/{name}.svg"), svg)?;
    }
    out.write("index.html", page::render(sweep, &drawings))?;
    out.commit()?;
    Ok(())
}

/// `results.json` of a sweep.
///
/// # Errors
/// When something has no JSON form, which nothing that was made by this project has.
pub fn sweep_json(sweep: &Sweep) -> io::Result<String> {
    let mut bytes = Vec::new();
    table::write_results(sweep, &mut bytes)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}
