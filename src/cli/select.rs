//! Selection of claims by the command line.

use super::exit::{Fault, refuse};
use super::names::{level_of, levels, push_new, solvers};
use super::pattern;
use super::solver;
use super::subject::{SelectedVariants, Variant, by_case};
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::run::{Run, Set};
use grainbench::reference::outside::ExternalProgram;
use std::sync::Arc;

/// Claims that are selected from one case.
pub(crate) struct CaseSelection {
    /// Case that contains the claims.
    pub(crate) case: &'static Case,
    /// Selected claims in the order of the case; never empty.
    pub(crate) claims: Vec<Claim>,
    /// External solver that runs the claims instead of the solvers named in them.
    pub(crate) external: Option<Arc<ExternalProgram>>,
    /// True if some claims of the case were left out. Only the figures of the selected claims are then drawn.
    pub(crate) is_part: bool,
}

/// Selects the claims of the named cases for the named solvers and levels. An external solver gets only the
/// solver-independent claims that apply to it.
pub(crate) fn select(cases: &[String], solvers: &[String], levels: &[String]) -> Result<Vec<CaseSelection>, Fault> {
    let (manifests, names): (Vec<&String>, Vec<&String>) = solvers.iter().partition(|name| solver::is_manifest(name));
    let names: Vec<String> = names.into_iter().cloned().collect();
    let mut selected =
        if names.is_empty() && !manifests.is_empty() { Vec::new() } else { of_registry(cases, &names, levels)? };
    for path in manifests {
        let external = solver::outside(path)?;
        for mut of_case in select_fair(cases, levels)? {
            of_case.claims.retain(|claim| claim.scope.applies_to(&*external));
            selected.push(CaseSelection { external: Some(Arc::clone(&external)), ..of_case });
        }
    }
    selected.retain(|selected| !selected.claims.is_empty());
    if selected.is_empty() {
        refuse!("expected at least one solver-independent claim in the selected cases, found none");
    }
    Ok(selected)
}

/// Selects the solver-independent claims of the cases.
pub(crate) fn select_fair(cases: &[String], levels: &[String]) -> Result<Vec<CaseSelection>, Fault> {
    let mut selected = of_registry(cases, &[], levels)?;
    for of_case in &mut selected {
        of_case.claims.retain(|claim| claim.scope.is_open());
    }
    Ok(selected)
}

/// Selects claims of the registry and of folders, in the order of the registry. `cases` contains `CASE`, `CASE/VARIANT`
/// or folders; if it is empty, the whole registry is selected. A claim is selected if its result belongs to one of the
/// solvers, or if it compares with one of the named programs, and if one of its runs has one of the levels.
fn of_registry(cases: &[String], solvers: &[String], levels: &[String]) -> Result<Vec<CaseSelection>, Fault> {
    let cases = pattern::expanded(cases)?;
    let named = cases.iter().map(|name| Variant::read_with_folders(name)).collect::<Result<Vec<_>, _>>()?;
    let of_case = |(case, variants): (&'static Case, SelectedVariants<'_>)| {
        let mut claims = (case.claims)();
        claims.retain(|claim| claim.runs.first().is_some_and(|run| variants.contain(run.variant)));
        CaseSelection { case, claims, external: None, is_part: false }
    };
    let mut selected: Vec<CaseSelection> = by_case(&named).into_iter().map(of_case).collect();
    refuse_unknown_solvers(&selected, solvers)?;
    let is_all = levels.iter().any(|level| level == "all");
    let is_default = levels.is_empty() || levels.iter().any(|level| level == "default");
    if !is_all && !is_default {
        refuse_unknown_levels(&selected, levels)?;
    }
    let levels: Vec<String> = levels.iter().map(|level| unified(level)).collect();
    for CaseSelection { case, claims, .. } in &mut selected {
        if !solvers.is_empty() {
            let wanted = |run: &Run| solvers.iter().any(|name| name == run.solver);
            // The name of a program also selects the claims that compare our solver with it.
            let asked = |run: &Run| wanted(run) && grainbench::cases::solvers::is_program(run.solver);
            claims.retain(|claim| claim.runs.first().is_some_and(wanted) || claim.runs.iter().any(asked));
        }
        let spellings = |run: &Run| [level_of(case, run), run.resolution.to_string()];
        let is_at = |run: &Run| spellings(run).iter().any(|name| levels.contains(&unified(name)));
        // The default level has the claims of the quick tier.
        let is_meant = |claim: &Claim| if is_default { claim.set() == Set::Main } else { claim.runs.iter().any(is_at) };
        claims.retain(|claim| is_all || is_meant(claim));
    }
    selected.retain(|selected| !selected.claims.is_empty());
    // Without any claim, the run would be green although nothing was checked.
    if selected.is_empty() {
        refuse!("expected at least one claim for the selected cases, solvers and levels, found none");
    }
    Ok(selected)
}

fn refuse_unknown_solvers(selected: &[CaseSelection], names: &[String]) -> Result<(), Fault> {
    let ours = grainbench::cases::solvers::names();
    let mut known: Vec<&str> = ours.iter().map(String::as_str).collect();
    for name in selected.iter().flat_map(|selected| solvers(&selected.claims)) {
        push_new(&mut known, name);
    }
    match names.iter().find(|name| !known.contains(&name.as_str())) {
        Some(name) => Err(Fault::unknown("a solver", name, known)),
        None => Ok(()),
    }
}

/// Returns an error if no selected case has one of the named levels.
fn refuse_unknown_levels(selected: &[CaseSelection], names: &[String]) -> Result<(), Fault> {
    let mut known: Vec<String> = vec!["default".to_owned(), "all".to_owned()];
    for name in selected.iter().flat_map(|CaseSelection { case, claims, .. }| levels(case, claims)) {
        push_new(&mut known, name);
    }
    let is_unknown = |name: &&String| known.iter().all(|known| unified(known) != unified(name));
    match names.iter().find(is_unknown) {
        Some(name) => Err(Fault::unknown("a level", name, known.iter().map(String::as_str))),
        None => Ok(()),
    }
}

/// Returns the name of a level in a unified spelling, because `dt=.1` and `dt=0.1` are the same level.
fn unified(name: &str) -> String {
    match name.split_once('=') {
        Some((knob, value)) if value.starts_with('.') => format!("{knob}=0{value}"),
        _ => name.to_owned(),
    }
}
