//! Cost and stability of a scene of the user's on the command line.

use crate::common::{grainbench, root};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Runs `cost` of a scene of the guide, and returns `results.json` and the stored runs with the times at which they were
/// written.
fn cost(directory: &Path) -> (Value, BTreeMap<PathBuf, SystemTime>) {
    let arguments = ["cost", "drop.toml", "--solver", "dem", "--budget", "5s", "--out", "out", "--json"];
    let answer = grainbench(directory, &arguments);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    let files = fs::read_dir(directory.join("out/runs")).unwrap().map(|entry| entry.unwrap().path());
    let runs = files.map(|path| (path.clone(), path.metadata().unwrap().modified().unwrap())).collect();
    (serde_json::from_str(&answer.out).unwrap(), runs)
}

/// The same command again reuses all runs, and finds the same values. A missing run is repeated.
#[test]
fn a_study_continues() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(root("guide/scenes/drop.toml"), folder.path().join("drop.toml")).unwrap();
    let (first, runs) = cost(folder.path());
    let (second, same) = cost(folder.path());
    assert!(!runs.is_empty() && runs == same, "{runs:?}\n{same:?}");
    fs::remove_file(runs.keys().next().unwrap()).unwrap();
    assert_ne!(cost(folder.path()).1, runs);
    let estimates = |results: &Value| -> Vec<Value> {
        let quantities = results["scenes"][0]["quantities"].as_array().unwrap().clone();
        quantities.into_iter().map(|quantity| quantity["estimates"].clone()).collect()
    };
    assert_eq!(estimates(&first), estimates(&second));
    // Each row is an estimate, without a verdict.
    let rows = estimates(&first).into_iter().flat_map(|rows| rows.as_array().unwrap().clone());
    let rows: Vec<Value> = rows.collect();
    assert!(!rows.is_empty() && rows.iter().all(|row| row["evidence"] == "convergence"), "{rows:?}");
    assert_eq!(first["verdicts"], Value::Array(Vec::new()));
}

/// One disc that oscillates on the spring of a floor: the exact limit is that of one mass on one spring.
#[test]
fn the_stable_step_of_a_scene_has_its_exact_limit() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "title = 't'\ndimension = 2\ngravity = [0.0, -9.81]\nduration = 1.0\nmaterials.m.density = 1000.0\n[contacts.m]\n\
         between = ['m', 'm']\nnormal_stiffness = 1.0e6\n[grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.0999]\n\
         [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n[probes]\na = { grain = 'a' }\n";
    fs::write(folder.path().join("s.toml"), scene).unwrap();
    let answer = grainbench(folder.path(), &["stability", "s.toml", "--solver", "dem", "--json"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    let results: Value = serde_json::from_str(&answer.out).unwrap();
    let limit = &results["stability"]["limits"][0];
    let [found, exact] = ["found", "exact"].map(|key| limit[key].as_f64().unwrap_or_else(|| panic!("{limit}")));
    assert!((exact - 1.0).abs() < 1e-6 && (found - 1.0).abs() < 0.03, "{limit}");
}

/// A variant without a target quantity: the error lists the variants with one. A variant beyond the first two works.
#[test]
fn each_variant_with_a_target_has_its_cost() {
    let folder = tempfile::tempdir().unwrap();
    let answer = grainbench(folder.path(), &["cost", "incline-disc/60deg-mu.9", "--solver", "dem", "--out", "out"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
}
