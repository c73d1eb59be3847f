//! The registry of cases: one for each folder with a `scene.toml`.

use grainbench_harness::case::{Case, Home, Made};
use grainbench_harness::runner::Runner;
use grainbench_harness::subject::{Subject, from_claims};
use grainbench_reference::{DataFile, parse_data};
use grainbench_scene::resolve::FileGrain;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use nalgebra::Vector3;
use std::path::Path;
use std::sync::Arc;

/// What a case says itself of what accuracy is measured by: its name, and its subjects.
type Own = (&'static str, fn() -> Vec<Subject>);

include!(concat!(env!("OUT_DIR"), "/registry.rs"));

/// Where the folders of the cases are.
pub static HOME: Home = Home { folder: env!("CARGO_MANIFEST_DIR"), read_grains, made: Some(&MADE) };
static MADE: Made = Made::new(Vec::new());

/// The case of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Case> {
    CASES.iter().copied().find(|case| case.name == name)
}

/// A runner of a case with the solvers of the registry.
#[must_use]
pub fn runner(case: &'static Case) -> Runner {
    Runner::new(case, Arc::new(crate::solvers::Registry))
}

/// What accuracy is measured by in a case: what it says itself, or what its claims say.
#[must_use]
pub fn subjects(case: &'static Case) -> Vec<Subject> {
    match COSTS.iter().find(|(name, _)| *name == case.name) {
        Some((_, subjects)) => subjects(),
        None => from_claims(case),
    }
}

/// Reads grains for a scene from a LAMMPS data file.
///
/// # Errors
/// Says file, line, what was expected and what was found.
pub fn read_grains(path: &Path) -> Result<Vec<FileGrain>, String> {
    Ok(grains_of(&grainbench_reference::read_data_file(path).map_err(|error| error.to_string())?))
}

/// The scene of a source whose grains stand in data files of LAMMPS: name and text of each.
///
/// # Errors
/// Says what is wrong with the scene, or with a file where.
pub(crate) fn made_of(source: &SceneSource, files: &[(&str, String)]) -> Result<Scene, String> {
    let read = |path: &Path| {
        let named = files.iter().find(|(name, _)| path.ends_with(name));
        let (name, text) = named.ok_or_else(|| format!("{}: expected a file of the start", path.display()))?;
        Ok(grains_of(&parse_data(text.as_bytes(), name).map_err(|error| error.to_string())?))
    };
    source.scene(&read).map_err(|error| error.to_string())
}

/// The grains of a data file.
fn grains_of(data: &DataFile) -> Vec<FileGrain> {
    let grain = |atom: &grainbench_reference::Atom| FileGrain {
        type_number: atom.type_,
        radius: atom.radius(),
        mass: atom.mass(),
        position: Vector3::from(atom.position),
        velocity: Vector3::from(atom.velocity),
        spin: Vector3::from(atom.angular_velocity),
    };
    data.atoms.iter().map(grain).collect()
}
