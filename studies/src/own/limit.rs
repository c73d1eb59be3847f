//! Largest stable time step of a solver in a scene, by bisection on failed runs.

use super::network::largest_stable_step;
use super::within::Within;
use crate::run_cache::key_of_run;
use crate::stability::bisection::largest;
use crate::stability::failure::{Failure, of_error};
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::stability::Limit;
use grainbench_scene::contact_law::{ContactLaw, SpringsKind};
use grainbench_scene::method::Method;
use grainbench_scene::scene::{Probe, ProbeTarget, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::RunOptions;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use grainbench_store::WriteError;
use grainbench_store::artifact::{Directory, Json};
use std::time::Instant;

/// Relative precision of a limit.
const PRECISION: f64 = 0.02;
/// Range of time steps, as fractions of the critical one.
const FRACTIONS: [f64; 2] = [0.1, 2.5];
/// Range of Courant numbers.
const COURANT: [f64; 2] = [0.1, 2.0];
/// Range of the time steps of a rigid-body engine (s).
const STEPS: [f64; 2] = [1.0 / 240.0, 0.1];
/// Cells per reference length of the runs on a grid.
const CELLS: f64 = 4.0;
/// Energies, and the ratio of the largest value to that at the smallest step above which a run is unstable. The elastic energy
/// of contacts that vibrate with the time step grows even if the grains hardly move.
const GROWTH: [(&str, f64); 2] = [("kinetic_energy", 10.0), ("elastic_energy", 3.0)];
/// Name of the probe that records the energies.
const PROBE: &str = "stability";
/// Number of snapshots whose contacts give the exact limit.
const SNAPSHOTS: u32 = 10;

/// Time step of a solver as a parameter.
#[derive(Clone, Copy)]
enum Parameter {
    Fraction,
    Courant,
    Step,
}

impl Parameter {
    const fn range(self) -> [f64; 2] {
        match self {
            Self::Fraction => FRACTIONS,
            Self::Courant => COURANT,
            Self::Step => STEPS,
        }
    }

    const fn at(self, value: f64) -> Resolution {
        match self {
            Self::Fraction => Resolution::CriticalFraction(value),
            Self::Courant => Resolution::Grid { cells: CELLS, points: Resolution::POINTS, courant: value },
            Self::Step => Resolution::Rigid { step: value, substeps: 1, iterations: Resolution::RIGID_ITERATIONS },
        }
    }

    const fn unit(self) -> &'static str {
        match self {
            Self::Fraction => "2√(m/k)",
            Self::Courant => "h/c",
            Self::Step => "s",
        }
    }

    fn default(self) -> f64 {
        match self {
            Self::Fraction => Resolution::FRACTION,
            Self::Courant => Resolution::COURANT,
            Self::Step => Resolution::RIGID_STEP / f64::from(Resolution::SUBSTEPS),
        }
    }
}

/// Reason why a step does not pass.
enum Stop {
    /// No conclusion about stability.
    Cannot(String),
    /// The run is unstable.
    Unstable(Failure),
}

/// Returns the largest stable time step of a solver in a scene, and true if it is from the cache. No run continues after the
/// deadline, or when `stop` returns true. The limit is then a lower bound, and its detail says so.
///
/// # Errors
/// When the limit cannot be stored.
pub fn of_scene(
    (name, scene): (&str, &Scene),
    (solvers, solver): (&dyn Solvers, &str),
    (deadline, stop): (Instant, &(dyn Fn() -> bool + Sync)),
    (program, cache): (&str, &Directory),
) -> Result<(Limit, bool), WriteError> {
    let id = key_of_run(program, solver, scene, &Resolution::TimeStep(0.0), "largest stable step");
    if let Ok(limit) = cache.get::<Json<_>>(&id) {
        return Ok((limit, true));
    }
    let stranger = solvers.strangers().into_iter().find(|stranger| stranger.name == solver);
    let parameter = match (&stranger, Method::from_name(solver)) {
        (Some(stranger), _) if stranger.deforms => Parameter::Courant,
        (None, Some(Method::Grid)) => Parameter::Courant,
        (None, Some(Method::Rigid)) => Parameter::Step,
        _ => Parameter::Fraction,
    };
    let mut limit = Limit {
        scene: name.to_owned(),
        knob: String::new(),
        at: None,
        solver: solver.to_owned(),
        unit: parameter.unit().to_owned(),
        found: None,
        unstable: None,
        exact: None,
        error: None,
        default: Some(parameter.default()),
        margin: None,
        detail: String::new(),
    };
    let is_whole = match solvers.find(solver) {
        None => {
            "there is no such solver".clone_into(&mut limit.detail);
            true
        }
        Some(_) if matches!(parameter, Parameter::Fraction) && !scene.critical_time_step().is_finite() => {
            "the scene has no contact springs, so no step is too large".clone_into(&mut limit.detail);
            true
        }
        Some(solver) => bisect(&mut limit, (&*solver, scene), parameter, (deadline, stop)),
    };
    // An external program fails when it is stopped.
    if is_whole && !stop() {
        cache.put::<Json<_>>(&id, &limit)?;
    }
    Ok((limit, false))
}

/// Finds the limit by bisection. Returns false if the deadline ended it.
fn bisect(
    limit: &mut Limit,
    (solver, scene): (&dyn Solver, &Scene),
    parameter: Parameter,
    (deadline, stop): (Instant, &(dyn Fn() -> bool + Sync)),
) -> bool {
    let mut scene = Scene { snapshots: SNAPSHOTS, snapshot_times: Vec::new(), ..scene.clone() };
    scene.probes.push(Probe { name: PROBE.to_owned(), target: ProbeTarget::System });
    let within = Within::new(solver, deadline, stop);
    let (mut energies, mut exact, mut unstable) = (None, None, None);
    let found = largest(parameter.range(), PRECISION, 0, |value| {
        let record = within.run(&scene, &parameter.at(value), &mut RunOptions::unstable());
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
    let exact =
        exact.filter(|_| matches!(parameter, Parameter::Fraction)).map(|step| step / scene.critical_time_step());
    let linearised = exact.filter(|_| !scene.laws.iter().flatten().all(is_linear));
    let exact = exact.filter(|_| scene.laws.iter().flatten().all(is_linear));
    let (detail, is_whole) = match found {
        Err(Stop::Cannot(why)) => (why, !within.0.is_cut()),
        Err(Stop::Unstable(how)) => (format!("unstable already at {:.3}: {how}", parameter.range()[0]), true),
        Ok(bracket) => {
            limit.found = Some(bracket.stable);
            limit.margin = limit.default.map(|default| bracket.stable / default);
            limit.exact = exact;
            limit.error = exact.map(|exact| (bracket.stable - exact) / exact);
            limit.unstable = unstable.as_ref().map(|(value, _)| *value);
            let how = unstable.map(|(_, how)| how);
            match (bracket.unstable, how) {
                (None, _) => ("stable at each tried step".to_owned(), true),
                (Some((_, Stop::Unstable(how))), _) => (how.to_string(), true),
                (Some((_, Stop::Cannot(why))), Some(how)) => {
                    (format!("{why}; the limit is a lower bound; {how}"), false)
                }
                (Some((_, Stop::Cannot(why))), None) => (format!("{why}; the limit is a lower bound"), false),
            }
        }
    };
    let linearised = linearised.map_or_else(String::new, |step| {
        format!(
            "; without dashpots, the contacts in the snapshots are stable up to {step:.3} (2/ω of central differences)"
        )
    });
    limit.detail = detail + &linearised;
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

/// Returns the largest value of an energy (J); infinity if a value is infinite, and zero if the solver does not report it.
fn largest_energy(record: &Record, name: &str) -> f64 {
    let values = record.series.column(&format!("{PROBE}.{name}")).unwrap_or_default();
    values.iter().copied().fold(0.0, f64::max)
}
