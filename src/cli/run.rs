//! `grainbench run`: evaluates the claims of cases and writes the report.

use super::cache;
use super::campaign;
use super::campaign::plan::PlanOptions;
use super::campaign::work::WorkOptions;
use super::conform;
use super::cores::{MOST_THREADS, at_once, share};
use super::earlier::EarlierReport;
use super::exit::{self, Fault, Outcome, RED, check_writable, print};
use super::filter::Filters;
use super::github;
use super::interrupt::Interrupt;
use super::keep::{self, keep};
use super::progress::Progress;
use super::provenance::provenance;
use super::select::{self, CaseSelection};
use super::value::whole;
use grainbench::harness::claim::Claim;
use grainbench::harness::course;
use grainbench::harness::data::{Data, SceneDataError};
use grainbench::harness::figure::Figure;
use grainbench::harness::mistake;
use grainbench::harness::run::{FinishedRun, Run, Set};
use grainbench::harness::runner::Runner;
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict::{self, Control, Severity, Verdict};
use grainbench::reference::has_ended_programs;
use grainbench::reference::outside::ExternalProgram;
use grainbench::reports::judged::ExternalResults;
use grainbench::reports::measured::Measurements;
use grainbench::reports::results::results_json;
use grainbench::reports::terminal::failing_lines;
use grainbench::reports::{
    Headline, Provenance, Report, RunCost, Section, line, summary_table, write_report, write_report_and_parquet,
};
use grainbench::scene::solver::RunError;
use grainbench::studies::run_cache::RunCache;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases, patterns such as 'incline-*' or '*/60deg*', or folders with `scene.toml` and `claims.toml`; all built-in cases by
    /// default.
    #[arg(value_name = "CASE|CASE/VARIANT|FOLDER")]
    pub(crate) cases: Vec<String>,
    #[command(flatten)]
    pub(crate) options: Options,
    #[command(flatten)]
    plan: PlanOptions,
    /// Do the unfinished tasks of a plan.
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["plan", "cases", "solver", "levels", "filter", "live", "no_controls", "json", "out", "no_cache"]
    )]
    resume: Option<PathBuf>,
    #[command(flatten)]
    work: WorkOptions,
}

/// Options of a run.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Select the claims of this solver; repeatable. A manifest runs the solver-independent claims with this program.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Select resolution levels: `default`, `all`, or names such as `dt=.1`.
    #[arg(long, value_name = "default|all|NAME,…", value_delimiter = ',')]
    pub(crate) levels: Vec<String>,
    /// Select rows by quantity, source (substring or pattern), evidence or outcome; filters of one key are alternatives. A filter
    /// by outcome still runs all claims, and all of them determine the exit code.
    #[arg(long, value_name = "quantity=…|source=…|evidence=…|outcome=…")]
    pub(crate) filter: Vec<String>,
    /// Repeat only the failed claims and controls of the report in `--out`, and the omitted parts of an interrupted
    /// run; with `--resume`, the failed tasks of the plan.
    #[arg(long, conflicts_with_all = ["update_stored", "plan"])]
    retry_failed: bool,
    /// Print the rows and controls whose outcome differs from this earlier report.
    #[arg(long, value_name = "DIR|results.json", conflicts_with_all = ["plan", "resume"])]
    against: Option<PathBuf>,
    /// Directory for the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// Write `rows.parquet` in addition to `rows.csv`.
    #[arg(long, conflicts_with_all = ["plan", "resume"])]
    parquet: bool,
    /// Run `lammps` and `liggghts` even if a stored run exists.
    #[arg(long)]
    pub(crate) live: bool,
    /// Directory with your copy of third-party data, as for `reference import`; without it the claims that need the data are
    /// `not-available`.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["plan", "resume"])]
    pub(crate) data: Option<PathBuf>,
    /// Treat amber results as red, including programs that are not installed.
    #[arg(long, conflicts_with_all = ["plan", "resume"])]
    pub(crate) strict: bool,
    /// Ignore the cache of finished runs.
    #[arg(long)]
    no_cache: bool,
    /// Skip the negative controls.
    #[arg(long)]
    pub(crate) no_controls: bool,
    /// Store the results of an external solver in `judged.json` next to its manifest; needs all cases and all controls.
    #[arg(long, requires = "solver", conflicts_with = "no_controls")]
    update_stored: bool,
    /// Expect the outcomes stored next to the manifest: only a different outcome is red.
    #[arg(long, requires = "solver", conflicts_with_all = ["no_controls", "update_stored", "plan"])]
    expect_stored: bool,
    /// Threads of each run; the results have the same bits for any number.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = whole(1, MOST_THREADS),
        conflicts_with_all = ["plan", "resume"]
    )]
    threads: u16,
    /// Number of simultaneous runs or tasks; as many as the cores allow by default, and one if a plan measures times.
    #[arg(short, long, value_name = "N", value_parser = whole(1, MOST_THREADS), conflicts_with_all = ["plan", "on"])]
    jobs: Option<u16>,
    /// Print only the counts and the failed rows.
    #[arg(short, long, conflicts_with_all = ["verbose", "plan", "resume"])]
    quiet: bool,
    /// Print each row to standard error as soon as it is judged.
    #[arg(short, long, conflicts_with_all = ["plan", "resume"])]
    verbose: bool,
}

/// Runs the cases, plans their runs, or does the tasks of a plan.
pub(crate) fn command(arguments: &Arguments) -> Outcome {
    let Arguments { cases, options, plan, resume, work } = arguments;
    if let Some(plan) = resume {
        return campaign::work::work(plan, work, options.jobs, options.retry_failed);
    }
    work.refuse_without_plan()?;
    match plan.arguments("run", cases, &options.solver) {
        Some(planned) => campaign::plan::plan(&campaign::plan::Arguments {
            levels: options.levels.clone(),
            filter: options.filter.clone(),
            no_controls: options.no_controls,
            live: options.live,
            json: options.json,
            ..planned
        }),
        None => run(cases, options),
    }
}

/// Runs the named cases; all cases if none is named.
fn run(cases: &[String], options: &Options) -> Outcome {
    let filters = Filters::read(&options.filter)?;
    // Without names, the cases of the earlier run are repeated.
    let before = if options.retry_failed { Some(EarlierReport::read("--retry-failed", &options.out)?) } else { None };
    let of_before = before.as_ref().map(EarlierReport::cases).unwrap_or_default();
    let cases = if cases.is_empty() { &of_before[..] } else { cases };
    let earlier = options.against.as_deref().map(|path| EarlierReport::read("--against", path)).transpose()?;
    let mut selected = select::select(cases, &options.solver, &options.levels)?;
    narrow(&mut selected, options, &filters)?;
    if let Some(folder) = &options.data {
        refuse_without_use(&selected, folder)?;
    }
    check_writable(&options.out)?;
    let kept = if options.expect_stored { Some(keep::read(keep::program(&selected)?)?) } else { None };
    if let Some(part) = cases.iter().chain(&options.filter).next().filter(|_| options.update_stored) {
        return Err(Fault::input(format!("--update-stored: expected all cases, found `{part}` named")));
    }
    let keeping = if options.update_stored { Some(keep::program(&selected)?) } else { None };
    let start = Instant::now();
    let thorough = options.levels.iter().any(|level| level == "all");
    let interrupt = Interrupt::listen();
    let cache = cache::open(options.no_cache);
    let (mut sections, left) = judge(&selected, options, thorough, cache.as_ref(), &interrupt);
    // Conformance belongs to the whole registry, and not to a single case.
    let is_whole = cases.is_empty() && options.filter.is_empty() && !options.retry_failed;
    if is_whole && (options.levels.is_empty() || thorough) && left == 0 {
        sections.extend(conform::section(&options.solver, cache.as_ref())?);
    }
    let mut words = words(cases, options);
    if left > 0 {
        let kept = if cache.is_some() { ", and the next run continues with the finished runs" } else { "" };
        let what = format!("interrupted: {left} checks were omitted; the report contains the finished checks{kept}");
        exit::say("warning", &what);
        words.push(interrupted(left));
    }
    if let Some(cache) = &cache {
        cache.make_room();
        words.extend(cache::words(cache));
    }
    let provenance = provenance(words, start.elapsed().as_secs_f64());
    let mut report = report(provenance, sections, is_whole && options.solver.is_empty())?;
    if let Some(program) = keeping {
        if left > 0 {
            return Err(Fault::input(format!("--update-stored: expected a whole run, found {left} checks left out")));
        }
        keep(program, &report)?;
    }
    let is_mute = selected.iter().any(|selection| selection.stranger.is_some()) && says_nothing(&report);
    if left > 0 {
        report.red_because.push(interrupted(left));
    }
    add_reasons(&mut report, is_mute, options.strict && !options.expect_stored);
    let otherwise = match &kept {
        Some(kept) => otherwise_than_kept(keep::program(&selected)?, kept, &report),
        None => Vec::new(),
    };
    report.red_because.extend(otherwise.iter().map(|line| format!("otherwise than kept: {line}")));
    report.shown = filters.outcomes();
    let write = if options.parquet { write_report_and_parquet } else { write_report };
    write(&options.out, &report).map_err(Fault::writing)?;
    if options.json {
        print(&results_json(&report).map_err(Fault::input)?)?;
    } else {
        print(&summary(&report, options))?;
    }
    github::tell(&report, options.json)?;
    if let Some(earlier) = &earlier {
        let changes = earlier.changes(&report, is_whole);
        let none = ["nothing: every result and every control has the same outcome and value".to_owned()];
        let lines = if changes.is_empty() { &none[..] } else { &changes[..] };
        lines.iter().for_each(|line| exit::say("changed", line));
    }
    if kept.is_some() {
        otherwise.iter().for_each(|line| exit::say("otherwise than kept", line));
        return Ok(if report.red_because.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(RED) });
    }
    Ok(exit_code(&report, options.strict))
}

/// Returns the reason why an interrupted run is red. [`EarlierReport`] reads it.
fn interrupted(left: usize) -> String {
    format!("interrupted: {left} checks left out")
}

/// Returns the differences from the stored results of an external solver.
fn otherwise_than_kept(program: &ExternalProgram, kept: &ExternalResults, report: &Report) -> Vec<String> {
    let mut otherwise = keep::other_program(program, kept);
    otherwise.extend(kept.otherwise(report));
    otherwise
}

/// Adds the reasons why a run is red although no result is: nothing was judged, or amber results count as red.
pub(crate) fn add_reasons(report: &mut Report, is_mute: bool, strict: bool) {
    if is_mute {
        report.red_because.push("nothing judged: no result describes its quantity".to_owned());
    }
    let amber = Headline::of_report(report).amber();
    if strict && amber > 0 {
        report.red_because.push(format!("strict: {amber} amber"));
    }
}

/// Rejects a data directory if no claim uses it, if it contains none of the needed data, or if the data is damaged.
fn refuse_without_use(selected: &[CaseSelection], folder: &Path) -> Result<(), Fault> {
    let runs = selected.iter().flat_map(|selection| &selection.claims).flat_map(|claim| &claim.runs);
    let mut needed: Vec<&Data> = runs.filter_map(|run| run.data).collect();
    needed.sort_by_key(|data| data.name);
    needed.dedup_by_key(|data| data.name);
    if needed.is_empty() {
        return Err(Fault::input(
            "--data: expected claims that start from third-party data, found none in the selection",
        ));
    }
    let not_made: Vec<SceneDataError> = needed.iter().filter_map(|data| (data.scene)(folder).err()).collect();
    let is_wrong = |reason: &SceneDataError| matches!(reason, SceneDataError::Wrong(_));
    let any_is_wrong = not_made.iter().any(is_wrong);
    if any_is_wrong || not_made.len() == needed.len() {
        let reasons =
            not_made.into_iter().filter(|reason| !any_is_wrong || is_wrong(reason)).map(SceneDataError::into_words);
        return Err(Fault::input(format!("--data: {}", reasons.collect::<Vec<_>>().join("; "))));
    }
    Ok(())
}

/// Returns a report. If it covers the whole registry, it includes the stored results of external solvers and stored
/// measurements.
pub(crate) fn report(provenance: Provenance, sections: Vec<Section>, is_whole: bool) -> Result<Report, Fault> {
    let (judged, measured) = if is_whole {
        (grainbench::peers::kept().map_err(Fault::input)?, grainbench::kept::measured().map_err(Fault::input)?)
    } else {
        (Vec::new(), Measurements::default())
    };
    Ok(Report { provenance, sections, judged, shown: Vec::new(), measured, red_because: Vec::new() })
}

/// Removes claims that the filters exclude. With `--retry-failed`, it also removes claims that were not red in the
/// report in `--out`.
pub(crate) fn narrow(selected: &mut Vec<CaseSelection>, options: &Options, filters: &Filters) -> Result<(), Fault> {
    let before = if options.retry_failed { Some(EarlierReport::read("--retry-failed", &options.out)?) } else { None };
    for of_case in &mut *selected {
        let case = of_case.case.name;
        let stranger = of_case.stranger.as_ref().map(|stranger| stranger.manifest().name.as_str());
        let solver =
            |claim: &Claim| stranger.or(claim.runs.first().map(|run| run.solver)).unwrap_or_default().to_owned();
        let controls = !options.no_controls;
        let is_meant = |claim: &Claim| {
            let repeats = |before: &EarlierReport| {
                let solver = solver(claim);
                before.was_red(case, &solver, claim) || before.was_left_out(case, &solver, claim, controls)
            };
            before.as_ref().is_none_or(repeats)
        };
        let asked = of_case.claims.len();
        of_case.claims.retain(|claim| filters.means(claim) && is_meant(claim));
        of_case.is_part = of_case.claims.len() < asked;
    }
    selected.retain(|of_case| !of_case.claims.is_empty());
    if selected.is_empty() {
        let what = if options.retry_failed { "that failed there" } else { "that the filters mean" };
        return Err(Fault::input(format!("expected at least one claim {what}, found none")));
    }
    Ok(())
}

/// Returns the printed text of a report.
fn summary(report: &Report, options: &Options) -> String {
    let page = options.out.join("index.html");
    if !options.quiet {
        return format!("{}\n{}\n", summary_table(report), page.display());
    }
    let failing: String = failing_lines(report).into_iter().map(|line| line + "\n").collect();
    format!("{failing}{}\n", Headline::of_report(report).sentence())
}

/// Returns success, or red if a result is red, a control stayed green, nothing was evaluated, or the report states
/// another reason. With `strict`, amber results are red too.
pub(crate) fn exit_code(report: &Report, strict: bool) -> ExitCode {
    let least = if strict { Severity::Amber } else { Severity::Red };
    let red_row = |verdict: &Verdict| verdict.outcome.severity() >= least;
    let rows = || report.sections.iter().flat_map(|section| &section.verdicts);
    let mut controls = report.sections.iter().flat_map(|section| &section.controls);
    let is_red = !report.red_because.is_empty()
        || rows().any(red_row)
        || !rows().any(is_judged)
        || controls.any(|control| !control.turned_red);
    if is_red { ExitCode::from(RED) } else { ExitCode::SUCCESS }
}

/// Returns true if a result describes its quantity. An unsupported scene counts, and a missing solver does not.
pub(crate) const fn is_judged(verdict: &Verdict) -> bool {
    use verdict::Outcome::{Broken, Fail, Known, Outdated, Pass, Unsupported};
    matches!(verdict.outcome, Pass | Fail | Known | Outdated | Unsupported | Broken)
}

/// Returns true if no result describes its quantity. Here, an unsupported scene does not count.
pub(crate) fn says_nothing(report: &Report) -> bool {
    let mut rows = report.sections.iter().flat_map(|section| &section.verdicts);
    rows.all(|row| row.outcome == verdict::Outcome::Unsupported || !is_judged(row))
}

/// Returns the options that differ from the default, in words.
pub(crate) fn words(cases: &[String], options: &Options) -> Vec<String> {
    let mut words = cases.to_vec();
    words.extend(options.solver.iter().map(|solver| format!("--solver {solver}")));
    if !options.levels.is_empty() {
        words.push(format!("--levels {}", options.levels.join(",")));
    }
    if options.live {
        words.push("--live".to_owned());
    }
    if options.no_controls {
        words.push("--no-controls".to_owned());
    }
    if options.data.is_some() {
        words.push("--data".to_owned());
    }
    words.extend(options.filter.iter().map(|filter| format!("--filter {filter}")));
    if options.retry_failed {
        words.push("--retry-failed".to_owned());
    }
    words
}

/// Work on one case. Each result has its own place, so the order of completion does not matter.
struct Work<'a> {
    selected: &'a CaseSelection,
    solvers: Arc<dyn Solvers>,
    runner: Runner,
    verdicts: Vec<OnceLock<Verdict>>,
    controls: Vec<OnceLock<Control>>,
    figures: OnceLock<Result<Vec<Figure>, RunError>>,
}

/// Work item, with indices of the case and of the claim within the case.
enum Task {
    Judge(usize, usize),
    Control(usize, usize),
    Draw(usize),
}

/// Returns the sections of the finished checks, and the number of checks that an interrupt left out.
fn judge(
    selected: &[CaseSelection],
    options: &Options,
    thorough: bool,
    cache: Option<&Arc<RunCache>>,
    interrupt: &Interrupt,
) -> (Vec<Section>, usize) {
    let solvers = cache::solvers(cache);
    let new = |selected| Work::new(selected, options, thorough, Arc::clone(&solvers));
    let work: Vec<Work<'_>> = selected.iter().map(new).collect();
    let tasks = tasks(selected, !options.no_controls);
    let progress = Progress::new(tasks.len() as u64, "checks");
    let jobs = options.jobs.map_or_else(|| at_once(usize::from(options.threads)), usize::from);
    let cut = AtomicUsize::new(0);
    let do_piece = |piece: usize| {
        if !do_task(&work, &tasks[piece], &progress, options.verbose) {
            cut.fetch_add(1, Ordering::Relaxed);
        }
    };
    let left = share(tasks.len(), jobs, || !interrupt.is_asked(), do_piece) + cut.load(Ordering::Relaxed);
    drop(progress);
    (work.into_iter().map(Work::section).collect(), left)
}

/// Returns the work items in order. Claims that need a new run come before claims that only need earlier runs. All
/// cases progress evenly, so two threads are seldom at one case, where they would wait for the same scene or run.
/// Figures come last, because they use finished runs.
fn tasks(selected: &[CaseSelection], with_controls: bool) -> Vec<Task> {
    let mut tasks = Vec::new();
    for (case, selected) in selected.iter().enumerate() {
        let share = 1.0 / selected.claims.len() as f64;
        let mut asked = HashSet::new();
        for (gate, claim) in selected.claims.iter().enumerate() {
            let known = asked.len();
            asked.extend(claim.runs.iter().map(Run::key));
            let is_new = asked.len() > known;
            let turn = gate as f64 * share;
            tasks.push((if is_new { turn } else { 1.0 + turn }, Task::Judge(case, gate)));
            if with_controls {
                tasks.push((1.0 + turn + 0.5 * share, Task::Control(case, gate)));
            }
        }
    }
    tasks.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let figures = (0..selected.len()).map(Task::Draw);
    tasks.into_iter().map(|(_, task)| task).chain(figures).collect()
}

/// Does a work item. Returns false if an interrupt ended a run that the item needs; it then has no result.
fn do_task(work: &[Work<'_>], task: &Task, progress: &Progress, verbose: bool) -> bool {
    let (Task::Judge(case, _) | Task::Control(case, _) | Task::Draw(case)) = *task;
    let at = &work[case];
    progress.now(at.selected.case.name);
    match *task {
        Task::Judge(_, gate) => {
            let row = at.runner.judge(&at.selected.claims[gate]);
            if has_ended_programs() && matches!(row.outcome, verdict::Outcome::Broken | verdict::Outcome::NotAvailable)
            {
                return false;
            }
            let row = at.verdicts[gate].get_or_init(|| row);
            if verbose {
                progress.tell(&format!("{}: {}", row.outcome.word(), line::verdict(row)));
            }
        }
        Task::Control(_, gate) => {
            let gate_of = &at.selected.claims[gate];
            let row = at.verdicts[gate].get().cloned().unwrap_or_else(|| at.runner.judge(gate_of));
            if at.runner.tries_control(gate_of, &row) {
                let control = at.runner.control(gate_of);
                // A run that ends with an error would count as a control that turned red.
                if has_ended_programs() {
                    return false;
                }
                at.controls[gate].get_or_init(|| control);
            }
        }
        Task::Draw(_) => {
            let figures = draw(at.selected, &at.runner);
            if has_ended_programs() && figures.is_err() {
                return false;
            }
            at.figures.get_or_init(|| figures);
        }
    }
    progress.advance();
    true
}

impl<'a> Work<'a> {
    fn new(selected: &'a CaseSelection, options: &Options, thorough: bool, solvers: Arc<dyn Solvers>) -> Self {
        Self {
            selected,
            solvers: Arc::clone(&solvers),
            runner: runner(selected, options, thorough, solvers),
            verdicts: selected.claims.iter().map(|_| OnceLock::new()).collect(),
            controls: selected.claims.iter().map(|_| OnceLock::new()).collect(),
            figures: OnceLock::new(),
        }
    }

    fn section(self) -> Section {
        let figures = match self.figures.into_inner() {
            Some(Ok(figures)) => figures,
            Some(Err(error)) => {
                let case = self.selected.case.name;
                exit::say("warning", &format!("{case}: its figures are omitted: {error}"));
                Vec::new()
            }
            None => Vec::new(),
        };
        let mut verdicts: Vec<Option<Verdict>> = self.verdicts.into_iter().map(OnceLock::into_inner).collect();
        mistake::explain(self.selected.case, &self.solvers, &self.selected.claims, &mut verdicts);
        Section {
            figures,
            verdicts: verdicts.into_iter().flatten().collect(),
            controls: self.controls.into_iter().filter_map(OnceLock::into_inner).collect(),
            runs: self.runner.done().iter().map(|(run, done)| cost(run, done)).collect(),
            ..blank(self.selected)
        }
    }
}

/// Returns the runner of a selected case.
pub(crate) fn runner(selected: &CaseSelection, options: &Options, thorough: bool, solvers: Arc<dyn Solvers>) -> Runner {
    let runner = Runner::new(selected.case, solvers).live(options.live).thorough(thorough);
    let runner = runner.controlled(!options.no_controls).with_data(options.data.as_deref());
    // With all levels, runs with stored results are repeated too.
    let runner = if thorough { runner.afresh(Set::Paper) } else { runner };
    let runner = match &selected.stranger {
        Some(stranger) => runner.with_solver(Arc::<ExternalProgram>::clone(stranger)),
        None => runner,
    };
    runner.threads(usize::from(options.threads))
}

/// Draws the figures of a case for the selected claims.
///
/// # Errors
/// When a run of a figure fails.
pub(crate) fn draw(selected: &CaseSelection, runner: &Runner) -> Result<Vec<Figure>, RunError> {
    if selected.stranger.is_some() || selected.is_part {
        // The case's own figures may need runs that none of these claims uses.
        return course::figures(runner, &selected.claims);
    }
    course::of_case(selected.case, runner, &selected.claims)
}

/// Returns the section of a case without results.
pub(crate) fn blank(selected: &CaseSelection) -> Section {
    let case = selected.case;
    Section {
        name: case.name.to_owned(),
        title: match &selected.stranger {
            Some(stranger) => format!("{}: {}", case.title, stranger.manifest().name),
            None => case.title.to_owned(),
        },
        claim: case.claim.to_owned(),
        derivation: case.derivation.to_owned(),
        weak: case.weakness.to_owned(),
        figures: Vec::new(),
        verdicts: Vec::new(),
        controls: Vec::new(),
        runs: Vec::new(),
    }
}

/// Returns the cost of a run.
pub(crate) fn cost(run: &Run, done: &FinishedRun) -> RunCost {
    let (provenance, cost) = (&done.record.provenance, &done.record.cost);
    RunCost {
        variant: run.scene_words(),
        solver: provenance.solver.clone(),
        resolution: run.resolution.to_string(),
        steps: cost.steps,
        particle_steps: cost.particle_steps,
        contact_evaluations: cost.contact_evaluations,
        wall_seconds: cost.wall_seconds,
        time_step: provenance.time_step,
        fraction_of_critical: provenance.critical_time_step.map(|critical| provenance.time_step / critical),
    }
}
