//! Hidden directories in which files are on their way, each with the name of the process that made it: what a process
//! left that is no more can be told from what another is working on, and from what a user calls alike.

use std::fs;
use std::io;
use std::path::Path;
use std::process;
use std::time::{Duration, SystemTime};

use tempfile::{Builder, TempDir};

/// What the names of hidden directories and of locks begin with.
const PREFIX: &str = ".grainbench-";
/// The file in a hidden directory that says whose it is.
const OWNER: &str = "owner";
/// The lock of a directory that is being written.
const LOCK: &str = ".grainbench-lock";
/// After which time something of an owner on another machine, who cannot be asked, is taken for left.
const PATIENCE: Duration = Duration::from_secs(24 * 3600);

/// A hidden directory on the same file system, so that a rename out of it is atomic. Files are made inside it rather
/// than by `NamedTempFile` so that they get the permissions of any other new file. What others left there who are no more
/// goes at this occasion.
pub(crate) fn temporary_in(parent: &Path) -> io::Result<TempDir> {
    // What cannot be taken away is no reason to write nothing.
    let _ = sweep(parent);
    let made = Builder::new().prefix(PREFIX).tempdir_in(parent).map_err(without_its_path)?;
    fs::write(made.path().join(OWNER), owner())?;
    Ok(made)
}

/// Takes away what processes that are no more had on its way into a folder. What has no owner of ours stays.
///
/// # Errors
/// When the folder cannot be read, or something in it not be removed.
pub fn sweep(folder: &Path) -> io::Result<()> {
    // The parent of a bare name is the current directory.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !name.starts_with(PREFIX) {
            continue;
        }
        let swept = if path.is_dir() && (is_left(&path.join(OWNER)) || is_barren(&path)) {
            fs::remove_dir_all(&path)
        } else if path.is_file() && name != LOCK && is_left(&path) {
            // On its way to being a lock.
            fs::remove_file(&path)
        } else {
            continue;
        };
        // Another may be sweeping too.
        swept.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
    }
    Ok(())
}

/// The lock of a directory, for as long as this is alive.
#[derive(Debug)]
pub(crate) struct Lock(std::path::PathBuf);

impl Lock {
    /// Takes the lock of a directory, within a while in which another may let go of it.
    pub(crate) fn of(directory: &Path) -> io::Result<Self> {
        const TRIES: u32 = 200;
        let path = directory.join(LOCK);
        for _ in 0..TRIES {
            // With its owner in it from the first moment: an empty one would be nobody's for ever.
            let mut file = Builder::new().prefix(PREFIX).tempfile_in(directory).map_err(without_its_path)?;
            io::Write::write_all(&mut file, owner().as_bytes())?;
            match file.persist_noclobber(&path).map_err(|error| error.error) {
                Ok(_) => return Ok(Self(path)),
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                Err(_) if is_left(&path) => {
                    let _ = fs::remove_file(&path);
                }
                Err(_) => std::thread::sleep(Duration::from_millis(50)),
            }
        }
        let whose = fs::read_to_string(&path).unwrap_or_default();
        let whose = whose.split_whitespace().nth(1).unwrap_or("of unknown number").to_owned();
        Err(io::Error::new(io::ErrorKind::ResourceBusy, format!("process {whose} is writing here ({LOCK})")))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// This process, in words: its number, and the machine on which it is that.
fn owner() -> String {
    format!("process {} on {}\n", process::id(), machine())
}

fn machine() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    name.map_or_else(|| "unknown".to_owned(), |name| name.trim().replace(char::is_whitespace, "-"))
}

/// Whether a file names an owner who is no more.
fn is_left(path: &Path) -> bool {
    let Ok(text) = fs::read_to_string(path) else { return false };
    let words: Vec<&str> = text.split_whitespace().collect();
    let ["process", number, "on", host] = words[..] else { return false };
    if host == machine() && Path::new("/proc/self").exists() {
        return number.parse::<u32>().is_ok_and(|number| !Path::new(&format!("/proc/{number}")).exists());
    }
    age_of(path).is_some_and(|age| age > PATIENCE)
}

/// Whether a hidden directory is as its maker had it for a moment only, and long ago: empty, and nobody's yet.
fn is_barren(path: &Path) -> bool {
    let is_old = age_of(path).is_some_and(|age| age > PATIENCE);
    let entries = |path: &Path| Some(fs::read_dir(path).ok()?.flatten().map(|entry| entry.path()).collect::<Vec<_>>());
    let is_empty = |path: &Path| fs::metadata(path).is_ok_and(|of| of.len() == 0);
    is_old && entries(path).is_some_and(|all| all.iter().all(|path| path.ends_with(OWNER) && is_empty(path)))
}

/// How long ago something was changed.
fn age_of(path: &Path) -> Option<Duration> {
    SystemTime::now().duration_since(fs::metadata(path).ok()?.modified().ok()?).ok()
}

/// What the system said, without the temporary name that nobody asked for.
fn without_its_path(error: io::Error) -> io::Error {
    let inner =
        error.get_ref().and_then(|wrapper| wrapper.source()).and_then(|inner| inner.downcast_ref::<io::Error>());
    inner.and_then(io::Error::raw_os_error).map_or(error, io::Error::from_raw_os_error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A process that has been and is no more.
    fn gone() -> u32 {
        let mut child = process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        child.id()
    }

    #[test]
    fn only_what_is_left_of_a_process_that_is_no_more_goes() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        for name in [".grainbench-notes", ".grainbench-left", ".grainbench-other"] {
            fs::create_dir(place(name)).unwrap();
        }
        fs::write(place(".grainbench-notes/mine"), "").unwrap();
        fs::write(place(".grainbench-left").join(OWNER), format!("process {} on {}\n", gone(), machine())).unwrap();
        fs::write(place(".grainbench-other").join(OWNER), "process 1 on another-machine\n").unwrap();
        let at_work = temporary_in(folder.path()).unwrap();
        sweep(folder.path()).unwrap();
        assert!(place(".grainbench-notes/mine").is_file() && at_work.path().is_dir());
        assert!(place(".grainbench-other").is_dir() && !place(".grainbench-left").exists());
    }

    #[test]
    fn a_lock_is_held_by_one_and_outlived_by_none() {
        let folder = tempfile::tempdir().unwrap();
        let held = Lock::of(folder.path()).unwrap();
        let (path, directory) = (folder.path().join(LOCK), folder.path().to_owned());
        assert!(path.is_file() && !is_left(&path));
        let waiting = std::thread::spawn(move || Lock::of(&directory).is_ok());
        std::thread::sleep(Duration::from_millis(120));
        drop(held);
        assert!(waiting.join().unwrap() && !path.exists());
        fs::write(&path, format!("process {} on {}\n", gone(), machine())).unwrap();
        assert!(Lock::of(folder.path()).is_ok());
    }
}
