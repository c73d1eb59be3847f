//! Cache of finished runs, in a folder outside the source tree.
//!
//! A user who can write the folder can change the results, because the keys of runs are plain hashes. A folder is not
//! used if another user owns it, or if every user can write it.

use super::exit;
use grainbench::harness::solvers::Solvers;
use grainbench::store::machine::user_directory;
use grainbench::studies::run_cache::{CachingSolvers, RunCache};
use std::env;
#[cfg(unix)]
use std::fs;
#[cfg(unix)]
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Environment variable that contains the path of the folder, or `off`.
const VARIABLE: &str = "GRAINBENCH_CACHE";
/// Largest size of the cache (bytes).
const MOST: u64 = 2 << 30;

/// Opens the cache. Returns `None` if the cache is off, if there is no folder for it, or if the folder cannot be
/// written or trusted. If `CI=true`, the cache is off unless the environment variable contains a folder.
pub(crate) fn open(fresh: bool) -> Option<Arc<RunCache>> {
    let is_ci = env::var_os("CI").is_some_and(|word| word == "true");
    let folder = match env::var_os(VARIABLE) {
        Some(word) if word == "off" => return None,
        Some(folder) if !folder.is_empty() => PathBuf::from(folder),
        _ if is_ci => return None,
        _ => user_directory("Library/Caches", "XDG_CACHE_HOME", ".cache")?,
    };
    let warn = |reason: String| exit::say("warning", &format!("the cache of finished runs is not used: {reason}"));
    let cache = RunCache::open(&folder, MOST, fresh, edition).map_err(|error| warn(error.to_string())).ok()?;
    match distrust(&folder) {
        Some(reason) => {
            warn(format!("{}: {reason}", folder.display()));
            None
        }
        None => Some(Arc::new(cache)),
    }
}

/// Returns a text with the number of runs taken from the cache, the folder of the cache and the owner of the folder;
/// `None` if no run was taken from the cache.
pub(crate) fn words(cache: &RunCache) -> Option<String> {
    let taken = cache.taken();
    let about = owner(cache.folder()).map(|owner| format!(", {owner}")).unwrap_or_default();
    let folder = cache.folder().display();
    (taken > 0)
        .then(|| format!("{taken} runs taken from the cache of finished runs, with their times: {folder}{about}"))
}

/// Returns the reason why a folder is not trusted: another user owns it, or every user can write it.
#[cfg(unix)]
fn distrust(folder: &Path) -> Option<String> {
    let about = fs::metadata(folder).ok()?;
    let user = rustix::process::geteuid().as_raw();
    if ![user, 0].contains(&about.uid()) {
        return Some(format!("expected a folder of user {user} or of root, found one of user {}", about.uid()));
    }
    let mode = about.mode() & 0o7777;
    (mode & 0o002 != 0).then(|| format!("expected a folder that not all users can write to, found mode {mode:o}"))
}

#[cfg(not(unix))]
const fn distrust(_: &Path) -> Option<String> {
    None
}

/// Returns the owner of a folder, and its group if the group can write it.
#[cfg(unix)]
fn owner(folder: &Path) -> Option<String> {
    let about = fs::metadata(folder).ok()?;
    let group = if about.mode() & 0o020 == 0 { String::new() } else { format!(", writable by group {}", about.gid()) };
    Some(format!("owned by user {}{group}", about.uid()))
}

#[cfg(not(unix))]
const fn owner(_: &Path) -> Option<String> {
    None
}

/// Returns the given solvers, which use the cache if there is one.
pub(crate) fn with(solvers: impl Solvers + 'static, cache: Option<&Arc<RunCache>>) -> Arc<dyn Solvers> {
    match cache {
        Some(cache) => Arc::new(CachingSolvers::new(solvers, Arc::clone(cache))),
        None => Arc::new(solvers),
    }
}

/// Returns the parts of this program on which the runs of a solver depend: its sources, the compiler and the build options.
fn edition(solver: &str) -> Option<String> {
    let sources = grainbench::kept::sources(solver)?;
    Some(format!("{sources} {}", env!("GRAINBENCH_BUILD")))
}
