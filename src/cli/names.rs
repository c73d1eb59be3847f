//! Names that the command line accepts: variants, levels and solvers of claims.

use super::exit::Fault;
use grainbench::harness::case::{Case, PLAIN};
use grainbench::harness::claim::Claim;
use grainbench::harness::run::Run;

/// Returns the name of a run's level: the name in the case, or the resolution in words.
pub(crate) fn level_of(case: &Case, run: &Run) -> String {
    let level = case.levels.iter().find(|level| level.resolution == run.resolution);
    level.map_or_else(|| run.resolution.to_string(), |level| level.name.to_owned())
}

/// Returns the names of the levels of a case, followed by the names of further levels of its claims.
pub(crate) fn levels(case: &Case, claims: &[Claim]) -> Vec<String> {
    let mut names: Vec<String> = case.levels.iter().map(|level| level.name.to_owned()).collect();
    for run in claims.iter().flat_map(|claim| &claim.runs) {
        push_new(&mut names, level_of(case, run));
    }
    names
}

/// Returns the names of the variants of a case. The plain scene is included if the result of a claim uses it.
pub(crate) fn variants(case: &Case, claims: &[Claim]) -> Result<Vec<String>, Fault> {
    let mut names = case.variants()?;
    if claims.iter().filter_map(|claim| claim.runs.first()).any(|run| run.variant == PLAIN) {
        push_new(&mut names, PLAIN.to_owned());
    }
    Ok(names)
}

/// Returns the solvers that identify results, followed by the programs with which they are compared. Each name occurs once.
pub(crate) fn solvers(claims: &[Claim]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for run in claims.iter().filter_map(|claim| claim.runs.first()) {
        push_new(&mut names, run.solver);
    }
    let programs = claims.iter().flat_map(|claim| &claim.runs);
    for run in programs.filter(|run| grainbench::cases::solvers::is_program(run.solver)) {
        push_new(&mut names, run.solver);
    }
    names
}

pub(crate) fn push_new<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}
