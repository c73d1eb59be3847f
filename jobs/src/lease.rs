//! Leases. A lease assigns tasks of a plan to one worker.
//!
//! A worker renews its lease at intervals. A lease expires if it is not renewed in time or if the process of its worker
//! has ended. Other workers may then take its unfinished tasks.
//!
//! Times are file times of the shared file system, because the clocks of the machines may differ.

use crate::fault::Fault;
use crate::plan::RUNNING;
use grainbench_store::lock::{LOCK, Lock, LockTerms, time_of};
use grainbench_store::{WriteError, machine, write_file};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time limits of the lock on the directory of leases. The lock is held while leases are read and one is added. The
/// longest wait is 60 s. A lock counts as abandoned after 20 s if its process cannot be checked.
const TERMS: LockTerms = LockTerms { wait: Duration::from_secs(60), abandoned_after: Duration::from_secs(20) };
/// File extension of leases.
const ENDING: &str = "json";

/// Contents of a lease file: the worker and its task ranges.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LeaseContents {
    /// Name of the worker.
    pub worker: String,
    /// Name of the machine.
    pub host: String,
    /// Process number on the machine.
    pub process: u32,
    /// Job of a batch system; `None` outside one.
    pub job: Option<String>,
    /// Ranges of leased task indices, each as the first index and one past the last.
    pub tasks: Vec<[usize; 2]>,
    /// Number of tasks that the worker has finished.
    pub done: usize,
}

impl LeaseContents {
    /// Returns true if the lease covers the task with the index `place`.
    #[must_use]
    pub fn has(&self, place: usize) -> bool {
        self.tasks.iter().any(|[from, to]| (*from..*to).contains(&place))
    }
}

/// Held lease. Its file is removed when this value is dropped.
#[derive(Debug)]
pub struct Lease {
    path: PathBuf,
    /// Contents of its file, apart from the number of finished tasks.
    pub contents: LeaseContents,
}

impl Lease {
    /// Leases all tasks of a range that no other worker holds, and returns the lease and the leases of all other
    /// workers.
    ///
    /// The lease is `None` if other workers hold the whole range. Leases expire `seconds` (s) after their last renewal.
    ///
    /// # Errors
    /// When the lock is not released within a minute, the leases cannot be read, or the disk rejects a write.
    pub fn take(
        plan: &Path,
        range: Range<usize>,
        contents: &LeaseContents,
        seconds: f64,
    ) -> Result<(Option<Self>, Vec<LeaseContents>), Fault> {
        let folder = plan.join(RUNNING);
        fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
        let _lock = Lock::acquire(&folder, TERMS).map_err(|error| match error.kind() {
            io::ErrorKind::ResourceBusy => {
                let expected = "a lock that is released within a minute";
                Fault::in_file(&folder.join(LOCK), expected, "a held lock; delete it if no worker is running")
            }
            _ => WriteError::new(&folder, error).into(),
        })?;
        let others: Vec<LeaseContents> =
            held(plan, seconds)?.into_iter().filter(|other| other.worker != contents.worker).collect();
        let free: Vec<usize> = range.filter(|&place| !others.iter().any(|other| other.has(place))).collect();
        if free.is_empty() {
            return Ok((None, others));
        }
        let tasks = free.chunk_by(|a, b| a + 1 == *b).map(|run| [run[0], run[run.len() - 1] + 1]).collect();
        let path = folder.join(format!("{}.{ENDING}", contents.worker));
        let lease = Self { path, contents: LeaseContents { tasks, ..contents.clone() } };
        lease.renew(0)?;
        Ok((Some(lease), others))
    }

    /// Renews the lease and records the number of finished tasks.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn renew(&self, done: usize) -> Result<(), WriteError> {
        let contents = LeaseContents { done, ..self.contents.clone() };
        write_file(&self.path, serde_json::to_string(&contents).unwrap_or_default())
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Returns the valid leases, sorted by worker, and removes expired ones. A lease expires `seconds` (s) after its last
/// renewal, or when the process of its worker has ended.
///
/// # Errors
/// When the directory of leases cannot be read.
pub fn held(plan: &Path, seconds: f64) -> Result<Vec<LeaseContents>, Fault> {
    let folder = plan.join(RUNNING);
    let entries = match fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(Fault::in_file(&folder, "a directory that can be read", error)),
    };
    let now = time_of(&folder);
    let mut found = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.extension().is_none_or(|ending| ending != ENDING) {
            continue;
        }
        let written = fs::metadata(&path).and_then(|about| about.modified());
        let (Ok(text), Ok(written)) = (fs::read_to_string(&path), written) else { continue };
        let Ok(contents) = serde_json::from_str::<LeaseContents>(&text) else { continue };
        let is_gone = machine::has_ended(contents.process, &contents.host) == Some(true);
        if is_gone || now.duration_since(written).unwrap_or_default().as_secs_f64() > seconds {
            let _ = fs::remove_file(&path);
        } else {
            found.push(contents);
        }
    }
    found.sort_by(|a, b| a.worker.cmp(&b.worker));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;

    fn lease_contents(worker: &str, process: u32) -> LeaseContents {
        LeaseContents { worker: worker.to_owned(), host: machine::name(), process, ..LeaseContents::default() }
    }

    #[test]
    fn no_task_has_two_owners() {
        let plan = tempfile::tempdir().unwrap();
        let own = std::process::id();
        let (first, others) = Lease::take(plan.path(), 2..6, &lease_contents("a", own), 60.0).unwrap();
        assert!(others.is_empty());
        let (second, others) = Lease::take(plan.path(), 0..10, &lease_contents("b", own), 60.0).unwrap();
        let (first, second) = (first.unwrap(), second.unwrap());
        assert_eq!((others.len(), &others[0].tasks), (1, &vec![[2, 6]]));
        assert_eq!(second.contents.tasks, [[0, 2], [6, 10]]);
        assert!((0..10).all(|place| first.contents.has(place) != second.contents.has(place)));
        assert!(Lease::take(plan.path(), 3..8, &lease_contents("c", own), 60.0).unwrap().0.is_none());
        drop(first);
        let (third, _) = Lease::take(plan.path(), 3..8, &lease_contents("c", own), 60.0).unwrap();
        assert_eq!(third.unwrap().contents.tasks, [[3, 6]]);
    }

    #[test]
    fn a_lease_lapses_with_its_owner_and_with_time() {
        let plan = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        for (process, host, seconds) in [(child.id(), machine::name(), 60.0), (1, "elsewhere".to_owned(), 0.02)] {
            let (lease, _) =
                Lease::take(plan.path(), 0..4, &LeaseContents { host, ..lease_contents("a", process) }, 60.0).unwrap();
            sleep(Duration::from_millis(100));
            assert_eq!(held(plan.path(), seconds).unwrap(), []);
            drop(lease);
        }
        fs::write(plan.path().join(RUNNING).join("b.json"), "{\"worker\"").unwrap();
        assert_eq!(held(plan.path(), 60.0).unwrap(), [], "what cannot be read is nobody's");
    }

    #[test]
    fn threads_that_ask_at_once_share_without_overlap() {
        let plan = tempfile::tempdir().unwrap();
        let leases: Vec<Option<Lease>> = std::thread::scope(|scope| {
            let ask = |at: usize| {
                let (path, contents) = (plan.path(), lease_contents(&format!("w{at}"), std::process::id()));
                scope.spawn(move || Lease::take(path, at..at + 5, &contents, 60.0).unwrap().0)
            };
            (0..8).map(ask).collect::<Vec<_>>().into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        for place in 0..12 {
            assert_eq!(leases.iter().flatten().filter(|lease| lease.contents.has(place)).count(), 1, "{place}");
        }
    }
}
