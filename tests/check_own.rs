//! `check` on runs with numbers of the user's own: a scene that is no case, a case at other numbers, VTK's files, a folder of
//! many.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::grainbench;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A run of LIGGGHTS whose deck was written by hand.
fn slope() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", "check", "liggghts-slope"].iter().collect()
}

fn file(name: &str) -> String {
    slope().join(name).display().to_string()
}

/// The VTK files of the run, with those of its box, as a shell's pattern gives them.
fn vtk() -> Vec<String> {
    let mut files: Vec<String> = fs::read_dir(slope())
        .unwrap()
        .map(|entry| entry.unwrap().path().display().to_string())
        .filter(|path| path.ends_with(".vtk"))
        .collect();
    files.sort();
    files
}

/// The numbers of the run, laid over the case of a sphere on a slope.
const NUMBERS: [&str; 11] = [
    "gravity={magnitude=9.81,slope_deg=30}",
    "duration=.5",
    "materials.rock={density=2500,young_modulus=5e6,poisson_ratio=.3}",
    "materials.rock.bulk_modulus=",
    "materials.rock.shear_modulus=",
    "contacts.plane={law=\"hertz\",friction=.5,restitution=.5}",
    "contacts.plane.normal_stiffness=",
    "contacts.plane.tangential_stiffness=",
    "contacts.plane.normal_damping=",
    "contacts.plane.tangential_damping=",
    "grains.sphere={radius=.005,position=[0,0,.005]}",
];

/// Exit code and rows.
fn judged(words: &[&str]) -> (Option<i32>, Vec<Value>) {
    let directory = tempfile::tempdir().unwrap();
    let answer = grainbench(directory.path(), &[&["check"], words, &["--json"]].concat());
    let results: Value = serde_json::from_str(&answer.out).unwrap_or_else(|_| panic!("{}{}", answer.out, answer.err));
    (answer.code, results["verdicts"].as_array().unwrap().clone())
}

/// The same at the numbers of the run, some of them others.
fn at_numbers(files: &[&str], others: &[&str]) -> (Option<i32>, Vec<Value>) {
    let set = NUMBERS.iter().chain(others).flat_map(|set| ["--set", set]);
    let words = [&["incline-sphere/45deg-mu.495"], &set.collect::<Vec<_>>()[..], &["--dump"], files].concat();
    judged(&words)
}

fn count(rows: &[Value], of: impl Fn(&Value) -> bool) -> usize {
    rows.iter().filter(|row| of(row)).count()
}

/// A deck that nobody generated, from its dump and from its VTK files: the time step is in the log beside them.
#[test]
fn a_scene_of_ones_own_is_compared_with_our_solvers() {
    let dump = file("sphere.dump");
    let vtk = vtk();
    assert!(vtk.iter().any(|path| path.contains("boundingBox")) || vtk.len() == 11);
    for files in [vec![dump.as_str()], vtk.iter().map(String::as_str).collect()] {
        let scene = file("slope.toml");
        let (code, rows) = judged(&[&[&scene, "--dump"], &files[..]].concat());
        let nearest = |row: &Value| row["source"].as_str().is_some_and(|source| source.starts_with("dem:liggghts"));
        assert_eq!((code, count(&rows, |row| row["verdict"] == "pass")), (Some(0), rows.len()), "{rows:#?}");
        assert!(count(&rows, nearest) >= 9, "{rows:#?}");
        assert_eq!(rows[0]["case"], "slope");
    }
}

/// Exact answers follow the scene, and their tolerances with it; another slope or another shape is red.
#[test]
fn exact_answers_follow_other_numbers() {
    let dump = file("sphere.dump");
    let is_exact = |row: &Value| row["evidence"] == "analytic";
    for files in [vec![dump.as_str()], vtk().iter().map(String::as_str).collect()] {
        let (code, rows) = at_numbers(&files, &[]);
        assert_eq!((code, count(&rows, is_exact)), (Some(0), 3), "{rows:#?}");
        // v = (5/7) g t sin θ at half a second, and Hertz's overlap over the radius beside what the spring rings with.
        let velocity = rows.iter().find(|row| row["quantity"] == "velocity at the end").unwrap();
        let expected = 5.0 / 7.0 * 9.81 * 0.5 * 0.5;
        assert!((velocity["expected"].as_f64().unwrap() - expected).abs() < 1e-12 * expected, "{velocity}");
        let overlap = (0.75 * 4.0 / 3.0 * std::f64::consts::PI * 0.005_f64.powi(3) * 2500.0 * 9.81 * 0.75_f64.sqrt()
            / (5e6 / (2.0 * (1.0 - 0.09)) * 0.005_f64.sqrt()))
        .powf(2.0 / 3.0);
        let allowed = velocity["allowed"].as_f64().unwrap();
        assert!(allowed > overlap / 0.005 && allowed < 1.3 * overlap / 0.005, "{allowed:e} {:e}", overlap / 0.005);
    }
    for wrong in ["gravity.slope_deg=30.5", "grains.sphere.radius=.0049", "gravity.magnitude=9.7"] {
        let set = [wrong, "grains.sphere.position=[0,0,.005]"];
        let (code, rows) = at_numbers(&[&dump], &set);
        let red = count(&rows, |row| is_exact(row) && row["verdict"] == "fail");
        assert!(code == Some(1) && red >= 1, "{wrong}: {rows:#?}");
    }
}

/// A folder with a folder for each case and variant is judged in one go; what is in none of them is said.
#[test]
fn a_folder_of_outputs_is_judged_together() {
    let directory = tempfile::tempdir().unwrap();
    let into = |place: &str, name: &str| {
        let folder = directory.path().join("runs").join(place);
        fs::create_dir_all(&folder).unwrap();
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/check").join(name);
        fs::copy(from, folder.join(name)).unwrap();
    };
    into("incline-disc/60deg-mu.9", "lammps-incline.dump.gz");
    into("backspin/sphere", "liggghts-backspin.dump.gz");
    let log = "liggghts-backspin.log";
    into("backspin/sphere", log);
    let folder = directory.path().join("runs/backspin/sphere");
    fs::rename(folder.join(log), folder.join("log.liggghts")).unwrap();
    let runs = directory.path().join("runs").display().to_string();
    let (code, rows) = judged(&["--all", &runs]);
    let of = |case: &str| count(&rows, |row| row["case"] == case && row["verdict"] == "pass");
    assert!(code == Some(0) && of("incline-disc") == 9 && of("backspin") > 5, "{rows:#?}");
    into("incline-disc/60deg-mu.9", "lammps-incline-half-friction.dump.gz");
    fs::remove_file(directory.path().join("runs/incline-disc/60deg-mu.9/lammps-incline.dump.gz")).unwrap();
    assert_eq!(judged(&["--all", &runs]).0, Some(1));
    let refused = |folder: &Path, said: &str| {
        let answer = grainbench(directory.path(), &["check", "--all", &folder.display().to_string()]);
        assert!(answer.code == Some(2) && answer.err.contains(said), "{}", answer.err);
    };
    refused(&directory.path().join("nowhere"), "expected a folder that can be read");
    fs::create_dir(directory.path().join("empty")).unwrap();
    refused(&directory.path().join("empty"), "expected outputs in `CASE` or `CASE/VARIANT` of it, found none");
    into("backspinn", "liggghts-backspin.dump.gz");
    refused(&directory.path().join("runs"), "did you mean `backspin`?");
}

/// What cannot be told is refused with the reason.
#[test]
fn files_that_do_not_tell_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let refused = |name: &str, bytes: &[u8], said: &str| {
        let path = directory.path().join(name);
        fs::write(&path, bytes).unwrap();
        let answer = grainbench(
            directory.path(),
            &["check", &file("slope.toml"), "--dt", "2e-6", "--dump", &path.display().to_string()],
        );
        assert!(answer.code == Some(2) && answer.err.contains(said), "{name}: {}", answer.err);
        assert_eq!(answer.err.lines().count(), 1);
    };
    let whole = fs::read(slope().join("sphere_0.vtk")).unwrap();
    refused("sphere.vtk", &whole, "expected the step in the file's name, as in `dump_5000.vtk`, found `sphere`");
    refused("cut_5.vtk", &whole[..whole.len() / 2], "cut_5.vtk:");
    refused("empty_5.vtk", b"", "empty_5.vtk:1: expected a dump");
    refused(
        "other_5.vtk",
        b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\n",
        "other_5.vtk:4: expected",
    );
    refused(
        "list.pvd",
        b"<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection></Collection></VTKFile>",
        "at least one file",
    );
}
