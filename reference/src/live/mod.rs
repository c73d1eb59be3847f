//! LAMMPS and LIGGGHTS as solvers, if they are installed. A run consists of deck, execution, dump and record.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use grainbench_scene::record::{Cost, Provenance, Record, Series};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Failure, Resolution, RunError, RunOutline, Solver, Watch};

use crate::deadline::Deadline;
use crate::deck::{CONTACTS, Deck, DeckError, END, END_CONTACTS, Program, SAMPLES, Stepping, logged, write_deck};
use crate::grain_dump::contacts_of;
use crate::observer::{DumpRecord, Observer};
use crate::pair_forces::PairForces;
use crate::process::{self, Limits, ProcessStart};
use crate::read::dump::DumpReader;
use crate::read::log::read_log;
use crate::read::numbers::NonFiniteNumbers;
use crate::read::read_error::{ReadError, one_line};
use crate::read::snapshot::DumpSnapshot;

/// Time limit of a run, if no other limit is given.
const TIME_LIMIT: Duration = Duration::from_secs(600);
/// Environment variable with another time limit (s).
const OTHER_LIMIT: &str = "GRAINBENCH_TIME_LIMIT";

/// Log file in the folder of a run.
const LOG: &str = "log.run";

/// Program that is run as a solver.
#[derive(Debug, Clone)]
pub struct LiveProgram {
    program: Program,
    executable: Result<PathBuf, String>,
    time_limit: Duration,
}

impl LiveProgram {
    /// Finds the program that `GRAINBENCH_LAMMPS` or `GRAINBENCH_LIGGGHTS` names, or else `lmp` or `liggghts` on
    /// `PATH`. The time limit of a run is ten minutes, or the number of seconds in `GRAINBENCH_TIME_LIMIT`.
    #[must_use]
    pub fn find(program: Program) -> Self {
        let (variable, usual) = (program.variable(), program.executable());
        let executable = match env::var_os(&variable).filter(|path| !path.is_empty()) {
            Some(path) => Some(PathBuf::from(&path))
                .filter(|path| path.is_file())
                .ok_or_else(|| format!("{variable} names `{}`, which is not a file", PathBuf::from(path).display())),
            None => env::var_os("PATH")
                .and_then(|path| env::split_paths(&path).map(|folder| folder.join(usual)).find(|path| path.is_file()))
                .ok_or_else(|| format!("there is no `{usual}` on PATH, and {variable} names none")),
        };
        match env::var(OTHER_LIMIT).ok().filter(|text| !text.is_empty()).map(|text| (text.parse::<u64>(), text)) {
            None => Self { program, executable, time_limit: TIME_LIMIT },
            Some((Ok(seconds), _)) => Self { program, executable, time_limit: Duration::from_secs(seconds) },
            Some((Err(_), text)) => {
                let reason = format!("{OTHER_LIMIT}: expected a whole number of seconds, found `{}`", one_line(&text));
                Self { program, executable: Err(reason), time_limit: TIME_LIMIT }
            }
        }
    }

    /// Returns the program at a path.
    #[must_use]
    pub fn at(program: Program, executable: &Path) -> Self {
        Self { program, executable: Ok(executable.to_owned()), time_limit: TIME_LIMIT }
    }

    /// Sets the common time limit for the run and the reading of its files.
    #[must_use]
    pub fn with_time_limit(self, time_limit: Duration) -> Self {
        Self { time_limit, ..self }
    }

    /// Returns the hash of the executable, or an empty text if there is none.
    #[must_use]
    pub fn edition(&self) -> String {
        /// Hashes by path and time of change, because a plan asks for each of its tasks.
        static KNOWN: Mutex<BTreeMap<(PathBuf, SystemTime), String>> = Mutex::new(BTreeMap::new());
        let Ok(path) = &self.executable else { return String::new() };
        let changed = fs::metadata(path).and_then(|about| about.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let hash = || fs::read(path).map_or_else(|_| String::new(), |bytes| blake3::hash(&bytes).to_hex().to_string());
        known.entry((path.clone(), changed)).or_insert_with(hash).clone()
    }

    fn executable(&self) -> Result<&Path, RunError> {
        let missing = |reason: &String| RunError::NotAvailable { solver: self.name(), reason: reason.clone() };
        self.executable.as_deref().map_err(missing)
    }

    fn deck(&self, scene: &Scene, resolution: &Resolution) -> Result<Deck, RunError> {
        write_deck(scene, resolution, self.program).map_err(|error| match error {
            DeckError::Unsupported { reason, .. } => RunError::Unsupported { solver: self.name(), reason },
            DeckError::Resolution(reason) => RunError::Resolution { solver: self.name(), reason },
        })
    }
}

impl Solver for LiveProgram {
    fn name(&self) -> String {
        self.program.name().to_owned()
    }

    fn available(&self) -> Result<(), RunError> {
        self.executable().map(drop)
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, watch: &mut dyn Watch) -> Result<Record, RunError> {
        let deck = self.deck(scene, resolution)?;
        let executable = self.executable()?;
        let stepping = deck.stepping;
        let particles = scene.grains.len() as u64;
        watch.begin(RunOutline { time_step: stepping.time_step, steps: stepping.steps, particles });
        let fail = |failure, last_lines| RunError::Program { solver: self.name(), failure, last_lines };
        let files = deck.files.iter().map(|(name, text)| (name.as_str(), text.as_str()));
        let folder = process::scratch(files).map_err(|error| fail(Failure::NotRun(error.to_string()), Vec::new()))?;
        let deadline = Deadline::after(self.time_limit);
        let limits = Limits { deadline, bytes: most_bytes(scene, stepping), memory: None, threads: 1 };
        let arguments = ["-in", &deck.files[0].0, "-log", LOG].map(str::to_owned);
        let started =
            ProcessStart { executable, arguments: &arguments, folder: folder.path(), at: None, errors_apart: false };
        let ended = process::run(&started, limits).map_err(|(failure, last_lines)| fail(failure, last_lines))?;
        let screen = ended.last_lines;
        if ended.code != 0 {
            return Err(fail(Failure::Crash(format!("exit status: {}", ended.code)), screen));
        }
        let unusable = |failure: Failure| fail(failure, screen.clone());
        let mut observed = observe(scene, &deck, folder.path(), deadline).map_err(unusable)?;
        let log = plain_file(folder.path(), LOG).and_then(|path| read_log(&path).map_err(output));
        let log = log.map_err(unusable)?;
        for (column, values) in logged::read(&deck.logged, &log, &observed.series) {
            observed.add(scene, &column, values);
        }
        observed.snapshots.iter_mut().for_each(|snapshot| scene.columns.keep(snapshot));
        complete(&observed.series, stepping).map_err(|missing| fail(Failure::Output(missing), screen.clone()))?;
        watch.progress(stepping.steps, stepping.steps);
        let seconds = log.runs.iter().filter_map(|run| run.end).map(|end| end.seconds).sum();
        let options = log.version.into_iter().collect();
        Ok(Record {
            provenance: Provenance::new(scene, self.name(), resolution, stepping.time_step, options),
            series: observed.series,
            snapshots: observed.snapshots,
            cost: Cost::of_program(stepping.steps, scene.grains.len(), seconds),
        })
    }
}

/// Returns the maximum size of the files of a run (B).
///
/// It contains 64 MiB for the start and 4 KiB per sample and grain. This is four times the size of its columns and a
/// dozen contacts.
pub(crate) fn most_bytes(scene: &Scene, stepping: Stepping) -> u64 {
    let samples = stepping.steps / stepping.interval + 2;
    (64 << 20) + samples.saturating_mul(4096).saturating_mul(scene.grains.len() as u64)
}

/// Returns an error if a series lacks a sample of its deck or has a value that is not finite.
pub(crate) fn complete(series: &Series, stepping: Stepping) -> Result<(), String> {
    let mut found = series.step.iter().copied();
    for step in stepping.samples() {
        match found.next() {
            Some(at) if at == step => {}
            Some(at) => return Err(format!("expected a sample at step {step}, found step {at}")),
            None => {
                let (last, steps) = (series.step.last().copied().unwrap_or_default(), stepping.steps);
                return Err(format!("expected samples to step {steps}, found the last at step {last}"));
            }
        }
    }
    for (column, values) in series.columns.iter().zip(&series.values) {
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let (name, step, value) = (&column.name, series.step[at], values[at]);
            return Err(format!("expected finite numbers, found {name} = {value} at step {step}"));
        }
    }
    Ok(())
}

/// Returns the failure of a run whose file cannot be read.
pub(crate) fn output(error: ReadError) -> Failure {
    Failure::Output(error.to_string())
}

/// Returns the path of a file that a run wrote in a folder. Links are refused, including those to parent folders.
/// Pipes are refused, because reading them could block forever.
pub(crate) fn plain_file(folder: &Path, name: &str) -> Result<PathBuf, Failure> {
    let path = folder.join(name);
    let between = Path::new(name).ancestors().skip(1).filter(|part| !part.as_os_str().is_empty());
    for part in between {
        if fs::symlink_metadata(folder.join(part)).is_ok_and(|found| !found.is_dir()) {
            let part = part.display();
            return Err(Failure::Output(format!("{name}: expected the folder {part}, found a link or a file")));
        }
    }
    match fs::symlink_metadata(&path) {
        Ok(found) if !found.is_file() => Err(Failure::Output(format!("{name}: expected a plain file, found none"))),
        // A missing file is reported when it is opened.
        _ => Ok(path),
    }
}

/// Reads the files of a deck's run in a folder until the deadline. Values that are not finite are kept, and errors
/// later name their column and step.
fn observe(scene: &Scene, deck: &Deck, folder: &Path, deadline: Deadline) -> Result<DumpRecord, Failure> {
    let stepping = deck.stepping;
    let mut snapshot = DumpSnapshot::default();
    let ids: Vec<u64> = (1..=scene.grains.len() as u64).collect();
    let mut pairs = PairForces::new(scene, &ids);
    for (name, is_there) in [(CONTACTS, true), (END_CONTACTS, !stepping.ends_on_a_sample())] {
        if !pairs.is_asked() || !is_there {
            continue;
        }
        let path = plain_file(folder, name)?;
        let mut reader = DumpReader::open(&path).map_err(output)?.not_finite(NonFiniteNumbers::Kept);
        while reader.read(&mut snapshot).map_err(output)? {
            deadline.check()?;
            pairs.take(name, &snapshot, &deck.names, None).map_err(output)?;
        }
    }
    let recorder = Recorder::new(scene, stepping.time_step, stepping.steps);
    let mut observer = Observer::new(scene, recorder.snapshot_steps()).with_pairs(pairs);
    for name in [SAMPLES, END] {
        if name == END && stepping.ends_on_a_sample() {
            continue;
        }
        let path = plain_file(folder, name)?;
        let mut reader = DumpReader::open(&path).map_err(output)?.not_finite(NonFiniteNumbers::Kept);
        while reader.read(&mut snapshot).map_err(output)? {
            deadline.check()?;
            let time = snapshot.step as f64 * stepping.time_step;
            observer.take(name, &snapshot, &deck.names, time, None).map_err(output)?;
        }
    }
    let mut observed = observer.finish();
    if scene.snapshot_contacts {
        let path = plain_file(folder, CONTACTS)?;
        let (mut reader, mut entries) = (DumpReader::open(&path).map_err(output)?, DumpSnapshot::default());
        for seen in observed.snapshots.iter_mut().filter(|seen| seen.step.is_multiple_of(stepping.interval)) {
            deadline.check()?;
            let contacts = contacts_of(seen, &mut reader, &mut entries, CONTACTS, &deck.names).map_err(output)?;
            seen.contacts = Some(contacts);
        }
    }
    Ok(observed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::source::SceneSource;

    const SCENE: &str = "title = 't'\ndimension = 2\nduration = 0.02\n[materials.m]\ndensity = 1000.0\n\
         [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1e6\n\
         [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.0]\n[output]\nevery = 0.01\n";
    const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n-1 1\n-1 1\n-1 1\n\
         ITEM: ATOMS id x y vx vy omegaz\n1 0 0 0 0 0\n";

    #[test]
    fn reading_ends_when_the_time_is_over() {
        let scene =
            SceneSource::from_text("scene.toml", Path::new("."), SCENE).scene(&|_| Err("none".to_owned())).unwrap();
        let deck = write_deck(&scene, &Resolution::TimeStep(0.01), Program::LAMMPS).unwrap();
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SAMPLES), DUMP).unwrap();
        let read = |time| observe(&scene, &deck, folder.path(), Deadline::after(time)).map(|seen| seen.series.step);
        assert_eq!(read(TIME_LIMIT), Ok(vec![0]));
        assert_eq!(read(Duration::ZERO), Err(Failure::TimeOut(0)));
    }
}
