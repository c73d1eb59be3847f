//! Simulations for tests in this crate.

use crate::options::Setting;
use crate::simulation::Simulation;
use crate::solver::{Mpm, Plan};
use grainbench_scene::scene::Scene;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::space::Space;

/// Returns a simulation of a scene before its first step, and the number of steps of the run.
pub(crate) fn prepared<S: Space>(setting: Setting, text: &str, cells: f64, points: u32) -> (Simulation<S>, u64) {
    let scene = Scene::from_text("test", &format!("title = 'test'\n{text}")).expect("the scene is right");
    let solver = Mpm { setting, ..Mpm::BEST };
    let plan = solver.plan(&scene, &Resolution::grid(cells, points)).expect("the resolution is right");
    let Plan { lattice, points, time_step, critical, steps } = plan;
    (Simulation::new(&scene, setting, lattice, points, [time_step, critical], 1), steps)
}
