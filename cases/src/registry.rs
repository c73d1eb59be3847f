//! Registry of cases. Each folder with a `scene.toml` is a case.

use grainbench_harness::case::SceneCache;
use grainbench_harness::prelude::*;
use grainbench_reference::data::folder;
use grainbench_reference::{DataFile, parse_data};
use grainbench_scene::error::SceneError;
use grainbench_scene::resolve::FileGrain;
use std::path::Path;

include!(concat!(env!("OUT_DIR"), "/registry.rs"));

/// Folder of the cases, function that reads their grain files, and cache of their scenes.
pub static HOME: Home =
    Home { folder: &|| folder("cases", env!("CARGO_MANIFEST_DIR")), read_grains, made: Some(&MADE) };
static MADE: SceneCache = SceneCache::new(Vec::new());

/// Returns the case with this name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Case> {
    CASES.iter().copied().find(|case| case.name == name)
}

/// Reads grains for a scene from a LAMMPS data file.
///
/// # Errors
/// The message names the file, the line, the expected text and the found text.
pub fn read_grains(path: &Path) -> Result<Vec<FileGrain>, SceneError> {
    Ok(grains_of(&grainbench_reference::read_data_file(path)?))
}

/// Returns the scene of a source that reads its grains from LAMMPS data files. `files` contains the name and the text of
/// each data file. An error gives the place in the scene or in a data file, or the data file that `files` lacks.
pub(crate) fn made_of(source: &SceneSource, files: &[(&str, String)]) -> Result<Scene, String> {
    let read = |path: &Path| {
        let named = files.iter().find(|(name, _)| path.ends_with(name));
        let (name, text) = named
            .ok_or_else(|| source.error("grains", "a data file of the start", &path.display().to_string(), None))?;
        Ok(grains_of(&parse_data(text.as_bytes(), name)?))
    };
    source.scene(&read).map_err(|error| error.to_string())
}

/// Returns the grains of a data file.
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
