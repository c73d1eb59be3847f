//! The stored runs are what they were, and say so when they are not.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use grainbench_reference::{StoredError, StoredRun, read_data_file};
use tempfile::TempDir;

fn stored() -> StoredRun {
    StoredRun::load("lammps", "plane-shear-10k").unwrap()
}

/// A copy of the stored run that a test may damage.
fn copy() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(stored().directory()).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
    }
    folder
}

/// Replaces text in a file of the copy and, where `vouch` is set, the file's hash in the provenance with it.
fn edit(folder: &Path, name: &str, from: &str, to: &str, vouch: bool) {
    let path = folder.join(name);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from));
    let before = grainbench_reference::hash_file(&path).unwrap();
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
    if vouch {
        let after = grainbench_reference::hash_file(&path).unwrap();
        edit(folder, "provenance.toml", &before, &after, false);
    }
}

fn fault(folder: &Path) -> String {
    let shown = StoredRun::load_from(folder).unwrap_err().to_string();
    assert!(!shown.contains('\n'), "{shown}");
    shown.replace(&folder.display().to_string(), "RUN")
}

#[test]
fn every_file_is_vouched_for() {
    let run = stored();
    let there: BTreeSet<String> = fs::read_dir(run.directory())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name != "provenance.toml")
        .collect();
    let listed: BTreeSet<String> = run.provenance().blake3.keys().cloned().collect();
    assert_eq!(there, listed);
}

#[test]
fn the_first_row_is_the_kinetic_energy_of_the_packing() {
    let run = stored();
    let packing = read_data_file(&run.file("data.relaxed.gz").unwrap()).unwrap();
    let energy: f64 =
        packing.atoms.iter().map(|grain| 0.5 * grain.mass() * grain.velocity.iter().map(|v| v * v).sum::<f64>()).sum();
    for row in [run.thermo()[0], run.thermo_half_step()[0]] {
        assert_eq!(row.step, 0);
        assert!((row.kinetic_energy / energy - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_series_cover_the_run() {
    let run = stored();
    assert_eq!(run.thermo().len(), 21);
    let (last, twin) = (run.thermo()[20], run.thermo_half_step()[20]);
    assert_eq!((last.step, last.time), (2000, 0.2));
    assert_eq!((twin.step, twin.time), (4000, 0.2));
    assert!((last.kinetic_energy - 4_623.680_413_690).abs() < 1e-9);
}

#[test]
fn the_time_step_is_worth_little() {
    // Measured: 1.9e-5 at most, and 2.7e-5 between a half and a quarter of the step, so that it does not shrink with
    // the step; a factor five is left for another build of the program.
    let run = stored();
    for (row, twin) in run.thermo().iter().zip(run.thermo_half_step()) {
        let difference = (row.kinetic_energy - twin.kinetic_energy).abs();
        assert!(difference <= 1e-4 * row.kinetic_energy, "t = {}", row.time);
    }
}

#[test]
fn a_changed_file_is_named() {
    let folder = copy();
    edit(folder.path(), "in.lammps", "0.5 0", "0.4 0", false);
    let shown = fault(folder.path());
    assert!(shown.starts_with("RUN/in.lammps: expected the file with BLAKE3 "), "{shown}");
}

#[test]
fn a_missing_file_is_named() {
    let folder = copy();
    fs::remove_file(folder.path().join("thermo.csv")).unwrap();
    let shown = fault(folder.path());
    assert!(shown.starts_with("RUN/thermo.csv: expected a readable file, found "), "{shown}");
    fs::remove_file(folder.path().join("provenance.toml")).unwrap();
    let shown = fault(folder.path());
    assert!(shown.starts_with("RUN/provenance.toml: expected a readable file, found "), "{shown}");
}

#[test]
fn a_file_without_hash_is_not_used() {
    let folder = copy();
    edit(folder.path(), "provenance.toml", "\"thermo.csv\"", "# \"thermo.csv\"", false);
    assert_eq!(fault(folder.path()), "RUN/provenance.toml: expected the hash of `thermo.csv`, found none");
}

#[test]
fn a_provenance_that_leads_out_of_the_folder_is_refused() {
    let folder = copy();
    edit(folder.path(), "provenance.toml", "\"thermo.csv\"", "\"../thermo.csv\"", false);
    assert_eq!(
        fault(folder.path()),
        "RUN/provenance.toml: expected a plain name of letters, digits, `.`, `-` and `_`, found `../thermo.csv`"
    );
    for (program, id) in [("..", "lammps"), ("lammps", "a/b"), ("", "x"), ("/", "x")] {
        let refused = StoredRun::load(program, id);
        assert!(matches!(refused, Err(StoredError::Name { .. })));
    }
    assert!(matches!(StoredRun::load("lammps", "none"), Err(StoredError::Unreadable { .. })));
}

#[test]
fn a_damaged_provenance_is_placed() {
    let folder = copy();
    edit(folder.path(), "provenance.toml", "units", "unit", false);
    let shown = fault(folder.path());
    assert!(
        shown.starts_with("RUN/provenance.toml:4: expected the provenance of a stored run, found unknown field `unit`"),
        "{shown}"
    );
}

#[test]
fn a_damaged_series_is_placed() {
    let folder = copy();
    edit(folder.path(), "thermo.csv", "\n100,0.01,", "\n100,0.01,-", true);
    let shown = fault(folder.path());
    assert!(
        shown.starts_with("RUN/thermo.csv:3:10: expected a kinetic energy, a finite number from 0 on, found `-"),
        "{shown}"
    );
}

#[test]
fn a_twin_printed_at_other_times_is_refused() {
    let folder = copy();
    edit(folder.path(), "thermo-half-step.csv", "200,0.01,", "200,0.0101,", true);
    assert_eq!(
        fault(folder.path()),
        "RUN/thermo-half-step.csv: expected the times of `thermo.csv`, found 0.0101 where that has 0.01"
    );
}
