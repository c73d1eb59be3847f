//! LAMMPS and LIGGGHTS as solvers, if they are installed. For a run, a deck is written and executed, and its dumps are
//! read.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;

use crate::contacts::{PairForces, contacts_of};
use crate::deck::{CONTACTS, Deck, DeckError, END, END_CONTACTS, Program, SAMPLES, logged, write_deck};
use crate::execution::process::{Deadline, Limits, on_path};
use crate::execution::{self, Launch, Protocol, most_bytes, output, plain_file};
use crate::observer::{DumpObserver, DumpRecord};
use crate::read::format::dump::DumpReader;
use crate::read::lines::opened;
use crate::read::log::parse_log;
use crate::read::read_error::{ReadError, one_line};
use crate::read::snapshot::DumpSnapshot;

/// Default time limit of a run.
const TIME_LIMIT: Duration = Duration::from_secs(600);
/// Environment variable with another time limit (s).
const OTHER_LIMIT: &str = "GRAINBENCH_TIME_LIMIT";

/// Log file in the folder of a run.
const LOG: &str = "log.run";

/// Installed program as a solver.
#[derive(Debug, Clone)]
pub struct LiveProgram {
    program: Program,
    executable: Result<PathBuf, String>,
    time_limit: Duration,
}

impl LiveProgram {
    /// Finds the program that `GRAINBENCH_LAMMPS` or `GRAINBENCH_LIGGGHTS` names, otherwise `lmp` or `liggghts` on
    /// `PATH`. The time limit of a run is 600 s, or the number of seconds in `GRAINBENCH_TIME_LIMIT`.
    #[must_use]
    pub fn find(program: Program) -> Self {
        let (variable, usual) = (program.variable(), program.executable());
        let executable = match env::var_os(&variable).filter(|path| !path.is_empty()) {
            Some(path) => Some(PathBuf::from(&path))
                .filter(|path| path.is_file())
                .ok_or_else(|| format!("{variable} names `{}`, which is not a file", PathBuf::from(path).display())),
            None => {
                on_path(usual).ok_or_else(|| format!("there is no `{usual}` on PATH, and {variable} names no program"))
            }
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

    /// Returns the program with the executable at a path, with the default time limit.
    #[must_use]
    pub fn at(program: Program, executable: &Path) -> Self {
        Self { program, executable: Ok(executable.to_owned()), time_limit: TIME_LIMIT }
    }

    /// Sets the time limit of a run, including the reading of its files.
    #[must_use]
    pub fn with_time_limit(self, time_limit: Duration) -> Self {
        Self { time_limit, ..self }
    }

    /// Returns the hash of the executable, or an empty text if there is none.
    #[must_use]
    pub fn edition(&self) -> String {
        /// Hashes of executables by path and time of change. They are computed once, because each task of a plan needs
        /// the hash.
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
}

impl Solver for LiveProgram {
    fn name(&self) -> String {
        self.program.name().to_owned()
    }

    fn available(&self) -> Result<(), RunError> {
        self.executable().map(drop)
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let deck = write_deck(scene, resolution, self.program).map_err(|error| match error {
            DeckError::Unsupported { reason, .. } => RunError::Unsupported { solver: self.name(), reason },
            DeckError::Resolution(reason) => RunError::Resolution { solver: self.name(), reason },
        })?;
        let (stepping, deadline) = (deck.stepping, Deadline::after(self.time_limit));
        let launch = Launch {
            solver: self.name(),
            stepping,
            files: deck.files.clone(),
            executable: self.executable()?.to_owned(),
            arguments: ["-in", &deck.files[0].0, "-log", LOG].map(str::to_owned).to_vec(),
            limits: Limits { deadline, bytes: most_bytes(scene, stepping), memory: None, threads: 1 },
            protocol: Protocol::ExitCode,
        };
        let read = |folder: &Path, deadline| {
            let mut observed = observe(scene, &deck, folder, deadline)?;
            let path = plain_file(folder, LOG)?;
            let log = opened(&path).and_then(|file| parse_log(file, &path.to_string_lossy())).map_err(output)?;
            for (column, values) in logged::read(&deck.logged, &log, &observed.series) {
                observed.add(scene, &column, values);
            }
            Ok((observed, log))
        };
        execution::run(&launch, (scene, resolution), observer, read, |_, _, log| (log.seconds(), log.version))
    }
}

/// Reads the dumps of a deck's run in a folder until the deadline. Values that are not finite are kept, so that later
/// errors can name their column and step.
fn observe(scene: &Scene, deck: &Deck, folder: &Path, deadline: Deadline) -> Result<DumpRecord, Failure> {
    let stepping = deck.stepping;
    let open = |name: &str| DumpReader::open(&plain_file(folder, name)?).map_err(output);
    // Calls a function with each snapshot of the dump at the samples, and of the dump at the end if the last step is no
    // sample.
    let read = |names: [&'static str; 2], take: &mut dyn FnMut(&str, &DumpSnapshot) -> Result<(), ReadError>| {
        let mut snapshot = DumpSnapshot::default();
        for name in &names[..if stepping.ends_on_a_sample() { 1 } else { 2 }] {
            let mut reader = open(name)?.keep_non_finite();
            while reader.read(&mut snapshot).map_err(output)? {
                deadline.check()?;
                take(name, &snapshot).map_err(output)?;
            }
        }
        Ok(())
    };
    let ids: Vec<u64> = (1..=scene.grains.len() as u64).collect();
    let mut pairs = PairForces::new(scene, &ids);
    if pairs.is_asked() {
        read([CONTACTS, END_CONTACTS], &mut |name, snapshot| pairs.take(name, snapshot, &deck.names, None))?;
    }
    let recorder = Recorder::new(scene, stepping.time_step, stepping.steps);
    let mut observer = DumpObserver::new(scene, recorder.snapshot_steps());
    observer.pairs = pairs;
    read([SAMPLES, END], &mut |name, snapshot| {
        observer.take(name, snapshot, &deck.names, snapshot.step as f64 * stepping.time_step, None)
    })?;
    let mut observed = observer.finish();
    if scene.snapshot_contacts {
        let (mut reader, mut entries) = (open(CONTACTS)?, DumpSnapshot::default());
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

    const SCENE: &str = include_str!("../../../tests/scenes/flight.toml");
    const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n-1 1\n-1 1\n-1 1\n\
         ITEM: ATOMS id x y vx vy omegaz\n1 0 0 0 0 0\n";

    #[test]
    fn reading_ends_when_the_time_is_over() {
        let scene = SceneSource::from_text("scene.toml", Path::new("."), SCENE)
            .set("duration", "0.02")
            .set("output.every", "0.01")
            .scene(&grainbench_scene::resolve::no_data_file)
            .unwrap();
        let deck = write_deck(&scene, &Resolution::TimeStep(0.01), Program::LAMMPS).unwrap();
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SAMPLES), DUMP).unwrap();
        let read = |time| observe(&scene, &deck, folder.path(), Deadline::after(time)).map(|seen| seen.series.step);
        assert_eq!(read(TIME_LIMIT), Ok(vec![0]));
        assert_eq!(read(Duration::ZERO), Err(Failure::TimeOut(0)));
    }
}
