//! Cost of a time step for one grain, 100 and 10 000 grains, without start-up.
//!
//! Discs in a square packing rest in a box. Each solver has one usual resolution. A timing is the difference of a long
//! run and a short run of one step. The difference of their times divided by the difference of their step counts is the
//! time of a step. The time of the short run minus the time of one step is the start-up. Each round times every solver
//! in every scene once.

use super::knobs::nominal_seconds;
use crate::clock::cpu_seconds;
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::load::{Load, TimingDifference};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::resolution::Resolution;
use std::sync::Arc;

/// Numbers of discs along each edge of the square packing.
const EDGES: [u32; 3] = [1, 10, 100];
/// Measured solvers, each at one resolution.
const SOLVERS: [(&str, Resolution); 5] = [
    ("dem", Resolution::CriticalFraction(Resolution::FRACTION)),
    ("rigid", Resolution::substeps(Resolution::SUBSTEPS)),
    ("mpm", Resolution::grid(4.0, 2)),
    ("lammps", Resolution::CriticalFraction(Resolution::FRACTION)),
    ("liggghts", Resolution::CriticalFraction(Resolution::FRACTION)),
];
/// Target run time of the long run (s).
const LONG: f64 = 0.5;
/// Minimum and maximum number of steps of a long run.
const STEPS: [f64; 2] = [40.0, 400_000.0];

/// Measures the cost of a step of each solver in a number of rounds.
///
/// # Errors
/// When the scene cannot be read, which does not occur for the scene of this study.
pub fn measure(solvers: &dyn Solvers, rounds: u32, now: &dyn Fn(&str)) -> Result<Vec<Load>, SceneError> {
    // Each solver with its scene, its resolution and the timings so far.
    let mut entrants = Vec::new();
    for edge in EDGES {
        let scene = Arc::new(box_of_discs(edge)?);
        for (name, resolution) in SOLVERS {
            let solver = solvers.find(name);
            let absent = match &solver {
                None => Some("no such solver".to_owned()),
                Some(solver) => solver.available().err().map(|reason| reason.to_string()),
            };
            let load = Load {
                grains: scene.grains.len(),
                solver: name.to_owned(),
                resolution: resolution.to_string(),
                laps: Vec::new(),
                absent,
            };
            entrants.push((solver, Arc::clone(&scene), resolution, load));
        }
    }
    for round in 1..=rounds {
        for (solver, scene, resolution, load) in &mut entrants {
            now(&format!("{} discs, {}, lap {round} of {rounds}", load.grains, load.solver));
            if let (Some(solver), None) = (solver, &load.absent) {
                match lap(&**solver, scene, resolution) {
                    Ok(lap) => load.laps.push(lap),
                    Err(reason) => load.absent = Some(reason.to_string()),
                }
            }
        }
    }
    Ok(entrants.into_iter().map(|(.., load)| load).collect())
}

/// Runs a solver for one step and for many steps, and returns the difference.
fn lap(solver: &dyn Solver, scene: &Scene, resolution: &Resolution) -> Result<TimingDifference, RunError> {
    let step = step(scene, resolution).map_err(|reason| RunError::Resolution { solver: solver.name(), reason })?;
    // The scene lasts one second, so its nominal time is that of one simulated second.
    let seconds = (LONG / nominal_seconds(scene, resolution)).clamp(STEPS[0] * step, STEPS[1] * step);
    let run = |seconds: f64| -> Result<LoadCost, RunError> {
        let scene = Scene {
            duration: Duration::Seconds(seconds),
            sampling: Sampling::Seconds(seconds),
            snapshots: 0,
            ..scene.clone()
        };
        let begun = cpu_seconds();
        let steps = solver.run(&scene, resolution, &mut ())?.cost.steps;
        Ok(LoadCost { steps, seconds, processor: cpu_seconds() - begun })
    };
    Ok(LoadCost::lap(run(step)?, run(seconds)?))
}

/// Cost of a run.
struct LoadCost {
    steps: u64,
    /// Simulated time (s).
    seconds: f64,
    /// Processor time (s).
    processor: f64,
}

impl LoadCost {
    /// Computes the difference of a short and a long run. A negative start-up time counts as zero.
    fn lap(short: Self, long: Self) -> TimingDifference {
        let more = long.processor - short.processor;
        let step = more / (long.steps - short.steps) as f64;
        let start_up = (short.processor - short.steps as f64 * step).max(0.0);
        // The short run of a rigid-body engine has more steps than its duration needs.
        TimingDifference { start_up, step, second: step * long.steps as f64 / long.seconds }
    }
}

/// Returns the time step of a resolution (s).
fn step(scene: &Scene, resolution: &Resolution) -> Result<f64, String> {
    match *resolution {
        Resolution::Rigid { step, substeps, .. } => Ok(step / f64::from(substeps)),
        Resolution::Grid { .. } => resolution.steps_on_grid(scene).map(|(step, _)| step),
        Resolution::CriticalFraction(_) | Resolution::TimeStep(_) => resolution.steps(scene).map(|(step, _)| step),
    }
}

/// Returns a scene of one second with a square packing of discs in contact in a box.
///
/// The scene has contact springs for rigid grains and elastic moduli for deformable grains.
fn box_of_discs(edge: u32) -> Result<Scene, SceneError> {
    let text = format!(
        "title = 'discs in a box'\ndimension = 2\nduration = 1.0\ngravity = [0.0, -9.8]\n\
         materials.rock = {{ density = 3000.0, bulk_modulus = 10.0e6, shear_modulus = 2.5e6 }}\n\
         contacts.all = {{ between = ['rock', 'rock'], normal_stiffness = 2.3e7, tangential_stiffness = 6.6e6, friction = 0.3, \
         normal_damping = 99.0, tangential_damping = 99.0 }}\n\
         [grains.disc]\nmaterial = 'rock'\nradius = 0.5\n\
         lattice = {{ origin = [0.5, 0.5], spacing = [1.0, 1.0], count = [{edge}, {edge}] }}\n\
         [walls.floor]\nmaterial = 'rock'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         [walls.left]\nmaterial = 'rock'\nplane = {{ point = [0.0, 0.0], normal = [1.0, 0.0] }}\n\
         [walls.right]\nmaterial = 'rock'\nplane = {{ point = [{:?}, 0.0], normal = [-1.0, 0.0] }}\n\
         [output]\nevery = 1.0\n",
        f64::from(edge)
    );
    Scene::from_text("discs in a box", &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_hold_one_disc_and_ten_thousand() {
        let counts = EDGES.map(|edge| box_of_discs(edge).unwrap().grains.len());
        assert_eq!(counts, [1, 100, 10_000]);
    }

    /// Start-up takes 3 ms of processor time, and each step of 1 ms of simulated time takes 20 µs.
    #[test]
    fn start_up_and_steps_are_separated() {
        let spent =
            |steps: u64| LoadCost { steps, seconds: 1e-3 * steps as f64, processor: 3e-3 + 20e-6 * steps as f64 };
        let TimingDifference { start_up, step, second } = LoadCost::lap(spent(100), spent(1000));
        for (found, expected) in [(start_up, 3e-3), (step, 20e-6), (second, 0.02)] {
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }
}
