//! Tests that a run continued from a checkpoint ends in the same bits as an uninterrupted run.

use crate::support::{collision, incline, scene};
use grainbench_mpm::solver::Mpm;
use grainbench_scene::sealed::SealError;
use grainbench_solver::Solver;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::{Observer, RunOptions};
use grainbench_solver::record::{Cost, Record};
use grainbench_solver::resolution::Resolution;

/// Observer that stores every checkpoint of a run, after conversion to and from bytes.
struct Keeper {
    every: u64,
    kept: Vec<Checkpoint>,
}

impl Observer for Keeper {
    fn options(&self) -> RunOptions {
        RunOptions { checkpoint_interval: Some(self.every), ..RunOptions::DEFAULT }
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.kept.push(Checkpoint::from_bytes(&checkpoint.to_bytes()?)?);
        Ok(())
    }
}

/// Returns a record with all bits, without wall time.
fn untimed(record: Record) -> String {
    format!("{:?}", Record { cost: Cost { wall_seconds: 0.0, ..record.cost }, ..record })
}

fn checkpoints(solver: Mpm, text: &str, at: &Resolution, every: u64) -> (String, Vec<Checkpoint>) {
    let mut keeper = Keeper { every, kept: Vec::new() };
    let whole = untimed(solver.run(&scene(text), at, &mut keeper).unwrap());
    (whole, keeper.kept)
}

/// A short run of a rolling sphere.
const SPHERE: &str = include_str!("../scenes/rolling-sphere.toml");

/// Returns a collision in which one disc is driven, with an energy budget.
fn driven() -> String {
    format!("{}budget.budget = true\n[driven.ram]\ngrains = 'a'\nvelocity = [0.05, 0.0]\n", collision(0.1, 0.9, 0.5))
}

/// The cases cover all kinds of contact with friction: between bodies, at a plane, after relaxation and in three
/// dimensions. Each restarts from an early and a late checkpoint.
#[test]
fn a_continued_run_leaves_the_same_bits() {
    let sampled = |text: String| format!("{text}[output]\nsnapshots = 3\n");
    let cases = [
        ("mpm", sampled(collision(0.1, 0.9, 0.5))),
        ("mpm:gap", sampled(collision(0.1, 0.9, 0.5))),
        ("mpm:2001", sampled(collision(0.1, 0.9, 0.5))),
        ("mpm:no-slip", sampled(collision(0.1, 0.9, 0.5))),
        ("mpm", sampled(incline(60.0, 0.9, 0.05, true))),
        ("mpm", sampled(SPHERE.to_owned())),
        ("mpm", sampled(driven())),
        ("mpm:no-slip", sampled(driven())),
    ];
    for (name, text) in cases {
        let (solver, at) = (Mpm::named(name).unwrap(), Resolution::grid(4.0, 2));
        let (whole, kept) = checkpoints(solver, &text, &at, 13);
        assert!(whole == untimed(solver.run(&scene(&text), &at, &mut ()).unwrap()), "{name}: another run when watched");
        for checkpoint in [kept.first().unwrap(), kept.last().unwrap()] {
            let continued = untimed(solver.run_from(&scene(&text), &at, Some(checkpoint), &mut ()).unwrap());
            assert!(whole == continued, "{name} from step {} is another run", checkpoint.step());
        }
    }
}

/// A restart with another scene, setting, resolution or solver is rejected, and the message names the difference. A
/// truncated checkpoint is rejected too.
#[test]
fn another_run_and_half_a_file_are_refused() {
    let (text, at) = (collision(0.1, 0.9, 0.5), Resolution::grid(4.0, 2));
    let (_, kept) = checkpoints(Mpm::BEST, &text, &at, 13);
    let refused =
        |solver: Mpm, text: &str, at: Resolution| match solver.run_from(&scene(text), &at, Some(&kept[0]), &mut ()) {
            Err(RunError::Checkpoint(error)) => error.to_string(),
            other => format!("{other:?}"),
        };
    let other_scene = refused(Mpm::BEST, &collision(0.1, 0.8, 0.5), at);
    assert!(other_scene.contains("another run") && other_scene.contains("fingerprint"), "{other_scene}");
    for message in [
        refused(Mpm::named("mpm:gap").unwrap(), &text, at),
        refused(Mpm::BEST.with(|setting| setting.penalty = 3.0), &text, at),
        refused(Mpm::BEST, &text, Resolution::grid(4.0, 3)),
    ] {
        assert!(message.contains("another run") && message.contains("solver"), "{message}");
    }
    let bytes = kept[0].to_bytes().unwrap();
    let cut = Checkpoint::from_bytes(&bytes[..bytes.len() / 2]);
    assert!(matches!(cut, Err(CheckpointError::NotSealed(SealError::Length(..)))));
}
