//! Largest stable time step of each assembly and solver.

use super::PATIENCE;
use super::assembly::Assembly;
use super::failure::{Failure, confirmed, of_error};
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::stability::Limit;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::RunOptions;
use grainbench_solver::resolution::Resolution;

/// Relative precision of a limit.
const PRECISION: f64 = 0.005;
/// Range of time steps in which the limit of an assembly is sought (√(m/k)). It is the same for all assemblies, so that
/// it contains no information about the exact limits.
const RANGE: [f64; 2] = [0.15, 3.0];
/// Default time step of input decks and commands (√(m/k)): a tenth of 2√(m/k).
const DEFAULT: f64 = 0.2;
/// Solvers with contact springs, for the limits of assemblies.
pub const SPRINGS: [&str; 3] = ["dem", "lammps", "liggghts"];
/// MPM solvers with their settings, for the limit of the bar.
pub const GRIDS: [&str; 6] =
    ["mpm", "mpm+linear", "mpm+gimp+flip", "mpm+linear+flip", "mpm+linear+flip+usf", "mpm+linear+flip+usl"];
/// Ratio of the energy to its initial value above which a run counts as unstable.
const MORE_ENERGY: f64 = 1.1;

/// Returns the largest stable time step of an assembly for a solver.
#[must_use]
pub fn of_assembly(assembly: &Assembly, (solvers, solver): (&dyn Solvers, &str)) -> Limit {
    let mut limit = Limit {
        scene: assembly.name.to_owned(),
        knob: if assembly.kappa.is_some() { "k_s/k_n".to_owned() } else { String::new() },
        at: assembly.kappa,
        solver: solver.to_owned(),
        unit: "√(m/k)".to_owned(),
        exact: Some(assembly.exact),
        default: Some(DEFAULT),
        ..Limit::default()
    };
    match solvers.find_within(solver, PATIENCE) {
        None => "there is no such solver".clone_into(&mut limit.detail),
        Some(solver) => {
            fill(&mut limit, RANGE, (PRECISION, 1), |step| {
                let run = || solver.run(&assembly.scene, &Resolution::TimeStep(step), &mut RunOptions::unstable());
                let record = confirmed(run).map_err(stop)?;
                assembly.judge(&record).map_err(Stop::Unstable)
            });
        }
    }
    limit
}

/// Returns the largest Courant number at which the energy of a vibrating bar grows by at most a tenth.
///
/// `bar` is the scene of the vibrating bar, and `cells` is the number of cells over its length.
#[must_use]
pub fn of_bar(bar: &Scene, (solvers, setting): (&dyn Solvers, &str), cells: f64) -> Limit {
    let mut limit = Limit {
        scene: "vibrating bar".to_owned(),
        knob: "cells over the length".to_owned(),
        at: Some(cells),
        solver: setting.to_owned(),
        unit: "h/c".to_owned(),
        default: Some(Resolution::COURANT),
        ..Limit::default()
    };
    match solvers.find(setting) {
        Some(solver) => {
            fill(&mut limit, [0.05, 0.8], (PRECISION, 2), |courant| vibrate(&*solver, bar, cells, courant));
        }
        None => "there is no such solver".clone_into(&mut limit.detail),
    }
    limit
}

fn vibrate(solver: &dyn Solver, scene: &Scene, cells: f64, courant: f64) -> Result<(), Stop> {
    let mut scene = scene.clone();
    // These 20 s are two periods of vibration.
    scene.duration = Duration::Seconds(20.0);
    let record = solver
        .run(&scene, &Resolution::Grid { cells, points: 2, courant }, &mut RunOptions::unstable())
        .map_err(stop)?;
    let energy = record.series.column("all.total_energy").unwrap_or_default();
    let start = *energy.first().ok_or_else(|| Stop::Cannot("the record has no energy".to_owned()))?;
    let most = energy
        .iter()
        .map(|energy| energy / start)
        .fold(0.0, |most, now: f64| if now.is_nan() { f64::INFINITY } else { most.max(now) });
    if most > MORE_ENERGY { Err(Stop::Unstable(Failure::Growth(most))) } else { Ok(()) }
}

/// Reason why a time step does not pass.
pub(crate) enum Stop {
    /// No conclusion about stability, such as that the solver cannot run the scene at all.
    Cannot(String),
    /// The run is unstable at this time step.
    Unstable(Failure),
}

fn stop(error: RunError) -> Stop {
    of_error(&error).map_or_else(|| Stop::Cannot(error.to_string()), Stop::Unstable)
}

/// Finds a limit by bisection, and enters it in the result. Returns false if a run without a conclusion ended the bisection;
/// a limit that was found is then a lower bound.
pub(crate) fn fill(
    limit: &mut Limit,
    range: [f64; 2],
    (precision, doublings): (f64, u32),
    test: impl FnMut(f64) -> Result<(), Stop>,
) -> bool {
    let end = match largest(range, precision, doublings, test) {
        Err(Stop::Unstable(how)) => {
            limit.detail = format!("unstable already at {:.3}: {how}", range[0]);
            return true;
        }
        Err(cannot) => Some((range[0], cannot)),
        Ok((found, unstable)) => {
            limit.found = Some(found);
            limit.margin = limit.default.map(|default| found / default);
            limit.error = limit.exact.map(|exact| (found - exact) / exact);
            unstable
        }
    };
    let (detail, is_whole) = match end {
        None => ("stable at each tried step".to_owned(), true),
        Some((step, Stop::Unstable(how))) => {
            limit.unstable = Some(step);
            (how.to_string(), true)
        }
        Some((_, Stop::Cannot(why))) => (why, false),
    };
    limit.detail = detail;
    is_whole
}

/// Largest time step that passed, and the smallest time step that failed with its failure; `None` if no step failed.
type Bracket<F> = (f64, Option<(f64, F)>);

/// Bisects the range between a time step that passes and one that fails on a logarithmic scale, until they differ by a
/// relative `precision`.
///
/// If the upper end of the range passes, it is doubled up to `doublings` times.
///
/// # Errors
/// The failure at the lower end of the range.
fn largest<F>(
    [low, high]: [f64; 2],
    precision: f64,
    doublings: u32,
    mut test: impl FnMut(f64) -> Result<(), F>,
) -> Result<Bracket<F>, F> {
    test(low)?;
    let (mut stable, mut above) = (low, high);
    let mut failure = None;
    for _ in 0..=doublings {
        match test(above) {
            Err(how) => {
                failure = Some((above, how));
                break;
            }
            Ok(()) => (stable, above) = (above, 2.0 * above),
        }
    }
    let Some(mut unstable) = failure else { return Ok((stable, None)) };
    while unstable.0 > stable * (1.0 + precision) {
        let middle = (stable * unstable.0).sqrt();
        match test(middle) {
            Ok(()) => stable = middle,
            Err(how) => unstable = (middle, how),
        }
    }
    Ok((stable, Some(unstable)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::assembly;
    use grainbench_dem::{convention::Convention, solver::Dem};
    use grainbench_solver::failure::Failure as ProgramFailure;
    use grainbench_solver::observer::Observer;
    use grainbench_solver::record::Record;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// The DEM as a program that crashes in one of its runs.
    #[derive(Clone)]
    struct CrashingOnce {
        runs: Arc<AtomicU64>,
        crash: u64,
    }

    impl Solver for CrashingOnce {
        fn name(&self) -> String {
            "dem".to_owned()
        }

        fn run(&self, scene: &Scene, step: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
            if self.runs.fetch_add(1, Ordering::Relaxed) == self.crash {
                let failure = ProgramFailure::Crash("exit status: 1".to_owned());
                return Err(RunError::Program { solver: self.name(), failure, last_lines: Vec::new() });
            }
            Dem::new(Convention::DEFAULT).run(scene, step, observer)
        }
    }

    impl Solvers for CrashingOnce {
        fn find(&self, _: &str) -> Option<Arc<dyn Solver>> {
            Some(Arc::new(self.clone()))
        }
    }

    #[test]
    fn a_crash_that_does_not_repeat_is_no_instability() {
        let pair = assembly::all().unwrap().into_iter().find(|assembly| assembly.name == "free pair").unwrap();
        let limits = [0, 1, 4, u64::MAX].map(|crash| {
            let solver = CrashingOnce { runs: Arc::default(), crash };
            of_assembly(&pair, (&solver, "dem"))
        });
        assert!(limits.iter().all(|limit| limit.found.is_some() && *limit == limits[3]), "{limits:?}");
        assert!(limits[3].error.unwrap().abs() < 0.01, "{:?}", limits[3]);
    }

    #[test]
    fn finds_a_threshold_and_its_failure() {
        let mut tried = 0;
        let found = largest([0.1, 3.0], 1e-3, 0, |step| {
            tried += 1;
            if step <= 2.0_f64.sqrt() { Ok(()) } else { Err("too large") }
        });
        let (stable, unstable) = found.unwrap();
        assert!((stable / 2.0_f64.sqrt() - 1.0).abs() < 1e-3 && tried < 20, "{stable}, {unstable:?}");
        assert_eq!(unstable.unwrap().1, "too large");
    }

    #[test]
    fn limits_outside_the_range_are_reported() {
        let always = largest([1.0, 2.0], 0.01, 3, |_| Ok::<(), ()>(())).unwrap();
        assert_eq!(always, (16.0, None));
        assert_eq!(largest([1.0, 2.0], 0.01, 3, |_| Err("no")), Err("no"));
    }
}
