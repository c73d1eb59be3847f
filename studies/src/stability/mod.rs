//! What stays stable: the largest stable step, found by bisection on a typed failure, and hard cases.

pub mod assembly;
pub mod bisection;
pub mod failure;
pub mod hard;
pub mod limit;

use grainbench_cases::solvers;
use grainbench_reference::deck::Program;
use grainbench_reference::live::Live;
use grainbench_scene::solver::Solver;
use std::time::Duration;

/// How long another program may take: one whose grains have flown off may go on for hours.
const PATIENCE: Duration = Duration::from_secs(20);

/// The solver of a name.
fn solver(name: &str) -> Option<Box<dyn Solver>> {
    match Program::by_name(name) {
        Some(program) => Some(Box::new(Live::find(program).with_time_limit(PATIENCE))),
        None => solvers::by_name(name),
    }
}
