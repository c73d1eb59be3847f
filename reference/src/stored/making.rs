//! Creation of stored runs with an installed program.

use std::io::Write as _;

use flate2::{Compression, GzBuilder};
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::perturbed::{PARTED, move_one};
use grainbench_solver::record::{Record, Series};
use grainbench_solver::refined::refined;
use grainbench_solver::resolution::Resolution;
use grainbench_store::artifact::hashes;

use super::scene_hash::scene_hash;
use super::{HALF_STEP_SERIES, PROVENANCE, Provenance, SERIES, drift};
use crate::deck::{Program, Stepping, write_deck};
use crate::live::LiveProgram;

/// Maximum number of stored samples of a run, without the last sample.
const MOST_SAMPLES: usize = 100;
/// Size from which a file of the deck is compressed (B).
const LARGE: usize = 1 << 14;

/// Runs a scene three times: as it is, with half the time step, and with a perturbed initial state. Returns the files of
/// the stored run by name and content, with `provenance.toml` last.
///
/// `id` is the name of the run in `reference build`. `title` describes the run, and `date` is the day (YYYY-MM-DD).
///
/// # Errors
/// If the program cannot express the scene, is not installed or fails, or if a value is not finite.
pub fn make(
    program: Program,
    id: &str,
    title: &str,
    date: &str,
    scene: &Scene,
    resolution: &Resolution,
) -> Result<Vec<(String, Vec<u8>)>, RunError> {
    let live = LiveProgram::find(program);
    let fail = |reason: String| RunError::Resolution { solver: program.name().to_owned(), reason };
    let stepping = Stepping::new(scene, resolution).map_err(fail)?;
    let run = live.run(scene, resolution, &mut ())?;
    let (half_scene, half_resolution) = refined(scene, stepping.time_step, [stepping.steps, stepping.interval], 2);
    let half = live.run(&half_scene, &half_resolution, &mut ())?;
    let mut moved_scene = scene.clone();
    move_one(&mut moved_scene);
    let moved = live.run(&moved_scene, resolution, &mut ())?;
    let deck = write_deck(scene, resolution, program).map_err(|error| fail(error.to_string()))?;
    let mut files = Vec::new();
    for (name, text) in deck.files {
        if text.len() < LARGE {
            files.push((name, text.into_bytes()));
        } else {
            files.push((format!("{name}.gz"), compressed(&text)));
        }
    }
    files.push((SERIES.to_owned(), compressed(&table(&run, program)?)));
    files.push((HALF_STEP_SERIES.to_owned(), compressed(&table(&half, program)?)));
    let mut commands =
        vec![program.command().to_owned(), format!("grainbench reference build {}/{id}", program.name())];
    let packed = files.iter().filter_map(|(name, _)| name.strip_suffix(".gz")).filter(|name| !name.ends_with(".csv"));
    for name in packed {
        commands.insert(0, format!("gzip -dk {name}.gz"));
    }
    let provenance = Provenance {
        program: program.to_string(),
        version: run.provenance.options.first().cloned().unwrap_or_default(),
        date: date.to_owned(),
        title: title.to_owned(),
        scene: scene_hash(scene, &stepping),
        predictable_steps: predictable_steps(&thinned(&run.series), &moved.series),
        commands,
        blake3: hashes(&files),
    };
    let text = toml::to_string(&provenance).map_err(|error| fail(error.to_string()))?;
    files.push((PROVENANCE.to_owned(), text.into_bytes()));
    Ok(files)
}

/// Returns about 100 samples of a run as CSV in full precision.
fn table(record: &Record, program: Program) -> Result<String, RunError> {
    let series = thinned(&record.series);
    for (column, values) in series.columns.iter().zip(&series.values) {
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let failure = Failure::Output(format!("`{}` is {} at step {}", column.name, values[at], series.step[at]));
            return Err(RunError::Program { solver: program.name().to_owned(), failure, last_lines: Vec::new() });
        }
    }
    Ok(csv_of(&series))
}

/// Returns a time series as CSV in full precision.
#[must_use]
pub fn csv_of(series: &Series) -> String {
    let names: String = series.columns.iter().map(|column| format!(",{}", column.name)).collect();
    let mut lines = format!("step,time{names}\n");
    for (at, (step, time)) in series.step.iter().zip(&series.time).enumerate() {
        let values: String = series.values.iter().map(|values| format!(",{:?}", values[at])).collect();
        lines.push_str(&format!("{step},{time:?}{values}\n"));
    }
    lines
}

/// Returns the last stored step up to which the perturbed run differs from `run` by at most [`PARTED`] of the scale of
/// each column, or `None` if this is true until the end.
fn predictable_steps(run: &Series, perturbed: &Series) -> Option<u64> {
    let parted = |step: u64| {
        drift(run, perturbed, step).iter().any(|column| column.error().is_nan() || column.error().abs() > PARTED)
    };
    let first = run.step.partition_point(|&step| !parted(step));
    (first < run.step.len()).then(|| run.step[first.saturating_sub(1)])
}

/// Returns at most [`MOST_SAMPLES`] evenly spaced samples of a series, and the last sample.
fn thinned(series: &Series) -> Series {
    let stride = series.step.len().div_ceil(MOST_SAMPLES).max(1);
    let keep: Vec<usize> =
        (0..series.step.len()).filter(|at| at % stride == 0 || at + 1 == series.step.len()).collect();
    let pick = |values: &[f64]| keep.iter().map(|&at| values[at]).collect::<Vec<f64>>();
    Series {
        step: keep.iter().map(|&at| series.step[at]).collect(),
        time: pick(&series.time),
        columns: series.columns.clone(),
        values: series.values.iter().map(|values| pick(values)).collect(),
    }
}

/// Returns a text compressed by gzip. File name and time are omitted, so that equal texts give equal files.
#[must_use]
pub fn compressed(text: &str) -> Vec<u8> {
    let mut encoder = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let _ = encoder.write_all(text.as_bytes());
    encoder.finish().unwrap_or_default()
}
