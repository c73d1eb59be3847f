//! Temporary hidden directories and files. Their names contain the number and the machine of the process that created
//! them. Files of ended processes are thus distinguished from files in use and from files of the user.

use crate::machine;
use std::fs;
use std::io;
use std::path::Path;
use std::process;
use std::time::{Duration, SystemTime};

use tempfile::{Builder, TempDir};

/// Start of the names of all our temporary files.
const PREFIX: &str = ".grainbench-";
/// Age after which a temporary file of another machine counts as left over, because its process cannot be checked.
const PATIENCE: Duration = Duration::from_secs(24 * 3600);

/// Creates a hidden directory on the same file system as `parent`, so that files can be moved out of it atomically.
///
/// Files in this directory should be created with `std::fs`, which gives them the permissions of ordinary new files,
/// unlike `NamedTempFile`. Temporary files of ended processes in `parent` are removed first.
///
/// # Errors
/// When the directory cannot be created.
pub fn temporary_in(parent: &Path) -> io::Result<TempDir> {
    // A failed removal does not prevent writing.
    let _ = remove_leftovers(parent);
    Builder::new().prefix(&prefix()).tempdir_in(parent).map_err(without_its_path)
}

/// Returns true if a name is that of a temporary file or a lock file of this program.
#[must_use]
pub fn is_scratch(name: &std::ffi::OsStr) -> bool {
    name.to_string_lossy().starts_with(PREFIX)
}

/// Returns the prefix of the names of temporary files of this process. A random suffix without a dash follows.
pub(crate) fn prefix() -> String {
    format!("{PREFIX}{}@{}-", process::id(), machine::name())
}

/// Returns the process number and the machine from the name of a temporary file, or `None` for other names.
fn owner_in(name: &str) -> Option<(u32, &str)> {
    let (number, rest) = name.strip_prefix(PREFIX)?.split_once('@')?;
    Some((number.parse().ok()?, rest.rsplit_once('-')?.0))
}

/// Removes temporary files and directories of ended processes from a folder. Other files remain.
///
/// # Errors
/// When the folder cannot be read or a file cannot be removed.
pub fn remove_leftovers(folder: &Path) -> io::Result<()> {
    // The parent of a bare file name is the current directory.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some((process, host)) = owner_in(&name) else { continue };
        // The age of the file decides if the process cannot be checked.
        let has_ended = machine::has_ended(process, host);
        if !has_ended.unwrap_or_else(|| age_of(&path).is_some_and(|age| age > PATIENCE)) {
            continue;
        }
        let swept = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
        // Another process may have removed the file at the same time.
        swept.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
    }
    Ok(())
}

/// Returns the time since the last change of a file.
fn age_of(path: &Path) -> Option<Duration> {
    SystemTime::now().duration_since(fs::metadata(path).ok()?.modified().ok()?).ok()
}

/// Returns the error of the operating system, without the name of the temporary file.
pub(crate) fn without_its_path(error: io::Error) -> io::Error {
    let inner =
        error.get_ref().and_then(|wrapper| wrapper.source()).and_then(|inner| inner.downcast_ref::<io::Error>());
    inner.and_then(io::Error::raw_os_error).map_or(error, io::Error::from_raw_os_error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lock::tests::gone;

    #[test]
    fn only_what_is_left_of_a_process_that_is_no_more_goes() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let left = format!(".grainbench-{}@{}-aX3", gone(), machine::name());
        let other = ".grainbench-1@another-machine-aX3";
        for name in [".grainbench-notes", ".grainbench-1-notes", &left, other] {
            fs::create_dir(place(name)).unwrap();
            fs::write(place(name).join("mine"), "").unwrap();
        }
        let file = format!(".grainbench-{}@{}-bY4", gone(), machine::name());
        fs::write(place(&file), "").unwrap();
        let at_work = temporary_in(folder.path()).unwrap();
        remove_leftovers(folder.path()).unwrap();
        assert!(at_work.path().is_dir() && !place(&left).exists() && !place(&file).exists());
        assert!([".grainbench-notes", ".grainbench-1-notes", other].iter().all(|name| place(name).is_dir()));
    }
}
