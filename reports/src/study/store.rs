//! Files of a study. They are written together, and can be read back to write them again or to compare studies.

use super::effects::Entry;
use super::estimate::{self, SceneCost};
use super::load::Load;
use super::point::Point;
use super::stability::{HardCaseResult, Limit};
use super::step::Model;
use super::{Study, cost, effects, load, page, stability};
use crate::report::Provenance;
use crate::store::SaveError;
use crate::{page as shared, plot};
use grainbench_harness::figure::Figure;
use grainbench_store::artifact::read_json;
use grainbench_store::{ReadError, StagedDir};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// File from which all files of a study can be written again.
pub const STUDY_FILE: &str = "study.json";

/// Content of `results.json`, whose keys are a public interface.
#[derive(Serialize)]
struct Results<'a> {
    provenance: &'a Provenance,
    passed: bool,
    verdicts: [(); 0],
    controls: [(); 0],
    points: Vec<&'a Point>,
    #[serde(skip_serializing_if = "<[SceneCost]>::is_empty")]
    scenes: &'a [SceneCost],
    stability: Stability<'a>,
    effects: &'a [Entry],
    #[serde(skip_serializing_if = "Option::is_none")]
    prices: Option<&'a Model>,
    #[serde(skip_serializing_if = "<[Load]>::is_empty")]
    loads: &'a [Load],
}

/// Stability limits and hard cases in `results.json`.
#[derive(Serialize)]
struct Stability<'a> {
    limits: &'a [Limit],
    hard: &'a [HardCaseResult],
}

/// Returns `results.json` of a study.
///
/// # Errors
/// When a value has no JSON form. This does not occur in studies of this project.
pub fn study_json(study: &Study) -> Result<String, serde_json::Error> {
    let results = Results {
        provenance: &study.provenance,
        passed: !study.is_red(),
        verdicts: [],
        controls: [],
        points: study.diagrams.iter().flat_map(|diagram| &diagram.points).collect(),
        scenes: &study.scenes,
        stability: Stability { limits: &study.limits, hard: &study.hard },
        effects: &study.ledger,
        prices: study.model.as_ref(),
        loads: &study.loads,
    };
    serde_json::to_string_pretty(&results).map(|text| text + "\n")
}

/// Writes `index.html`, `results.json`, `study.json`, `points.csv` and `figures/*.svg` to a directory. If an error
/// occurs, no file is written.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_study(dir: impl AsRef<Path>, study: &Study) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    let stored = serde_json::to_string_pretty(study).map_err(SaveError::encode(STUDY_FILE))?;
    out.write(STUDY_FILE, stored + "\n")?;
    out.write("results.json", study_json(study).map_err(SaveError::encode("results.json"))?)?;
    out.write_with("points.csv", |file| cost::points_table(&study.diagrams).csv(file))?;
    out.write("index.html", page::render(study))?;
    for (name, figure) in named_figures(study) {
        out.write(format!("figures/{name}.svg"), plot::draw(&figure)?)?;
    }
    Ok(out.commit()?)
}

/// Returns the figures of a study with the names of their files.
#[must_use]
pub fn named_figures(study: &Study) -> Vec<(String, Figure)> {
    let diagrams = study.diagrams.iter().map(|diagram| {
        let figure = cost::figure(diagram);
        (format!("cost-{}-{}-{}", diagram.case, diagram.variant, figure.name), figure)
    });
    let others = cost::scatters(&study.diagrams).into_iter().chain(load::figure(&study.loads));
    let others = others.chain(stability::figures(&study.limits));
    let others = others.chain(study.scenes.iter().flat_map(estimate::figures));
    let all = diagrams.chain(others.map(|figure| (figure.name.clone(), figure)));
    let mut names = BTreeSet::new();
    all.map(|(stem, figure)| (shared::unique(&shared::slug(&stem), &mut names), figure)).collect()
}

/// Returns a study as text for storage in the source tree. It contains the Pareto front of each solver and the effects
/// that are on, each with its median change. Repetitions, cost model and costs of a step for different numbers of
/// grains are left out.
///
/// # Errors
/// When a value has no JSON form. This does not occur in studies of this project.
pub fn kept_text(study: &Study) -> Result<String, serde_json::Error> {
    let mut study = study.clone();
    study.model = None;
    study.loads = Vec::new();
    study.ledger.retain(|entry| entry.on);
    for entry in &mut study.ledger {
        entry.shifts = effects::median(entry).cloned().into_iter().collect();
    }
    for diagram in &mut study.diagrams {
        let kept = |line| {
            let front = cost::front(cost::of_line(diagram, line));
            // If a solver has no point on the front, its first point is stored, because it states the reason.
            let first = cost::of_line(diagram, line).take(usize::from(front.is_empty()));
            front.into_iter().chain(first).map(|point| Point { repetitions: Vec::new(), ..point.clone() })
        };
        diagram.points = cost::lines([&*diagram]).into_iter().flat_map(kept).collect();
    }
    serde_json::to_string_pretty(&study).map(|text| text + "\n")
}

/// Returns the points in a `results.json` of a study.
///
/// # Errors
/// When the file is missing or damaged. The message names the position in the file.
pub fn points_of(path: &Path) -> Result<Vec<Point>, ReadError> {
    #[derive(Deserialize)]
    struct Session {
        points: Vec<Point>,
    }
    read_json::<Session>(path).map(|session| session.points)
}
