//! Throughput benchmark of solvers and external programs on the same scenes. It reports particle-steps per second of
//! processor time, and ratios of these rates.
//!
//! A timing is the processor time of a long run minus that of a short run, so that start-up and output cancel. In every
//! round each solver is timed once, and ratios of rates are taken within the round. A temporarily slow machine
//! therefore affects all solvers of a round alike.

use crate::clock::cpu_seconds;
use grainbench_harness::statistics::range;
use grainbench_reports::table::{Cell, Column, Format, Table};
use grainbench_reports::{Provenance, number, row};
use grainbench_scene::columns::Columns;
use grainbench_scene::scene::{Duration, Probe, ProbeTarget, Sampling, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::resolution::Resolution;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

/// Shortest timing that is used (s of processor time). A shorter difference of two times is noise.
const SHORTEST: f64 = 0.05;

/// Benchmark scene with its resolution and step counts.
#[derive(Clone, Debug)]
pub struct Track {
    /// Name of the benchmark scene.
    pub name: String,
    /// Scene of the runs. The benchmark replaces its duration, probes and output.
    pub scene: Scene,
    /// Time step of all runs.
    pub resolution: Resolution,
    /// Numbers of steps of the short and of the long run.
    pub steps: [u64; 2],
}

/// Benchmarked solver and name of the solver with which it is compared.
pub struct BenchmarkedSolver {
    /// Solver whose rate is measured.
    pub solver: Arc<dyn Solver>,
    /// Name of the solver by whose rate this solver's rate is divided.
    pub against: &'static str,
    /// True for a program that keeps running between runs.
    ///
    /// Its processor time is unknown before it ends, so its wall time with one thread is used instead.
    pub stays: bool,
}

/// Results of all solvers for one scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneThroughput {
    /// Name of the benchmark scene.
    pub track: String,
    /// Number of grains.
    pub grains: usize,
    /// Numbers of steps of the short and of the long run.
    pub steps: [u64; 2],
    /// Results in the order of the solvers.
    pub results: Vec<SolverThroughput>,
}

/// Result of one solver.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SolverThroughput {
    /// Name of the solver.
    pub solver: String,
    /// Version, if the solver reports one.
    pub version: Option<String>,
    /// Millions of particle-steps per second of processor time, for each round.
    pub rates: Vec<f64>,
    /// Ratio of the rate to the rate of the reference solver, for each round.
    pub ratios: Vec<f64>,
    /// Name of the reference solver, whose rates are the denominators of `ratios`.
    pub against: String,
    /// Kinetic energy of the grains at the end of the short run (J). Equal energies show that solvers ran the same
    /// scene.
    pub kinetic_energy: Option<f64>,
    /// Reason why the solver has no rates.
    pub absent: Option<String>,
}

/// Stored result of a throughput benchmark.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ThroughputBenchmark {
    /// Version, date and machine.
    pub provenance: Provenance,
    /// Results by scene.
    pub heats: Vec<SceneThroughput>,
}

impl ThroughputBenchmark {
    /// Returns the benchmark as Markdown.
    #[must_use]
    pub fn markdown(&self) -> String {
        self.words(&self.table().markdown())
    }

    /// Returns the benchmark as text for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        self.words(&self.table().text())
    }

    /// Returns the table with a note about its entries and with the versions of all programs.
    fn words(&self, table: &str) -> String {
        let programs = self.heats.iter().flat_map(|heat| &heat.results).filter(|raced| raced.solver == raced.against);
        let versions: BTreeSet<&str> = programs.filter_map(|raced| raced.version.as_deref()).collect();
        let Provenance { version, commit, date, machine, .. } = &self.provenance;
        let ours = format!("grainbench {version} ({commit})");
        let all: Vec<&str> = [ours.as_str()].into_iter().chain(versions).chain([date.as_str(), machine]).collect();
        format!(
            "Rates are in million particle-steps per second of processor time, from the difference of a long and a short \
             run. The solvers took turns, and a ratio compares two runs of the same round. Entries are median \
             (smallest..largest).\n\n{table}\n{}.\n",
            all.join("; ")
        )
    }

    /// Returns the table of median, minimum and maximum over the rounds.
    fn table(&self) -> Table<'_> {
        let columns = [
            Column::heading("scene"),
            Column::new("grains", Format::Count),
            Column::text("steps"),
            Column::text("solver"),
            Column::text("rate"),
            Column::text("ratio to the program"),
            Column::text("difference in kinetic energy"),
        ];
        let shown = |values: &[f64]| -> Cell {
            range(values).map(|[least, middle, largest]| format!("{middle:.2} ({least:.2}..{largest:.2})")).into()
        };
        let row = move |(heat, raced): (&SceneThroughput, &SolverThroughput)| {
            let [rate, ratio, off] = match &raced.absent {
                Some(reason) => [reason.into(), "".into(), "".into()],
                None if raced.solver == raced.against => [shown(&raced.rates), "".into(), "".into()],
                None => {
                    let off = apart(heat, raced).map(|off| format!("{off:.0e}"));
                    [shown(&raced.rates), shown(&raced.ratios), off.into()]
                }
            };
            let [short, long] = heat.steps.map(number::count);
            row![&heat.track, heat.grains, format!("{short}, {long}"), &raced.solver, rate, ratio, off]
        };
        let results = self.heats.iter().flat_map(|heat| heat.results.iter().map(move |raced| (heat, raced)));
        Table::new("", columns, results.map(row))
    }
}

/// Returns the scene with a given number of steps. Its only output is the energy at the end.
fn for_steps(scene: &Scene, steps: u64) -> Scene {
    Scene {
        duration: Duration::Cycles(steps),
        sampling: Sampling::Cycles(steps),
        snapshots: 0,
        snapshot_times: Vec::new(),
        snapshot_contacts: false,
        columns: Columns::default(),
        probes: vec![Probe { name: "all".to_owned(), target: ProbeTarget::System }],
        ..scene.clone()
    }
}

/// Returns the processor time of a run (s), the kinetic energy at its end (J) and the version of the program. For a program
/// that keeps running between runs, the time is the wall-clock time.
fn run(racer: &BenchmarkedSolver, track: &Track, steps: u64) -> Result<(f64, Option<f64>, Option<String>), RunError> {
    let scene = for_steps(&track.scene, steps);
    let begun = cpu_seconds();
    let start = Instant::now();
    let record = racer.solver.run(&scene, &track.resolution, &mut ())?;
    let spent = if racer.stays { start.elapsed().as_secs_f64() } else { cpu_seconds() - begun };
    let energy = record.series.column("all.kinetic_energy").and_then(|values| values.last().copied());
    Ok((spent, energy, record.provenance.options.into_iter().next()))
}

/// Times all solvers on a benchmark scene in turn, in a number of rounds. `now` receives the name of each timing before it.
pub fn heat(track: &Track, racers: &[BenchmarkedSolver], rounds: u32, now: &dyn Fn(&str)) -> SceneThroughput {
    let blank = |racer: &BenchmarkedSolver| SolverThroughput {
        solver: racer.solver.name(),
        against: racer.against.to_owned(),
        absent: racer.solver.available().err().map(|reason| reason.to_string()),
        ..SolverThroughput::default()
    };
    let mut results: Vec<SolverThroughput> = racers.iter().map(blank).collect();
    let particle_steps = (track.steps[1] - track.steps[0]) as f64 * track.scene.grains.len() as f64;
    for round in 1..=rounds {
        for (racer, raced) in racers.iter().zip(&mut results) {
            now(&format!("{}, {}, lap {round} of {rounds}", track.name, raced.solver));
            if raced.absent.is_none() {
                let lap = |raced: &mut SolverThroughput| -> Result<f64, RunError> {
                    let [short, long] = track.steps;
                    let (before, energy, version) = run(racer, track, short)?;
                    let (after, ..) = run(racer, track, long)?;
                    (raced.kinetic_energy, raced.version) = (energy, version);
                    Ok(after - before)
                };
                match lap(raced) {
                    Ok(seconds) if seconds < SHORTEST => {
                        raced.absent = Some(format!("too few steps: a run took {:.0} ms", 1e3 * seconds));
                    }
                    Ok(seconds) => raced.rates.push(1e-6 * particle_steps / seconds),
                    Err(reason) => raced.absent = Some(reason.to_string()),
                }
            }
        }
    }
    let rates: Vec<(String, Vec<f64>)> =
        results.iter().map(|raced| (raced.solver.clone(), raced.rates.clone())).collect();
    for raced in &mut results {
        if let Some((_, of_other)) = rates.iter().find(|(solver, _)| *solver == raced.against) {
            raced.ratios = raced.rates.iter().zip(of_other).map(|(rate, other)| rate / other).collect();
        }
    }
    SceneThroughput { track: track.name.clone(), grains: track.scene.grains.len(), steps: track.steps, results }
}

/// Returns the relative difference of the kinetic energies of a solver and its reference solver, or `None` if one of the
/// energies is unknown.
fn apart(heat: &SceneThroughput, raced: &SolverThroughput) -> Option<f64> {
    let other = heat.results.iter().find(|other| other.solver == raced.against)?;
    let (ours, theirs) = (raced.kinetic_energy?, other.kinetic_energy?);
    Some((ours - theirs).abs() / theirs.abs())
}
