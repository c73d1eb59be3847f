//! Runs of the scene that the tables in `tests/refusals` edit: unchanged, with an unstable time step, and until it
//! becomes unstable.

use crate::common::{files, grainbench};

const SCENE: &str = include_str!("../scenes/two-discs.toml");

#[test]
fn the_scene_itself_is_fine() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let answer = grainbench(directory.path(), &["simulate", "scene.toml", "--solver", "dem", "--variant", "slippery"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
}

#[test]
fn step_above_the_critical_one_is_taken_when_it_is_meant() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments = [
        "simulate",
        "scene.toml",
        "--solver",
        "dem",
        "--time-step-fraction",
        "1.5",
        "--allow-unstable",
        "--out",
        "out",
    ];
    // Without contact in the first 10 ms, no spring can be unstable.
    let answer =
        grainbench(directory.path(), &[&arguments[..], &["--set", "grains.lower.position=[1.0, 0.5]"]].concat());
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    assert!(directory.path().join("out/record.json").is_file());
}

#[test]
fn a_run_that_blows_up_says_when_where_why_and_what_would_have_been_stable() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments =
        ["simulate", "scene.toml", "--solver", "dem", "--time-step-fraction", "0.9", "--out", "out", "--json"];
    let long = ["--set", "duration=100", "--set", "grains.upper.position=[0.0, 0.295]"];
    let answer = grainbench(directory.path(), &[&arguments[..], &long].concat());
    assert_eq!((answer.code, answer.out.as_str()), (Some(1), ""));
    // The run leaves incomplete output, but no record.
    let left = files(directory.path());
    assert!(left.contains(&"out/broken.json".to_owned()) && left.contains(&"out/series.csv".to_owned()), "{left:?}");
    assert!(!left.contains(&"out/record.json".to_owned()), "{left:?}");
    insta::assert_snapshot!(answer.err);
}
