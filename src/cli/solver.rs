//! Solver named on the command line: a built-in solver, or an external solver by its manifest.

use super::exit::{Fault, refuse};
use grainbench::cases::solvers;
use grainbench::reference::outside::ExternalProgram;
use grainbench::solver::Solver;
use std::path::Path;
use std::sync::Arc;

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
