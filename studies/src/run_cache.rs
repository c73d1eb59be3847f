//! Finished runs, kept outside the tree from one command to the next: records, and never verdicts.
//!
//! A run is known by its scene, its solver with its defect, its resolution, the path that its loops take, and what this program
//! was built from of it: who changes a case runs that case again, who changes a solver runs what it does. What is damaged, or
//! holds another run, is done again. Of a run whose snapshots somebody takes as they come, or whose end state or checkpoints
//! are wanted, nothing is kept; nor of other people's programs, which may change behind our back.

use crate::identity;
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::run::Run;
use grainbench_harness::solvers::{Kept, Solvers, Stranger};
use grainbench_lanes::Processor;
use grainbench_reports::{Desk, WriteError, sweep};
use grainbench_scene::checkpoint::Checkpoint;
use grainbench_scene::kept_record;
use grainbench_scene::record::Record;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Defect, Resolution, RunError, Solver, Watch};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, SystemTime};

/// A run that takes less (s) is done sooner than it is read.
const LEAST: f64 = 2e-3;
/// A record of more than this many bytes would push too many others out.
const LARGEST: usize = 256 << 20;
/// How a file's name ends.
const ENDING: &str = "run";

/// What a solver's name was built from; none of what is not ours.
pub type Edition = fn(&str) -> Option<String>;

/// A folder of finished runs.
pub struct RunCache {
    folder: PathBuf,
    /// Bytes that all files together may have.
    most: u64,
    /// Nothing that stands there is taken.
    fresh: bool,
    edition: Edition,
    taken: AtomicU64,
    /// Where files are written before they have their names; from the first that is kept.
    desk: OnceLock<Option<Desk>>,
}

impl RunCache {
    /// The runs in a folder, which is made when it is not there; with `fresh` none of them is taken.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn open(folder: &Path, most: u64, fresh: bool, edition: Edition) -> Result<Self, WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError::new(folder, source))?;
        // Of a program that was killed while it wrote.
        sweep(folder).map_err(|source| WriteError::new(folder, source))?;
        let folder = folder.to_owned();
        Ok(Self { folder, most, fresh, edition, taken: AtomicU64::new(0), desk: OnceLock::new() })
    }

    /// How many runs came from here.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.taken.load(Ordering::Relaxed)
    }

    /// What a run is; none where it is not kept.
    fn name(&self, solver: &str, defect: Option<Defect>, scene: &Scene, resolution: &Resolution) -> Option<String> {
        let program = (self.edition)(solver)?;
        Some(identity::of_run(&program, solver, scene, resolution, &format!("{defect:?} {}", Processor::new().name())))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.{ENDING}"))
    }

    /// The record of a name, if it stands here whole.
    fn take(&self, name: &str) -> Option<Record> {
        if self.fresh {
            return None;
        }
        let path = self.path(name);
        let record = kept_record::from_bytes(name, &fs::read(&path).ok()?)?;
        self.taken.fetch_add(1, Ordering::Relaxed);
        // The oldest are the first to go. Where the time cannot be set it goes by when it was done.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Some(record)
    }

    /// Keeps a record. A disk that refuses is no reason to lose the run: the next one does it again.
    fn put(&self, name: &str, record: &Record) {
        if record.cost.wall_seconds < LEAST {
            return;
        }
        let Ok(bytes) = kept_record::to_bytes(name, record) else { return };
        if bytes.len() <= LARGEST
            && let Some(desk) = self.desk.get_or_init(|| Desk::new(&self.folder).ok())
        {
            let _ = desk.write(&format!("{name}.{ENDING}"), bytes);
        }
    }

    /// Takes away what was not used for longest until the rest has room.
    pub fn make_room(&self) {
        let of = |entry: fs::DirEntry| {
            let is_one = entry.path().extension().is_some_and(|ending| ending == ENDING);
            let about = entry.metadata().ok().filter(|_| is_one)?;
            Some((about.modified().unwrap_or(SystemTime::UNIX_EPOCH), about.len(), entry.path()))
        };
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries.filter_map(of).collect();
        files.sort();
        let mut all: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
        for (_, bytes, path) in files {
            if all <= self.most {
                break;
            }
            // Somebody else may have taken it away.
            let _ = fs::remove_file(path);
            all -= bytes;
        }
    }
}

/// Solvers whose finished runs are kept and taken.
pub struct WithCache<S> {
    solvers: S,
    cache: Arc<RunCache>,
}

impl<S: Solvers> WithCache<S> {
    /// These solvers with this cache.
    pub const fn new(solvers: S, cache: Arc<RunCache>) -> Self {
        Self { solvers, cache }
    }

    fn wrapped(&self, name: &str, defect: Option<Defect>, solver: Option<Arc<dyn Solver>>) -> Option<Arc<dyn Solver>> {
        let solver = solver?;
        if self.solvers.is_program(name) {
            return Some(solver);
        }
        Some(Arc::new(Cached { solver, name: name.to_owned(), defect, cache: Arc::clone(&self.cache) }))
    }
}

impl<S: Solvers> Solvers for WithCache<S> {
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

    fn strangers(&self) -> Vec<Stranger> {
        self.solvers.strangers()
    }

    fn edition(&self, name: &str) -> String {
        self.solvers.edition(name)
    }

    fn stored(&self, case: &Case, run: &Run, scene: &Scene) -> Option<Result<Record, RunError>> {
        self.solvers.stored(case, run, scene)
    }

    fn kept(&self, case: &Case, run: &Run, scene: &Scene, control: Option<&str>) -> Option<Result<Kept, RunError>> {
        self.solvers.kept(case, run, scene, control)
    }

    fn uncertainty(&self, case: &Case, claim: &Claim) -> Option<f64> {
        self.solvers.uncertainty(case, claim)
    }

    fn is_stored(&self, case: &Case, run: &Run) -> bool {
        self.solvers.is_stored(case, run)
    }
}

/// A solver whose finished runs are kept and taken.
struct Cached {
    solver: Arc<dyn Solver>,
    name: String,
    defect: Option<Defect>,
    cache: Arc<RunCache>,
}

impl Solver for Cached {
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

    fn run(&self, scene: &Scene, resolution: &Resolution, watch: &mut dyn Watch) -> Result<Record, RunError> {
        let wants_more = !watch.keeps_snapshots() || watch.wants_end_state() || watch.checkpoint_interval().is_some();
        let Some(name) = self.cache.name(&self.name, self.defect, scene, resolution).filter(|_| !wants_more) else {
            return self.solver.run(scene, resolution, watch);
        };
        if let Some(record) = self.cache.take(&name) {
            return Ok(record);
        }
        let record = self.solver.run(scene, resolution, watch)?;
        self.cache.put(&name, &record);
        Ok(record)
    }

    fn restart(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: &Checkpoint,
        watch: &mut dyn Watch,
    ) -> Result<Record, RunError> {
        self.solver.restart(scene, resolution, from, watch)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// Three files of a hundred bytes where there is room for two and a half: that of the longest rest goes, and what is no run
    /// of ours stays.
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
