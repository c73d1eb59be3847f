//! Sweep points of the cost study: the parameter values with which each kind of solver runs.

use grainbench_harness::solvers::ExternalSolver;
use grainbench_harness::subject::SolverSetup;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use grainbench_solver::resolution::Resolution;

/// Sweep point: one setting of a solver's parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// Solver name, including the settings of the material point method.
    pub solver: String,
    /// Name of the curve in the diagram: the solver without its settings.
    pub line: String,
    /// Resolution of the run: time step, substeps or cells.
    pub resolution: Resolution,
    /// Description of further changed parameters.
    pub knobs: String,
    /// Fineness of the point in a sequence that refines one parameter; larger values are finer. `None` outside a
    /// sequence.
    pub sequence: Option<f64>,
}

/// Time steps of the DEM solver as fractions of the critical time step.
const FRACTIONS: [f64; 8] = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002];
/// Time steps of LAMMPS, LIGGGHTS and external solvers as fractions of the critical time step. There are few, because
/// start-up takes longer than most runs.
const PROGRAM_FRACTIONS: [f64; 3] = [0.2, 0.05, 0.01];
/// Cell counts of external solvers relative to the solver setup.
const PROGRAM_CELLS: [f64; 3] = [0.25, 0.5, 1.0];
/// Numbers of substeps of rapier.
const SUBSTEPS: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Iterations of rapier's constraint solver with eight substeps.
const ITERATIONS: [u32; 3] = [1, 2, 16];
/// Time steps of rapier with one substep (s).
const STEPS: [f64; 2] = [0.03, 0.004];
/// Cell counts of the MPM solver relative to the solver setup.
const CELLS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// Further settings of the material point method (basis, transfer, contact) and their descriptions.
const SETTINGS: [(&str, &str); 8] = [
    ("mpm+linear+flip", "hat functions, FLIP"),
    ("mpm+gimp+flip", "GIMP, FLIP"),
    ("mpm+apic", "APIC"),
    ("mpm+flip", "FLIP"),
    ("mpm:2000", "nodal contact of 2000"),
    ("mpm:2001", "nodal contact of 2001"),
    ("mpm:gap", "nodal contact at the gap"),
    ("mpm:penalty", "hat functions, FLIP, springs at surfaces"),
];

/// Returns all sweep points of a solver setup for our solvers, LAMMPS, LIGGGHTS and external solvers.
///
/// External solvers are included if they support the setup: contact springs or deformable bodies. If they declare time
/// steps or cell counts, these are used.
#[must_use]
pub fn turns(lane: &SolverSetup, external_solvers: &[ExternalSolver]) -> Vec<SweepPoint> {
    let own = match lane.method {
        Method::Dem => {
            let programs = ["lammps", "liggghts"].map(|name| steps(lane, name, &PROGRAM_FRACTIONS));
            [steps(lane, "dem", &FRACTIONS), programs.concat()].concat()
        }
        Method::Rigid => rigid(lane),
        Method::Grid => grid(lane),
    };
    own.into_iter().chain(external_solvers.iter().flat_map(|external| theirs(lane, external))).collect()
}

fn theirs(lane: &SolverSetup, external: &ExternalSolver) -> Vec<SweepPoint> {
    match (lane.method, lane.about) {
        (Method::Dem, _) if external.has_springs => {
            let fractions = if external.fractions.is_empty() { &PROGRAM_FRACTIONS[..] } else { &external.fractions };
            steps(lane, &external.name, fractions)
        }
        (Method::Grid, Resolution::Grid { cells: about, points, courant }) if external.deforms => {
            let usual = PROGRAM_CELLS.map(|factor| factor * about);
            let cells = if external.cells.is_empty() { &usual[..] } else { &external.cells };
            let at = |&cells: &f64| {
                let resolution = Resolution::Grid { cells, points, courant };
                turn(&external.name, &external.name, resolution, &lane.knobs, Some(cells / about))
            };
            cells.iter().map(at).collect()
        }
        _ => Vec::new(),
    }
}

fn turn(solver: &str, line: &str, resolution: Resolution, knobs: &str, sequence: Option<f64>) -> SweepPoint {
    SweepPoint { solver: solver.to_owned(), line: line.to_owned(), resolution, knobs: knobs.to_owned(), sequence }
}

/// Returns a sequence of time steps, as fractions of the critical time step.
fn steps(lane: &SolverSetup, solver: &str, fractions: &[f64]) -> Vec<SweepPoint> {
    let at = |&fraction: &f64| {
        turn(solver, solver, Resolution::CriticalFraction(fraction), &lane.knobs, Some(1.0 / fraction))
    };
    fractions.iter().map(at).collect()
}

fn rigid(lane: &SolverSetup) -> Vec<SweepPoint> {
    let at = |resolution, sequence| turn("rigid", "rigid", resolution, &lane.knobs, sequence);
    let substeps = SUBSTEPS.map(|count| at(Resolution::substeps(count), Some(f64::from(count))));
    let iterations = ITERATIONS
        .map(|iterations| at(Resolution::Rigid { step: Resolution::RIGID_STEP, substeps: 8, iterations }, None));
    let steps =
        STEPS.map(|step| at(Resolution::Rigid { step, substeps: 1, iterations: Resolution::RIGID_ITERATIONS }, None));
    substeps.into_iter().chain(iterations).chain(steps).collect()
}

fn grid(lane: &SolverSetup) -> Vec<SweepPoint> {
    let Resolution::Grid { cells, points, courant } = lane.about else { return Vec::new() };
    let at = |factor: f64, points: u32, courant: f64| Resolution::Grid { cells: cells * factor, points, courant };
    let mut turns: Vec<SweepPoint> = CELLS
        .iter()
        .map(|&factor| turn("mpm", "mpm", at(factor, points, courant), &lane.knobs, Some(factor)))
        .collect();
    if !lane.knobs.is_empty() {
        // For a setup with other changed parameters, one refinement sequence is enough.
        return turns;
    }
    for other in [points.saturating_sub(1).max(1), points + 1] {
        turns.push(turn("mpm", "mpm", at(0.5, other, courant), "", None));
    }
    turns.push(turn("mpm", "mpm", at(0.5, points, 0.5 * courant), "", None));
    for (solver, words) in SETTINGS {
        turns.push(turn(solver, "mpm", at(0.5, points, courant), words, None));
    }
    turns
}

/// Estimates the run time from counts alone (s).
///
/// The estimate uses no timing, so that long points are skipped equally on all machines.
#[must_use]
pub fn nominal_seconds(scene: &Scene, resolution: &Resolution) -> f64 {
    let grains = scene.grains.len() as f64;
    let seconds = scene.duration.seconds();
    match *resolution {
        Resolution::CriticalFraction(_) | Resolution::TimeStep(_) => {
            resolution.steps(scene).map_or(0.0, |(_, steps)| steps as f64 * (60e-9 * grains + 60e-9))
        }
        Resolution::Rigid { step, substeps, .. } => {
            seconds.map_or(0.0, |time| (time / step).max(1.0) * f64::from(substeps) * (3e-6 * grains + 2e-6))
        }
        Resolution::Grid { cells, points, courant } => {
            grid_seconds(scene, cells, points, courant, seconds.unwrap_or(0.0))
        }
    }
}

/// Estimates the run time (s) as points × steps × time per point and step.
fn grid_seconds(scene: &Scene, cells: f64, points: u32, courant: f64, seconds: f64) -> f64 {
    let dimensions = scene.dimension.count();
    let cell = scene.reference_length / cells;
    let grains: f64 = scene.grains.iter().map(|grain| scene.grain_shape.mass(grain.radius, 1.0)).sum();
    let bodies: f64 = scene.bodies.iter().map(|body| body.shape.volume(dimensions)).sum();
    let count = (grains + bodies) / cell.powi(dimensions as i32) * f64::from(points).powi(dimensions as i32);
    let settling = scene.start.settle.map_or(0.0, |settle| settle.duration);
    let steps = (seconds + settling) / (courant * scene.crossing_time(cell));
    steps * count * if dimensions == 2 { 250e-9 } else { 900e-9 }
}
