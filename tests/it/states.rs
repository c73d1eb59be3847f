//! Initial states of cases. Each state is unchanged, and a file `NAME.state.toml` beside it contains the command that makes it.

use crate::common::entries;
use grainbench::cases::registry::{CASES, read_grains};
use grainbench::fields::overlap::sphere_in_box;
use grainbench::reference::deck::Stepping;
use grainbench::reference::stored::scene_hash;
use grainbench::scene::end_state::EndState;
use grainbench::scene::source::SceneSource;
use grainbench::solver::resolution::Resolution;
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Origin {
    /// Name and version of the program that made the state.
    program: String,
    /// Commit from which the program was built.
    commit: String,
    /// Date (YYYY-MM-DD).
    date: String,
    machine: String,
    /// File of the scene whose final state this is, in the folder of the state.
    scene: String,
    /// Variant of the scene; none for the plain scene.
    variant: Option<String>,
    /// Changed keys of the scene, with their values.
    #[serde(default)]
    set: Vec<[String; 2]>,
    /// BLAKE3 hash of everything in the scene on which a run depends, including the time step.
    scene_blake3: String,
    /// Time step (s).
    time_step: f64,
    /// Command that makes the state again, run in the root of the project.
    command: String,
    /// Later changes of the state, or limits of its reproducibility.
    note: String,
    grains: usize,
    /// Packing fraction in the box `within`.
    packing_fraction: f64,
    /// Lower and upper corner of a box (m) away from sides, floor and surface.
    within: [[f64; 3]; 2],
    /// BLAKE3 hash of the state file.
    blake3: String,
}

/// Returns the paths of all state files of all cases.
fn states() -> Vec<PathBuf> {
    let folders = CASES.iter().map(|case| case.directory());
    let files = folders.flat_map(entries);
    let mut states: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|ending| ending == "state")).collect();
    states.sort();
    states
}

fn origin(state: &Path) -> Origin {
    let file = state.with_extension("state.toml");
    let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

#[test]
fn a_state_names_its_origin() {
    let states = states();
    assert!(states.len() >= 3, "cases that begin with the end of another run");
    let mut wrong = Vec::new();
    for path in &states {
        let (told, bytes) = (origin(path), fs::read(path).unwrap());
        let found = blake3::hash(&bytes).to_hex().to_string();
        if found != told.blake3 {
            wrong.push(format!("{}: another file: {found}", path.display()));
        }
        assert!(bytes.len() <= 10_000_000, "{} is too large to be kept", path.display());
        let state = EndState::from_bytes(&bytes).unwrap();
        let scene = scene_source(path, &told).scene(&read_grains).unwrap();
        assert!(state.of[0] == *scene.title && state.grains.len() == told.grains, "{}", path.display());
        let stepping = Stepping::new(&scene, &Resolution::TimeStep(told.time_step)).unwrap();
        let hash = scene_hash(&scene, &stepping);
        if hash != told.scene_blake3 {
            wrong.push(format!("{}: of another scene: {hash}", path.display()));
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        for word in [&*told.scene, name, "grainbench simulate", "--time-step"] {
            assert!(told.command.contains(word), "{}: `{word}` in the command", path.display());
        }
        for part in [&told.program, &told.commit, &told.date, &told.machine, &told.note] {
            assert!(!part.trim().is_empty(), "{}: a part of its origin is empty", path.display());
        }
        for [key, value] in &told.set {
            assert!(told.command.contains(&format!("{key}={value}")), "{}: `{key}` in the command", path.display());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns the scene whose final state is the given state.
fn scene_source(state: &Path, origin: &Origin) -> SceneSource {
    let source = SceneSource::read(&state.with_file_name(&origin.scene)).unwrap();
    let source = origin.variant.iter().fold(source, |source, variant| source.variant(variant));
    origin.set.iter().fold(source, |source, [key, value]| source.set(key, value))
}

/// The packing fraction is the solid volume divided by the volume of the box. The box extends over the whole period along y.
#[test]
fn the_packing_fraction_of_a_state_is_the_one_that_is_told() {
    let mut wrong = Vec::new();
    for path in &states() {
        let (told, state) = (origin(path), EndState::from_bytes(&fs::read(path).unwrap()).unwrap());
        let [low, high] = told.within;
        let volume: f64 = (0..3).map(|axis| high[axis] - low[axis]).product();
        let period = high[1] - low[1];
        let overlap = |grain: &grainbench::scene::scene::Grain, image: f64| {
            let mut centre = grain.position;
            centre.y += image * period;
            let side = |corner: [f64; 3]| [0, 1, 2].map(|axis| corner[axis] - centre[axis]);
            sphere_in_box(grain.radius, side(low), side(high))
        };
        let solid: f64 =
            state.grains.iter().flat_map(|grain| [-1.0, 0.0, 1.0].map(|image| overlap(grain, image))).sum();
        let found = solid / volume;
        if (found - told.packing_fraction).abs() > 5.1e-5 {
            wrong.push(format!("{}: {found:.6}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
