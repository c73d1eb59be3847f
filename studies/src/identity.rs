//! Identifiers of runs and tasks: hashes of 64 hexadecimal digits.

use grainbench_scene::checkpoint::fingerprint;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Resolution;
use std::fs;
use std::path::Path;

/// Returns the hash of a file's content. If the file cannot be read, returns the hash of its path.
#[must_use]
pub fn of_file(path: &Path) -> String {
    match fs::read(path) {
        Ok(bytes) => blake3::hash(&bytes).to_hex().to_string(),
        Err(_) => blake3::hash(path.as_os_str().as_encoded_bytes()).to_hex().to_string(),
    }
}

/// Returns the hash of the running program. Every change of a solver, a case or a claim changes it.
#[must_use]
pub fn of_this_program() -> String {
    std::env::current_exe().map_or_else(|_| "unknown".to_owned(), |path| of_file(&path))
}

/// Returns the hash of a run from program, solver, scene, resolution and `read`, which describes the evaluated quantity or
/// other conditions of the run.
#[must_use]
pub fn of_run(program: &str, solver: &str, scene: &Scene, resolution: &Resolution, read: &str) -> String {
    of_words(program, &[solver, fingerprint(scene).to_hex().as_str(), &format!("{resolution:?}"), read])
}

/// Returns the hash of a task from the program and a description of the task.
#[must_use]
pub fn of_words(program: &str, words: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in std::iter::once(&program).chain(words) {
        // Each part follows its length, so that two different lists never have the same byte sequence.
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}
