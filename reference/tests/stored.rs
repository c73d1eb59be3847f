//! Tests that stored runs are unchanged and that any change of their files is reported.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::io::Read as _;
use std::path::Path;

use flate2::read::GzDecoder;
use grainbench_reference::deck::Program;
use grainbench_reference::stored::{StoredRun, compressed, drift, folder};
use grainbench_solver::record::{Column, Series};
use grainbench_store::key::of_file;
use tempfile::TempDir;

const ID: &str = "oblique-impact-damped";

/// Returns a copy of a stored run that a test can damage.
fn copy() -> TempDir {
    let copy = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(folder(Program::LAMMPS, ID)).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, copy.path().join(path.file_name().unwrap())).unwrap();
    }
    copy
}

/// Replaces the text `from` by `to` in a file of the copy. If `vouch` is true, the hash of the file in the provenance
/// is updated.
fn edit(folder: &Path, name: &str, from: &str, to: &str, vouch: bool) {
    let path = folder.join(name);
    let before = of_file(&path);
    let bytes = fs::read(&path).unwrap();
    let mut text = String::new();
    if name.ends_with(".gz") {
        GzDecoder::new(&bytes[..]).read_to_string(&mut text).unwrap();
    } else {
        text = String::from_utf8(bytes).unwrap();
    }
    assert!(text.contains(from), "{text}");
    let text = text.replacen(from, to, 1);
    fs::write(&path, if name.ends_with(".gz") { compressed(&text) } else { text.into_bytes() }).unwrap();
    if vouch {
        edit(folder, "provenance.toml", &before, &of_file(&path), false);
    }
}

fn fault(folder: &Path) -> String {
    let shown = StoredRun::load(folder).unwrap_err().to_string();
    assert!(!shown.contains('\n'), "{shown}");
    shown.replace(&folder.display().to_string(), "RUN")
}

/// All stored runs of both programs are tested.
#[test]
fn every_run_loads_and_every_file_is_vouched_for() {
    let mut count = 0;
    for program in Program::ALL {
        for entry in fs::read_dir(folder(program, "")).unwrap() {
            let run = StoredRun::load(&entry.unwrap().path()).unwrap();
            let there: BTreeSet<String> = fs::read_dir(&run.directory)
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .filter(|name| name != "provenance.toml")
                .collect();
            let listed: BTreeSet<String> = run.provenance.blake3.keys().cloned().collect();
            assert_eq!(there, listed);
            assert_eq!(run.provenance.program, program.to_string());
            assert!(run.provenance.version.contains(&run.provenance.program), "{}", run.provenance.version);
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

/// Each inconsistent file is named, with its line if it is known. An edited series has its new hash in the provenance.
#[test]
fn an_edited_file_is_named() {
    // A file, a part and its replacement, and the message, or its beginning before `…`.
    let edits = [
        ("in.lammps", "0.5 1", "0.4 1", "in.lammps: expected the file with BLAKE3 …"),
        (
            "provenance.toml",
            "\"series.csv.gz\"",
            "# \"series.csv.gz\"",
            "provenance.toml: expected the hash of `series.csv.gz`, found none",
        ),
        (
            "provenance.toml",
            "\"series.csv.gz\"",
            "\"../series.csv.gz\"",
            "provenance.toml: expected a plain name of letters, digits, `.`, `-` and `_`, found `../series.csv.gz`",
        ),
        ("provenance.toml", "title", "titel", "provenance.toml:4: expected one of the keys program, version, …"),
        ("series.csv.gz", ",grain.x,", ",grain.x,grain.x,", "series.csv.gz:1: expected columns with different names…"),
        ("series.csv.gz", "step,", "steps,", "series.csv.gz: expected a column `step`, found none"),
        (
            "series-half-step.csv.gz",
            "\n20,0.0002,",
            "\n20,0.00021,",
            "series-half-step.csv.gz: expected the times of `series.csv.gz`, found 0.00021 instead of 0.0002",
        ),
    ];
    for (file, from, to, message) in edits {
        let folder = copy();
        edit(folder.path(), file, from, to, file.ends_with(".gz"));
        let (shown, message) = (fault(folder.path()), format!("RUN/{message}"));
        let matches = message.strip_suffix('…').map_or(shown == message, |start| shown.starts_with(start));
        assert!(matches, "{shown}\n{message}");
    }
}

#[test]
fn a_missing_file_is_named() {
    let folder = copy();
    fs::remove_file(folder.path().join("series.csv.gz")).unwrap();
    let shown = fault(folder.path());
    assert!(shown.starts_with("RUN/series.csv.gz: expected a readable file, found "), "{shown}");
    fs::remove_file(folder.path().join("provenance.toml")).unwrap();
    let shown = fault(folder.path());
    assert!(shown.starts_with("RUN/provenance.toml: expected a readable file, found "), "{shown}");
}

/// Each file of a stored run is emptied, truncated, and changed in one bit. The error names it.
#[test]
fn a_damaged_file_is_named() {
    let folder = copy();
    let paths = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    assert!(paths.len() > 3, "{paths:?}");
    for path in paths {
        let (whole, name) = (fs::read(&path).unwrap(), path.file_name().unwrap().to_string_lossy().into_owned());
        let mut flipped = whole.clone();
        flipped[whole.len() / 2] ^= 0x80;
        for damaged in [&[], &whole[..whole.len() / 2], &flipped] {
            fs::write(&path, damaged).unwrap();
            let shown = fault(folder.path());
            assert!(shown.starts_with(&format!("RUN/{name}:")) && shown.contains("expected "), "{shown}");
        }
        fs::write(&path, whole).unwrap();
        StoredRun::load(folder.path()).unwrap();
    }
}

#[test]
fn drift_is_measured_in_units_of_what_moves() {
    let series = |values: [f64; 3]| Series {
        step: vec![0, 10, 20],
        time: vec![0.0, 1.0, 2.0],
        columns: vec![Column { name: "a.x".to_owned(), unit: "m".to_owned() }],
        values: vec![values.to_vec()],
    };
    let stored = series([100.0, 101.0, 104.0]);
    let drift_of = |rerun: &Series, last| drift(&stored, rerun, last)[0].clone();
    assert_eq!(drift_of(&stored, u64::MAX).error(), 0.0);
    let found = drift_of(&series([100.0, 101.0, 104.4]), u64::MAX);
    assert!((found.error() - 0.1).abs() < 1e-12 && found.time == 2.0, "{found:?}");
    assert_eq!(drift_of(&series([100.0, 101.0, 104.4]), 10).error(), 0.0);
    let short = Series { step: vec![0, 10, 30], ..series([100.0, 101.0, 104.0]) };
    assert!(drift_of(&short, u64::MAX).error().is_nan());
    assert!(drift_of(&series([100.0, f64::NAN, 104.0]), u64::MAX).error().is_nan());
}
