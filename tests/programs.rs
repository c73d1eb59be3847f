//! Rows of programs that are not installed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use serde_json::Value;
use std::process::Command;

#[test]
fn a_program_that_is_not_installed_is_amber_and_says_where_it_was_looked_for() {
    let directory = tempfile::tempdir().unwrap();
    let program = |arguments: &[&str]| {
        let command = Command::new(env!("CARGO_BIN_EXE_grainbench"))
            .args(arguments)
            .current_dir(directory.path())
            .env("GRAINBENCH_LAMMPS", "nowhere/lmp")
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (command.status.code(), text(command.stdout), text(command.stderr))
    };
    let (code, out, _) = program(&["run", "backspin/disc", "--solver", "lammps", "--live", "--json"]);
    assert_eq!(code, Some(1), "nothing was judged");
    let results: Value = serde_json::from_str(&out).unwrap();
    let rows = results["verdicts"].as_array().unwrap();
    assert!(!rows.is_empty() && rows.iter().all(|row| row["verdict"] == "not-available"), "{out}");
    assert!(results["controls"].as_array().unwrap().is_empty(), "what cannot be judged has no control");

    std::fs::write(directory.path().join("s.toml"), SCENE).unwrap();
    let (code, _, err) = program(&["simulate", "s.toml", "--solver", "lammps", "--time-step", "1e-3"]);
    assert_eq!(code, Some(2));
    assert_eq!(err, "error: lammps is not available: GRAINBENCH_LAMMPS names `nowhere/lmp`, where no file is\n");
}

#[test]
fn a_time_limit_that_is_no_time_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("s.toml"), SCENE).unwrap();
    let command = Command::new(env!("CARGO_BIN_EXE_grainbench"))
        .args(["simulate", "s.toml", "--solver", "lammps", "--time-step", "1e-3"])
        .current_dir(directory.path())
        .env("GRAINBENCH_TIME_LIMIT", "2s")
        .output()
        .unwrap();
    assert_eq!(command.status.code(), Some(2));
    let said = String::from_utf8(command.stderr).unwrap();
    let reason = "GRAINBENCH_TIME_LIMIT: expected a whole number of seconds, found `2s`";
    assert_eq!(said, format!("error: lammps is not available: {reason}\n"));
}

const SCENE: &str = r#"title = "A disc in flight"
dimension = 2
duration = 0.01

[materials.rock]
density = 1000.0

[contacts.rock]
between = ["rock", "rock"]
normal_stiffness = 1e6

[grains.disc]
material = "rock"
radius = 0.5
position = [0.0, 0.0]
"#;
