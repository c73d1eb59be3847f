//! Cache of finished runs, outside the source tree and shared by all commands. It stores records of runs, not outcomes of
//! claims.
//!
//! The key of a run is a hash of its scene, solver, planted defect, resolution, SIMD backend, and of the sources, compiler and
//! options with which the solver was built. A changed case or solver therefore repeats only the affected runs. A file that is
//! damaged or holds another run is ignored. Runs are not cached if snapshots are streamed, or if the end state or checkpoints
//! are requested. Runs of external programs are not cached either, because these programs may change unnoticed.

use grainbench_harness::solvers::{ExternalSolver, References, Solvers};
use grainbench_lanes::Processor;
use grainbench_scene::scene::Scene;
use grainbench_solver::checkpoint::{Checkpoint, fingerprint};
use grainbench_solver::failure::RunError;
use grainbench_solver::kept_record;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::{Defect, Solver};
use grainbench_store::{FolderWriter, WriteError, key, remove_leftovers};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, SystemTime};

/// Shortest run that is cached (s). Shorter runs are faster than reading a file.
const LEAST: f64 = 2e-3;
/// Largest record that is cached (bytes). A larger record would displace too many others.
const LARGEST: usize = 256 << 20;
/// File extension of cached runs.
const ENDING: &str = "run";

/// Function that returns the hash of the sources of a solver, or `None` for another program.
pub type Edition = fn(&str) -> Option<String>;

/// Returns the hash of a run from program, solver, scene, resolution and `read`, which describes the evaluated quantity or
/// other conditions of the run.
#[must_use]
pub fn key_of_run(program: &str, solver: &str, scene: &Scene, resolution: &Resolution, read: &str) -> String {
    key::of_words(program, &run_words(solver, scene, resolution, read).each_ref().map(String::as_str))
}

/// Returns the words that describe a run.
#[must_use]
pub fn run_words(solver: &str, scene: &Scene, resolution: &Resolution, read: &str) -> [String; 4] {
    [solver.to_owned(), fingerprint(scene).to_hex().to_string(), format!("{resolution:?}"), read.to_owned()]
}

/// Folder of finished runs.
pub struct RunCache {
    folder: PathBuf,
    /// Maximum size of all files (bytes).
    most: u64,
    /// True to ignore existing files.
    fresh: bool,
    edition: Edition,
    taken: AtomicU64,
    /// Directory for temporary files, created with the first stored run.
    desk: OnceLock<Option<FolderWriter>>,
}

impl RunCache {
    /// Opens the cache in a folder and creates the folder if necessary. `most` is the maximum size of all files
    /// (bytes). Existing files are ignored if `fresh` is true.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path, most: u64, fresh: bool, edition: Edition) -> Result<Self, WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError::new(folder, source))?;
        // Removes temporary files of killed programs.
        remove_leftovers(folder).map_err(|source| WriteError::new(folder, source))?;
        let folder = folder.to_owned();
        Ok(Self { folder, most, fresh, edition, taken: AtomicU64::new(0), desk: OnceLock::new() })
    }

    /// Returns the folder of the cache.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the number of runs that were read from the cache.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.taken.load(Ordering::Relaxed)
    }

    /// Returns the key of a run, or `None` for other programs, whose runs are not cached.
    fn name(&self, solver: &str, defect: Option<Defect>, scene: &Scene, resolution: &Resolution) -> Option<String> {
        let program = (self.edition)(solver)?;
        Some(key_of_run(&program, solver, scene, resolution, &format!("{defect:?} {}", Processor::new().name())))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.{ENDING}"))
    }

    /// Returns the record of a key, or `None` if the file is missing or damaged, or if existing files are ignored.
    fn take(&self, name: &str) -> Option<Record> {
        if self.fresh {
            return None;
        }
        let path = self.path(name);
        let record = kept_record::from_bytes(name, &fs::read(&path).ok()?)?;
        self.taken.fetch_add(1, Ordering::Relaxed);
        // The file time is the time of the last use, because the least recently used files are removed first. If it
        // cannot be set, it stays the time of writing.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Some(record)
    }

    /// Stores a record, unless the run is too short or the record too large. Write errors are ignored, because the run
    /// can be repeated.
    fn put(&self, name: &str, record: &Record) {
        if record.cost.wall_seconds < LEAST {
            return;
        }
        let Ok(bytes) = kept_record::to_bytes(name, record) else { return };
        if bytes.len() <= LARGEST
            && let Some(desk) = self.desk.get_or_init(|| FolderWriter::new(&self.folder).ok())
        {
            let _ = desk.write(&format!("{name}.{ENDING}"), bytes);
        }
    }

    /// Removes the least recently used files until the remaining files do not exceed the maximum size.
    pub fn make_room(&self) {
        let file_entry = |entry: fs::DirEntry| {
            let is_one = entry.path().extension().is_some_and(|ending| ending == ENDING);
            let about = entry.metadata().ok().filter(|_| is_one)?;
            Some((about.modified().unwrap_or(SystemTime::UNIX_EPOCH), about.len(), entry.path()))
        };
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries.filter_map(file_entry).collect();
        files.sort();
        let mut all: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
        for (_, bytes, path) in files {
            if all <= self.most {
                break;
            }
            match fs::remove_file(path) {
                Ok(()) => all -= bytes,
                // Another process has removed the file.
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => all -= bytes,
                Err(_) => {}
            }
        }
    }
}

/// Solvers with a cache of finished runs.
pub struct CachingSolvers<S> {
    solvers: S,
    cache: Arc<RunCache>,
}

impl<S: Solvers> CachingSolvers<S> {
    /// Combines solvers with a cache.
    pub const fn new(solvers: S, cache: Arc<RunCache>) -> Self {
        Self { solvers, cache }
    }

    fn wrapped(&self, name: &str, defect: Option<Defect>, solver: Option<Arc<dyn Solver>>) -> Option<Arc<dyn Solver>> {
        let solver = solver?;
        if self.solvers.is_program(name) {
            return Some(solver);
        }
        Some(Arc::new(CachingSolver { solver, name: name.to_owned(), defect, cache: Arc::clone(&self.cache) }))
    }
}

impl<S: Solvers> Solvers for CachingSolvers<S> {
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>> {
        self.wrapped(name, None, self.solvers.find(name))
    }

    fn find_within(&self, name: &str, limit: Duration) -> Option<Arc<dyn Solver>> {
        self.wrapped(name, None, self.solvers.find_within(name, limit))
    }

    fn with_defect(&self, name: &str, defect: Defect) -> Option<Arc<dyn Solver>> {
        self.wrapped(name, Some(defect), self.solvers.with_defect(name, defect))
    }

    fn is_program(&self, name: &str) -> bool {
        self.solvers.is_program(name)
    }

    fn strangers(&self) -> Vec<ExternalSolver> {
        self.solvers.strangers()
    }

    fn edition(&self, name: &str) -> String {
        self.solvers.edition(name)
    }

    fn references(&self) -> &dyn References {
        self.solvers.references()
    }
}

/// Solver with a cache of finished runs.
struct CachingSolver {
    solver: Arc<dyn Solver>,
    name: String,
    defect: Option<Defect>,
    cache: Arc<RunCache>,
}

impl Solver for CachingSolver {
    fn name(&self) -> String {
        self.solver.name()
    }

    fn available(&self) -> Result<(), RunError> {
        self.solver.available()
    }

    fn has_springs(&self) -> bool {
        self.solver.has_springs()
    }

    fn deforms(&self) -> bool {
        self.solver.deforms()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let options = observer.options();
        let wants_more = !options.keep_snapshots || options.end_state || options.checkpoint_interval.is_some();
        let Some(name) = self.cache.name(&self.name, self.defect, scene, resolution).filter(|_| !wants_more) else {
            return self.solver.run(scene, resolution, observer);
        };
        if let Some(record) = self.cache.take(&name) {
            return Ok(record);
        }
        let record = self.solver.run(scene, resolution, observer)?;
        self.cache.put(&name, &record);
        Ok(record)
    }

    fn restart(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: &Checkpoint,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        self.solver.restart(scene, resolution, from, observer)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// There are three files of 100 bytes and room for 250 bytes. The least recently used run is removed, and other
    /// files are kept.
    #[test]
    fn the_longest_unused_makes_room() {
        let folder = tempfile::tempdir().unwrap();
        let cache = RunCache::open(folder.path(), 250, false, |_| None).unwrap();
        for (age, name) in [(30, "a.run"), (10, "b.run"), (20, "c.run"), (99, "notes.txt")] {
            let path = folder.path().join(name);
            fs::write(&path, [0; 100]).unwrap();
            let then = SystemTime::now() - Duration::from_secs(age);
            File::options().append(true).open(&path).unwrap().set_modified(then).unwrap();
        }
        cache.make_room();
        let mut left: Vec<String> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(left, ["b.run", "c.run", "notes.txt"]);
    }
}
