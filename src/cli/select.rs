//! Which claims a command line means.

use super::exit::Fault;
use super::pattern;
use super::solver;
use super::subject::Variant;
use grainbench::cases::registry::CASES;
use grainbench::harness::case::{Case, PLAIN};
use grainbench::harness::claim::Claim;
use grainbench::harness::run::{Run, Set};
use grainbench::reference::outside::Outside;
use std::sync::Arc;

/// The claims of one case that are to be judged.
pub(crate) struct Selected {
    /// The case.
    pub(crate) case: &'static Case,
    /// Its claims, in their order; never empty.
    pub(crate) claims: Vec<Claim>,
    /// The program that is put in the place of the solvers that they name.
    pub(crate) stranger: Option<Arc<Outside>>,
    /// Whether some of them were left out afterwards: of a part is drawn what its claims show alone.
    pub(crate) is_part: bool,
}

/// The claims of the cases named, of solvers and of programs by their manifests: what is judged of each.
pub(crate) fn select(cases: &[String], solvers: &[String], levels: &[String]) -> Result<Vec<Selected>, Fault> {
    let (manifests, names): (Vec<&String>, Vec<&String>) = solvers.iter().partition(|name| solver::is_manifest(name));
    let names: Vec<String> = names.into_iter().cloned().collect();
    let mut selected =
        if names.is_empty() && !manifests.is_empty() { Vec::new() } else { of_registry(cases, &names, levels)? };
    for path in manifests {
        let stranger = solver::outside(path)?;
        for mut of_case in select_fair(cases, levels)? {
            of_case.claims.retain(|claim| claim.scope.is_asked_of(&*stranger));
            selected.push(Selected { stranger: Some(Arc::clone(&stranger)), ..of_case });
        }
    }
    selected.retain(|selected| !selected.claims.is_empty());
    if selected.is_empty() {
        return Err(Fault::input(
            "expected at least one gate that is fair to any solver, found none in the cases named",
        ));
    }
    Ok(selected)
}

/// The claims of the cases that are fair to any solver.
pub(crate) fn select_fair(cases: &[String], levels: &[String]) -> Result<Vec<Selected>, Fault> {
    let mut selected = of_registry(cases, &[], levels)?;
    for of_case in &mut selected {
        of_case.claims.retain(|claim| claim.scope.is_open());
    }
    Ok(selected)
}

/// The claims of the cases (`CASE`, `CASE/VARIANT` or a folder; all of the registry when none is named) whose rows are of one
/// of the solvers and that need one of the levels, in the order of the registry.
fn of_registry(cases: &[String], solvers: &[String], levels: &[String]) -> Result<Vec<Selected>, Fault> {
    let cases = pattern::expanded(cases)?;
    let named = cases.iter().map(|name| Variant::read_with_folders(name)).collect::<Result<Vec<_>, _>>()?;
    let in_registry = |named: &&Variant<'_>| CASES.iter().any(|case| std::ptr::eq(*case, named.case));
    let folders = named.iter().filter(|named| !in_registry(named)).map(|named| named.case);
    let mut selected = Vec::new();
    for case in CASES.iter().copied().chain(folders) {
        let mine: Vec<&Variant<'_>> = named.iter().filter(|named| std::ptr::eq(named.case, case)).collect();
        if mine.is_empty() && !named.is_empty() {
            continue;
        }
        let mut claims = (case.claims)();
        if !mine.is_empty() && mine.iter().all(|named| named.variant.is_some()) {
            let wanted = |variant: &str| mine.iter().any(|named| named.variant == Some(variant));
            claims.retain(|claim| row(claim).is_some_and(|run| wanted(run.variant)));
        }
        selected.push(Selected { case, claims, stranger: None, is_part: false });
    }
    refuse_unknown_solvers(&selected, solvers)?;
    let levels = wanted_levels(&selected, levels)?;
    for Selected { case, claims, .. } in &mut selected {
        if !solvers.is_empty() {
            let wanted = |run: &Run| solvers.iter().any(|name| name == run.solver);
            // A program is asked for by rows that compare ours with it.
            let asked = |run: &Run| wanted(run) && grainbench::cases::solvers::is_program(run.solver);
            claims.retain(|claim| row(claim).is_some_and(wanted) || claim.runs.iter().any(asked));
        }
        match &levels {
            Levels::Default => claims.retain(|claim| claim.set() == Set::Main),
            Levels::All => {}
            Levels::Named(names) => claims.retain(|claim| claim.runs.iter().any(|run| is_at(case, run, names))),
        }
    }
    selected.retain(|selected| !selected.claims.is_empty());
    // A selection without a row would end green without having looked at anything.
    if selected.is_empty() {
        return Err(Fault::input(
            "expected at least one gate, found none that is of the cases, solvers and levels named",
        ));
    }
    Ok(selected)
}

/// The run that names a claim's row.
fn row(claim: &Claim) -> Option<&Run> {
    claim.runs.first()
}

fn refuse_unknown_solvers(selected: &[Selected], names: &[String]) -> Result<(), Fault> {
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

/// Which levels are wanted.
enum Levels {
    /// What the main job runs.
    Default,
    All,
    Named(Vec<String>),
}

/// The levels asked for, each one that a selected case has.
fn wanted_levels(selected: &[Selected], names: &[String]) -> Result<Levels, Fault> {
    if names.iter().any(|name| name == "all") {
        return Ok(Levels::All);
    }
    if names.is_empty() || names.iter().any(|name| name == "default") {
        return Ok(Levels::Default);
    }
    let mut known: Vec<String> = vec!["default".to_owned(), "all".to_owned()];
    for name in selected.iter().flat_map(|Selected { case, claims, .. }| levels(case, claims)) {
        push_new(&mut known, name);
    }
    let unified: Vec<String> = known.iter().map(|name| unified(name)).collect();
    for name in names {
        if !unified.contains(&self::unified(name)) {
            return Err(Fault::unknown("a level", name, known.iter().map(String::as_str)));
        }
    }
    Ok(Levels::Named(names.iter().map(|name| self::unified(name)).collect()))
}

fn is_at(case: &Case, run: &Run, levels: &[String]) -> bool {
    [level_of(case, run), run.resolution.to_string()].iter().any(|name| levels.contains(&unified(name)))
}

/// `dt=.1` and `dt=0.1` are one level.
fn unified(name: &str) -> String {
    match name.split_once('=') {
        Some((knob, value)) if value.starts_with('.') => format!("{knob}=0{value}"),
        _ => name.to_owned(),
    }
}

/// Name of the level of a run: that of the case, or the resolution in words.
pub(crate) fn level_of(case: &Case, run: &Run) -> String {
    let level = case.levels.iter().find(|level| level.resolution == run.resolution);
    level.map_or_else(|| run.resolution.to_string(), |level| level.name.to_owned())
}

/// Names of the levels of a case: its own, then what its claims have beside it.
pub(crate) fn levels(case: &Case, claims: &[Claim]) -> Vec<String> {
    let mut names: Vec<String> = case.levels.iter().map(|level| level.name.to_owned()).collect();
    for run in claims.iter().flat_map(|claim| &claim.runs) {
        push_new(&mut names, level_of(case, run));
    }
    names
}

/// Names of the variants of a case, the plain scene among them where a claim looks at it.
pub(crate) fn variants(case: &Case, claims: &[Claim]) -> Result<Vec<String>, Fault> {
    let mut names = case.variants()?;
    if claims.iter().filter_map(row).any(|run| run.variant == PLAIN) {
        push_new(&mut names, PLAIN.to_owned());
    }
    Ok(names)
}

/// Solvers that claims name their rows by, and programs that they are compared with, each once, in their order.
pub(crate) fn solvers(claims: &[Claim]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for run in claims.iter().filter_map(row) {
        push_new(&mut names, run.solver);
    }
    let programs = claims.iter().flat_map(|claim| &claim.runs);
    for run in programs.filter(|run| grainbench::cases::solvers::is_program(run.solver)) {
        push_new(&mut names, run.solver);
    }
    names
}

fn push_new<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}
