//! Where finished runs are kept: outside the tree, for whoever runs the same again.

use super::exit;
use grainbench::cases::solvers::Registry;
use grainbench::harness::solvers::Solvers;
use grainbench::studies::run_cache::{RunCache, WithCache};
use std::env;
use std::path::PathBuf;
use std::sync::Arc;

/// The folder, or `off`.
const VARIABLE: &str = "GRAINBENCH_CACHE";
/// Bytes that it may have.
const MOST: u64 = 2 << 30;

/// The cache; none where it is off, where there is no place for it, or where that cannot be written to.
pub(crate) fn open(fresh: bool) -> Option<Arc<RunCache>> {
    let folder = match env::var_os(VARIABLE) {
        Some(word) if word == "off" => return None,
        Some(folder) if !folder.is_empty() => PathBuf::from(folder),
        _ => usual()?,
    };
    let cache = RunCache::open(&folder, MOST, fresh, edition);
    cache.map(Arc::new).map_err(|error| exit::say("warning", &format!("finished runs are not kept: {error}"))).ok()
}

/// The solvers of the registry, with a cache where there is one.
pub(crate) fn solvers(cache: Option<&Arc<RunCache>>) -> Arc<dyn Solvers> {
    with(Registry, cache)
}

/// Solvers with a cache where there is one.
pub(crate) fn with(solvers: impl Solvers + 'static, cache: Option<&Arc<RunCache>>) -> Arc<dyn Solvers> {
    match cache {
        Some(cache) => Arc::new(WithCache::new(solvers, Arc::clone(cache))),
        None => Arc::new(solvers),
    }
}

/// What of this program a solver's runs hang on: its sources, and what they were built with.
fn edition(solver: &str) -> Option<String> {
    let sources = grainbench::kept::sources(solver)?;
    Some(format!("{sources} {}", env!("GRAINBENCH_BUILD")))
}

/// Where programs of this system keep what can be made again.
fn usual() -> Option<PathBuf> {
    let of = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let home = || of("HOME");
    let base = if cfg!(windows) {
        of("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        of("XDG_CACHE_HOME").or_else(|| home().map(|home| home.join(".cache")))
    };
    base.map(|base| base.join("grainbench"))
}
