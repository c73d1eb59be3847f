//! `grainbench race`: measures the throughput of our solvers and of other programs, in turn on the same scenes.

use super::exit::{Fault, Outcome, THROUGHPUT, check_output, exit_code, print, print_text, refuse};
use super::progress::Progress;
use super::provenance::provenance;
use super::publish::write_files;
use super::value::whole;
use super::{solver, subject};
use grainbench::cases::registry::read_grains;
use grainbench::cases::solvers;
use grainbench::scene::source::SceneSource;
use grainbench::solver::resolution::Resolution;
use grainbench::store::StagedDir;
use grainbench::studies::race::{BenchmarkedSolver, SceneThroughput, ThroughputBenchmark, Track, heat};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Default benchmark scenes: dense discs, dense spheres, a sparse gas, Hertz contacts, few grains, and the impact of a
/// ball on a bed of 25,000 grains.
const TRACKS: [&str; 7] =
    ["plane-shear", "cooling-gas", "nine-discs/kappa-1", "discs-400", "spheres", "hertz", "impact-bed/late"];
/// Benchmark scenes that are not cases.
const SCENES: [(&str, &str); 3] = [
    ("discs-400", include_str!("../../benches/race/discs-400.toml")),
    ("spheres", include_str!("../../benches/race/spheres.toml")),
    ("hertz", include_str!("../../benches/race/hertz.toml")),
];
/// Pairs of our solver, in the contact convention of a program, and the program.
const PAIRS: [[&str; 2]; 2] = [["dem:lammps", "lammps"], ["dem:liggghts", "liggghts"]];
/// Default number of particle-steps of the long run. Every program needs some seconds for it.
const WORK: u64 = 30_000_000;
/// Largest default number of steps of the long run, for scenes with few grains.
const MOST_STEPS: u64 = 600_000;

/// Largest default number of steps of the short run. Kinetic energies are compared at its end, because later collisions
/// amplify rounding errors.
const MOST_TO_COMPARE: u64 = 1000;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Scenes of grains, by case or scene file.
    ///
    /// Default: plane-shear, cooling-gas, nine-discs/kappa-1, impact-bed/late, and three scenes that are not cases:
    /// discs-400, spheres and hertz.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml")]
    tracks: Vec<String>,
    /// Number of timings for each solver and each scene.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = whole::<u32>(1, 999))]
    rounds: u32,
    /// Numbers of steps of the short and of the long run. Default: about 30 million particle-steps for the long run,
    /// and at most 1000 steps for the short run.
    #[arg(long, value_name = "SHORT,LONG", value_parser = steps)]
    steps: Option<[u64; 2]>,
    /// Measure only this solver or program. A manifest adds a program to the comparison with LAMMPS. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    /// Directory of `race.json`, with each timing, and of `race.md`.
    #[arg(long, value_name = "DIR", default_value = "grainbench-race")]
    out: PathBuf,
}

/// Reads the numbers of steps of the short and of the long run.
fn steps(text: &str) -> Result<[u64; 2], String> {
    let expected = || format!("expected two numbers of steps, with the second larger than the first, found `{text}`");
    let (short, long) = text.split_once(',').ok_or_else(expected)?;
    match (short.trim().parse(), long.trim().parse()) {
        (Ok(short), Ok(long)) if 0 < short && short < long => Ok([short, long]),
        _ => Err(expected()),
    }
}

/// Runs the benchmark and writes the table of throughputs.
pub(crate) fn race(arguments: &Arguments) -> Outcome {
    let known = PAIRS.as_flattened();
    let (manifests, named): (Vec<&String>, Vec<&String>) =
        arguments.solver.iter().partition(|name| solver::is_manifest(name));
    if let Some(unknown) = named.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Fault::unknown("a solver or program", unknown, known.iter().copied()));
    }
    check_output(&arguments.out, &THROUGHPUT, &["race.json", "race.md"])?;
    let names: Vec<&str> = if arguments.tracks.is_empty() {
        TRACKS.to_vec()
    } else {
        arguments.tracks.iter().map(String::as_str).collect()
    };
    let tracks = names.iter().map(|name| track(name, arguments.steps)).collect::<Result<Vec<_>, _>>()?;
    let wanted = |name: &str| {
        let is_beside = !manifests.is_empty() && PAIRS[0].contains(&name);
        arguments.solver.is_empty() || is_beside || named.iter().any(|wanted| *wanted == name)
    };
    let of_registry = PAIRS
        .iter()
        .flat_map(|pair| pair.iter().map(|&name| (name, pair[1])))
        .filter(|(name, _)| wanted(name))
        .filter_map(|(name, against)| {
            Some(BenchmarkedSolver { solver: solvers::by_name(name)?.into(), against, stays: false })
        });
    let mut racers: Vec<BenchmarkedSolver> = of_registry.collect();
    for path in manifests {
        let program = solver::outside(path)?;
        let stays = !program.manifest().worker.is_empty();
        racers.push(BenchmarkedSolver { solver: program, against: PAIRS[0][1], stays });
    }
    let start = Instant::now();
    let laps = tracks.len() as u64 * racers.len() as u64 * u64::from(arguments.rounds);
    let progress = Progress::new(laps, "laps");
    let now = |lap: &str| {
        progress.now(lap);
        progress.advance();
    };
    let heats: Vec<SceneThroughput> = tracks.iter().map(|track| heat(track, &racers, arguments.rounds, &now)).collect();
    drop(progress);
    let has_run = heats.iter().flat_map(|heat| &heat.results).any(|raced| !raced.rates.is_empty());
    let options = vec![format!("rounds {}", arguments.rounds)];
    let race = ThroughputBenchmark { provenance: provenance(options, start.elapsed().as_secs_f64()), heats };
    let json = serde_json::to_string_pretty(&race)? + "\n";
    write_files(StagedDir::new(&arguments.out)?, &[("race.json", json), ("race.md", race.markdown())])?;
    print_text(&race.text())?;
    print(&format!("\n{}\n", arguments.out.join("race.md").display()))?;
    Ok(exit_code(!has_run))
}

/// Returns a benchmark scene with grains. Its time step is the default time step of its case, or 0.1 of the critical one.
fn track(name: &str, steps: Option<[u64; 2]>) -> Result<Track, Fault> {
    let (scene, case) = match SCENES.iter().find(|(known, _)| *known == name) {
        Some((known, text)) => (SceneSource::from_text(known, Path::new(""), text).scene(&read_grains)?, None),
        None => subject::scene(name, &[])?,
    };
    if scene.grains.is_empty() {
        refuse!("expected a scene with grains, found none in `{name}`");
    }
    let of_case = case.map(|case| case.default_level.resolution);
    let resolution = match of_case {
        Some(step @ (Resolution::CriticalFraction(_) | Resolution::TimeStep(_))) => step,
        _ => Resolution::CriticalFraction(0.1),
    };
    let long = (WORK / scene.grains.len() as u64).clamp(60, MOST_STEPS);
    let steps = steps.unwrap_or([(long / 6).min(MOST_TO_COMPARE), long]);
    Ok(Track { name: name.to_owned(), scene, resolution, steps })
}
