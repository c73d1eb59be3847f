//! The registry of solvers: a line each.

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_rigid::solver::Rigid;
use grainbench_scene::solver::Solver;

/// Every solver, by name.
#[must_use]
pub fn all() -> Vec<Box<dyn Solver>> {
    let dem = Convention::ALL.into_iter().map(|convention| Box::new(Dem::new(convention)) as Box<dyn Solver>);
    dem.chain([Box::new(Rigid::new()) as Box<dyn Solver>]).collect()
}

/// The solver of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    all().into_iter().find(|solver| solver.name() == name)
}
