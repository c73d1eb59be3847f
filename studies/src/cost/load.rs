//! What a step costs of one grain, of a hundred and of ten thousand, start-up apart.
//!
//! Discs stand on each other in a box, each solver at a usual resolution. Of two runs one is of one step: what the long one
//! takes more, over the steps that it has more, is the time of a step, and what the short one takes beside its step is the
//! start-up. All solvers do a lap of every scene in turn.

use super::knobs::nominal_seconds;
use crate::Follow;
use crate::clock::cpu_seconds;
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::load::{Lap, Load};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_scene::solver::{Resolution, RunError, Solver};
use grainbench_scene::source::SceneSource;
use std::path::Path;
use std::sync::Arc;

/// Discs on an edge of their square.
const EDGES: [u32; 3] = [1, 10, 100];
/// Solvers and their resolutions.
const SOLVERS: [(&str, Resolution); 5] = [
    ("dem", Resolution::CriticalFraction(Resolution::FRACTION)),
    ("rigid", Resolution::substeps(Resolution::SUBSTEPS)),
    ("mpm", Resolution::grid(4.0, 2)),
    ("lammps", Resolution::CriticalFraction(Resolution::FRACTION)),
    ("liggghts", Resolution::CriticalFraction(Resolution::FRACTION)),
];
/// A long run is as many steps as take about this long (s),
const LONG: f64 = 0.5;
/// but no fewer and no more than these.
const STEPS: [f64; 2] = [40.0, 400_000.0];

/// Laps that [`measure`] tells its follower of.
#[must_use]
pub fn laps(rounds: u32) -> u64 {
    u64::from(rounds) * (EDGES.len() * SOLVERS.len()) as u64
}

/// A solver that takes part, and what it left so far.
struct Entrant {
    solver: Option<Arc<dyn Solver>>,
    scene: Arc<Scene>,
    resolution: Resolution,
    load: Load,
}

/// Measures in so many rounds.
///
/// # Errors
/// When the scene cannot be read, which none of this project can fail to be.
pub fn measure(solvers: &dyn Solvers, rounds: u32, follow: &mut impl Follow) -> Result<Vec<Load>, SceneError> {
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
            entrants.push(Entrant { solver, scene: Arc::clone(&scene), resolution, load });
        }
    }
    for round in 1..=rounds {
        for Entrant { solver, scene, resolution, load } in &mut entrants {
            follow.now(&format!("{} discs, {}, lap {round} of {rounds}", load.grains, load.solver));
            if let (Some(solver), None) = (solver, &load.absent) {
                match lap(&**solver, scene, resolution) {
                    Ok(lap) => load.laps.push(lap),
                    Err(reason) => load.absent = Some(reason.to_string()),
                }
            }
            follow.done(false);
        }
    }
    Ok(entrants.into_iter().map(|entrant| entrant.load).collect())
}

/// One lap.
fn lap(solver: &dyn Solver, scene: &Scene, resolution: &Resolution) -> Result<Lap, RunError> {
    let step = step(scene, resolution).map_err(|reason| RunError::Resolution { solver: solver.name(), reason })?;
    // The scene lasts for a second.
    let seconds = (LONG / nominal_seconds(scene, resolution)).clamp(STEPS[0] * step, STEPS[1] * step);
    let run = |seconds: f64| -> Result<Spent, RunError> {
        let scene = Scene {
            duration: Duration::Seconds(seconds),
            sampling: Sampling::Seconds(seconds),
            snapshots: 0,
            ..scene.clone()
        };
        let begun = cpu_seconds();
        let steps = solver.run(&scene, resolution, &mut ())?.cost.steps;
        Ok(Spent { steps, seconds, processor: cpu_seconds() - begun })
    };
    Ok(Spent::lap(run(step)?, run(seconds)?))
}

/// What a run took.
struct Spent {
    steps: u64,
    /// Of the simulated motion (s).
    seconds: f64,
    /// Processor time (s).
    processor: f64,
}

impl Spent {
    /// A long run less a short one. Start-up that the difference leaves below nothing is none.
    fn lap(short: Self, long: Self) -> Lap {
        let more = long.processor - short.processor;
        let step = more / (long.steps - short.steps) as f64;
        let start_up = (short.processor - short.steps as f64 * step).max(0.0);
        Lap { start_up, step, second: more / (long.seconds - short.seconds) }
    }
}

/// The time step (s).
fn step(scene: &Scene, resolution: &Resolution) -> Result<f64, String> {
    match *resolution {
        Resolution::Rigid { step, substeps, .. } => Ok(step / f64::from(substeps)),
        Resolution::Grid { .. } => resolution.steps_on_grid(scene).map(|(step, _)| step),
        Resolution::CriticalFraction(_) | Resolution::TimeStep(_) => resolution.steps(scene).map(|(step, _)| step),
    }
}

/// A square of discs that touch, in a box, for a second: springs for grains that have them, moduli for grains that deform.
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
    SceneSource::from_text("discs in a box", Path::new(""), &text).scene(&|_| Err("there are no files here".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_hold_one_disc_and_ten_thousand() {
        let counts = EDGES.map(|edge| box_of_discs(edge).unwrap().grains.len());
        assert_eq!(counts, [1, 100, 10_000]);
    }

    /// 3 ms to start, 20 µs a step of 1 ms.
    #[test]
    fn start_up_is_told_apart_from_steps() {
        let spent = |steps: u64| Spent { steps, seconds: 1e-3 * steps as f64, processor: 3e-3 + 20e-6 * steps as f64 };
        let Lap { start_up, step, second } = Spent::lap(spent(100), spent(1000));
        for (found, expected) in [(start_up, 3e-3), (step, 20e-6), (second, 0.02)] {
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }
}
