//! Cost and stability of a scene of the user's on the command line.

use crate::common::{Directory, interrupted, root, temporary, temporary_with};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, SystemTime};

/// Runs `cost` of a scene of the guide, and returns `results.json` and the stored runs with the times at which they were
/// written.
fn cost(directory: &Path) -> (Value, BTreeMap<PathBuf, SystemTime>) {
    let answer = directory.ok("cost drop.toml --solver dem --budget 5s --out out --json");
    let files = fs::read_dir(directory.join("out/runs")).unwrap().map(|entry| entry.unwrap().path());
    let runs = files.map(|path| (path.clone(), path.metadata().unwrap().modified().unwrap())).collect();
    (serde_json::from_str(&answer.out).unwrap(), runs)
}

/// The same command again reuses all runs, and finds the same values. A missing run is repeated.
#[test]
fn a_study_continues() {
    let folder = temporary();
    fs::copy(root("guide/scenes/drop.toml"), folder.join("drop.toml")).unwrap();
    let (first, runs) = cost(&folder);
    let (second, same) = cost(&folder);
    assert!(!runs.is_empty() && runs == same, "{runs:?}\n{same:?}");
    fs::remove_file(runs.keys().next().unwrap()).unwrap();
    assert_ne!(cost(&folder).1, runs);
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

/// A window compares means over this time: in free fall, the mean velocity from a to b is −g (a + b)/2. Negative controls: the
/// value at the end differs, and a window outside the run is an error.
#[test]
fn a_window_of_time_is_compared() {
    let folder = temporary();
    fs::copy(root("guide/scenes/drop.toml"), folder.join("drop.toml")).unwrap();
    let cost = |window: &str| {
        folder.run(format!("cost drop.toml --solver dem --budget 3s --quantity ball.vz --json --out out {window}"))
    };
    let estimate = |window: &str| {
        let results = cost(window).ok().json();
        let estimate = &results["scenes"][0]["quantities"][0]["estimates"][0];
        ["value", "uncertainty"].map(|key| estimate[key].as_f64().unwrap())
    };
    let mean = -9.81 * 0.06;
    let [value, uncertainty] = estimate("--window 0.02..0.1");
    assert!((value - mean).abs() <= uncertainty.max(1e-9), "{value} ± {uncertainty}, {mean}");
    let [end, _] = estimate("");
    assert!((end - mean).abs() > 0.1, "{end}");
    let outside = cost("--window 0.6..0.7");
    let expected = "--window: expected a window within 0..0.5, the duration of drop.toml, found 0.6..";
    outside.refused(expected);
}

/// Ctrl-C ends a study with exit code 1. The same command continues it with the finished runs.
#[test]
#[cfg(target_os = "linux")]
fn a_stopped_study_continues() {
    let folder = temporary();
    fs::copy(root("guide/scenes/heap.toml"), folder.join("heap.toml")).unwrap();
    for command in ["cost", "effects"] {
        let is_run = |entry: &fs::DirEntry| entry.path().extension().is_some_and(|ending| ending == "json");
        let runs = || {
            let files = fs::read_dir(folder.join(command).join("runs")).into_iter().flatten().flatten();
            files.filter(is_run).count()
        };
        let study = format!("{command} heap.toml --solver dem --out {command}");
        let mut child = folder.program(format!("{study} --budget 60s"));
        let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        while runs() < 2 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(20));
        }
        let (code, message) = interrupted(child);
        assert!(code == Some(1) && message.contains("stopped; the same command continues"), "{message}");
        let finished = runs();
        assert!(finished >= 2, "{finished}");
        let answer = folder.run(format!("{study} --budget 4s"));
        assert!(answer.code == Some(0) && runs() >= finished, "{command}: {}", answer.err);
    }
}

/// The effects of a folder without claims are those of its scene. The scale of a change is stated, and effects for which the
/// budget leaves no time are listed. A larger budget continues.
#[test]
fn effects_of_a_folder_continue_within_a_larger_budget() {
    let folder = temporary();
    fs::create_dir(folder.join("mine")).unwrap();
    fs::copy(root("guide/scenes/heap.toml"), folder.join("mine/scene.toml")).unwrap();
    let short = folder.run("effects mine --time-step-fraction 0.005 --budget 1s --out e");
    assert!(short.code == Some(1) && short.err.contains("expected a larger `--budget`"), "{}", short.err);
    let whole = folder.ok("effects mine --out e");
    let is_needed = |line: &str| line.contains(" gravity ") && line.contains(" needed ");
    assert!(whole.out.lines().any(is_needed) && whole.out.contains("needed: without the effect"), "{}", whole.out);
    // All effects are stored, so that no time is needed.
    let again = folder.run("effects mine --budget 1s --out e");
    assert_eq!((again.code, again.out), (Some(0), whole.out), "{}", again.err);
}

/// A rigid-body engine has no elastic energy: the row is unsupported, and is not compared.
#[test]
fn a_quantity_that_a_method_lacks_is_unsupported() {
    let folder = temporary();
    let scene = fs::read_to_string(root("guide/scenes/slope.toml")).unwrap();
    let scene = scene.replace("disc = { grain = \"disc\" }", "all = { system = true }");
    folder.write("s.toml", scene);
    let answer = folder.ok("cost s.toml --solver dem --solver rigid --budget 6s --quantity all.elastic_energy");
    let note = "rigid: unsupported, because its contacts are rigid: all.elastic_energy.";
    assert!(answer.out.contains(note) && !answer.out.contains("differ by"), "{}", answer.out);
}

/// One disc that oscillates on the spring of a floor: the exact limit is that of one mass on one spring.
#[test]
fn the_stable_step_of_a_scene_has_its_exact_limit() {
    let folder = temporary_with("s.toml", include_str!("../scenes/disc-on-a-spring.toml"));
    let answer = folder.ok("stability s.toml --solver dem --json");
    let results = answer.json();
    let limit = &results["stability"]["limits"][0];
    let [found, exact] = ["found", "exact"].map(|key| limit[key].as_f64().unwrap_or_else(|| panic!("{limit}")));
    assert!((exact - 1.0).abs() < 1e-6 && (found - 1.0).abs() < 0.03, "{limit}");
}

/// A variant without a target quantity: the error lists the variants with one. A variant beyond the first two works.
#[test]
fn each_variant_with_a_target_has_its_cost() {
    let folder = temporary();
    folder.ok("cost incline-disc/60deg-mu.9 --solver dem --out out");
}
