//! Damaged files and their readers. A reader must return the contents, or an error that names the position.

use crate::damage::{
    DATA, DUMPS, LOGS, TABLE, apply, damages, expect, names_place, of_data, of_dump, of_log, of_table, strange_bytes,
};
use crate::driver::RandomSource;
use crate::observer::RunObserver;
use flate2::Compression;
use flate2::write::GzEncoder;
use grainbench::cases::registry;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench::reference::comparison::{Options, compare};
use grainbench::reference::outputs::{OutputError, Outputs, Sources};
use grainbench::reference::stored::StoredRun;
use grainbench::reports::export::record_json;
use grainbench::reports::junit::junit_xml;
use grainbench::reports::results::results_json;
use grainbench::reports::study::point::{Point, PointStatus, Timing};
use grainbench::reports::study::points_of;
use grainbench::reports::{Provenance, Report, Section, page, plot, record_figures};
use grainbench::scene::scene::{Sampling, Scene};
use grainbench::solver::Solver;
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::solver::failure::RunError;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use grainbench::store::refuse_mixed;
use proptest::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tempfile::TempDir;

/// Largest accepted number of rows in a snapshot of the scene below.
const MOST_ROWS: u64 = 1000;

type Answer = Result<(), String>;

/// A reader of a file: its name, its weight in the random choice, and its test.
type Reader = (&'static str, usize, fn(&mut RandomSource) -> Answer);

type Files = Vec<(String, Vec<u8>)>;

/// Readers with their weights. Slow readers, which draw, simulate or read many files, have smaller weights.
const READERS: [Reader; 12] = [
    ("dump", 4, |lot| of_dump(&damaged_text(lot, &DUMPS))),
    ("log", 4, |lot| of_log(&damaged_text(lot, &LOGS))),
    ("table", 4, |lot| of_table(&damaged(lot, TABLE.as_bytes()))),
    ("data file", 4, |lot| of_data(&damaged(lot, DATA.as_bytes()))),
    ("packed dump", 4, of_packed_dump),
    ("bytes", 4, of_bytes),
    ("checkpoint", 2, of_checkpoint),
    ("record.json", 2, of_record),
    ("results.json, manifest.json", 2, of_results),
    ("report.json", 1, of_report),
    ("two outputs", 1, of_two),
    ("stored run", 1, of_stored),
];

/// Chooses a reader at random, damages a file and reads it.
pub(crate) fn try_out(lot: &mut RandomSource) -> Answer {
    let mut drawn = lot.draw(0..READERS.iter().map(|(_, weight, _)| weight).sum());
    for (name, weight, reader) in READERS {
        if drawn < weight {
            lot.show(name);
            return reader(lot);
        }
        drawn -= weight;
    }
    Ok(())
}

/// Returns a folder for readers that need a file name. It exists until the process ends.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| tempfile::tempdir().unwrap()).path()
}

/// Writes a file to the folder and returns its path.
fn left(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// Damages bytes at random. Adds the changes to the description of the item.
fn damaged(lot: &mut RandomSource, bytes: &[u8]) -> Vec<u8> {
    let damages = lot.draw(damages());
    let bytes = apply(bytes, &damages);
    lot.show(&format!("{damages:?}\n{}", String::from_utf8_lossy(&bytes[..bytes.len().min(6000)])));
    bytes
}

/// Damages one of several texts.
fn damaged_text(lot: &mut RandomSource, texts: &[&str]) -> Vec<u8> {
    let text = lot.one(texts).as_bytes();
    damaged(lot, text)
}

/// Checks an error message: it must be one line and name the file.
fn one_line_of(path: &Path, error: &dyn ToString) -> Answer {
    let message = error.to_string();
    let names = message.contains(&*path.to_string_lossy());
    if names && !message.chars().any(char::is_control) { Ok(()) } else { Err(format!("badly said: {message:?}")) }
}

fn packed(bytes: &[u8], zstd: bool) -> Vec<u8> {
    if zstd {
        return compress_to_vec(bytes, CompressionLevel::Fastest);
    }
    let mut out = GzEncoder::new(Vec::new(), Compression::fast());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

/// Damages a compressed dump, before or after its compression.
fn of_packed_dump(lot: &mut RandomSource) -> Answer {
    let text = lot.one(&DUMPS).as_bytes();
    let (zstd, before) = lot.draw(any::<(bool, bool)>());
    let bytes = if before { packed(&damaged(lot, text), zstd) } else { damaged(lot, &packed(text, zstd)) };
    of_dump(&bytes)
}

fn of_bytes(lot: &mut RandomSource) -> Answer {
    let bytes = lot.draw(strange_bytes());
    lot.show(&format!("{bytes:?}"));
    of_data(&bytes)?;
    of_log(&bytes)?;
    of_dump(&bytes)
}

/// Returns the scene of a case with a short duration.
fn scene() -> Scene {
    let mut scene = registry::by_name("nine-discs").unwrap().variant("plain").unwrap();
    scene.duration = grainbench::scene::scene::Duration::Cycles(40);
    scene.sampling = Sampling::Cycles(10);
    scene.snapshots = 2;
    scene
}

const SOLVER: Convention = Convention::LAMMPS;
const RESOLUTION: Resolution = Resolution::CriticalFraction(0.1);

/// Returns the record of a short run and a checkpoint of the run.
fn run() -> &'static (Record, Vec<u8>) {
    static RUN: OnceLock<(Record, Vec<u8>)> = OnceLock::new();
    RUN.get_or_init(|| {
        let mut observer = RunObserver::with_checkpoints(25, 1);
        let record = Dem::new(SOLVER).run(&scene(), &RESOLUTION, &mut observer).unwrap();
        (record, observer.checkpoints.pop().unwrap().to_bytes().unwrap())
    })
}

/// Damages the body of a checkpoint and computes its length and hash again, or damages the whole file.
fn of_checkpoint(lot: &mut RandomSource) -> Answer {
    let whole = &run().1;
    let line = whole.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    let bytes = if lot.draw(any::<bool>()) {
        let body = damaged(lot, &whole[line + 40..]);
        let length = (body.len() as u64).to_le_bytes();
        [&whole[..line], &length, blake3::hash(&body).as_bytes(), &body].concat()
    } else {
        damaged(lot, whole)
    };
    let words = |error: CheckpointError| one_line_of(Path::new("checkpoint"), &error);
    match Checkpoint::from_bytes(&bytes) {
        Err(error) => words(error),
        Ok(checkpoint) => match Dem::new(SOLVER).run_from(&scene(), &RESOLUTION, Some(&checkpoint), &mut ()) {
            Ok(_) | Err(RunError::Broken(_) | RunError::NotFinite { .. }) => Ok(()),
            Err(RunError::Checkpoint(error)) => words(error),
            Err(error) => Err(error.to_string()),
        },
    }
}

fn of_record(lot: &mut RandomSource) -> Answer {
    let text = serde_json::to_vec(&run().0).unwrap();
    let path = left("record.json", &damaged(lot, &text));
    match record_json::load(folder()) {
        Err(error) => one_line_of(&path, &error),
        Ok(record) => {
            let named = [record_figures::NamedRecord { name: String::new(), record: &record }];
            draw(&record_figures::figures(&named, &record_figures::FigureOptions::default()))
        }
    }
}

/// Draws figures. If a figure cannot be drawn, checks the error message.
fn draw(figures: &[Figure]) -> Answer {
    for figure in figures {
        if let Err(error) = plot::draw(figure) {
            let message = error.to_string();
            expect(!message.chars().any(char::is_control), &format!("badly said: {message:?}"))?;
        }
    }
    Ok(())
}

/// Returns the text of a report with results, controls and figures.
fn report() -> &'static Vec<u8> {
    static REPORT: OnceLock<Vec<u8>> = OnceLock::new();
    REPORT.get_or_init(|| {
        let case = registry::by_name("incline-disc").unwrap();
        let runner = grainbench::cases::runner(case);
        let claims: Vec<_> = runner.claims().into_iter().take(2).collect();
        let axes = || [Axis::linear("time t (s)"), Axis { label: "error (1)".to_owned(), logarithmic: true }];
        let points = || vec![(0.0, 1e-3), (0.1, 2e-3), (0.2, 1e-5)];
        let curves = vec![Curve::new("ours", Stroke::Line, points()), Curve::new("theirs", Stroke::Markers, points())];
        let section = Section {
            name: case.name.to_owned(),
            title: case.title.to_owned(),
            claim: case.claim.to_owned(),
            derivation: "A *disc* on an incline.\n\n```text\na = g sin θ\n```\n".to_owned(),
            weak: case.weakness.to_owned(),
            figures: vec![Figure::graph("error", "Error", "Of the displacement.", axes(), curves)],
            verdicts: claims.iter().map(|claim| runner.judge(claim)).collect(),
            controls: claims.iter().map(|claim| runner.control(claim)).collect(),
            ..Section::default()
        };
        let provenance = Provenance {
            version: "0.1.0".to_owned(),
            commit: "none".to_owned(),
            date: "2026-01-01".to_owned(),
            machine: "any".to_owned(),
            rustc: "any".to_owned(),
            options: vec!["run".to_owned()],
            wall_seconds: 1.0,
        };
        serde_json::to_vec_pretty(&Report { provenance, sections: vec![section], ..Report::default() }).unwrap()
    })
}

/// Reads a report and writes its files again, as `grainbench report` does.
fn of_report(lot: &mut RandomSource) -> Answer {
    let path = left("report.json", &damaged(lot, report()));
    let report = match Report::load(folder()) {
        Err(error) => return one_line_of(&path, &error),
        Ok(report) => report,
    };
    let errors = [
        page::render(&report).err().map(|error| error.to_string()),
        results_json(&report).err().map(|error| error.to_string()),
        junit_xml(&report).err().map(|error| error.to_string()),
    ];
    for message in errors.into_iter().flatten() {
        expect(!message.chars().any(char::is_control), &format!("badly said: {message:?}"))?;
    }
    Ok(())
}

fn of_results(lot: &mut RandomSource) -> Answer {
    if lot.draw(any::<bool>()) {
        let text = b"{\n  \"whole\": false,\n  \"files\": [\n    \"results.json\",\n    \"figures/a.svg\"\n  ]\n}\n";
        left("manifest.json", &damaged(lot, text));
        return refuse_mixed(folder()).or_else(|error| one_line_of(&folder().join("manifest.json"), &error));
    }
    let point = Point {
        case: "backspin".to_owned(),
        variant: "disc".to_owned(),
        solver: "dem".to_owned(),
        resolution: "dt=.1".to_owned(),
        quantity: "displacement".to_owned(),
        unit: "m".to_owned(),
        standing: PointStatus::Measured,
        value: Some(1.0),
        expected: Some(1.1),
        error: Some(0.1),
        wall_seconds: Some(0.1),
        wall_spread: Some(0.01),
        cpu_seconds: Some(0.1),
        start_up_seconds: Some(0.01),
        repetitions: vec![Timing { wall: 0.1, cpu: 0.1, start_up: 0.01, reference: 0.02 }],
        ..Point::default()
    };
    let text = serde_json::to_vec_pretty(&serde_json::json!({ "points": [point.clone(), point] })).unwrap();
    let path = left("results.json", &damaged(lot, &text));
    points_of(&path).map_or_else(|error| one_line_of(&path, &error), |_| Ok(()))
}

/// Compares two files, or reads one file as output of a scene.
fn of_two(lot: &mut RandomSource) -> Answer {
    let text = *lot.one(&[DUMPS[0], DUMPS[1], DUMPS[3], TABLE]);
    let first = left("first", &damaged(lot, text.as_bytes()));
    if lot.draw(any::<bool>()) {
        let second = left("second", text.as_bytes());
        return compare(&first, &second, &Options::default()).map_or_else(|error| names_place(&error), |_| Ok(()));
    }
    let sources = Sources {
        files: vec![first.clone()],
        time_step: Some(1e-5),
        most_rows: Some(MOST_ROWS),
        partial: lot.draw(any::<bool>()),
        from_first: lot.draw(any::<bool>()),
        ..Sources::default()
    };
    static SCENE: OnceLock<Scene> = OnceLock::new();
    let observed = Outputs::survey(sources).and_then(|outputs| outputs.observe(SCENE.get_or_init(scene)));
    match observed {
        Ok(observed) => {
            let numbers = observed.series.time.iter().chain(observed.series.values.iter().flatten());
            expect(numbers.into_iter().all(|value| value.is_finite()), "a number of what was observed is none")
        }
        Err(OutputError::Read(error)) => names_place(&error),
        Err(error) => one_line_of(&first, &error),
    }
}

/// Damages one file of a stored run, with or without a new hash for the file.
fn of_stored(lot: &mut RandomSource) -> Answer {
    static RUN: OnceLock<(PathBuf, Files)> = OnceLock::new();
    let (folder, files) = RUN.get_or_init(|| {
        let name = "backspin-disc-overlap-r-1e-3-damping-ratio-0";
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/lammps").join(name);
        let to = folder().join("stored");
        fs::create_dir(&to).unwrap();
        let mut files: Files = fs::read_dir(from)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()))
            .collect();
        files.sort();
        for (name, bytes) in &files {
            fs::write(to.join(name), bytes).unwrap();
        }
        (to, files)
    });
    let (name, bytes) = lot.one(files);
    // The provenance is damaged more often than all other files. Damage of any other file is found by its hash.
    let (name, bytes) = if lot.draw(any::<bool>()) {
        files.iter().find(|(name, _)| name == "provenance.toml").map_or((name, bytes), |(name, bytes)| (name, bytes))
    } else {
        (name, bytes)
    };
    fs::write(folder.join(name), damaged(lot, bytes)).unwrap();
    let loaded = StoredRun::load(folder);
    fs::write(folder.join(name), bytes).unwrap();
    match loaded {
        Err(error) => one_line_of(folder, &error),
        Ok(_) => Ok(()),
    }
}
