//! Restart equals straight run, in every bit: of every case's scene, and of a process that was killed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{files, grainbench};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::harness::case::Case;
use grainbench::scene::checkpoint::{Checkpoint, CheckpointError};
use grainbench::scene::record::{Cost, Record};
use grainbench::scene::scene::{Duration, Sampling, Scene};
use grainbench::scene::solver::{Resolution, RunError, Watch};
use std::path::Path;
use std::process::{Command, Stdio};

/// Keeps every checkpoint of a run.
struct Keeper {
    every: u64,
    kept: Vec<Checkpoint>,
}

impl Watch for Keeper {
    fn progress(&mut self, _done: u64, _total: u64) {}
    fn checkpoint_interval(&self) -> Option<u64> {
        Some(self.every)
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.kept.push(Checkpoint::from_bytes(&checkpoint.to_bytes()?)?);
        Ok(())
    }
}

/// A record without its times, in every bit.
fn untimed(record: Record) -> String {
    format!("{:?}", Record { cost: Cost { wall_seconds: 0.0, ..record.cost }, ..record })
}

/// The beginning of a scene, with samples at odd places.
fn begun(mut scene: Scene) -> Scene {
    let cycles = if scene.grains.len() > 1000 { 40 } else { 300 };
    scene.duration = Duration::Cycles(cycles);
    scene.sampling = Sampling::Cycles(7);
    scene.snapshots = 3;
    scene
}

/// Moving walls, periodic faces, Hertz, rolling resistance, cohesion, spheres: whatever the cases hold, in every
/// convention.
#[test]
fn every_case_continues_to_the_same_bits() {
    let mut compared = 0;
    // Of many packings by one law, some.
    let variants = |case: &Case| -> Vec<Scene> {
        let names = case.variants().unwrap();
        names.iter().step_by(names.len().div_ceil(12)).map(|variant| case.variant(variant).unwrap()).collect()
    };
    for (case, scene) in CASES.iter().flat_map(|case| variants(case).into_iter().map(move |scene| (case, scene))) {
        let scene = begun(scene);
        for solver in solvers::all().into_iter().filter(|solver| solver.name().starts_with("dem")) {
            let resolution = Resolution::CriticalFraction(0.1);
            let mut keeper = Keeper { every: 19, kept: Vec::new() };
            let whole = match solver.run(&scene, &resolution, &mut ()) {
                // Scenes of deformable bodies alone.
                Err(RunError::Unsupported { .. }) => continue,
                run => untimed(run.unwrap()),
            };
            let watched = untimed(solver.run(&scene, &resolution, &mut keeper).unwrap());
            assert!(whole == watched, "{}: {} is another run when checkpoints are taken", case.name, solver.name());
            let (first, last) = (keeper.kept.first().unwrap(), keeper.kept.last().unwrap());
            for checkpoint in [first, last] {
                let continued = untimed(solver.restart(&scene, &resolution, checkpoint, &mut ()).unwrap());
                assert!(whole == continued, "{}: {} from step {}", case.name, solver.name(), checkpoint.step());
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Discs that rattle in a box for long enough to be killed in the middle.
const LONG: &str = r#"title = "Discs in a box"
dimension = 2
duration_cycles = 1_000_000
gravity = [0.0, -9.8]
materials.rock = { density = 1000.0, bulk_modulus = 1e6, shear_modulus = 5e5 }

[contacts.rock]
between = ["rock", "rock"]
normal_stiffness = 1e6
tangential_stiffness = 5e5
friction = 0.4

[grains.all]
material = "rock"
radius = 0.1
velocity = [1.0, 0.3]
lattice = { origin = [0.15, 0.15], spacing = [0.25, 0.25], count = [3, 3] }

[walls]
left = { material = "rock", plane = { point = [0.0, 0.0], normal = [1.0, 0.0] } }
right = { material = "rock", plane = { point = [1.0, 0.0], normal = [-1.0, 0.0] } }
floor = { material = "rock", plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
lid = { material = "rock", plane = { point = [0.0, 1.0], normal = [0.0, -1.0] } }

[output]
every_cycles = 100_000
snapshots = 2
[probes]
all = { system = true }
"#;

/// What a run left, but for the times in it.
fn left(directory: &Path) -> Vec<(String, String)> {
    let text = |name: &String| {
        let text = std::fs::read_to_string(directory.join(name)).unwrap();
        let mut parts = text.split("\"wall_seconds\":");
        let first = parts.next().unwrap_or_default().to_owned();
        let is_number = |letter: char| letter.is_ascii_digit() || "+-.e".contains(letter);
        parts.fold(first, |all, part| all + part.trim_start_matches(is_number))
    };
    files(directory).iter().map(|name| (name.clone(), text(name))).collect()
}

/// Grains on springs, and grains that deform.
#[test]
fn a_killed_run_continues_to_the_same_files() {
    killed_and_continued(LONG, &["--solver", "dem"], "20000");
    // A grid knows no cycles of another method.
    let timed =
        LONG.replace("duration_cycles = 1_000_000", "duration = 1.0").replace("every_cycles = 100_000", "every = 0.05");
    killed_and_continued(&timed, &["--solver", "mpm", "--cells", "2", "--points", "2"], "200");
}

fn killed_and_continued(scene: &str, options: &[&str], every: &str) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    std::fs::write(path.join("scene.toml"), scene).unwrap();
    let simulate = [&["simulate", "scene.toml"], options].concat();
    let straight = grainbench(path, &[&simulate[..], &["--out", "straight"]].concat());
    assert_eq!(straight.code, Some(0), "{}", straight.err);

    let checkpoints = ["--checkpoint", "run.checkpoint", "--checkpoint-every", every];
    let mut victim = Command::new(env!("CARGO_BIN_EXE_grainbench"))
        .current_dir(path)
        .args(simulate.iter().chain(&checkpoints).chain(&["--out", "killed"]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !path.join("run.checkpoint").exists() {
        assert!(victim.try_wait().unwrap().is_none(), "{options:?}: it ended before its first checkpoint");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    victim.kill().unwrap();
    victim.wait().unwrap();
    assert!(!path.join("killed").exists(), "{options:?}: nothing half-written");

    let restart = ["--restart", "run.checkpoint", "--out", "continued"];
    let continued = grainbench(path, &[&simulate[..], &checkpoints, &restart].concat());
    assert_eq!(continued.code, Some(0), "{}", continued.err);
    assert_eq!(left(&path.join("straight")), left(&path.join("continued")), "{options:?}");
}

/// Ctrl-C leaves what is finished, and says so.
#[test]
#[cfg(target_os = "linux")]
fn an_interrupted_run_leaves_what_is_finished() {
    let directory = tempfile::tempdir().unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_grainbench"))
        .args(["run", "--out", "out"])
        .current_dir(directory.path())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It listens once it catches the signal; the registry takes far longer than that.
    let catches = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap().trim().to_owned();
        u64::from_str_radix(&caught, 16).unwrap() & (1 << 1) != 0
    };
    while !catches() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let ended = child.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.contains("interrupted: ") && said.contains("the report holds what was finished"), "{said}");
    let results = std::fs::read_to_string(directory.path().join("out/results.json")).unwrap();
    let results: serde_json::Value = serde_json::from_str(&results).unwrap();
    let options = results["provenance"]["options"].to_string();
    assert!(options.contains("interrupted: "), "{options}");
}
