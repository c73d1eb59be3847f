//! A run continued from a checkpoint equals an uninterrupted run to the bit, for all cases and for a killed process.

use crate::common::{Directory, Folder, bits, files, interrupted, temporary, temporary_with, untimed};
use crate::observer::RunObserver;
use grainbench::cases::kept::{self, StorableRun};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::harness::case::Case;
use grainbench::harness::run::FinishedRun;
use grainbench::resume::{self, Place};
use grainbench::scene::scene::{Duration, Sampling, Scene};
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::RunOptions;
use grainbench::solver::record::{Cost, Record};
use grainbench::solver::resolution::Resolution;
use rayon::prelude::*;
use std::path::Path;
use std::process::Stdio;
use std::sync::Arc;

/// Returns the first part of a scene. Samples are seven steps apart.
fn begun(mut scene: Scene) -> Scene {
    let cycles = if scene.grains.len() > 1000 { 40 } else { 300 };
    scene.duration = Duration::Cycles(cycles);
    scene.sampling = Sampling::Cycles(7);
    scene.snapshots = 3;
    scene
}

/// Number of grains above which a scene is skipped. Its contact laws occur in smaller beds of the same case.
const MANY: usize = 20_000;

/// The scenes cover all features of the cases in each convention, such as moving walls, Hertz contacts and cohesion.
#[test]
fn every_case_continues_to_the_same_bits() {
    // At most twelve variants of a case are run.
    let variants = |case: &Case| -> Vec<Scene> {
        let names = case.variants().unwrap();
        names.iter().step_by(names.len().div_ceil(12)).map(|variant| case.variant(variant).unwrap()).collect()
    };
    let scenes: Vec<(&Case, Scene)> = CASES
        .iter()
        .flat_map(|case| variants(case).into_iter().map(move |scene| (*case, begun(scene))))
        .filter(|(_, scene)| scene.grains.len() <= MANY)
        .collect();
    let compare = |(case, scene): &(&Case, Scene)| {
        let mut compared = 0;
        for solver in solvers::all().into_iter().filter(|solver| solver.name().starts_with("dem")) {
            let resolution = Resolution::CriticalFraction(0.1);
            let mut observer = RunObserver::with_checkpoints(19, 1);
            let whole = match solver.run(scene, &resolution, &mut ()) {
                // Skips scenes with only deformable bodies, and scenes whose dashpots need a shorter time step.
                Err(RunError::Unsupported { .. } | RunError::Resolution { .. }) => continue,
                run => bits(run.unwrap()),
            };
            let watched = bits(solver.run(scene, &resolution, &mut observer).unwrap());
            assert!(whole == watched, "{}: {} is another run when checkpoints are taken", case.name, solver.name());
            let (first, last) = (observer.checkpoints.first().unwrap(), observer.checkpoints.last().unwrap());
            for checkpoint in [first, last] {
                let continued = bits(solver.run_from(scene, &resolution, Some(checkpoint), &mut ()).unwrap());
                assert!(whole == continued, "{}: {} from step {}", case.name, solver.name(), checkpoint.step());
                compared += 1;
            }
        }
        compared
    };
    let compared: u32 = scenes.par_iter().map(compare).sum();
    assert!(compared > 100, "{compared}");
}

/// A run that was interrupted twice gives the same stored files as an uninterrupted run, except for the run time.
#[test]
fn a_run_that_is_kept_goes_on_to_the_same_files() {
    let case = CASES.iter().find(|case| case.name == "impact-bed").unwrap();
    let claim = (case.claims)().into_iter().find(|claim| claim.runs[0].variant == "thousand").unwrap();
    let run = claim.runs[0].clone();
    let scene = case.variant(run.variant).unwrap();
    let solver = solvers::by_name(run.solver).unwrap();
    let wanted = StorableRun { case, claim, run: run.clone(), wrong: false, id: "thousand".to_owned() };
    let files = |record: Record| {
        assert!(record.cost.wall_seconds > 0.0);
        let record = Record { cost: Cost { wall_seconds: 1.0, ..record.cost }, ..record };
        let done = FinishedRun::new(Arc::new(scene.clone()), Arc::new(record));
        kept::files(&wanted, &done, &scene, ["commit", "2024-01-01"]).unwrap()
    };
    let straight = files(solver.run(&scene, &run.resolution, &mut ()).unwrap());

    let directory = temporary();
    let path = directory.join("run.checkpoint");
    let place = Place { path: &path, every: 300 };
    let go = |from: Option<&Checkpoint>, until: u64| {
        let mut watch = RunObserver {
            until: Some(until),
            ..RunObserver::new(RunOptions { end_state: true, ..RunOptions::DEFAULT })
        };
        let record = resume::run(solver.as_ref(), &scene, &run.resolution, from, place, &mut watch);
        assert!(record.is_err() || watch.end.is_some(), "the final state of a resumed run");
        record
    };
    let stored = || Checkpoint::from_bytes(&std::fs::read(&path).unwrap()).unwrap();
    let mut from = None;
    for until in [700, 1400] {
        let ended = go(from.as_ref(), until);
        assert!(matches!(ended, Err(RunError::Interrupted { .. })), "{ended:?}");
        from = Some(stored());
        assert!(from.as_ref().is_some_and(|from| from.step() <= until && from.step() + 300 >= until));
    }
    assert!(files(go(from.as_ref(), u64::MAX).unwrap()) == straight);

    // If another command wrote the checkpoint, the run time before it is unknown.
    let theirs = stored().with_output(b"snapshots".to_vec());
    assert!(go(Some(&theirs), u64::MAX).unwrap().cost.wall_seconds.is_nan());
    let mut other = scene.clone();
    other.gravity *= 2.0;
    let mut watch = RunObserver::default();
    let refused = resume::run(solver.as_ref(), &other, &run.resolution, Some(&theirs), place, &mut watch);
    assert!(matches!(refused, Err(RunError::Checkpoint(CheckpointError::OtherRun { .. }))), "{refused:?}");
}

/// Discs that bounce in a box. The run is long enough to be killed in the middle.
const LONG: &str = include_str!("../scenes/discs-in-a-box.toml");

/// Returns the names and texts of the output files of a run, without run times.
fn left(directory: &Path) -> Vec<(String, String)> {
    files(directory).into_iter().map(|name| (name.clone(), untimed(&directory.read(name)))).collect()
}

/// Grains with contact springs, and deformable grains.
#[test]
fn a_killed_run_continues_to_the_same_files() {
    killed_and_continued(LONG, "--solver dem", "20000");
    // The duration of a grid run cannot be given in cycles.
    let timed =
        LONG.replace("duration_cycles = 1_000_000", "duration = 1.0").replace("every_cycles = 100_000", "every = 0.05");
    killed_and_continued(&timed, "--solver mpm --cells 2 --points 2", "200");
}

/// If there are many snapshots, they are on disk, and the checkpoint contains only the names of their parts.
#[test]
fn a_killed_run_with_snapshots_on_disk_continues_to_the_same_files() {
    let many = LONG
        .replace("count = [3, 3]", "count = [30, 30]")
        .replace("[1.0, 0.0], normal = [-1.0", "[8.0, 0.0], normal = [-1.0")
        .replace("[0.0, 1.0], normal = [0.0, -1.0]", "[0.0, 8.0], normal = [0.0, -1.0]")
        .replace("duration_cycles = 1_000_000", "duration_cycles = 10_000")
        .replace("every_cycles = 100_000\nsnapshots = 2", "every_cycles = 1_000\nsnapshots = 100");
    let directory = killed_and_continued(&many, "--solver dem --write dump,vtk", "5000");
    let (checkpoint, parts) = (directory.join("run.checkpoint"), directory.join("run.checkpoint.parts"));
    let parts: Vec<_> = std::fs::read_dir(parts).unwrap().flatten().collect();
    assert!(!parts.is_empty());
    // Fifty snapshots of 900 discs would be about 15 MB.
    let bytes = std::fs::metadata(checkpoint).unwrap().len();
    assert!(bytes < 9 << 20, "{bytes}");
}

fn killed_and_continued(scene: &str, options: &str, every: &str) -> Folder {
    let path = temporary_with("scene.toml", scene);
    let simulate = format!("simulate scene.toml {options}");
    path.ok(format!("{simulate} --out straight"));

    let watched = format!("{simulate} --checkpoint run.checkpoint --checkpoint-every {every}");
    let mut victim = path.start(format!("{watched} --out killed"));
    while !path.join("run.checkpoint").exists() {
        assert!(victim.try_wait().unwrap().is_none(), "{options}: it ended before its first checkpoint");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    victim.kill().unwrap();
    victim.wait().unwrap();
    assert!(!path.join("killed").exists(), "{options}: nothing half-written");

    path.ok(format!("{watched} --restart run.checkpoint --out continued"));
    assert_eq!(left(&path.join("straight")), left(&path.join("continued")), "{options}");
    path
}

/// A checkpoint with a correct hash but wrong numbers is rejected before the run continues.
#[test]
fn a_checkpoint_with_wrong_numbers_is_refused() {
    let path = temporary();
    let scene = LONG.replace("1_000_000", "200").replace("100_000", "50");
    path.write("scene.toml", scene);
    path.ok("simulate scene.toml --solver dem --checkpoint kept --checkpoint-every 100 --out a");
    let whole = std::fs::read(path.join("kept")).unwrap();
    let head = whole.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    let body = &whole[head + 40..];
    // Computes length and hash for the changed numbers.
    let resealed = |body: &[u8]| {
        let hash = blake3::hash(body);
        [&whole[..head], &(body.len() as u64).to_le_bytes(), hash.as_bytes(), body].concat()
    };
    let restarted = |body: &[u8]| {
        path.write("other", resealed(body));
        path.run("simulate scene.toml --solver dem --restart other --out b")
    };
    assert_eq!(restarted(body).code, Some(0));
    let places = |number: f64| -> Vec<usize> {
        let bytes = number.to_le_bytes();
        (0..body.len() - 8).filter(|&at| body[at..at + 8] == bytes).collect()
    };
    // The radius of a grain is in the state, and in the snapshots of the record.
    let wrong = |at: usize| [(at, 0.7), (at, -0.1), (at, f64::NAN), (at - 8, f64::INFINITY)];
    let is_refused = |(at, wrong): (usize, f64)| {
        let mut other = body.to_vec();
        other[at..at + 8].copy_from_slice(&wrong.to_le_bytes());
        let answer = restarted(&other);
        answer.code != Some(0) && answer.err.contains("the checkpoint is damaged: it has ")
    };
    let refused = places(0.1).into_iter().filter(|&at| wrong(at).into_iter().all(is_refused)).count();
    assert_eq!(refused, 9);
}

/// A run that crashes leaves its time series, its snapshots, the state at the crash, and the reason.
#[test]
fn a_run_that_breaks_leaves_what_there_is() {
    let timed =
        LONG.replace("duration_cycles = 1_000_000", "duration = 3.0").replace("every_cycles = 100_000", "every = 0.01");
    let breaking = [
        "--solver dem --time-step-fraction 3 --allow-unstable",
        "--solver mpm --cells 2 --points 2 --courant 2.5 --allow-unstable",
        "--solver rigid --substeps 1 --set 'grains.all.velocity=[100.0, 50.0]'",
    ];
    for options in breaking {
        let path = temporary_with("scene.toml", &timed);
        let run = path.run(format!("simulate scene.toml --out out {options}"));
        assert_eq!(run.code, Some(1), "{options}: {}", run.err);
        assert!(run.err.contains("the incomplete output"), "{}", run.err);
        let broken = path.json("out/broken.json");
        assert!(run.err.contains(broken["error"].as_str().unwrap()), "{broken}");
        let dump = path.read("out/snapshots.dump");
        let last = dump.rsplit("ITEM: TIMESTEP\n").next().unwrap().lines().next().unwrap();
        assert_eq!(last, broken["step"].to_string(), "the state that broke is the last");
        assert!(!path.join("out/record.json").exists(), "it is no record of a run");
        path.run("report out").refused("the run did not finish");
    }
}

/// Memory does not depend on the number of snapshots. Rows that wait to be written and one checkpoint took 36 MB to 53 MB for
/// 10,000 discs (memory of the allocator included). A program that also kept 60 snapshots in memory took 170 MB more. The
/// limit lies between. The short test has 60 snapshots, and the long test has 1000.
#[test]
#[cfg(target_os = "linux")]
fn snapshots_and_checkpoints_take_no_memory() {
    let snapshots = if std::env::var_os("GRAINBENCH_LONG").is_some() { "1000" } else { "60" };
    let scene = |snapshots: &str| {
        LONG.replace("count = [3, 3]", "count = [100, 100]")
            .replace("[1.0, 0.0], normal = [-1.0", "[25.2, 0.0], normal = [-1.0")
            .replace("[0.0, 1.0], normal = [0.0, -1.0]", "[0.0, 25.2], normal = [0.0, -1.0]")
            .replace("duration_cycles = 1_000_000", "duration_cycles = 1_000")
            .replace("snapshots = 2", &format!("snapshots = {snapshots}"))
    };
    let path = temporary_with("none.toml", scene("0"));
    path.write("many.toml", scene(snapshots));
    let none = crate::common::peak_memory(&path, "simulate none.toml --solver dem --out none");
    let checkpoints = "--checkpoint run.checkpoint --checkpoint-every 50";
    let many = crate::common::peak_memory(&path, &format!("simulate many.toml --solver dem --out many {checkpoints}"));
    let most = none + 100_000;
    assert!(many < most, "{many} kB with {snapshots} snapshots, {none} kB without, at most {most} kB expected");
}

/// After Ctrl-C, the finished results are written, and a message reports the interrupt.
#[test]
#[cfg(target_os = "linux")]
fn an_interrupted_run_leaves_what_is_finished() {
    let directory = temporary();
    let child = directory.program("run --out out").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // The test waits until the process catches the signal. A run of the whole registry takes much longer than that.
    let catches = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap().trim().to_owned();
        u64::from_str_radix(&caught, 16).unwrap() & (1 << 1) != 0
    };
    while !catches() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let (code, message) = interrupted(child);
    assert!(code == Some(1) && message.contains("interrupted: "), "{message}");
    assert!(message.contains("the report contains the finished checks"), "{message}");
    let options = directory.json("out/results.json")["provenance"]["options"].to_string();
    assert!(options.contains("interrupted: "), "{options}");
}
