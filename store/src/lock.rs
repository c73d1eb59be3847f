//! Lock of a directory. Only one process at a time holds it; the others wait or end with an error.

use crate::machine;
use crate::scratch::{prefix, without_its_path};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::time::{Duration, Instant, SystemTime};
use tempfile::Builder;

/// Name of the lock file.
pub const LOCK: &str = ".grainbench-lock";
/// Pause between two attempts to lock.
const PAUSE: Duration = Duration::from_millis(20);

/// Time limits of a lock.
#[derive(Clone, Copy, Debug)]
pub struct LockTerms {
    /// Longest wait for a lock that another process holds.
    pub wait: Duration,
    /// Age at which a lock counts as abandoned if its process cannot be checked, for example a process of another
    /// machine.
    pub abandoned_after: Duration,
}

/// Lock of a directory. It is released when this value is dropped.
#[derive(Debug)]
pub struct Lock(PathBuf);

impl Lock {
    /// Locks a directory. The lock of a process that has ended is removed.
    ///
    /// # Errors
    /// When another process does not release the lock in time ([`io::ErrorKind::ResourceBusy`]), or when the directory
    /// cannot be written.
    pub fn acquire(directory: &Path, terms: LockTerms) -> io::Result<Self> {
        let path = directory.join(LOCK);
        let start = Instant::now();
        loop {
            // The lock file names its owner as soon as it exists. The owner of an empty file would be unknown after a
            // crash.
            let mut file = Builder::new().prefix(&prefix()).tempfile_in(directory).map_err(without_its_path)?;
            file.write_all(owner().as_bytes())?;
            match file.persist_noclobber(&path).map_err(|error| error.error) {
                Ok(_) => return Ok(Self(path)),
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                Err(_) => {}
            }
            if !remove_abandoned(&path, terms.abandoned_after) {
                if start.elapsed() > terms.wait {
                    return Err(busy(&path));
                }
                std::thread::sleep(PAUSE);
            }
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// Returns the text of a lock file of this process: its number and its machine.
fn owner() -> String {
    format!("process {} on {}\n", process::id(), machine::name())
}

/// Returns the process number and the machine from the text of a lock file, or `None` if the text has another form.
fn owner_in(text: &str) -> Option<(u32, &str)> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let ["process", number, "on", host] = words[..] else { return None };
    Some((number.parse().ok()?, host))
}

fn busy(path: &Path) -> io::Error {
    let text = fs::read_to_string(path).unwrap_or_default();
    let process = owner_in(&text).map_or("of unknown number".to_owned(), |(number, _)| number.to_string());
    io::Error::new(io::ErrorKind::ResourceBusy, format!("process {process} is writing to this directory ({LOCK})"))
}

/// Removes an abandoned lock. Returns false if another process holds the lock, so that the caller must wait.
fn remove_abandoned(path: &Path, after: Duration) -> bool {
    let Ok(text) = fs::read_to_string(path) else { return !path.exists() };
    // The age decides if the process cannot be checked.
    let has_ended = owner_in(&text).and_then(|(process, host)| machine::has_ended(process, host));
    if !has_ended.unwrap_or_else(|| age(path).is_some_and(|age| age > after)) {
        return false;
    }
    // Another process may meanwhile have replaced the abandoned lock by its own lock, which is then moved back.
    let Ok(aside) = Builder::new().prefix(&prefix()).tempdir_in(path.parent().unwrap_or(Path::new("."))) else {
        return false;
    };
    let taken = aside.path().join("lock");
    if fs::rename(path, &taken).is_ok() && fs::read_to_string(&taken).is_ok_and(|found| found != text) {
        let _ = fs::hard_link(&taken, path);
    }
    true
}

/// Returns the age of a file by the clock of its file system, or `None` if the file does not exist.
fn age(path: &Path) -> Option<Duration> {
    let written = fs::metadata(path).ok()?.modified().ok()?;
    Some(time_of(path.parent()?).duration_since(written).unwrap_or_default())
}

/// Returns the time of a file system. The clocks of machines that share a file system may differ. If the folder is not
/// writable, returns the time of the local clock.
#[must_use]
pub fn time_of(folder: &Path) -> SystemTime {
    let file = Builder::new().prefix(&prefix()).tempfile_in(folder);
    let now = file.and_then(|file| file.as_file().metadata()?.modified());
    now.unwrap_or_else(|_| SystemTime::now())
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    const TERMS: LockTerms =
        LockTerms { wait: Duration::from_secs(10), abandoned_after: Duration::from_secs(24 * 3600) };
    const SHORT: LockTerms = LockTerms { wait: Duration::from_millis(50), ..TERMS };

    /// Returns the number of a process that has ended.
    pub(crate) fn gone() -> u32 {
        let mut child = process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        child.id()
    }

    #[test]
    fn a_lock_has_one_owner_and_ends_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let held = Lock::acquire(folder.path(), TERMS).unwrap();
        let (path, directory) = (folder.path().join(LOCK), folder.path().to_owned());
        let error = Lock::acquire(folder.path(), SHORT).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::ResourceBusy);
        assert!(error.to_string().contains(&format!("process {} is writing", process::id())), "{error}");
        let waiting = std::thread::spawn(move || Lock::acquire(&directory, TERMS).is_ok());
        std::thread::sleep(Duration::from_millis(120));
        drop(held);
        assert!(waiting.join().unwrap() && !path.exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_lock_is_abandoned_with_its_process_or_by_its_age() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        for (text, is_free) in [
            (format!("process {} on {}\n", gone(), machine::name()), true),
            (owner(), false),
            ("process 1 on another-machine\n".to_owned(), false),
            (String::new(), false),
        ] {
            fs::write(&path, &text).unwrap();
            assert_eq!(Lock::acquire(folder.path(), SHORT).is_ok(), is_free, "{text:?}");
            // The age decides only if the process cannot be checked.
            fs::write(&path, &text).unwrap();
            std::thread::sleep(Duration::from_millis(40));
            let old = LockTerms { abandoned_after: Duration::from_millis(10), ..SHORT };
            assert_eq!(Lock::acquire(folder.path(), old).is_ok(), text != owner(), "{text:?}");
            let _ = fs::remove_file(&path);
        }
    }

    #[test]
    fn threads_own_a_lock_in_turn() {
        let folder = tempfile::tempdir().unwrap();
        let inside = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let _lock = Lock::acquire(folder.path(), TERMS).unwrap();
                    assert_eq!(inside.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                    std::thread::sleep(Duration::from_millis(5));
                    inside.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                });
            }
        });
    }
}
