//! `grainbench cost`: measures error against computing time.

use super::campaign::arguments::{self, PlanOptions};
use super::exit::{Fault, Outcome, check_writable};
use super::keep::keep_study;
use super::progress::Progress;
use super::provenance::provenance;
use super::publish::{Output, publish_study};
use super::strangers::NamedSolvers;
use super::subject::Variant;
use grainbench::cases::registry::{self, CASES};
use grainbench::cases::solvers::Registry;
use grainbench::harness::subject::TargetQuantity;
use grainbench::reports::study::point::Point;
use grainbench::reports::study::{Study, cost as drawn, points_of, write_study};
use grainbench::studies::ProgressObserver;
use grainbench::studies::cost::against::{compare, shared};
use grainbench::studies::cost::run::{Meter, PointSelection};
use grainbench::studies::cost::{load, step};
use grainbench::studies::result_cache::ResultCache;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to measure. Default: all cases with an exact solution.
    #[arg(value_name = "CASE|CASE/VARIANT")]
    pub(crate) cases: Vec<String>,
    /// Measure only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Resolution levels. `all` includes points that take more than 20 s.
    #[arg(long, value_name = "default|all", default_value = "default", value_parser = ["default", "all"])]
    pub(crate) levels: String,
    /// Also measure the cost of the parts of a step, and of a step with one and with 10,000 grains. Without a named
    /// case, these costs are always measured.
    #[arg(long)]
    pub(crate) prices: bool,
    /// Measure finished points again.
    #[arg(long)]
    no_cache: bool,
    /// Compare with an earlier `results.json`. Counts must be equal, and times must agree within their spread.
    #[arg(long, value_name = "OLD.json", conflicts_with = "plan")]
    against: Option<PathBuf>,
    /// Store the results in the source tree, for the first screen of the report. Needs all cases and all built-in solvers.
    #[arg(long, conflicts_with_all = ["cases", "solver"])]
    update_stored: bool,
    /// Directory of the report and of the finished points.
    #[arg(long, value_name = "DIR", default_value = "grainbench-cost")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Measure only errors and operation counts, in a plan. Without timing, several tasks can run on one machine.
    #[arg(long, requires = "plan", conflicts_with = "prices")]
    counts: bool,
    #[command(flatten)]
    plan: PlanOptions,
}

impl Arguments {
    /// Returns the arguments of the plan; none without `--plan`.
    pub(crate) fn planned(&self) -> Option<arguments::Arguments> {
        let planned = self.plan.arguments("cost", &self.cases, &self.solver)?;
        let levels = if self.levels == "all" { vec![self.levels.clone()] } else { Vec::new() };
        let &Self { prices, counts, json, .. } = self;
        Some(arguments::Arguments { levels, prices, counts, json, ..planned })
    }
}

/// Number of rounds in which the cost of a step is measured.
pub(crate) const ROUNDS: u32 = 5;

/// Measures the points and writes the report, which is updated after each target quantity.
pub(crate) fn cost(arguments: &Arguments) -> Outcome {
    let subjects = subjects(&arguments.cases)?;
    let (solvers, named) = NamedSolvers::read(&arguments.solver)?;
    let old = arguments.against.as_deref().map(points_of).transpose().map_err(Fault::input)?;
    check_writable(&arguments.out)?;
    let cache = ResultCache::open(&arguments.out.join("points"), arguments.no_cache).map_err(Fault::writing)?;
    let wanted = PointSelection { solvers: named, all: arguments.levels == "all", counts: false };
    let meter = Meter::new(&cache, wanted, &solvers);
    let pieces: usize = subjects.iter().map(|subject| meter.count(subject)).sum();
    if pieces == 0 {
        return Err(Fault::input("expected at least one point, found none for the selected cases and solvers"));
    }
    let start = Instant::now();
    let prices = arguments.prices || arguments.cases.is_empty();
    let beside = if prices { step::pieces(ROUNDS) + load::laps(ROUNDS) } else { 0 };
    let mut follower = Follower::new(pieces as u64 + beside, "points");
    let mut study = Study::new(provenance(words(arguments), 0.0));
    if prices {
        study.model = Some(step::measure(&Registry, ROUNDS, &mut follower).map_err(Fault::input)?);
        study.loads = load::measure(&Registry, ROUNDS, &mut follower)?;
    }
    let mut asked = Vec::new();
    for (at, subject) in subjects.iter().enumerate() {
        let diagram = meter.diagram(subject, &mut follower).map_err(Fault::writing)?;
        if diagram.points.is_empty() {
            continue;
        }
        asked.extend(diagram.points.iter().map(|point| point.solver.clone()));
        study.sources = sources(&asked);
        study.diagrams.push(diagram);
        let mut options = words(arguments);
        if at + 1 < subjects.len() {
            options.push(format!("unfinished: {} of {} quantities", at + 1, subjects.len()));
            study.provenance = provenance(options, start.elapsed().as_secs_f64());
            write_study(&arguments.out, &study).map_err(Fault::writing)?;
        }
    }
    study.provenance = provenance(words(arguments), start.elapsed().as_secs_f64());
    if let (Some(old), Some(path)) = (&old, &arguments.against) {
        set_against(&mut study, old, path);
    }
    if arguments.update_stored {
        keep_study("cost", &study)?;
    }
    let reused = follower.end();
    let text = text(&study) + &format!("{reused} of {pieces} points are from an earlier measurement\n");
    let output = Output { text: Some(text), ..Output::new(&arguments.out, arguments.json, false) };
    publish_study(&study, output, is_red(&study))
}

/// Returns true if a study measures no error, or if a value has become worse since an earlier study.
pub(crate) fn is_red(study: &Study) -> bool {
    let measures = study.diagrams.iter().flat_map(|diagram| &diagram.points).any(|point| point.error.is_some());
    !measures || study.changes.iter().any(|change| change.worse)
}

/// Compares a study with the points of an earlier study, and names the file `path` of that study in the report.
pub(crate) fn set_against(study: &mut Study, old: &[Point], path: &Path) {
    let new: Vec<Point> = study.diagrams.iter().flat_map(|diagram| diagram.points.clone()).collect();
    study.changes = compare(old, &new);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    study.against = Some(format!("{name}, {} of {} points compared", shared(old, &new), new.len()));
}

/// Returns the target quantities of the named cases, in the order of the registry.
pub(crate) fn subjects(names: &[String]) -> Result<Vec<TargetQuantity>, Fault> {
    let named = names.iter().map(|name| Variant::read(name)).collect::<Result<Vec<_>, _>>()?;
    let mut found = Vec::new();
    for case in CASES {
        let mine: Vec<_> = named.iter().filter(|named| named.case.name == case.name).collect();
        if mine.is_empty() && !named.is_empty() {
            continue;
        }
        let wanted = |variant: &str| {
            mine.is_empty() || mine.iter().any(|named| named.variant.is_none_or(|name| name == variant))
        };
        found.extend(registry::subjects(case).into_iter().filter(|subject| wanted(subject.variant)));
    }
    if found.is_empty() {
        return Err(Fault::input(
            "expected a case with an exact solution for a single run, found none in the selection",
        ));
    }
    Ok(found)
}

/// Returns the command, the cases and the options that differ from the default, in words.
pub(crate) fn words(arguments: &Arguments) -> Vec<String> {
    let mut words = vec!["cost".to_owned()];
    words.extend(arguments.cases.iter().cloned());
    words.extend(arguments.solver.iter().map(|solver| format!("--solver {solver}")));
    if arguments.levels != "default" {
        words.push(format!("--levels {}", arguments.levels));
    }
    words
}

/// Returns hashes of the solvers' sources, by solver name.
pub(crate) fn sources(names: &[String]) -> BTreeMap<String, String> {
    names.iter().filter_map(|name| Some((name.clone(), grainbench::kept::sources(name)?))).collect()
}

/// Returns the summary of a cost study as text: one line per target quantity and error target, followed by the changes
/// since an earlier study.
pub(crate) fn text(study: &Study) -> String {
    let mut text = String::new();
    for diagram in &study.diagrams {
        text.push_str(&format!("{}/{} · {}\n", diagram.case, diagram.variant, diagram.quantity));
        for target in drawn::TARGETS {
            text.push_str(&format!("  {}\n", drawn::sentence(diagram, target)));
        }
    }
    if let Some(old) = &study.against {
        text.push_str(&format!("against {old}: "));
        if study.changes.is_empty() {
            text.push_str("all counts are equal, and no time differs by more than noise\n");
        } else {
            text.push('\n');
        }
        for change in &study.changes {
            text.push_str(&format!("  {}: {}\n", change.what, change.how));
        }
    }
    text
}

/// Progress display of a study, which counts reused results.
pub(crate) struct Follower {
    progress: Option<Progress>,
    reused: u64,
}

impl Follower {
    pub(crate) fn new(pieces: u64, what: &str) -> Self {
        Self { progress: Some(Progress::new(pieces, what)), reused: 0 }
    }

    /// Creates a progress display that prints nothing.
    pub(crate) const fn none() -> Self {
        Self { progress: None, reused: 0 }
    }

    /// Removes the progress bar, and returns the number of reused results.
    pub(crate) fn end(&mut self) -> u64 {
        self.progress = None;
        self.reused
    }
}

impl ProgressObserver for Follower {
    fn now(&mut self, piece: &str) {
        if let Some(progress) = &self.progress {
            progress.now(piece);
        }
    }

    fn done(&mut self, reused: bool) {
        self.reused += u64::from(reused);
        if let Some(progress) = &self.progress {
            progress.advance();
        }
    }
}
