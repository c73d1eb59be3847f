//! Hard cases. Each case has a solver-independent condition, which a run of each solver either meets or violates.

mod contacts;
mod extremes;
mod many;

use super::PATIENCE as LIMIT;
use super::failure::{Failure, confirmed, finite, of_error};
use crate::cost::knobs::nominal_seconds;
use grainbench_harness::conformance::HalfwayCheckpoint;
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::stability::{HardCaseResult, Hardness};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Grain, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::RunOptions;
use grainbench_solver::record::{GrainState, Record};
use grainbench_solver::resolution::Resolution;

/// Function that checks the condition at the end of a run.
type Check = fn(&Scene, &Record) -> Result<(), Failure>;

/// Hard case: a scene in which solvers may fail, and the required property.
pub struct HardCase {
    /// Name in tables, such as `mass-ratio-1e6`.
    pub name: String,
    /// Condition in words.
    pub must: &'static str,
    /// Scene.
    pub scene: Scene,
    /// Function that checks the condition.
    pub check: Check,
    /// True if the run is also continued from a checkpoint at half of the steps. It must then end in the same bits.
    pub goes_on: bool,
    /// Solvers to test. For cases of 10⁹ grain-steps these are only fast solvers, which need a minute.
    pub asked: &'static [&'static str],
}

/// Solvers that are tested by default.
const SOLVERS: [&str; 5] = ["dem", "rigid", "mpm", "lammps", "liggghts"];
/// Fractions of the default time step that are tried after a failure.
const SMALLER: [f64; 4] = [0.5, 0.25, 0.1, 0.01];
/// Default time step of solvers with contact springs, as a fraction of the critical time step.
const FRACTION: f64 = 0.1;
/// Default number of cells per reference length of the scene.
const CELLS: f64 = 8.0;
/// Material points per cell along each axis.
const POINTS: u32 = 2;
/// Longest expected run with a smaller time step (s).
const PATIENCE: f64 = 60.0;
/// Longest expected run with the default time step (s). Longer cases count as unsupported.
const HOPELESS: f64 = 600.0;

/// Returns all hard cases.
///
/// # Errors
/// When a scene cannot be read, which occurs only if the scene format has changed.
pub fn all() -> Result<Vec<HardCase>, SceneError> {
    Ok([extremes::cases()?, contacts::cases()?, many::cases()?].into_iter().flatten().collect())
}

/// Returns a case from the text of its scene.
fn case(name: impl Into<String>, must: &'static str, text: &str, check: Check) -> Result<HardCase, SceneError> {
    let name = name.into();
    let scene = Scene::from_text(&format!("hard/{name}"), text)?;
    Ok(HardCase { name, must, scene, check, goes_on: false, asked: &SOLVERS })
}

/// Estimates the time of a case with a solver (s); zero if the case is too long to run.
#[must_use]
pub fn seconds(case: &HardCase, solver: &str) -> f64 {
    let expected = nominal_seconds(&case.scene, &resolution(solver, 1.0));
    if expected > HOPELESS { 0.0 } else { expected }
}

/// Runs a case with a solver at its default time step, and at smaller steps if the run fails.
#[must_use]
pub fn judge(case: &HardCase, solvers: &dyn Solvers, name: &str) -> HardCaseResult {
    let mut row = HardCaseResult {
        case: case.name.clone(),
        must: case.must.to_owned(),
        solver: name.to_owned(),
        standing: Hardness::Unsupported,
        resolution: resolution(name, 1.0).to_string(),
        detail: String::new(),
    };
    let scene = &case.scene;
    let Some(solver) = solvers.find_within(name, LIMIT) else { return row };
    let expected = nominal_seconds(scene, &resolution(name, 1.0));
    if expected > HOPELESS {
        let hours = (expected / 3600.0).ceil();
        row.detail = format!("a uniform grid that resolves the smallest grain would take about {hours:.0} h");
        return row;
    }
    match attempt(case, &*solver, 1.0) {
        Ok(()) => row.standing = Hardness::Holds,
        Err(Stop::Cannot(error)) => {
            let is_missing = matches!(error, RunError::NotAvailable { .. });
            row.standing = if is_missing { Hardness::NotAvailable } else { Hardness::Unsupported };
            row.detail = error.to_string();
        }
        Err(Stop::Failed(how)) => {
            row.detail = how.to_string();
            row.standing = if how.is_typed() { Hardness::TypedFailure } else { Hardness::QuietlyWrong };
            let bearable = |part: &f64| nominal_seconds(scene, &resolution(name, *part)) <= PATIENCE;
            if let Some(part) = SMALLER.into_iter().filter(bearable).find(|&part| attempt(case, &*solver, part).is_ok())
            {
                row.standing = Hardness::HoldsAtASmallerStep;
                row.resolution = resolution(name, part).to_string();
                let quiet = if how.is_typed() { "" } else { "wrong without an error at the default step: " };
                row.detail = format!("{quiet}{how}");
            }
        }
    }
    row
}

/// Reason why an attempt failed.
enum Stop {
    Cannot(RunError),
    Failed(Failure),
}

/// Returns the default resolution of a solver with its time step multiplied by `part`.
fn resolution(solver: &str, part: f64) -> Resolution {
    match solver.split([':', '+']).next() {
        Some("rigid") => Resolution::substeps((8.0 / part).round() as u32),
        Some("mpm") => Resolution::Grid { cells: CELLS, points: POINTS, courant: Resolution::COURANT * part },
        _ => Resolution::CriticalFraction(FRACTION * part),
    }
}

fn attempt(case: &HardCase, solver: &dyn Solver, part: f64) -> Result<(), Stop> {
    let scene = &case.scene;
    let resolution = resolution(&solver.name(), part);
    let mut halfway = HalfwayCheckpoint::new(RunOptions::unstable());
    let run = confirmed(|| {
        if case.goes_on {
            solver.run(scene, &resolution, &mut halfway)
        } else {
            solver.run(scene, &resolution, &mut RunOptions::unstable())
        }
    });
    let record = run.map_err(|error| match (of_error(&error), error) {
        (Some(failure), _) => Stop::Failed(failure),
        // A solver that rejects the time step and names a stable one has failed with a typed error.
        (None, RunError::Resolution { reason, .. }) => Stop::Failed(Failure::Broken(reason)),
        (None, error) => Stop::Cannot(error),
    })?;
    if case.goes_on {
        continues(scene, solver, &resolution, (&record, halfway))?;
    }
    record.snapshots.iter().try_for_each(finite).map_err(Stop::Failed)?;
    (case.check)(scene, &record).map_err(Stop::Failed)
}

/// Checks that a run that is continued from half of its steps ends in the same bits as the uninterrupted run.
fn continues(
    scene: &Scene,
    solver: &dyn Solver,
    resolution: &Resolution,
    (whole, halfway): (&Record, HalfwayCheckpoint),
) -> Result<(), Stop> {
    let checkpoint = halfway.written_by(solver).map_err(Stop::Cannot)?;
    let continued =
        solver.run_from(scene, resolution, Some(&checkpoint), &mut RunOptions::unstable()).map_err(Stop::Cannot)?;
    let differ = end(whole).iter().zip(end(&continued)).filter(|(a, b)| a != b).count();
    if differ > 0 || end(whole).len() != end(&continued).len() {
        let what = format!("{differ} grains have a different final state when the run is continued");
        return Err(Stop::Failed(Failure::Wrong(what)));
    }
    Ok(())
}

/// Returns the grains at the end of a run.
fn end(record: &Record) -> &[GrainState] {
    record.snapshots.last().map_or(&[], |snapshot| &snapshot.grains)
}

/// Returns the kinetic energy of grains, including rotation (J).
fn kinetic(grains: &[GrainState], scene: &Scene) -> f64 {
    let pairs = grains.iter().zip(&scene.grains);
    pairs
        .map(|(grain, start)| energy(&Grain { mass: grain.mass, velocity: grain.velocity, spin: grain.spin, ..*start }))
        .sum()
}

/// Returns the kinetic energy at the start, including rotation (J).
fn kinetic_at_start(scene: &Scene) -> f64 {
    scene.grains.iter().map(energy).sum()
}

fn energy(grain: &Grain) -> f64 {
    0.5 * grain.mass * grain.velocity.norm_squared() + 0.5 * grain.inertia * grain.spin.norm_squared()
}

/// Returns an error if a value differs from the expected value by more than `allowed`.
fn near(what: &str, value: f64, expected: f64, allowed: f64) -> Result<(), Failure> {
    // NaN fails this comparison.
    if (value - expected).abs() <= allowed {
        Ok(())
    } else {
        Err(Failure::Wrong(format!("{what} is {value:.4e}, expected {expected:.4e}")))
    }
}

/// Checks the velocities after an elastic head-on impact: they are those of two point masses, within 3 % of the
/// approach speed.
fn head_on(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let (a, b) = (&scene.grains[0], &scene.grains[1]);
    let grains = end(record);
    if grains.len() < 2 {
        return Err(Failure::Wrong("the run has no grains at the end".to_owned()));
    }
    let total = a.mass + b.mass;
    let centre = (a.mass * a.velocity.x + b.mass * b.velocity.x) / total;
    let speed = a.velocity.x - b.velocity.x;
    let allowed = 0.03 * speed.abs();
    near("velocity of the first grain", grains[0].velocity.x, centre - speed * b.mass / total, allowed)?;
    near("velocity of the second grain", grains[1].velocity.x, centre + speed * a.mass / total, allowed)?;
    if grains[0].position.x > grains[1].position.x {
        return Err(Failure::Tunnelling("the grains have passed through each other".to_owned()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_dem::convention::Convention;
    use grainbench_dem::solver::Dem;

    /// A check that passes for every result would call every time step stable.
    #[test]
    fn every_check_refuses_a_run_of_something_else() {
        for case in all().unwrap() {
            let scene = case.scene;
            let mut grains: Vec<GrainState> =
                scene.grains.iter().enumerate().map(|(at, grain)| GrainState::start(at as u32 + 1, grain)).collect();
            // All grains are moved far away and are faster than in any case.
            for grain in &mut grains {
                grain.position += nalgebra::Vector3::new(-3e9, -7e9, -5e9) * grain.radius;
                grain.velocity += nalgebra::Vector3::new(-1e9, -2e9, 0.0);
            }
            let snapshot = grainbench_solver::record::Snapshot::of_grains(&scene, 1, 1.0, grains);
            let solver = Dem::new(Convention::DEFAULT);
            let mut short = crate::stability::assembly::all().unwrap().swap_remove(0).scene;
            short.duration = grainbench_scene::scene::Duration::Cycles(1);
            let mut record = solver.run(&short, &Resolution::TimeStep(0.1), &mut ()).unwrap();
            record.snapshots = vec![snapshot];
            assert!((case.check)(&scene, &record).is_err(), "{} lets anything through", case.name);
        }
    }
}
