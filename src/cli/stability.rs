//! `grainbench stability`: finds the largest stable time steps and runs hard cases.

use super::campaign::arguments::{self, PlanOptions};
use super::cost::{Follower, sources};
use super::exit::{Fault, Outcome, check_writable};
use super::keep::keep_study;
use super::provenance::provenance;
use super::publish::{Output, publish_study};
use super::strangers::NamedSolvers;
use grainbench::cases::registry;
use grainbench::harness::case::PLAIN;
use grainbench::harness::solvers::Solvers;
use grainbench::reports::number;
use grainbench::reports::study::stability::{HardCaseResult, Hardness, Limit};
use grainbench::reports::study::{Study, write_study};
use grainbench::studies::result_cache::ResultCache;
use grainbench::studies::stability::assembly::{self, Assembly};
use grainbench::studies::stability::hard::{self, HardCase};
use grainbench::studies::stability::limit;
use grainbench::studies::{ProgressObserver, identity};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Case in which the stability limit of grid methods is measured.
const BAR: &str = "vibrating-bar";
/// Numbers of cells along the bar, from coarse to fine.
const BAR_CELLS: [f64; 3] = [25.0, 50.0, 100.0];
/// Shortest time between two updates of the report.
const EVERY: Duration = Duration::from_secs(5);

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Names, or beginnings of names, of hard cases and of assemblies with a known stability limit. Default: all.
    #[arg(value_name = "CASE")]
    pub(crate) cases: Vec<String>,
    /// Test only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Repeat the finished parts of the study.
    #[arg(long)]
    no_cache: bool,
    /// Store the results in the source tree, for the first screen of the report. Needs all cases and all built-in solvers.
    #[arg(long, conflicts_with_all = ["cases", "solver"])]
    update_stored: bool,
    /// Directory of the report and of the finished parts.
    #[arg(long, value_name = "DIR", default_value = "grainbench-stability")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON instead of text.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plan: PlanOptions,
}

impl Arguments {
    /// Returns the arguments of the plan; none without `--plan`.
    pub(crate) fn planned(&self) -> Option<arguments::Arguments> {
        let planned = self.plan.arguments("stability", &self.cases, &self.solver)?;
        Some(arguments::Arguments { json: self.json, ..planned })
    }
}

/// Work item of the study: a stability limit or a hard case, with its solver.
pub(crate) enum WorkItem<'a> {
    Assembly(&'a Assembly, &'a str),
    Bar(&'static str, f64),
    Hard(&'a HardCase, &'a str),
}

/// Finds the stability limits, runs the hard cases and writes the report, which is updated at intervals of [`EVERY`].
pub(crate) fn stability(arguments: &Arguments) -> Outcome {
    let assemblies = assembly::all()?;
    let hard = hard::all();
    let (solvers, named) = NamedSolvers::read(&arguments.solver)?;
    let strangers = solvers.names();
    let pieces = select(&arguments.cases, [&named, &strangers], &assemblies, &hard)?;
    check_writable(&arguments.out)?;
    let cache = ResultCache::open(&arguments.out.join("pieces"), arguments.no_cache).map_err(Fault::writing)?;
    let program = identity::of_this_program();
    let start = Instant::now();
    let mut written = start;
    let mut follower = Follower::new(pieces.len() as u64, "limits and cases");
    let words = words(arguments);
    let mut study = Study::new(provenance(words.clone(), 0.0));
    for (at, piece) in pieces.iter().enumerate() {
        let reused = do_piece(piece, (&program, &solvers), &cache, &mut study, &mut follower)?;
        follower.done(reused);
        let last = at + 1 == pieces.len();
        if last || written.elapsed() > EVERY {
            let mut options = words.clone();
            if !last {
                options.push(format!("unfinished: {} of {} limits and cases", at + 1, pieces.len()));
            }
            study.provenance = provenance(options, start.elapsed().as_secs_f64());
            study.sources = sources_of(&study);
            write_study(&arguments.out, &study).map_err(Fault::writing)?;
            written = Instant::now();
        }
    }
    if arguments.update_stored {
        keep_study("stability", &study)?;
    }
    let reused = follower.end();
    let text = text(&study) + &format!("{reused} of {} were done before\n", pieces.len());
    let output = Output { text: Some(text), ..Output::new(&arguments.out, arguments.json, false) };
    publish_study(&study, output, is_red(&study))
}

/// Returns true if no stability limit was found and no hard case was solved.
fn measures_nothing(study: &Study) -> bool {
    let holds = |row: &HardCaseResult| matches!(row.standing, Hardness::Holds | Hardness::HoldsAtASmallerStep);
    study.limits.iter().all(|row| row.found.is_none()) && !study.hard.iter().any(holds)
}

/// Returns the command, the cases and the options that differ from the default, in words.
pub(crate) fn words(arguments: &Arguments) -> Vec<String> {
    let mut words = vec!["stability".to_owned()];
    words.extend(arguments.cases.iter().cloned());
    words.extend(arguments.solver.iter().map(|solver| format!("--solver {solver}")));
    words
}

/// Returns the hashes of the sources of all solvers in the study, by solver name.
pub(crate) fn sources_of(study: &Study) -> BTreeMap<String, String> {
    let limits = study.limits.iter().map(|row| row.solver.clone());
    let asked: Vec<String> = limits.chain(study.hard.iter().map(|row| row.solver.clone())).collect();
    sources(&asked)
}

/// Returns true if nothing was measured, or if a solver ends without an error and with a wrong result. LAMMPS, LIGGGHTS
/// and `rigid` are exempt, because their errors are documented.
pub(crate) fn is_red(study: &Study) -> bool {
    let red = |solver: &str| !grainbench::cases::solvers::is_program(solver) && solver != "rigid";
    measures_nothing(study) || study.hard.iter().any(|row| row.standing == Hardness::QuietlyWrong && red(&row.solver))
}

pub(crate) fn do_piece(
    piece: &WorkItem<'_>,
    (program, solvers): (&str, &NamedSolvers),
    cache: &ResultCache,
    study: &mut Study,
    follower: &mut Follower,
) -> Result<bool, Fault> {
    match *piece {
        WorkItem::Assembly(assembly, solver) => {
            follower.now(&format!("{} · {solver}", assembly.name));
            let asked = limit::of_assembly(
                &(program.to_owned() + &solvers.edition(solver)),
                assembly,
                (solvers, solver),
                cache,
            );
            let (limit, reused) = asked.map_err(Fault::writing)?;
            study.limits.push(limit);
            Ok(reused)
        }
        WorkItem::Bar(setting, cells) => {
            follower.now(&format!("{BAR} · {setting}"));
            let bar = registry::by_name(BAR).ok_or_else(|| Fault::input("expected the case of a vibrating bar"))?;
            let scene = bar.variant(PLAIN)?;
            let asked = limit::of_bar(program, &scene, (solvers, setting), cells, cache);
            let (limit, reused) = asked.map_err(Fault::writing)?;
            study.limits.push(limit);
            Ok(reused)
        }
        WorkItem::Hard(case, solver) => {
            follower.now(&format!("{} · {solver}", case.name));
            let asked = hard::verdict(&(program.to_owned() + &solvers.edition(solver)), case, (solvers, solver), cache);
            let (row, reused) = asked.map_err(Fault::writing)?;
            study.hard.push(row);
            Ok(reused)
        }
    }
}

/// Returns the selected work items. `cases` contains beginnings of the names of assemblies (with `-` for spaces), of
/// the bar and of hard cases. `solvers` contains the selected names, and `strangers` the names of the external solvers.
pub(crate) fn select<'a>(
    cases: &[String],
    [solvers, strangers]: [&'a [String]; 2],
    assemblies: &'a [Assembly],
    hard: &'a [HardCase],
) -> Result<Vec<WorkItem<'a>>, Fault> {
    let named = |name: &str| name.replace(' ', "-");
    let mut known: Vec<String> = assemblies.iter().map(|assembly| named(assembly.name)).collect();
    known.push(BAR.to_owned());
    known.extend(hard.iter().map(|case| case.name.clone()));
    if let Some(name) = cases.iter().find(|name| name.is_empty() || !known.iter().any(|known| known.starts_with(*name)))
    {
        return Err(Fault::unknown("an assembly or a hard case", name, known.iter().map(String::as_str)));
    }
    let case = |name: &str| cases.is_empty() || cases.iter().any(|wanted| name.starts_with(wanted));
    let solver = |name: &str| solvers.is_empty() || solvers.iter().any(|wanted| wanted == name);
    let theirs = || strangers.iter().map(String::as_str);
    let mut pieces = Vec::new();
    for assembly in assemblies.iter().filter(|assembly| case(&named(assembly.name))) {
        let asked = limit::SPRINGS.into_iter().filter(|name| solver(name)).chain(theirs());
        pieces.extend(asked.map(|name| WorkItem::Assembly(assembly, name)));
    }
    for setting in limit::GRIDS.into_iter().filter(|name| case(BAR) && solver(name)) {
        pieces.extend(BAR_CELLS.map(|cells| WorkItem::Bar(setting, cells)));
    }
    for hard in hard.iter().filter(|hard| case(&hard.name)) {
        let asked = hard.asked.iter().copied().filter(|name| solver(name)).chain(theirs());
        pieces.extend(asked.map(|name| WorkItem::Hard(hard, name)));
    }
    if pieces.is_empty() {
        return Err(Fault::input("expected at least one case for the selected solvers, found none"));
    }
    Ok(pieces)
}

pub(crate) fn text(study: &Study) -> String {
    let mut text = String::new();
    for Limit { scene, at, solver, unit, found, exact, error, detail, .. } in &study.limits {
        let number = |value: &Option<f64>| value.map_or("—".to_owned(), |value| number::significant(value, 4));
        let at = at.map_or(String::new(), |at| format!(" {}", number::significant(at, 3)));
        let exact = exact.map_or(String::new(), |_| format!(", exact {} ({})", number(exact), number::error(*error)));
        text.push_str(&format!(
            "{:<32} {solver:<22} {} {unit}{exact}; above: {detail}\n",
            format!("{scene}{at}"),
            number(found)
        ));
    }
    for row in &study.hard {
        let detail = if row.detail.is_empty() { String::new() } else { format!(": {}", row.detail) };
        text.push_str(&format!(
            "{:<32} {:<14} {} [{}]{detail}\n",
            row.case,
            row.solver,
            row.standing.word(),
            row.resolution
        ));
    }
    text
}
