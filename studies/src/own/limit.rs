//! Largest stable time step of a solver in a scene, by bisection on failed runs.

use super::cost::SceneStudy;
use super::ladder::Ladder;
use super::network::largest_stable_step;
use super::within::Within;
use crate::run_cache::key_of_run;
use crate::stability::assembly::dice;
use crate::stability::failure::{Failure, confirmed, of_error};
use crate::stability::limit::{Stop, fill};
use grainbench_reports::study::stability::Limit;
use grainbench_scene::contact_law::{ContactLaw, SpringsKind};
use grainbench_scene::scene::{Duration, Probe, ProbeTarget, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::RunOptions;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use grainbench_store::WriteError;
use nalgebra::Vector3;
use std::time::Instant;

/// Relative precision of a limit.
const PRECISION: f64 = 0.02;
/// Cells per reference length of the runs on a grid.
const CELLS: f64 = 4.0;
/// Energies, and the ratio of the largest value to that at the smallest step above which a run is unstable. The elastic energy
/// of contacts that vibrate with the time step grows even if the grains hardly move.
const GROWTH: [(&str, f64); 2] = [("kinetic_energy", 10.0), ("elastic_energy", 3.0)];
/// Smallest number of steps of a run. Longer steps are not tried, because a short run shows no growth.
const FEWEST: f64 = 10.0;
/// Largest velocity along an axis that perturbs a grain, in radii per critical step. In a scene without springs, the unit is a
/// radius per duration. A grain at rest would otherwise stay at rest with any step.
const PERTURBATION: f64 = 1e-6;
/// Name of the probe that records the energies.
const PROBE: &str = "stability";
/// Number of snapshots whose contacts give the exact limit.
const SNAPSHOTS: u32 = 10;

/// Time step of a solver as a parameter.
struct Parameter {
    unit: &'static str,
    /// Range in which the limit is sought.
    range: [f64; 2],
    default: f64,
    resolution: fn(f64) -> Resolution,
    /// Returns the time step at the value 1 (s); none if the scene does not determine it.
    unit_step: fn(&Scene) -> Option<f64>,
}

/// Fraction of the critical time step.
const FRACTION: Parameter = Parameter {
    unit: "2√(m/k)",
    range: [0.1, 2.5],
    default: Resolution::FRACTION,
    resolution: Resolution::CriticalFraction,
    unit_step: |scene| Some(scene.critical_time_step()),
};
/// Courant number of a grid.
const COURANT: Parameter = Parameter {
    unit: "h/c",
    range: [0.1, 2.0],
    default: Resolution::COURANT,
    resolution: |courant| Resolution::Grid { cells: CELLS, points: Resolution::POINTS, courant },
    unit_step: |scene| {
        // In a long scene, the step is hardly shortened to a whole number of steps.
        let long = scene.duration.seconds().map(|seconds| Duration::Seconds(1e3 * seconds))?;
        let courant = Resolution::Grid { cells: CELLS, points: Resolution::POINTS, courant: 1.0 };
        courant.steps_on_grid(&Scene { duration: long, ..scene.clone() }).ok().map(|(step, _)| step)
    },
};
/// Time step of a rigid-body engine (s).
const STEP: Parameter = Parameter {
    unit: "s",
    range: [1.0 / 240.0, 0.1],
    default: Resolution::RIGID_STEP / Resolution::SUBSTEPS as f64,
    resolution: |step| Resolution::Rigid { step, substeps: 1, iterations: Resolution::RIGID_ITERATIONS },
    unit_step: |_| Some(1.0),
};

/// Adds small random velocities and spins to the grains without prescribed motion.
fn perturb(scene: &mut Scene) {
    let (groups, critical) = (scene.driven_group_of_grains(), scene.critical_time_step());
    let time = if critical.is_finite() { critical } else { scene.duration.seconds().unwrap_or(1.0) };
    let (is_flat, mut dice) = (scene.dimension.count() == 2, dice());
    for (at, grain) in scene.grains.iter_mut().enumerate() {
        if groups.get(at).is_some_and(Option::is_some) {
            continue;
        }
        let mut vector = |largest: f64| Vector3::from_fn(|_, _| largest * dice());
        let (mut velocity, mut spin) = (vector(PERTURBATION * grain.radius / time), vector(PERTURBATION / time));
        if is_flat {
            velocity.z = 0.0;
            spin = Vector3::new(0.0, 0.0, spin.z);
        }
        grain.velocity += velocity;
        grain.spin += spin;
    }
}

/// Returns the largest stable time step of a solver in the scene of a study. No run continues after the deadline, or when the
/// user stops the study. The limit is then a lower bound, and its detail says so.
///
/// # Errors
/// When the limit cannot be stored.
pub fn of_scene(study: &SceneStudy<'_>, solver: &str, deadline: Instant) -> Result<Limit, WriteError> {
    let (scene, solvers) = (study.scene, study.solvers);
    let program = study.program.clone() + &solvers.edition(solver);
    let id = key_of_run(&program, solver, scene, &Resolution::TimeStep(0.0), "largest stable step");
    if let Ok(limit) = study.cache.get(&id) {
        return Ok(limit);
    }
    let ladder = Ladder::new(solver, scene, solvers);
    let has_springs = !ladder.has_cells() && !ladder.is_rigid();
    let parameter = if has_springs {
        FRACTION
    } else if ladder.has_cells() {
        COURANT
    } else {
        STEP
    };
    let mut limit = Limit {
        scene: study.name.clone(),
        solver: solver.to_owned(),
        unit: parameter.unit.to_owned(),
        default: Some(parameter.default),
        ..Limit::default()
    };
    let is_whole = match solvers.find(solver) {
        None => {
            "there is no such solver".clone_into(&mut limit.detail);
            true
        }
        Some(_) if has_springs && !scene.critical_time_step().is_finite() => {
            "the scene has no contact springs, so no step is too large".clone_into(&mut limit.detail);
            true
        }
        Some(solver) => bisect(&mut limit, (&*solver, scene), (&parameter, has_springs), (deadline, study.stop)),
    };
    // An external program fails when it is stopped.
    if is_whole && !(study.stop)() {
        study.cache.put(&id, &limit)?;
    }
    Ok(limit)
}

/// Finds the limit by bisection. Returns false if the deadline ended it.
fn bisect(
    limit: &mut Limit,
    (solver, scene): (&dyn Solver, &Scene),
    (parameter, has_springs): (&Parameter, bool),
    (deadline, stop): (Instant, &(dyn Fn() -> bool + Sync)),
) -> bool {
    let mut scene = Scene { snapshots: SNAPSHOTS, snapshot_times: Vec::new(), ..scene.clone() };
    scene.probes.push(Probe { name: PROBE.to_owned(), target: ProbeTarget::System });
    perturb(&mut scene);
    let within = Within::new(solver, deadline, stop);
    let (mut energies, mut exact, mut unstable) = (None, None, None);
    let [low, high] = parameter.range;
    // Without a duration in seconds, the scene lasts a number of steps of any length.
    let seconds_and_unit = scene.duration.seconds().zip((parameter.unit_step)(&scene));
    let longest = seconds_and_unit.map_or(high, |(seconds, unit)| seconds / (FEWEST * unit));
    if longest < low {
        limit.detail = format!("the scene is too short: its duration is less than {FEWEST} steps");
        return true;
    }
    let is_concluded = fill(limit, [low, high.min(longest)], (PRECISION, 0), |value| {
        if let Some((seconds, unit)) = seconds_and_unit {
            // A whole number of steps, which the solver would otherwise shorten.
            let step = value * unit;
            scene.duration = Duration::Seconds((seconds / step).ceil() * step);
        }
        let record = confirmed(|| within.run(&scene, &(parameter.resolution)(value), &mut RunOptions::unstable()));
        let record = record.map_err(|error| match of_error(&error) {
            Some(failure) => Stop::Unstable(shortened(failure, &error)),
            // The solver knows that a dashpot is unstable at this step.
            None if matches!(error, RunError::Resolution { .. }) => Stop::Unstable(Failure::Broken(error.to_string())),
            None if Instant::now() >= deadline => Stop::Cannot("the time limit ended the bisection".to_owned()),
            None => Stop::Cannot(error.to_string()),
        });
        let now = record.and_then(|record| {
            let most = GROWTH.map(|(name, _)| largest_energy(&record, name));
            let Some(least) = energies else {
                energies = Some(most);
                let steps = record.snapshots.iter().filter_map(|snapshot| largest_stable_step(&scene, snapshot));
                exact = steps.reduce(f64::min);
                return Ok(());
            };
            let growth = |at: usize| most[at] / least[at];
            // An energy that is zero, or that the solver does not report, shows no growth.
            let grown = (0..GROWTH.len()).find(|&at| least[at] > 0.0 && growth(at) > GROWTH[at].1);
            grown.map_or(Ok(()), |at| Err(Stop::Unstable(Failure::Growth(growth(at)))))
        });
        if let Err(Stop::Unstable(failure)) = &now {
            unstable = Some((value, failure.to_string()));
        }
        now
    });
    let is_linear = |law: &ContactLaw| law.springs.kind() == SpringsKind::Linear && !law.has_damping();
    // The matrix of the contacts has no rolling springs.
    let rolls = scene.laws.iter().flatten().any(|law| law.rolling_friction > 0.0);
    let exact = if has_springs && !rolls { exact.map(|step| step / scene.critical_time_step()) } else { None };
    let is_exact = scene.laws.iter().flatten().all(is_linear);
    let mut is_whole = is_concluded || !within.0.is_cut();
    if let Some(found) = limit.found {
        limit.exact = exact.filter(|_| is_exact);
        limit.error = limit.exact.map(|exact| (found - exact) / exact);
        if limit.unstable.is_none() && longest < high {
            limit.error = None;
            limit.detail +=
                &format!("; with longer steps the scene has fewer than {FEWEST}, so the limit is a lower bound");
        }
        if !is_concluded {
            is_whole = false;
            limit.detail += "; the limit is a lower bound";
            if let Some((value, how)) = unstable {
                limit.unstable = Some(value);
                limit.detail += &format!("; {how}");
            }
        }
    }
    if let Some(step) = exact.filter(|_| !is_exact) {
        limit.detail += &format!(
            "; without dashpots, the contacts in the snapshots are stable up to {step:.3} (2/ω of central differences)"
        );
    }
    is_whole
}

/// Returns a failure without the numbers and the advice that an error message of a run repeats.
fn shortened(failure: Failure, error: &RunError) -> Failure {
    match error {
        RunError::Broken(broken) => {
            Failure::Broken(format!("{} at t = {:.3e} s: {}", broken.subject, broken.time, broken.cause))
        }
        _ => failure,
    }
}

/// Returns the largest value of an energy (J); infinity if a value is not finite, and zero if the solver does not report it.
fn largest_energy(record: &Record, name: &str) -> f64 {
    let values = record.series.column(&format!("{PROBE}.{name}")).unwrap_or_default();
    values.iter().fold(0.0, |most: f64, value| if value.is_nan() { f64::INFINITY } else { most.max(*value) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_dem::convention::Convention;
    use grainbench_dem::solver::Dem;
    use std::time::Duration as Time;

    /// Returns the limit of a disc in equilibrium between two planes. Its stiffness is 2k, so the exact limit is √½.
    fn limit_at_rest(duration: f64) -> Limit {
        let text = format!(
            "title = 'rest'\ndimension = 2\nduration = {duration:?}\nmaterials.m.density = 1000.0\n\
             contacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0e5 }}\n\
             grains.a = {{ material = 'm', radius = 0.05, position = [0.0, 0.0499] }}\n\
             walls.floor = {{ material = 'm', plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}\n\
             walls.lid = {{ material = 'm', plane = {{ point = [0.0, 0.0998], normal = [0.0, -1.0] }} }}\n\
             output.every = 0.001\n"
        );
        let scene = Scene::from_text("rest", &text).unwrap();
        let (mut limit, deadline) = (Limit::default(), Instant::now() + Time::from_secs(600));
        bisect(&mut limit, (&Dem::new(Convention::DEFAULT), &scene), (&FRACTION, true), (deadline, &|| false));
        limit
    }

    #[test]
    fn a_grain_at_rest_is_not_stable_at_any_step() {
        let limit = limit_at_rest(10.0);
        assert!(limit.error.unwrap().abs() < PRECISION && limit.unstable.is_some(), "{limit:?}");
        assert!((limit.exact.unwrap() - 0.5_f64.sqrt()).abs() < 1e-6, "{limit:?}");
    }

    /// A duration of .1 s is five critical steps, so that ten steps are half as long.
    #[test]
    fn the_limit_of_a_short_scene_is_a_lower_bound() {
        let limit = limit_at_rest(0.1);
        assert!(limit.found.unwrap() < 0.6 && limit.unstable.is_none() && limit.error.is_none(), "{limit:?}");
        assert!(limit.detail.contains("lower bound"), "{limit:?}");
    }
}
