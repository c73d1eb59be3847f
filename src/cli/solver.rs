//! Solvers named on the command line: built-in solvers, and external solvers by their manifests.

use super::exit::{Fault, refuse};
use grainbench::cases::solvers::{self, Registry};
use grainbench::harness::solvers::{ExternalSolver, References, Solvers};
use grainbench::reference::outside::ExternalProgram;
use grainbench::solver::{Defect, Solver};
use grainbench::store::key;
use std::collections::BTreeMap;
use std::env;
use std::path::Path;
use std::process;
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Returns the solver with this name, or the external solver of this manifest.
pub(crate) fn find(name: &str) -> Result<Arc<dyn Solver>, Fault> {
    if is_manifest(name) {
        return Ok(outside(name)?);
    }
    if let Some(now) = solvers::renamed(name) {
        eprintln!("note: `{name}` is the old name of `{now}`, which is used");
    }
    let solver = solvers::by_name(name).ok_or_else(|| {
        let names = solvers::names();
        Fault::unknown("the path of a manifest (`SOLVER.toml`) or a solver", name, names.iter().map(String::as_str))
    })?;
    Ok(Arc::from(solver))
}

/// Returns true if the text is the path of a manifest.
pub(crate) fn is_manifest(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// Returns the external solver of a manifest. Its name must not be the name of a built-in solver, because names identify results.
pub(crate) fn outside(path: &str) -> Result<Arc<ExternalProgram>, Fault> {
    let outside = ExternalProgram::read(Path::new(path))?;
    let name = outside.manifest().name.as_str();
    if solvers::by_name(name).is_some() {
        refuse!("{path}: name: expected an unused name, found `{name}`");
    }
    Ok(Arc::new(outside))
}

/// Solvers that a command line names.
#[derive(Clone, Default)]
pub(crate) struct NamedSolvers {
    external_solvers: Vec<Arc<ExternalProgram>>,
    /// Time of reading and process number. They identify the external solvers, which may have changed since earlier
    /// results were made.
    read: String,
    /// True to identify an external solver by the contents of its files; false to identify it by the time of reading.
    by_content: bool,
}

impl NamedSolvers {
    /// Reads the manifests whose paths are in `names`. Returns the solvers, and `names` with each path replaced by its
    /// solver's name. If several processes share the work, an external solver is identified by the contents of its files.
    pub(crate) fn read_for(names: &[String], is_shared: bool) -> Result<(Self, Vec<String>), Fault> {
        let (mut external_solvers, mut known) = (Vec::new(), Vec::new());
        for name in names {
            if is_manifest(name) {
                let external = outside(name)?;
                known.push(external.name());
                external_solvers.push(external);
            } else {
                find(name)?;
                known.push(name.clone());
            }
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let read = format!("{}-{}", now.as_nanos(), process::id());
        if is_shared {
            // The identification must not differ between processes, so a file that cannot be read is an error.
            for external in &external_solvers {
                external.edition().map_err(Fault::input)?;
            }
        }
        Ok((Self { external_solvers, read, by_content: is_shared }, known))
    }

    /// Returns the hashes of the files of the external solvers, by path. Paths below the current directory are relative.
    pub(crate) fn inputs(&self) -> BTreeMap<String, String> {
        let here = env::current_dir().unwrap_or_default();
        // A folder that cannot be read causes an error when the solvers are read.
        let files = self.external_solvers.iter().flat_map(|external| external.files().unwrap_or_default());
        let shown = |path: &Path| path.strip_prefix(&here).unwrap_or(path).display().to_string();
        files.map(|path| (shown(&path), key::of_file(&path))).collect()
    }

    /// Returns the names of the external solvers.
    pub(crate) fn names(&self) -> Vec<String> {
        self.external_solvers.iter().map(|external| external.name()).collect()
    }

    fn external(&self, name: &str) -> Option<&Arc<ExternalProgram>> {
        self.external_solvers.iter().find(|external| external.manifest().name == name)
    }
}

impl Solvers for NamedSolvers {
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>> {
        let external = self.external(name).map(|external| Arc::<ExternalProgram>::clone(external) as Arc<dyn Solver>);
        external.or_else(|| Registry.find(name))
    }

    fn find_within(&self, name: &str, limit: Duration) -> Option<Arc<dyn Solver>> {
        // The time limit of an external solver is in its manifest.
        if self.external(name).is_some() { self.find(name) } else { Registry.find_within(name, limit) }
    }

    fn with_defect(&self, name: &str, defect: Defect) -> Option<Arc<dyn Solver>> {
        Registry.with_defect(name, defect)
    }

    fn is_program(&self, name: &str) -> bool {
        self.external(name).is_some() || solvers::is_program(name)
    }

    fn external_solvers(&self) -> Vec<ExternalSolver> {
        let description = |external: &Arc<ExternalProgram>| {
            let manifest = external.manifest();
            ExternalSolver {
                name: external.name(),
                fractions: manifest.knobs.critical_fraction.clone(),
                cells: manifest.knobs.cells.clone(),
                has_springs: external.has_springs(),
                deforms: external.deforms(),
                stays: !manifest.worker.is_empty(),
            }
        };
        self.external_solvers.iter().map(description).collect()
    }

    fn edition(&self, name: &str) -> String {
        let Some(external) = self.external(name) else { return Registry.edition(name) };
        let content = if self.by_content { external.edition().ok() } else { None };
        content.unwrap_or_else(|| self.read.clone())
    }

    fn references(&self) -> &dyn References {
        &Registry
    }
}
