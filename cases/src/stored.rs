//! Stored runs of LAMMPS and LIGGGHTS that claims read, by the names of their folders.

use crate::registry::CASES;
use grainbench_harness::prelude::*;
use grainbench_harness::run::ExpectedOutcome;
use grainbench_reference::deck::Program;
use grainbench_reference::stored::{StoredRun, folder, unusable};
use grainbench_scene::error::SceneError;

/// A run of LAMMPS or LIGGGHTS that a claim reads, stored or not.
#[derive(Clone)]
pub struct Reference {
    /// Case of the claims that read the run.
    pub case: &'static Case,
    /// Scene, variant and resolution of the run.
    pub run: Run,
    /// Program of the run: LAMMPS or LIGGGHTS.
    pub program: Program,
    /// Name of the folder of the stored run.
    pub id: String,
}

/// Returns all runs of LAMMPS and LIGGGHTS that claims read, in the order of the registry, each once.
#[must_use]
pub fn all() -> Vec<Reference> {
    let mut all: Vec<Reference> = Vec::new();
    for &case in CASES {
        // The module `kept` handles runs whose results are stored in the folder of their case.
        for run in (case.claims)().into_iter().flat_map(|claim| claim.runs).filter(|run| !run.kept) {
            let Some(program) = Program::by_name(run.solver).filter(|_| run.standing != ExpectedOutcome::Refused)
            else {
                continue;
            };
            let id = id(case, &run);
            if !all.iter().any(|known| known.program == program && known.id == id) {
                all.push(Reference { case, run, program, id });
            }
        }
    }
    all
}

impl Reference {
    /// Returns the scene of the run.
    ///
    /// # Errors
    /// When the scene file is wrong.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let mut scene = self.case.variant(self.run.variant)?;
        if let Some((_, change)) = &self.run.adjustment {
            change(&mut scene);
        }
        Ok(scene)
    }

    /// Returns a title of the run: case, variant, adjustment and resolution.
    #[must_use]
    pub fn title(&self) -> String {
        let mut title = self.case.name.to_owned();
        if self.run.variant != PLAIN {
            title.push_str(&format!("/{}", self.run.variant));
        }
        if let Some((name, _)) = &self.run.adjustment {
            title.push_str(&format!(", {name}"));
        }
        format!("{title}, {}", self.run.resolution)
    }
}

/// Returns the folder name of a run: case, variant and adjustment in lower case, joined by `-`.
#[must_use]
pub fn id(case: &Case, run: &Run) -> String {
    let variant = if run.variant == PLAIN { "" } else { run.variant };
    let adjustment = run.adjustment.as_ref().map_or("", |(name, _)| name.as_str());
    folder_name(&format!("{} {variant} {adjustment}", case.name))
}

/// Returns words as the name of a folder: in lower case, joined by `-`, with letters, digits and `.` only.
pub(crate) fn folder_name(words: &str) -> String {
    let words = words.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '.');
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-").to_lowercase()
}

/// Returns true for the solver names `lammps` and `liggghts`.
#[must_use]
pub fn is_program(name: &str) -> bool {
    Program::by_name(name).is_some()
}

/// Returns true if there is a folder with the stored run.
#[must_use]
pub fn exists(case: &Case, run: &Run) -> bool {
    Program::by_name(run.solver).is_some_and(|program| folder(program, &id(case, run)).is_dir())
}

/// Reads the stored record of a run of LAMMPS or LIGGGHTS; `None` for another solver or if no run is stored.
pub(crate) fn record(case: &Case, run: &Run, scene: &Scene) -> Option<Result<Record, RunError>> {
    let program = Program::by_name(run.solver)?;
    let folder = folder(program, &id(case, run));
    if !folder.is_dir() {
        return None;
    }
    let stored = StoredRun::load(&folder).map_err(|error| unusable(program, &error));
    Some(stored.and_then(|stored| stored.record(scene, &run.resolution, program)))
}
