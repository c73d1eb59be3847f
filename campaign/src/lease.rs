//! Leases: who is at which tasks. A worker says now and then that it is still there; of one that says nothing for long, or
//! whose process is no more, what it had not finished is anybody's.
//!
//! Times are those of the file system, which all workers share: clocks of machines differ.

use crate::fault::Fault;
use crate::machine;
use crate::plan::RUNNING;
use grainbench_reports::{WriteError, write_file};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Held for as long as leases are looked at and one is added.
const LOCK: &str = ".lock";
/// A lock that is older (s) has no owner any more.
const LEFT: f64 = 20.0;
/// How often a lock is asked for, and how long it is waited between.
const TRIES: u32 = 3000;
const PAUSE: Duration = Duration::from_millis(20);
/// How names of leases end.
const ENDING: &str = "json";

/// What a worker says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Said {
    /// Its name.
    pub worker: String,
    /// Its machine.
    pub host: String,
    /// Its process there.
    pub process: u32,
    /// Job of a batch system.
    pub job: Option<String>,
    /// First and one after the last of tasks that are its own.
    pub tasks: Vec<[usize; 2]>,
    /// How many of them are done by now.
    pub done: usize,
}

impl Said {
    /// Whether a task is its own.
    #[must_use]
    pub fn has(&self, place: usize) -> bool {
        self.tasks.iter().any(|[from, to]| (*from..*to).contains(&place))
    }
}

/// A lease that is held.
#[derive(Debug)]
pub struct Lease {
    path: PathBuf,
    said: Said,
}

impl Lease {
    /// Takes those tasks of a range that nobody holds; gives what others hold too. `None` where they hold all of it.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn take(
        plan: &Path,
        range: Range<usize>,
        said: &Said,
        seconds: f64,
    ) -> Result<(Option<Self>, Vec<Said>), Fault> {
        let folder = plan.join(RUNNING);
        fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
        let _lock = Lock::of(&folder)?;
        let others: Vec<Said> = held(plan, seconds)?.into_iter().filter(|other| other.worker != said.worker).collect();
        let mut tasks: Vec<[usize; 2]> = Vec::new();
        for place in range {
            if others.iter().any(|other| other.has(place)) {
                continue;
            }
            match tasks.last_mut() {
                Some([_, to]) if *to == place => *to = place + 1,
                _ => tasks.push([place, place + 1]),
            }
        }
        if tasks.is_empty() {
            return Ok((None, others));
        }
        let path = folder.join(format!("{}.{ENDING}", said.worker));
        let lease = Self { path, said: Said { tasks, ..said.clone() } };
        lease.renew(0)?;
        Ok((Some(lease), others))
    }

    /// Whether a task may be done.
    #[must_use]
    pub fn has(&self, place: usize) -> bool {
        self.said.has(place)
    }

    /// Says that the worker is still there, and how many tasks it has done.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn renew(&self, done: usize) -> Result<(), WriteError> {
        let said = Said { done, ..self.said.clone() };
        write_file(&self.path, serde_json::to_string(&said).unwrap_or_default())
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// The leases that are held. Those of workers that are no more are taken away.
///
/// # Errors
/// When they cannot be read.
pub fn held(plan: &Path, seconds: f64) -> Result<Vec<Said>, Fault> {
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
        let (Ok(text), Some(age)) = (fs::read_to_string(&path), age(&path, now)) else { continue };
        let Ok(said) = serde_json::from_str::<Said>(&text) else { continue };
        let is_gone = said.host == machine::name() && machine::runs(said.process) == Some(false);
        if is_gone || age > seconds {
            let _ = fs::remove_file(&path);
        } else {
            found.push(said);
        }
    }
    found.sort_by(|a, b| a.worker.cmp(&b.worker));
    Ok(found)
}

/// What time it is on a file system; by our own clock where nothing can be written there.
fn time_of(folder: &Path) -> SystemTime {
    let path = folder.join(format!(".time-{}-{}", machine::name(), std::process::id()));
    let now = File::create(&path).and_then(|file| file.metadata()?.modified());
    let _ = fs::remove_file(&path);
    now.unwrap_or_else(|_| SystemTime::now())
}

/// How long ago (s) a file was written; none where it is not there.
fn age(path: &Path, now: SystemTime) -> Option<f64> {
    let written = fs::metadata(path).and_then(|about| about.modified()).ok()?;
    Some(now.duration_since(written).unwrap_or_default().as_secs_f64())
}

/// The lock, for as long as this is alive.
struct Lock {
    path: PathBuf,
    /// Those of one machine take turns by a lock of the system, which ends with its process; none where there are no such locks.
    _turn: Option<File>,
}

impl Lock {
    fn of(folder: &Path) -> Result<Self, Fault> {
        let path = folder.join(LOCK);
        let turn = File::create(folder.join(format!("{LOCK}-{}", machine::name()))).ok();
        let turn = turn.filter(|file| file.lock().is_ok());
        for _ in 0..TRIES {
            match File::create_new(&path) {
                Ok(mut file) => {
                    let _ = file.write_all(machine::name().as_bytes());
                    return Ok(Self { path, _turn: turn });
                }
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                    return Err(WriteError::new(path, error).into());
                }
                Err(_) => {}
            }
            if is_left(&path, turn.is_some(), time_of(folder)) {
                // Of those who try this one can, and it takes away what it has looked at.
                let aside = folder.join(format!(".left-{}-{}", machine::name(), std::process::id()));
                if fs::rename(&path, &aside).is_ok() {
                    let _ = fs::remove_file(&aside);
                }
            } else {
                sleep(PAUSE);
            }
        }
        Err(Fault::in_file(
            &path,
            "a lock that is let go of within a minute",
            "one that is held; remove it if nobody works",
        ))
    }
}

/// Whether nobody holds a lock any more: it is old, or of this machine, of whose processes it is the turn of another.
fn is_left(path: &Path, is_our_turn: bool, now: SystemTime) -> bool {
    let is_of_this_machine = || fs::read_to_string(path).is_ok_and(|host| host == machine::name());
    age(path, now).is_some_and(|age| age > LEFT) || is_our_turn && is_of_this_machine()
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    fn said(worker: &str, process: u32) -> Said {
        Said { worker: worker.to_owned(), host: machine::name(), process, job: None, tasks: Vec::new(), done: 0 }
    }

    #[test]
    fn no_task_has_two_owners() {
        let plan = tempfile::tempdir().unwrap();
        let own = std::process::id();
        let (first, others) = Lease::take(plan.path(), 2..6, &said("a", own), 60.0).unwrap();
        assert!(others.is_empty());
        let (second, others) = Lease::take(plan.path(), 0..10, &said("b", own), 60.0).unwrap();
        let (first, second) = (first.unwrap(), second.unwrap());
        assert_eq!((others.len(), &others[0].tasks), (1, &vec![[2, 6]]));
        assert_eq!(second.said.tasks, [[0, 2], [6, 10]]);
        assert!((0..10).all(|place| first.has(place) != second.has(place)));
        assert!(Lease::take(plan.path(), 3..8, &said("c", own), 60.0).unwrap().0.is_none());
        drop(first);
        assert_eq!(Lease::take(plan.path(), 3..8, &said("c", own), 60.0).unwrap().0.unwrap().said.tasks, [[3, 6]]);
    }

    #[test]
    fn a_lease_lapses_with_its_owner_and_with_time() {
        let plan = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        for (process, host, seconds) in [(child.id(), machine::name(), 60.0), (1, "elsewhere".to_owned(), 0.02)] {
            let (lease, _) = Lease::take(plan.path(), 0..4, &Said { host, ..said("a", process) }, 60.0).unwrap();
            sleep(Duration::from_millis(100));
            assert_eq!(held(plan.path(), seconds).unwrap(), []);
            drop(lease);
        }
        fs::write(plan.path().join(RUNNING).join("b.json"), "{\"worker\"").unwrap();
        assert_eq!(held(plan.path(), 60.0).unwrap(), [], "what cannot be read is nobody's");
    }

    /// A worker that was killed while it held the lock keeps nobody of its machine waiting.
    #[test]
    fn a_lock_is_left_by_who_is_no_more() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        for (host, is_our_turn, left) in [
            (machine::name(), true, true),
            (machine::name(), false, false),
            ("elsewhere".to_owned(), true, false),
            (String::new(), true, false),
        ] {
            fs::write(&path, &host).unwrap();
            let written = fs::metadata(&path).unwrap().modified().unwrap();
            assert_eq!(is_left(&path, is_our_turn, written), left, "{host:?} {is_our_turn}");
            assert!(is_left(&path, is_our_turn, written + Duration::from_secs(21)), "{host:?} {is_our_turn}");
        }
    }

    #[test]
    fn threads_that_ask_at_once_share_without_overlap() {
        let plan = tempfile::tempdir().unwrap();
        let leases: Vec<Option<Lease>> = std::thread::scope(|scope| {
            let ask = |at: usize| {
                let (path, said) = (plan.path(), said(&format!("w{at}"), std::process::id()));
                scope.spawn(move || Lease::take(path, at..at + 5, &said, 60.0).unwrap().0)
            };
            (0..8).map(ask).collect::<Vec<_>>().into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        for place in 0..12 {
            assert_eq!(leases.iter().flatten().filter(|lease| lease.has(place)).count(), 1, "{place}");
        }
    }
}
