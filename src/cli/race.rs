//! `grainbench race`: how fast solvers are, beside other programs on the same scenes in turn.

use super::exit::{Fault, Outcome, RED, check_writable, print};
use super::progress::Progress;
use super::provenance::provenance;
use super::subject;
use grainbench::cases::solvers;
use grainbench::reports::{Provenance, StagedDir};
use grainbench::scene::solver::{Resolution, Solver};
use grainbench::studies::Follow;
use grainbench::studies::race::{Heat, Racer, Track, apart, heat, spread};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Scenes that are run where none is named: dense in the plane and in space, sparse, and few grains.
const TRACKS: [&str; 4] = ["plane-shear", "settled-column", "cooling-gas", "nine-discs/kappa-1"];
/// Our solver in the convention of a program, and the program.
const PAIRS: [[&str; 2]; 2] = [["dem:lammps", "lammps"], ["dem:liggghts", "liggghts"]];
/// Particle-steps of a long run, unless steps are asked for: some seconds of any program.
const WORK: u64 = 20_000_000;
/// Most steps of one: of few grains what a step costs by itself is felt early.
const MOST_STEPS: u64 = 600_000;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Scenes of grains, by case or file.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml")]
    tracks: Vec<String>,
    /// Laps of each racer on each scene.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..1000))]
    rounds: u32,
    /// Steps of the short and of the long run.
    #[arg(long, value_name = "SHORT,LONG", value_parser = steps)]
    steps: Option<[u64; 2]>,
    /// Only this solver or program; may be given more than once.
    #[arg(long, value_name = "NAME")]
    solver: Vec<String>,
    /// Directory for `race.json`, which keeps every lap, and `race.md`.
    #[arg(long, value_name = "DIR", default_value = "grainbench-race")]
    out: PathBuf,
}

/// Two numbers of steps.
fn steps(text: &str) -> Result<[u64; 2], String> {
    let expected = || format!("expected two numbers of steps, the second larger, found `{text}`");
    let (short, long) = text.split_once(',').ok_or_else(expected)?;
    match (short.trim().parse(), long.trim().parse()) {
        (Ok(short), Ok(long)) if 0 < short && short < long => Ok([short, long]),
        _ => Err(expected()),
    }
}

/// What is kept of a race.
#[derive(Serialize, Deserialize)]
pub(crate) struct Race {
    provenance: Provenance,
    heats: Vec<Heat>,
}

/// Runs the race and leaves its table.
pub(crate) fn race(arguments: &Arguments) -> Outcome {
    let known = PAIRS.as_flattened();
    if let Some(unknown) = arguments.solver.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Fault::unknown("a racer", unknown, known.iter().copied()));
    }
    check_writable(&arguments.out)?;
    let names: Vec<&str> = if arguments.tracks.is_empty() {
        TRACKS.to_vec()
    } else {
        arguments.tracks.iter().map(String::as_str).collect()
    };
    let tracks = names.iter().map(|name| track(name, arguments.steps)).collect::<Result<Vec<_>, _>>()?;
    let wanted = |name: &str| arguments.solver.is_empty() || arguments.solver.iter().any(|wanted| wanted == name);
    let entered: Vec<(Box<dyn Solver>, &'static str)> = PAIRS
        .iter()
        .flat_map(|pair| pair.iter().map(|&name| (name, pair[1])))
        .filter(|(name, _)| wanted(name))
        .filter_map(|(name, against)| Some((solvers::by_name(name)?, against)))
        .collect();
    let racers: Vec<Racer<'_>> =
        entered.iter().map(|(solver, against)| Racer { solver: solver.as_ref(), against }).collect();
    let start = Instant::now();
    let laps = tracks.len() as u64 * racers.len() as u64 * u64::from(arguments.rounds);
    let mut follower = Laps(Progress::new(laps, "laps"));
    let heats: Vec<Heat> = tracks.iter().map(|track| heat(track, &racers, arguments.rounds, &mut follower)).collect();
    drop(follower);
    let has_run = heats.iter().flat_map(|heat| &heat.results).any(|raced| !raced.rates.is_empty());
    let options = vec![format!("rounds {}", arguments.rounds)];
    let race = Race { provenance: provenance(options, start.elapsed().as_secs_f64()), heats };
    let table = table(&race);
    let mut out = StagedDir::new(&arguments.out).map_err(Fault::writing)?;
    let json = serde_json::to_string_pretty(&race).map_err(Fault::input)?;
    out.write("race.json", json + "\n").map_err(Fault::writing)?;
    out.write("race.md", &table).map_err(Fault::writing)?;
    out.commit().map_err(Fault::writing)?;
    print(&table)?;
    print(&format!("\n{}\n", arguments.out.join("race.md").display()))?;
    Ok(if has_run { ExitCode::SUCCESS } else { ExitCode::from(RED) })
}

/// A scene that grains on springs can run, at the step that its case takes for them.
fn track(name: &str, steps: Option<[u64; 2]>) -> Result<Track, Fault> {
    let (scene, case) = subject::scene(name, &[])?;
    if scene.grains.is_empty() {
        return Err(Fault::input(format!("expected a scene with grains, found none in `{name}`")));
    }
    let of_case = case.map(|case| case.default_level.resolution);
    let resolution = match of_case {
        Some(step @ (Resolution::CriticalFraction(_) | Resolution::TimeStep(_))) => step,
        _ => Resolution::CriticalFraction(0.1),
    };
    let long = (WORK / scene.grains.len() as u64).clamp(60, MOST_STEPS);
    Ok(Track { name: name.to_owned(), scene, resolution, steps: steps.unwrap_or([long / 6, long]) })
}

struct Laps(Progress);

impl Follow for Laps {
    fn now(&mut self, piece: &str) {
        self.0.now(piece);
    }
    fn done(&mut self, _reused: bool) {
        self.0.advance();
    }
}

/// The race as a table: medians of the laps with their least and largest.
fn table(race: &Race) -> String {
    let shown = |values: &[f64], digits: usize| {
        spread(values).map_or_else(
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
    for heat in &race.heats {
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
            let _ =
                writeln!(text, "| `{track}` | {grains} | {short}, {long} | `{solver}` | {rate} | {ratio} | {off} |");
        }
    }
    let programs = race.heats.iter().flat_map(|heat| &heat.results).filter(|raced| raced.solver == raced.against);
    let versions: BTreeSet<&str> = programs.filter_map(|raced| raced.version.as_deref()).collect();
    let Provenance { version, commit, date, machine, .. } = &race.provenance;
    let ours = format!("grainbench {version} ({commit})");
    let all: Vec<&str> = [ours.as_str()].into_iter().chain(versions).chain([date.as_str(), machine]).collect();
    let _ = writeln!(text, "\n{}.", all.join("; "));
    text
}
