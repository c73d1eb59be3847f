//! Runs of the scene that the tables in `tests/refusals` edit: unchanged, with an unstable time step, and until it
//! becomes unstable.

use crate::common::{Directory, files, temporary_with};

const SCENE: &str = include_str!("../scenes/two-discs.toml");

#[test]
fn the_scene_itself_is_fine() {
    let directory = temporary_with("scene.toml", SCENE);
    directory.run("simulate scene.toml --solver dem --variant slippery").quiet();
}

#[test]
fn step_above_the_critical_one_is_taken_when_it_is_meant() {
    let directory = temporary_with("scene.toml", SCENE);
    // Without contact in the first 10 ms, no spring can be unstable.
    directory.ok("simulate scene.toml --solver dem --time-step-fraction 1.5 --allow-unstable --out out \
         --set 'grains.lower.position=[1.0, 0.5]'");
    assert!(directory.join("out/record.json").is_file());
}

#[test]
fn a_run_that_blows_up_says_when_where_why_and_what_would_have_been_stable() {
    let directory = temporary_with("scene.toml", SCENE);
    let answer = directory.run(
        "simulate scene.toml --solver dem --time-step-fraction 0.9 --out out --json --set duration=100 \
         --set 'grains.upper.position=[0.0, 0.295]'",
    );
    assert_eq!((answer.code, answer.out.as_str()), (Some(1), ""));
    // The run leaves incomplete output, but no record.
    let left = files(&directory);
    assert!(left.contains(&"out/broken.json".to_owned()) && left.contains(&"out/series.csv".to_owned()), "{left:?}");
    assert!(!left.contains(&"out/record.json".to_owned()), "{left:?}");
    insta::assert_snapshot!(answer.err);
}
