//! `grainbench simulate`: simulates a scene with one solver and writes the record.

use super::checkpoint::{self, refuse_others};
use super::cores::{MOST_THREADS, cores};
use super::exit::{Fault, Outcome, RECORD, check_output, print, print_json, refuse};
use super::interrupt::Interrupt;
use super::jobs;
use super::jobs::collect::{CollectOptions, collect};
use super::jobs::work::WorkOptions;
use super::progress::Progress;
use super::solver;
use super::value::{Step, path_and_value, positive, whole};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use grainbench::cases::registry::read_grains;
use grainbench::dem::stability::stable_fraction;
use grainbench::jobs::shard;
use grainbench::jobs::sweep::Sweep;
use grainbench::reports::export::{self, SnapshotFormat};
use grainbench::reports::{SnapshotStore, number};
use grainbench::resume::Place;
use grainbench::scene::effects::Effects;
use grainbench::scene::end_state::EndState;
use grainbench::scene::method::Method;
use grainbench::scene::scene::{Duration, Scene};
use grainbench::scene::source::SceneSource;
use grainbench::solver::Solver;
use grainbench::solver::brief::Brief;
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::solver::failure::{RunError, StorageError};
use grainbench::solver::observer::{Observer, RunOptions, RunOutline};
use grainbench::solver::record::{Cost, PartialOutput, Provenance, Record, Series, Snapshot};
use grainbench::solver::resolution::Resolution;
use grainbench::store::{StagedDir, write_file};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Scene file, or file of a parameter sweep, which names its solvers.
    #[arg(value_name = "SCENE.toml|SWEEP.toml")]
    scene: PathBuf,
    /// Solver, by name or manifest.
    #[arg(long, value_name = "NAME|SOLVER.toml", default_value = "", hide_default_value = true)]
    solver: String,
    /// Name of a variant of the scene.
    #[arg(long)]
    variant: Option<String>,
    /// Override one key of the scene, such as `contacts.all.friction=0.5`. Repeatable.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    #[command(flatten)]
    step: Step,
    /// Number of cells per reference length (grains: per radius), for a solver with a grid. Default: 8.
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    cells: Option<f64>,
    /// Number of material points per cell along each axis, for a solver with a grid. Default: 3.
    #[arg(long, value_name = "NUMBER", value_parser = whole::<u32>(1, 64))]
    points: Option<u32>,
    /// Courant number c Δt/h, for a solver with a grid. Default: 0.4.
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    courant: Option<f64>,
    /// Number of time steps per 1/60 s, for a rigid-body solver. Default: 8.
    #[arg(long, value_name = "NUMBER", value_parser = whole::<u32>(1, u32::MAX))]
    substeps: Option<u32>,
    /// Number of iterations of the constraint solver per time step, for a rigid-body solver. Default: 4.
    #[arg(long, value_name = "NUMBER", value_parser = whole::<u32>(1, u32::MAX))]
    iterations: Option<u32>,
    /// Accept a time step at or above the critical one.
    #[arg(long)]
    allow_unstable: bool,
    /// Number of threads of `dem` and `mpm`. Default: all cores. The record does not depend on it.
    #[arg(long, value_name = "N", value_parser = whole(1, MOST_THREADS))]
    threads: Option<u16>,
    /// Write a checkpoint to this file at regular intervals. Each checkpoint replaces the previous one.
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Number of steps between checkpoints.
    #[arg(
        long,
        value_name = "STEPS",
        default_value_t = 100_000,
        value_parser = whole(1, u64::MAX),
        requires = "checkpoint"
    )]
    checkpoint_every: u64,
    /// Continue the run from this checkpoint. The record then equals that of an uninterrupted run to the bit, except
    /// for the run times.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
    /// Write the final state with the contact history to this file. Another scene can start from it (`grains.NAME.state`).
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Halve the size of the state file by rounding: positions to 2⁻³⁶ radii, all other numbers to 24 bits.
    #[arg(long, requires = "state")]
    rounded: bool,
    /// Directory of the record.
    #[arg(long, value_name = "DIR", default_value = "grainbench-simulate")]
    out: PathBuf,
    /// Formats of the snapshots. Default: `dump` and `vtk` for at most 200 000 rows of grains, contacts and points. For
    /// more rows: `parquet` if the scene requests snapshots besides the first and the last, otherwise none.
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = snapshot_format())]
    write: Option<Vec<Option<SnapshotFormat>>>,
    /// Print provenance, cost and final state as JSON. For a sweep, print its results as JSON.
    #[arg(long)]
    json: bool,
    /// Write a plan of the sweep to this directory and run nothing. `run --resume DIR` runs the plan.
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    plan: Option<PathBuf>,
    /// Number of shards of the plan. Default: as many as last at least 60 s on average.
    #[arg(long, value_name = "N", value_parser = whole(1, shard::MOST), requires = "plan")]
    shards: Option<u32>,
}

impl Arguments {
    /// Returns an error if a resolution option is given that belongs to another kind of solver, because it would have no effect.
    fn refuse_others(&self, method: Method) -> Result<(), Fault> {
        let given = [
            ("--time-step or --time-step-fraction", !self.step.is_usual(), Method::Dem),
            ("--cells", self.cells.is_some(), Method::Grid),
            ("--points", self.points.is_some(), Method::Grid),
            ("--courant", self.courant.is_some(), Method::Grid),
            ("--substeps", self.substeps.is_some(), Method::Rigid),
            ("--iterations", self.iterations.is_some(), Method::Rigid),
        ];
        let Some((option, ..)) =
            given.into_iter().find(|(_, is_given, option_method)| *is_given && *option_method != method)
        else {
            return Ok(());
        };
        let own = match method {
            Method::Dem => "`--time-step` or `--time-step-fraction`",
            Method::Grid => "`--cells`, `--points` and `--courant`, from which its time step follows",
            Method::Rigid => "`--substeps` and `--iterations`",
        };
        let solver = &self.solver;
        Err(Fault::input(format!(
            "{option}: the resolution of `{solver}` is set by {own}; other resolution options are not supported"
        )))
    }

    /// Returns true if neither the command line nor the scene requests snapshots. A large run then stores no rows.
    fn asks_for_no_snapshots(&self, scene: &Scene) -> bool {
        self.write.as_ref().map_or_else(
            || scene.snapshots == 0 && scene.snapshot_times.is_empty(),
            |asked| asked.iter().all(Option::is_none),
        )
    }
}

/// Returns the parser of a format of snapshots; none for `none`.
fn snapshot_format() -> impl TypedValueParser<Value = Option<SnapshotFormat>> {
    PossibleValuesParser::new(SnapshotFormat::NAMES).map(|name| SnapshotFormat::by_name(&name))
}

/// Largest number of scene keys that one command line may override.
const MOST_OVERRIDES: usize = 1000;

/// Simulates a scene and writes the record.
pub(crate) fn simulate(arguments: &Arguments) -> Outcome {
    if arguments.plan.is_some() || Sweep::is_in(&arguments.scene) {
        return sweep(arguments);
    }
    let mut source = SceneSource::read(&arguments.scene)?;
    if arguments.solver.is_empty() {
        refuse!("--solver: expected a solver, such as `dem`, found none");
    }
    if let Some(variant) = &arguments.variant {
        source = source.variant(variant);
    }
    if arguments.set.len() > MOST_OVERRIDES {
        let found = arguments.set.len();
        refuse!("--set: expected at most {MOST_OVERRIDES} keys, found {found}: edit the scene");
    }
    for (path, value) in &arguments.set {
        source = source.set(path, value);
    }
    let scene = source.scene(&read_grains)?;
    let solver = solver::find(&arguments.solver)?;
    let resolution = resolution(arguments, &scene, solver.as_ref())?;
    if arguments.state.is_some() && Method::from_name(&arguments.solver) != Some(Method::Dem) {
        let solver = &arguments.solver;
        refuse!("--state: expected `dem`, found `{solver}`, which does not report its final state");
    }
    let has_checkpoints = matches!(Method::from_name(&arguments.solver), Some(Method::Dem | Method::Grid));
    if arguments.checkpoint.is_some() && !has_checkpoints {
        let solver = &arguments.solver;
        refuse!("--checkpoint: expected `dem` or `mpm`, found `{solver}`, which writes no checkpoints");
    }
    check_output(&arguments.out, &RECORD, &export::FILES)?;
    let header = if arguments.json { None } else { Some(header(&scene, solver.as_ref())) };
    let from = arguments.restart.as_deref().map(checkpoint::read).transpose()?;
    let store = arguments.checkpoint.as_deref().map(|path| Place { path, every: arguments.checkpoint_every });
    let (method, critical) = (Method::from_name(&arguments.solver), scene.critical_time_step());
    if let Some(store) = &store {
        refuse_others(store.path)?;
    }
    let mut snapshots = match &store {
        Some(store) => SnapshotStore::for_checkpoint(store.path),
        None => SnapshotStore::for_output(&arguments.out),
    };
    snapshots = snapshots.holding(&scene.columns);
    if arguments.asks_for_no_snapshots(&scene) {
        snapshots = snapshots.in_short();
    }
    if let (Some(path), Some(checkpoint)) = (&arguments.restart, &from) {
        snapshots = snapshots.resume(path, checkpoint.output())?;
    }
    let interrupt = Interrupt::listen();
    let mut watcher = Watcher {
        arguments,
        method,
        critical,
        header,
        progress: None,
        store,
        snapshots,
        remains: None,
        state: None,
        interrupt,
    };
    let record = solver.run_from(&scene, &resolution, from.as_ref(), &mut watcher);
    let Watcher { mut snapshots, remains, state, .. } = watcher;
    let mut record = match record {
        Ok(record) => record,
        Err(error) => return Err(left(&error, remains.as_ref(), snapshots, arguments)),
    };
    // Some solvers return all snapshots at the end of the run.
    for snapshot in record.snapshots.drain(..) {
        snapshots.add(snapshot)?;
    }
    let formats = formats(&snapshots, arguments);
    let mut out = StagedDir::new(&arguments.out)?;
    export::write_run(&record, &mut snapshots, &formats, &mut out)?;
    out.commit()?;
    if let Some(path) = &arguments.state {
        let form = if arguments.rounded { EndState::to_rounded_bytes } else { EndState::to_bytes };
        let bytes = state.as_ref().map(form).transpose().map_err(Fault::input)?;
        write_file(path, bytes.unwrap_or_default())?;
    }
    if arguments.json {
        let (Record { provenance, cost, .. }, out) = (&record, arguments.out.display().to_string());
        return print_json(&Summary { provenance, cost, end: snapshots.end(), snapshots: snapshots.len(), out });
    }
    print(&footer(&record, &snapshots, &formats, arguments))
}

/// Writes a plan of a sweep. Without `--plan`, the plan is written to `--out`, all its tasks are run, and the report is made.
fn sweep(arguments: &Arguments) -> Outcome {
    let given = [
        ("--solver", !arguments.solver.is_empty()),
        ("--variant", arguments.variant.is_some()),
        ("--set", !arguments.set.is_empty()),
        ("--threads", arguments.threads.is_some()),
        ("--write", arguments.write.is_some()),
        ("--checkpoint", arguments.checkpoint.is_some()),
        ("--restart", arguments.restart.is_some()),
        ("--state", arguments.state.is_some()),
        ("--allow-unstable", arguments.allow_unstable),
    ];
    if let Some((name, _)) = given.iter().find(|(_, is_given)| *is_given) {
        refuse!("{name}: not supported with a sweep");
    }
    [Method::Dem, Method::Grid].into_iter().try_for_each(|method| arguments.refuse_others(method))?;
    let out = arguments.plan.as_ref().unwrap_or(&arguments.out).clone();
    let what = arguments.scene.display().to_string();
    let &Arguments { shards, json, .. } = arguments;
    let planned =
        jobs::arguments::Arguments { what, shards, out: out.clone(), json, ..jobs::arguments::Arguments::default() };
    if arguments.plan.is_some() {
        return jobs::plan::plan(&planned);
    }
    jobs::plan::write(&planned)?;
    jobs::work::work(&out, &WorkOptions { quiet: json, ..WorkOptions::default() }, None, false)?;
    collect(&out, &CollectOptions { json: arguments.json, ..CollectOptions::default() })
}

/// Returns the error of a failed or interrupted run, after writing the output that exists.
fn left(error: &RunError, remains: Option<&Series>, mut snapshots: SnapshotStore, arguments: &Arguments) -> Fault {
    let Some(series) = remains else { return fault(error, arguments) };
    let formats = formats(&snapshots, arguments);
    let mut write = || -> Result<(), Fault> {
        let mut out = StagedDir::new(&arguments.out)?;
        export::write_remains(&error.to_string(), series, &mut snapshots, &formats, &mut out)?;
        Ok(out.commit()?)
    };
    let out = arguments.out.display();
    let last = if formats.is_empty() { "" } else { " with its last state" };
    Fault::Broken(match write() {
        Ok(()) => format!("{error}; the incomplete output{last} is in {out}"),
        Err(fault) => format!("{error}; the incomplete output could not be written to {out}: {fault}"),
    })
}

/// Returns the requested formats of the snapshots, or the default formats.
fn formats(snapshots: &SnapshotStore, arguments: &Arguments) -> BTreeSet<SnapshotFormat> {
    match &arguments.write {
        Some(asked) => asked.iter().copied().flatten().collect(),
        None => SnapshotFormat::usual(snapshots),
    }
}

/// Returns the requested resolution. Returns an error for a time step at or above the critical one, unless
/// `--allow-unstable` is given.
fn resolution(arguments: &Arguments, scene: &Scene, solver: &dyn Solver) -> Result<Resolution, Fault> {
    if Method::from_name(&arguments.solver) == Some(Method::Rigid) {
        arguments.refuse_others(Method::Rigid)?;
        return Ok(Resolution::Rigid {
            step: Resolution::RIGID_STEP,
            substeps: arguments.substeps.unwrap_or(Resolution::SUBSTEPS),
            iterations: arguments.iterations.unwrap_or(Resolution::RIGID_ITERATIONS),
        });
    }
    // A solver with both springs and deformable bodies gets cells only if the scene needs deformable bodies.
    if solver.deforms() && (!solver.has_springs() || scene.needs_deformable().is_some()) {
        arguments.refuse_others(Method::Grid)?;
        let cells = arguments.cells.unwrap_or(Resolution::CELLS);
        let points = arguments.points.unwrap_or(Resolution::POINTS);
        let courant = arguments.courant.unwrap_or(Resolution::COURANT);
        if courant >= 1.0 && !arguments.allow_unstable {
            refuse!("Courant number: expected less than 1, found {courant} (--allow-unstable permits it)");
        }
        return Ok(Resolution::Grid { cells, points, courant });
    }
    arguments.refuse_others(Method::Dem)?;
    let critical = scene.critical_time_step();
    let resolution = arguments.step.resolution();
    let step = match resolution {
        Resolution::CriticalFraction(fraction) => fraction * critical,
        Resolution::TimeStep(step) => step,
        Resolution::Grid { .. } | Resolution::Rigid { .. } => return Ok(resolution),
    };
    if scene.is_unstable_at(step) && !arguments.allow_unstable {
        refuse!(
            "time step: expected less than the critical step 2√(m_min/k_max) = {critical:.6e} s, found {step:.6e} s, {} of \
             it (--allow-unstable permits it)",
            number::significant(step / critical, 4)
        );
    }
    let stable = stable_fraction(scene);
    if scene.grains.len() > 2 && step > stable * critical {
        eprintln!(
            "warning: the time step is {} of the critical step. Above {stable:.3} of it, a packing can be unstable",
            number::significant(step / critical, 4)
        );
    }
    Ok(resolution)
}

/// Returns the error of a run that left no output. For an error in an input file, the message names the file.
fn fault(error: &RunError, arguments: &Arguments) -> Fault {
    match error {
        RunError::Broken(_)
        | RunError::Program { .. }
        | RunError::NotFinite { .. }
        | RunError::Interrupted { .. }
        | RunError::NotStored(_)
        | RunError::Checkpoint(CheckpointError::NotStored(_)) => Fault::Broken(error.to_string()),
        RunError::Checkpoint(_) => {
            Fault::input(arguments.restart.as_ref().map_or_else(|| error.to_string(), |path| in_file(path, error)))
        }
        RunError::Resolution { .. } => Fault::input(in_file(&arguments.scene, error)),
        RunError::Unsupported { .. } | RunError::NotAvailable { .. } | RunError::Stale { .. } => Fault::input(error),
    }
}

fn in_file(path: &Path, error: &RunError) -> String {
    format!("{}: {error}", path.display())
}

/// Returns the lines that are printed before the first step.
fn header(scene: &Scene, solver: &dyn Solver) -> String {
    let effects = Effects::words(scene);
    let effects = match (effects.is_empty(), scene.grains.is_empty()) {
        (false, _) => effects.join(", "),
        (true, true) => "deformation only".to_owned(),
        (true, false) => "contact springs only".to_owned(),
    };
    let count = |number: usize| number::count(number as u64);
    let mut lines = format!("scene      {}\nsolver     {}\neffects    {effects}\n", scene.title, solver.name());
    if !scene.grains.is_empty() || scene.bodies.is_empty() {
        let comers = &scene.stays.entries;
        let late = match scene.duration {
            Duration::Seconds(time) => comers.len() - scene.stays.entered_by(time),
            Duration::Cycles(_) => 0,
        };
        // If all grains are poured, the number of poured grains is not printed again.
        let words = match (comers.len(), late) {
            (0, _) => String::new(),
            (some, 0) if some == scene.grains.len() => String::new(),
            (some, 0) => format!(", {} of them poured", count(some)),
            (some, late) => {
                format!(", {} of them poured, of which {} after the end of the run", count(some), count(late))
            }
        };
        lines += &format!("grains     {}{words}\n", count(scene.grains.len()));
    }
    if !scene.bodies.is_empty() {
        lines += &format!("bodies     {}\n", count(scene.bodies.len()));
    }
    lines
}

fn footer(
    record: &Record,
    snapshots: &SnapshotStore,
    formats: &BTreeSet<SnapshotFormat>,
    arguments: &Arguments,
) -> String {
    let cost = &record.cost;
    let evaluations = cost
        .contact_evaluations
        .map_or(String::new(), |count| format!(", {} contact evaluations", number::count(count)));
    // Text files are easy to find, so only other formats are mentioned.
    let bulk = if formats.contains(&SnapshotFormat::Dump) || snapshots.is_empty() {
        String::new()
    } else {
        let (count, rows) = (number::count(snapshots.len()), number::count(snapshots.rows()));
        let form = if formats.contains(&SnapshotFormat::Parquet) {
            "as Parquet in snapshots/ (--write dump,vtk for text)"
        } else if formats.contains(&SnapshotFormat::Vtk) {
            "in vtk/"
        } else {
            "not written (--write parquet, or dump,vtk for text)"
        };
        format!("snapshots  {count} of {rows} rows, {form}\n")
    };
    format!("took       {}{evaluations}\n{bulk}{}\n", number::seconds(cost.wall_seconds), arguments.out.display())
}

/// Observer of a run. It prints the header when the solver accepts the run, shows the progress, and stores the output.
struct Watcher<'a> {
    arguments: &'a Arguments,
    method: Option<Method>,
    critical: f64,
    header: Option<String>,
    progress: Option<Progress>,
    store: Option<Place<'a>>,
    snapshots: SnapshotStore,
    /// Time series of a failed or interrupted run.
    remains: Option<Series>,
    /// Final state of the run.
    state: Option<EndState>,
    interrupt: Interrupt,
}

impl Watcher<'_> {
    /// Returns the estimated duration of a run (s); `None` if it is below 10 s.
    fn estimate(&self, ahead: RunOutline) -> Option<f64> {
        let seconds = ahead.steps as f64 * ahead.particles as f64 / A_SECOND;
        (seconds >= 10.0).then_some(seconds)
    }

    /// Returns a warning about a long run, with the reason and possible changes.
    fn warning(&self, ahead: RunOutline, seconds: f64) -> String {
        let shorter = match self.method {
            Some(Method::Grid) => {
                "The time step is the time of a wave through part of a cell. Softer moduli or larger cells (--cells)"
            }
            _ => "The time step is a fraction of √(m/k). Softer springs",
        };
        format!(
            "warning: this takes about {}, {} steps of {:.3e} s for {} particles. {shorter} shorten the run. \
             --checkpoint FILE stores the finished steps",
            rough(seconds),
            number::count(ahead.steps),
            ahead.time_step,
            number::count(ahead.particles)
        )
    }
}

/// Approximate speed of our solvers on one thread (particle-steps per second).
const A_SECOND: f64 = 1e7;
/// Estimated duration above which the user is warned (s).
const LONG: f64 = 3600.0;

/// Returns a duration in words, with two significant digits and a suitable unit.
fn rough(seconds: f64) -> String {
    let (size, unit) = match seconds {
        ..600.0 => (seconds, "s"),
        ..7200.0 => (seconds / 60.0, "min"),
        ..1e6 => (seconds / 3600.0, "h"),
        _ => (seconds / 86400.0, "days"),
    };
    format!("{} {unit}", number::significant(size, 2))
}

impl Observer for Watcher<'_> {
    fn options(&self) -> RunOptions {
        RunOptions {
            threads: self.arguments.threads.map_or_else(cores, usize::from),
            checkpoint_interval: self.store.as_ref().map(|store| store.every),
            most_rows: self.snapshots.most_rows(),
            allow_unstable: self.arguments.allow_unstable,
            keep_snapshots: false,
            end_state: self.arguments.state.is_some(),
        }
    }

    fn begin(&mut self, ahead: RunOutline) {
        let RunOutline { time_step, steps, .. } = ahead;
        let of_critical = if self.method == Some(Method::Grid) {
            "within the Courant number of the grid".to_owned()
        } else if self.method == Some(Method::Rigid) {
            "of rigid contacts, which have no critical step".to_owned()
        } else if self.critical.is_finite() {
            let fraction = number::significant(time_step / self.critical, 4);
            format!("{fraction} of the critical step {:.6e} s", self.critical)
        } else {
            "no critical step, because no contact can occur".to_owned()
        };
        if let Some(header) = self.header.take() {
            let estimate = self.estimate(ahead).map_or_else(String::new, |seconds| {
                format!(", about {} at ten million particle-steps a second", rough(seconds))
            });
            let steps = number::count(steps);
            let points = match self.method {
                Some(Method::Grid) => format!("points     {}\n", number::count(ahead.particles)),
                _ => String::new(),
            };
            // A closed standard output does not end the run.
            let _ = print(&format!(
                "{header}{points}time step  {time_step:.6e} s, {of_critical}\nsteps      {steps}{estimate}\n"
            ));
        }
        if let Some(seconds) = self.estimate(ahead).filter(|&seconds| seconds >= LONG) {
            eprintln!("{}", self.warning(ahead, seconds));
        }
        self.progress = Some(Progress::new(steps, "steps"));
    }

    fn progress(&mut self, done: u64, total: u64) {
        if let Some(progress) = &self.progress {
            progress.set(done, total);
        }
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        let Some(store) = &self.store else { return Ok(()) };
        let kept = self.snapshots.keep().map_err(|error| CheckpointError::NotStored(error.to_string()))?;
        store.put(&checkpoint.with_output(kept))?;
        self.snapshots.forget_others();
        Ok(())
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        self.snapshots.add(snapshot).map(|()| None).map_err(|error| StorageError(error.to_string()))
    }

    fn in_short(&mut self, brief: Brief, rows: u64) {
        self.snapshots.pass(brief, rows);
    }

    fn end_state(&mut self, state: EndState) {
        self.state = Some(state);
    }

    fn is_over(&self) -> bool {
        self.interrupt.is_asked()
    }

    fn broke(&mut self, remains: PartialOutput) {
        // If this write fails, the error is reported when the remaining output is written.
        let _ = self.snapshots.add_last(remains.end);
        self.remains = Some(remains.series);
    }
}

/// Summary of a run, printed as JSON.
#[derive(Serialize)]
struct Summary<'a> {
    provenance: &'a Provenance,
    cost: &'a Cost,
    end: Option<&'a Brief>,
    snapshots: u64,
    out: String,
}
