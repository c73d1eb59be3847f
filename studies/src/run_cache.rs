//! Cache of finished runs, outside the source tree and shared by all commands. It stores records of runs, not outcomes of
//! claims.
//!
//! The key of a run is a hash of its scene, solver, the defect of a control, resolution, run options, SIMD backend, and of
//! the sources, compiler and options with which the solver was built. A changed case or solver therefore repeats only the
//! affected runs. A file that is damaged or holds another run is ignored. Runs are not cached if snapshots are streamed, if the
//! end state or checkpoints are requested, or if they are shorter than 2 ms or larger than 256 MiB. Runs of external programs
//! are not cached either, because these programs may change unnoticed.

use grainbench_harness::solvers::{ExternalSolver, References, Solvers};
use grainbench_harness::wrapper::{Start, Wrapped, Wrapper};
use grainbench_lanes::Processor;
use grainbench_scene::scene::Scene;
use grainbench_solver::checkpoint::fingerprint;
use grainbench_solver::failure::RunError;
use grainbench_solver::kept_record;
use grainbench_solver::observer::{Observer, RunOptions};
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::{Defect, Solver};
use grainbench_store::artifact::Directory;
use grainbench_store::{WriteError, key};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Shortest run that is cached (s). Shorter runs are faster than reading a file.
const LEAST: f64 = 2e-3;
/// Largest record that is cached (bytes). A larger record would displace too many others.
const LARGEST: usize = 256 << 20;

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
    runs: Directory,
    /// Maximum size of all files (bytes).
    most: u64,
    edition: Edition,
    taken: AtomicU64,
}

impl RunCache {
    /// Opens the cache in a folder and creates the folder if necessary. `most` is the maximum size of all files
    /// (bytes). Existing files are ignored if `fresh` is true.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path, most: u64, fresh: bool, edition: Edition) -> Result<Self, WriteError> {
        Ok(Self { runs: Directory::open(folder, "run", fresh)?, most, edition, taken: AtomicU64::new(0) })
    }

    /// Returns the folder of the cache.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.runs.folder()
    }

    /// Returns the number of runs that were read from the cache.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.taken.load(Ordering::Relaxed)
    }

    /// Returns the key of a run, or `None` for runs that are not cached: those of other programs, those that continue
    /// from a checkpoint, and those whose output is more than a record.
    fn name(
        &self,
        (solver, defect): (&str, Option<Defect>),
        Start { scene, resolution, from }: Start<'_>,
        options: RunOptions,
    ) -> Option<String> {
        // The number of threads does not change a record.
        let RunOptions { threads: _, checkpoint_interval, most_rows, allow_unstable, keep_snapshots, end_state } =
            options;
        if from.is_some() || checkpoint_interval.is_some() || !keep_snapshots || end_state {
            return None;
        }
        let mut read = format!("{defect:?} {}", Processor::new().name());
        // Default values are omitted, so that the keys of runs stored by earlier versions stay valid.
        if allow_unstable {
            read += " unstable";
        }
        if most_rows != RunOptions::DEFAULT.most_rows {
            read += &format!(" at most {most_rows} rows");
        }
        Some(key_of_run(&(self.edition)(solver)?, solver, scene, resolution, &read))
    }

    /// Returns the record of a key, or `None` if the file is missing or damaged, or if existing files are ignored.
    fn take(&self, name: &str) -> Option<Record> {
        let record = kept_record::from_bytes(name, &self.runs.read(name).ok()?)?;
        self.taken.fetch_add(1, Ordering::Relaxed);
        // The least recently used files are removed first.
        self.runs.touch(name);
        Some(record)
    }

    /// Stores a record, unless the run is too short or the record too large. Write errors are ignored, because the run
    /// can be repeated.
    fn put(&self, name: &str, record: &Record) {
        if record.cost.wall_seconds >= LEAST
            && let Ok(bytes) = kept_record::to_bytes(name, record)
            && bytes.len() <= LARGEST
        {
            let _ = self.runs.write(name, &bytes);
        }
    }
}

/// Solvers with a cache of finished runs.
pub struct CachingSolvers<S> {
    solvers: S,
    cache: Arc<RunCache>,
}

impl<S> Drop for CachingSolvers<S> {
    /// Removes the least recently used files until the remaining files do not exceed the maximum size.
    fn drop(&mut self) {
        self.cache.runs.make_room(self.cache.most);
    }
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
        Some(Arc::new(Wrapped(CachingSolver { solver, name: name.to_owned(), defect, cache: Arc::clone(&self.cache) })))
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

    fn external_solvers(&self) -> Vec<ExternalSolver> {
        self.solvers.external_solvers()
    }

    fn edition(&self, name: &str) -> String {
        self.solvers.edition(name)
    }

    fn references(&self) -> &dyn References {
        self.solvers.references()
    }
}

struct CachingSolver {
    solver: Arc<dyn Solver>,
    name: String,
    defect: Option<Defect>,
    cache: Arc<RunCache>,
}

impl Wrapper for CachingSolver {
    fn inner(&self) -> &dyn Solver {
        &*self.solver
    }

    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let Some(name) = self.cache.name((&self.name, self.defect), start, observer.options()) else {
            return start.run(&*self.solver, observer);
        };
        if let Some(record) = self.cache.take(&name) {
            return Ok(record);
        }
        let record = start.run(&*self.solver, observer)?;
        self.cache.put(&name, &record);
        Ok(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::record::{Cost, Provenance, Series};

    /// Solver whose record states the number of its runs.
    struct Counting(AtomicU64);

    impl Solver for Counting {
        fn name(&self) -> String {
            "dem".to_owned()
        }

        fn run(&self, scene: &Scene, resolution: &Resolution, _: &mut dyn Observer) -> Result<Record, RunError> {
            Ok(Record {
                provenance: Provenance::new(scene, self.name(), resolution, 1.0, Vec::new()),
                series: Series::default(),
                snapshots: Vec::new(),
                cost: Cost::of_program(self.0.fetch_add(1, Ordering::Relaxed), 1, 1.0),
            })
        }
    }

    /// Two runs share an entry if they differ only by the number of threads, and never if they differ by another option.
    #[test]
    fn runs_with_other_options_share_no_entry() {
        let text = "title = 'one'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1000.0\n[grains.ball]\n\
            material = 'm'\nradius = 0.1\nposition = [0.0, 0.0]\n";
        let scene = Scene::from_text("one", text).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let cache = RunCache::open(folder.path(), u64::MAX, false, |_| Some(String::new())).unwrap();
        let solver = Arc::new(Counting(AtomicU64::new(0)));
        let solver = Wrapped(CachingSolver { solver, name: "dem".to_owned(), defect: None, cache: Arc::new(cache) });
        let options = RunOptions::DEFAULT;
        let cached = [
            options,
            RunOptions { allow_unstable: true, ..options },
            RunOptions { most_rows: 7, ..options },
            RunOptions { most_rows: 8, ..options },
            RunOptions { most_rows: 8, allow_unstable: true, ..options },
        ];
        let number =
            |mut options: RunOptions| solver.run(&scene, &Resolution::TimeStep(1.0), &mut options).unwrap().cost.steps;
        for _ in 0..2 {
            assert_eq!(cached.map(number), [0, 1, 2, 3, 4]);
            assert_eq!(cached.map(|options| number(RunOptions { threads: 2, ..options })), [0, 1, 2, 3, 4]);
        }
        let others = [
            RunOptions { keep_snapshots: false, ..options },
            RunOptions { end_state: true, ..options },
            RunOptions { checkpoint_interval: Some(1), ..options },
        ];
        assert_eq!(others.map(number), [5, 6, 7]);
        assert_eq!(others.map(number), [8, 9, 10]);
    }
}
