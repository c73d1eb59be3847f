//! Tests of programs that are missing, fail, hang or write invalid output. Scripts replace the programs, so that none
//! need be installed.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use grainbench_reference::deck::Program;
use grainbench_reference::live::LiveProgram;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

/// Returns the scene of a disc in flight at 1 m/s, with three samples.
fn scene() -> Scene {
    let text = include_str!("../../tests/scenes/flight.toml");
    SceneSource::from_text("scene.toml", Path::new("."), text)
        .set("duration", "0.02")
        .set("grains.disc.velocity", "[1.0, 0.0]")
        .set("output.every", "0.01")
        .set("probes.disc.grain", "disc")
        .scene(&grainbench_scene::resolve::no_data_file)
        .unwrap()
}

/// Creates an executable script in a folder.
fn script(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("program");
    fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

fn run(text: &str) -> Result<Record, RunError> {
    run_within(60, text)
}

fn run_within(seconds: u64, text: &str) -> Result<Record, RunError> {
    let folder = tempfile::tempdir().unwrap();
    let live =
        LiveProgram::at(Program::LAMMPS, &script(folder.path(), text)).with_time_limit(Duration::from_secs(seconds));
    live.run(&scene(), &Resolution::TimeStep(0.01), &mut ())
}

#[test]
fn a_program_that_is_missing() {
    let live = LiveProgram::at(Program::LAMMPS, Path::new("no/such/program"));
    let error = live.run(&scene(), &Resolution::TimeStep(0.01), &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Program { failure: Failure::NotRun(_), .. }), "{error}");
}

#[test]
fn a_failed_program_shows_its_last_lines() {
    let error = run("echo one; echo two; echo 'ERROR: Lost atoms'; printf '\\377 bytes\\n' >&2; exit 3").unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, RunError::Program { failure: Failure::Crash(_), .. }), "{message}");
    assert_eq!(message, "lammps failed: exit status: 3; it said last: one | two | ERROR: Lost atoms | \u{fffd} bytes");
}

#[test]
fn a_program_that_hangs_is_ended() {
    let error = run_within(1, "echo working; exec sleep 60").unwrap_err();
    assert_eq!(error.to_string(), "lammps was not done after 1 s; it said last: working");
}

/// Returns a script that writes a complete run with three samples and a log. `x` is the position at the second sample.
fn whole(x: &str, steps: &str) -> String {
    format!(
        "for step in {steps}; do x=$step; [ $step = 1 ] && x={x}; printf \"ITEM: TIMESTEP\\n$step\\nITEM: NUMBER OF ATOMS\\n\
         1\\nITEM: BOX BOUNDS ff ff pp\\n0 1\\n0 1\\n0 1\\nITEM: ATOMS id x y vx vy omegaz\\n1 $x 0 1 0 0\\n\"; done \
         > dump.grains\nprintf 'LAMMPS (1 Jan 2030)\\nStep Time\\n0 0\\n\
         Loop time of 0.25 on 1 procs for 2 steps with 1 atoms\\n' > log.run"
    )
}

#[test]
fn a_program_that_does_its_run() {
    let record = run(&whole("1", "0 1 2")).unwrap();
    assert_eq!(record.series.column("disc.x").unwrap(), [0.0, 1.0, 2.0]);
    assert_eq!(record.series.time, [0.0, 0.01, 0.02]);
    assert!(record.series.column("disc.angle").is_none(), "no dump contains it");
    assert_eq!((record.cost.steps, record.cost.wall_seconds), (2, 0.25));
    assert_eq!(record.provenance.options, ["LAMMPS (1 Jan 2030)"]);
    // Quantities that the program does not write are absent, not zero.
    assert_eq!((record.cost.contact_evaluations, record.cost.pair_tests, record.cost.bytes), (None, None, None));
    let last = record.snapshots.last().unwrap();
    assert!(last.contacts.is_none() && last.walls.iter().all(|wall| wall.force.is_none()));
    assert!(last.grains[0].angle.is_none() && last.grains[0].force.is_none() && last.grains[0].torque.is_none());
    assert_eq!(record.snapshots.iter().map(|snapshot| snapshot.step).collect::<Vec<_>>(), [0, 2]);
}

/// Unreadable files, incomplete runs and runs with NaN are failures and are not evaluated.
#[test]
fn a_program_that_leaves_less_than_its_run() {
    for (script, message) in [
        ("echo nonsense > dump.grains", "dump.grains:1: expected a line `ITEM: …`, found `nonsense`"),
        (&*whole("1", "0 1"), "expected samples to step 2, found the last sample at step 1"),
        (&*whole("1", "0 2"), "expected a sample at step 1, found step 2"),
        (&*whole("nan", "0 1 2"), "expected finite numbers, found disc.x = NaN at step 1"),
    ] {
        let error = run(script).unwrap_err().to_string();
        assert!(error.ends_with(message), "{error}");
    }
}

/// A missing file is an error. A pipe is not read, and a program that fills the disk is ended.
#[test]
fn a_program_that_leaves_no_plain_file() {
    let rows: [(&str, &[&str]); 3] = [
        ("true", &["left output that cannot be used", "dump.grains"]),
        ("mkfifo dump.grains", &["dump.grains: expected a plain file, found something else"]),
        ("yes > dump.grains", &["MB for the samples of this scene, found more"]),
    ];
    for (script, parts) in rows {
        let error = run(script).unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
}

/// When a program is ended, its child processes end too. The guard shell ends them when the pipe to its standard input
/// closes.
#[test]
fn a_program_ends_with_all_that_it_started() {
    let folder = tempfile::tempdir().unwrap();
    let pid_file = folder.path().join("told");
    let text = format!("sleep 60 & echo $! > {}; wait", pid_file.display());
    assert!(run_within(1, &text).unwrap_err().to_string().contains("was not done after 1 s"));
    let child = fs::read_to_string(pid_file).unwrap();
    let is_there =
        || fs::read_to_string(format!("/proc/{}/stat", child.trim())).is_ok_and(|stat| !stat.contains(") Z"));
    (0..500).for_each(|_| {
        if is_there() {
            std::thread::sleep(Duration::from_millis(20));
        }
    });
    assert!(!is_there(), "process {child} goes on");
}
