//! What tells one piece of work from another, in sixty-four digits.

use grainbench_scene::checkpoint::fingerprint;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Resolution;
use std::fs;
use std::path::Path;

/// Hash of a file's content; of its path where it cannot be read.
#[must_use]
pub fn of_file(path: &Path) -> String {
    match fs::read(path) {
        Ok(bytes) => blake3::hash(&bytes).to_hex().to_string(),
        Err(_) => blake3::hash(path.as_os_str().as_encoded_bytes()).to_hex().to_string(),
    }
}

/// Hash of the program that runs: every change of a solver, a case or a gate changes it.
#[must_use]
pub fn of_this_program() -> String {
    std::env::current_exe().map_or_else(|_| "unknown".to_owned(), |path| of_file(&path))
}

/// What a run is, by content: program, solver, scene, resolution, and what is read from it.
#[must_use]
pub fn of_run(program: &str, solver: &str, scene: &Scene, resolution: &Resolution, read: &str) -> String {
    of_words(program, &[solver, fingerprint(scene).to_hex().as_str(), &format!("{resolution:?}"), read])
}

/// What a piece of work is whose content is all in words.
#[must_use]
pub fn of_words(program: &str, words: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in std::iter::once(&program).chain(words) {
        // The length before each part keeps two lists of parts from running into one.
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}
