//! The registry of solvers: a line each.

use crate::varied;
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_mpm::solver::Mpm;
use grainbench_reference::deck::Program;
use grainbench_reference::live::Live;
use grainbench_rigid::solver::Rigid;
use grainbench_scene::solver::Solver;

/// Every solver of ours.
#[must_use]
pub fn all() -> Vec<Box<dyn Solver>> {
    let dem = Convention::ALL.into_iter().map(|convention| Box::new(Dem::new(convention)) as Box<dyn Solver>);
    let mpm = Mpm::ALL.into_iter().map(|setting| Box::new(setting) as Box<dyn Solver>);
    dem.chain([Box::new(Rigid::new()) as Box<dyn Solver>]).chain(mpm).collect()
}

/// Other people's programs, whether or not they are installed.
#[must_use]
pub fn programs() -> Vec<Box<dyn Solver>> {
    Program::ALL.into_iter().map(|program| Box::new(Live::find(program)) as Box<dyn Solver>).collect()
}

/// The names of all of them.
#[must_use]
pub fn names() -> Vec<String> {
    all().iter().chain(&programs()).map(|solver| solver.name()).collect()
}

/// The solver of a name. The material point method may be given words that change its setting, such as
/// `mpm+quadratic+apic`.
#[must_use]
pub fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    all().into_iter().chain(programs()).find(|solver| solver.name() == name).or_else(|| varied::by_name(name))
}

/// Whether a name is that of another program.
#[must_use]
pub fn is_program(name: &str) -> bool {
    Program::by_name(name).is_some()
}
