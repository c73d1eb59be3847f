//! Solvers and other programs on the same scenes in turn: grains stepped in a second of processor time, and how often as
//! many as by another.
//!
//! A lap is a long run less a short one, so that start, set-up and output do not count, in processor time of all that takes
//! part. In every round each racer does one lap of a scene, and rates are divided within the round: a machine that is slower
//! for a while is so for all of them.

use crate::Follow;
use crate::clock::cpu_seconds;
use grainbench_harness::statistics::range;
use grainbench_reports::Provenance;
use grainbench_scene::columns::Columns;
use grainbench_scene::scene::{Duration, Probe, ProbeTarget, Sampling, Scene};
use grainbench_scene::solver::{Resolution, RunError, Solver};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::Instant;

/// A lap that takes less processor time (s) tells noise: it is the difference of two times.
const SHORTEST: f64 = 0.05;

/// What is run: a scene at a step, for so many steps.
#[derive(Clone, Debug)]
pub struct Track {
    /// Its name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The step.
    pub resolution: Resolution,
    /// Steps of the short and of the long run.
    pub steps: [u64; 2],
}

/// A racer and the one that its rate is divided by.
pub struct Racer {
    /// The solver.
    pub solver: Arc<dyn Solver>,
    /// Whose rate the others of its pair are divided by.
    pub against: &'static str,
    /// Whether it is a program that stays from run to run: what it spent is not told before it ends, and of one thread it is what
    /// the clock shows.
    pub stays: bool,
}

/// What all racers did on a track.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Heat {
    /// Name of the track.
    pub track: String,
    /// Grains.
    pub grains: usize,
    /// Steps of the short and of the long run.
    pub steps: [u64; 2],
    /// What each did, in the order in which they were named.
    pub results: Vec<Raced>,
}

/// What a racer did.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Raced {
    /// The solver.
    pub solver: String,
    /// Its version, where it tells one.
    pub version: Option<String>,
    /// Million particle-steps in a second of processor time, lap by lap.
    pub rates: Vec<f64>,
    /// Its rate over that of the racer it is compared with, lap by lap.
    pub ratios: Vec<f64>,
    /// The racer it is compared with.
    pub against: String,
    /// Kinetic energy of the grains after the short run (J): the same scene was run where they agree.
    pub kinetic_energy: Option<f64>,
    /// Why it took no part.
    pub absent: Option<String>,
}

/// What is kept of a race.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Race {
    /// Where and when.
    pub provenance: Provenance,
    /// Scene by scene.
    pub heats: Vec<Heat>,
}

impl Race {
    /// The race as a table: medians of the laps with their least and largest.
    #[must_use]
    pub fn table(&self) -> String {
        let shown = |values: &[f64], digits: usize| {
            range(values).map_or_else(
                || "–".to_owned(),
                |[least, middle, largest]| format!("{middle:.digits$} [{least:.digits$}..{largest:.digits$}]"),
            )
        };
        let mut text =
            "Million particle-steps in a second of processor time, of a long run less that of a short one; racers \
                        took turns, and ratios are of the same round. Median [least..largest].\n\n\
                        | scene | grains | steps | racer | rate | over the program | kinetic energy apart |\n\
                        |---|---|---|---|---|---|---|\n"
                .to_owned();
        for heat in &self.heats {
            for raced in &heat.results {
                let [short, long] = heat.steps;
                let (rate, ratio, off) = match &raced.absent {
                    Some(reason) => (reason.replace('|', "¦"), String::new(), String::new()),
                    None if raced.solver == raced.against => (shown(&raced.rates, 2), String::new(), String::new()),
                    None => {
                        let off = apart(heat, raced).map_or_else(|| "–".to_owned(), |off| format!("{off:.0e}"));
                        (shown(&raced.rates, 2), shown(&raced.ratios, 2), off)
                    }
                };
                let (track, grains, solver) = (&heat.track, heat.grains, &raced.solver);
                let _ = writeln!(
                    text,
                    "| `{track}` | {grains} | {short}, {long} | `{solver}` | {rate} | {ratio} | {off} |"
                );
            }
        }
        let programs = self.heats.iter().flat_map(|heat| &heat.results).filter(|raced| raced.solver == raced.against);
        let versions: BTreeSet<&str> = programs.filter_map(|raced| raced.version.as_deref()).collect();
        let Provenance { version, commit, date, machine, .. } = &self.provenance;
        let ours = format!("grainbench {version} ({commit})");
        let all: Vec<&str> = [ours.as_str()].into_iter().chain(versions).chain([date.as_str(), machine]).collect();
        let _ = writeln!(text, "\n{}.", all.join("; "));
        text
    }
}

/// The scene for so many steps, with nothing to be told of it but the energy at its end.
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

/// Processor time of a run (s), and what it left: kinetic energy at its end (J) and the version of the program.
fn run(racer: &Racer, track: &Track, steps: u64) -> Result<(f64, Option<f64>, Option<String>), RunError> {
    let scene = for_steps(&track.scene, steps);
    let begun = cpu_seconds();
    let start = Instant::now();
    let record = racer.solver.run(&scene, &track.resolution, &mut ())?;
    let spent = if racer.stays { start.elapsed().as_secs_f64() } else { cpu_seconds() - begun };
    let energy = record.series.column("all.kinetic_energy").and_then(|values| values.last().copied());
    Ok((spent, energy, record.provenance.options.into_iter().next()))
}

/// All racers on a track, `rounds` times in turn.
pub fn heat(track: &Track, racers: &[Racer], rounds: u32, follow: &mut impl Follow) -> Heat {
    let blank = |racer: &Racer| Raced {
        solver: racer.solver.name(),
        version: None,
        rates: Vec::new(),
        ratios: Vec::new(),
        against: racer.against.to_owned(),
        kinetic_energy: None,
        absent: racer.solver.available().err().map(|reason| reason.to_string()),
    };
    let mut results: Vec<Raced> = racers.iter().map(blank).collect();
    let particle_steps = (track.steps[1] - track.steps[0]) as f64 * track.scene.grains.len() as f64;
    for round in 1..=rounds {
        for (racer, raced) in racers.iter().zip(&mut results) {
            follow.now(&format!("{}, {}, lap {round} of {rounds}", track.name, raced.solver));
            if raced.absent.is_none() {
                let lap = |raced: &mut Raced| -> Result<f64, RunError> {
                    let [short, long] = track.steps;
                    let (before, energy, version) = run(racer, track, short)?;
                    let (after, ..) = run(racer, track, long)?;
                    (raced.kinetic_energy, raced.version) = (energy, version);
                    Ok(after - before)
                };
                match lap(raced) {
                    Ok(seconds) if seconds < SHORTEST => {
                        raced.absent = Some(format!("too few steps to tell: a lap took {:.0} ms", 1e3 * seconds));
                    }
                    Ok(seconds) => raced.rates.push(1e-6 * particle_steps / seconds),
                    Err(reason) => raced.absent = Some(reason.to_string()),
                }
            }
            follow.done(false);
        }
    }
    let rates: Vec<(String, Vec<f64>)> =
        results.iter().map(|raced| (raced.solver.clone(), raced.rates.clone())).collect();
    for raced in &mut results {
        if let Some((_, of_other)) = rates.iter().find(|(solver, _)| *solver == raced.against) {
            raced.ratios = raced.rates.iter().zip(of_other).map(|(rate, other)| rate / other).collect();
        }
    }
    Heat { track: track.name.clone(), grains: track.scene.grains.len(), steps: track.steps, results }
}

/// How far apart the kinetic energies of a racer and of the one that it is compared with are, relative to the latter.
#[must_use]
pub fn apart(heat: &Heat, raced: &Raced) -> Option<f64> {
    let other = heat.results.iter().find(|other| other.solver == raced.against)?;
    let (ours, theirs) = (raced.kinetic_energy?, other.kinetic_energy?);
    Some((ours - theirs).abs() / theirs.abs())
}
