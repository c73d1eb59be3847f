//! `grainbench simulate`: one scene, one solver, one record.

use super::checkpoint::{self, Store};
use super::exit::{Fault, Outcome, check_writable, print, print_json};
use super::progress::Progress;
use grainbench::cases::registry::read_grains;
use grainbench::cases::solvers;
use grainbench::reports::{StagedDir, export, number};
use grainbench::scene::checkpoint::{Checkpoint, CheckpointError};
use grainbench::scene::effects::Effects;
use grainbench::scene::record::{Cost, Provenance, Record, Snapshot};
use grainbench::scene::scene::Scene;
use grainbench::scene::solver::{Method, Resolution, RunError, Solver, Watch};
use grainbench::scene::source::SceneSource;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Scene file.
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// Solver, by name.
    #[arg(long, value_name = "NAME")]
    solver: String,
    /// Variant of the scene.
    #[arg(long)]
    variant: Option<String>,
    /// Override one key of the scene, such as `contacts.all.friction=0.5`; may be given more than once.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    /// Time step as a fraction of the critical one, 2√(m_min/k_max).
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.1,
        value_parser = positive,
        allow_hyphen_values = true,
        conflicts_with = "time_step"
    )]
    time_step_fraction: f64,
    /// Time step in seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    time_step: Option<f64>,
    /// Cells per reference length, of solvers with a grid: per radius, where there are grains.
    #[arg(long, value_name = "NUMBER", default_value_t = 8.0, value_parser = positive)]
    cells: f64,
    /// Material points per cell and axis, of solvers with a grid.
    #[arg(long, value_name = "NUMBER", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=64))]
    points: u32,
    /// Courant number c Δt/h, of solvers with a grid.
    #[arg(long, value_name = "NUMBER", default_value_t = Resolution::COURANT, value_parser = positive)]
    courant: f64,
    /// Time steps in each sixtieth of a second, of solvers for rigid bodies.
    #[arg(long, value_name = "NUMBER", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..))]
    substeps: u32,
    /// Iterations of the constraint solver in each time step, of solvers for rigid bodies.
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = Resolution::RIGID_ITERATIONS,
        value_parser = clap::value_parser!(u32).range(1..)
    )]
    iterations: u32,
    /// Take a time step of the critical one or above.
    #[arg(long)]
    allow_unstable: bool,
    /// Leave a checkpoint here every so many steps, each in the place of the one before.
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Steps from one checkpoint to the next.
    #[arg(
        long,
        value_name = "STEPS",
        default_value_t = 100_000,
        value_parser = clap::value_parser!(u64).range(1..),
        requires = "checkpoint"
    )]
    checkpoint_every: u64,
    /// Continue from this checkpoint of the same run: the record is that of the whole run, in every bit but its times.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
    /// Directory for the record.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print provenance, cost and the end of the run as JSON.
    #[arg(long)]
    json: bool,
}

/// Most keys that are overridden on a command line.
const MOST_OVERRIDES: usize = 1000;

/// A key and its value.
pub(crate) fn path_and_value(text: &str) -> Result<(String, String), String> {
    let (path, value) = text.split_once('=').ok_or("expected path=value, found no `=`")?;
    Ok((path.trim().to_owned(), value.trim().to_owned()))
}

/// A number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// Simulates a scene and writes its record.
pub(crate) fn simulate(arguments: &Arguments) -> Outcome {
    let mut source = SceneSource::read(&arguments.scene)?;
    if let Some(variant) = &arguments.variant {
        source = source.variant(variant);
    }
    if arguments.set.len() > MOST_OVERRIDES {
        let found = arguments.set.len();
        return Err(Fault::input(format!(
            "--set: expected at most {MOST_OVERRIDES} keys, found {found}: edit the scene"
        )));
    }
    for (path, value) in &arguments.set {
        source = source.set(path, value);
    }
    let scene = source.scene(&read_grains)?;
    let solver = solver(&arguments.solver)?;
    let resolution = resolution(arguments, &scene)?;
    check_writable(&arguments.out)?;
    let header = if arguments.json { None } else { Some(header(&scene, solver.as_ref())) };
    let from = arguments.restart.as_deref().map(checkpoint::read).transpose()?;
    let store = arguments.checkpoint.clone().map(|path| Store { path, every: arguments.checkpoint_every });
    let (method, critical) = (Method::of(&arguments.solver), scene.critical_time_step());
    if let Some(store) = &store {
        store.refuse_others()?;
    }
    let grains = scene.grains.len();
    let mut watcher = Watcher { grains, method, critical, header, progress: None, store };
    let record = match &from {
        None => solver.run(&scene, &resolution, &mut watcher),
        Some(checkpoint) => solver.restart(&scene, &resolution, checkpoint, &mut watcher),
    };
    let record = record.map_err(fault)?;
    drop(watcher);
    write(&record, arguments)?;
    if arguments.json {
        print_json(&Summary::of(&record, arguments))?;
    } else {
        print(&footer(&record, arguments))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn solver(name: &str) -> Result<Box<dyn Solver>, Fault> {
    solvers::by_name(name).ok_or_else(|| {
        let names = solvers::names();
        Fault::unknown("a solver", name, names.iter().map(String::as_str))
    })
}

/// The resolution asked for, unless it is above the critical step and nobody said that this is meant.
fn resolution(arguments: &Arguments, scene: &Scene) -> Result<Resolution, Fault> {
    if Method::of(&arguments.solver) == Some(Method::Rigid) {
        let &Arguments { substeps, iterations, .. } = arguments;
        return Ok(Resolution::Rigid { step: Resolution::RIGID_STEP, substeps, iterations });
    }
    if Method::of(&arguments.solver) == Some(Method::Grid) {
        let &Arguments { cells, points, courant, .. } = arguments;
        if courant >= 1.0 && !arguments.allow_unstable {
            return Err(Fault::input(format!(
                "Courant number: expected less than 1, found {courant} (--allow-unstable takes it all the same)"
            )));
        }
        return Ok(Resolution::Grid { cells, points, courant });
    }
    let critical = scene.critical_time_step();
    let (resolution, step) = match arguments.time_step {
        Some(step) => (Resolution::TimeStep(step), step),
        None => {
            let fraction = arguments.time_step_fraction;
            (Resolution::CriticalFraction(fraction), fraction * critical)
        }
    };
    if step >= critical && critical.is_finite() && !arguments.allow_unstable {
        return Err(Fault::input(format!(
            "time step: expected less than the critical step 2√(m_min/k_max) = {critical:.6e} s, found {step:.6e} s, {} of \
             it (--allow-unstable takes it all the same)",
            number::significant(step / critical, 4)
        )));
    }
    Ok(resolution)
}

fn fault(error: RunError) -> Fault {
    match error {
        RunError::Broken(broken) => Fault::Broken(broken.to_string()),
        RunError::Program { .. } | RunError::NotFinite { .. } => Fault::Broken(error.to_string()),
        RunError::Unsupported { .. }
        | RunError::Resolution { .. }
        | RunError::NotAvailable { .. }
        | RunError::Stale { .. }
        | RunError::Checkpoint(_) => Fault::input(error),
    }
}

fn write(record: &Record, arguments: &Arguments) -> Result<(), Fault> {
    let mut out = StagedDir::new(&arguments.out).map_err(Fault::writing)?;
    export::write_record(record, &mut out).map_err(Fault::writing)?;
    out.commit().map_err(Fault::writing)
}

/// What is known before the first step.
fn header(scene: &Scene, solver: &dyn Solver) -> String {
    let effects = Effects::words(scene);
    let effects = if effects.is_empty() { "contact springs only".to_owned() } else { effects.join(", ") };
    format!(
        "scene      {}\nsolver     {}\neffects    {effects}\ngrains     {}\n",
        scene.title,
        solver.name(),
        number::count(scene.grains.len() as u64)
    )
}

fn footer(record: &Record, arguments: &Arguments) -> String {
    let cost = &record.cost;
    format!(
        "took       {}, {} contact evaluations\n{}\n",
        number::seconds(cost.wall_seconds),
        number::count(cost.contact_evaluations),
        arguments.out.display()
    )
}

/// Tells people what runs, once the solver has taken it up, and how far it is.
struct Watcher {
    grains: usize,
    method: Option<Method>,
    critical: f64,
    header: Option<String>,
    progress: Option<Progress>,
    store: Option<Store>,
}

impl Watcher {
    /// How long so many steps may take, where that is long: grains on springs go through about ten million
    /// particle-steps a second. Of methods with a grid the progress tells it.
    fn estimate(&self, steps: u64) -> String {
        const A_SECOND: f64 = 1e7;
        let seconds = steps as f64 * self.grains as f64 / A_SECOND;
        if self.method == Some(Method::Grid) || seconds < 10.0 {
            return String::new();
        }
        let (size, unit) = match seconds {
            ..600.0 => (seconds, "s"),
            ..36e3 => (seconds / 60.0, "min"),
            ..1e6 => (seconds / 3600.0, "h"),
            _ => (seconds / 86400.0, "days"),
        };
        format!(", about {} {unit} at ten million particle-steps a second", number::significant(size, 2))
    }
}

impl Watch for Watcher {
    fn begin(&mut self, time_step: f64, steps: u64) {
        let of_critical = if self.method == Some(Method::Grid) {
            "within the Courant number of the grid".to_owned()
        } else if self.critical.is_finite() {
            let fraction = number::significant(time_step / self.critical, 4);
            format!("{fraction} of the critical step {:.6e} s", self.critical)
        } else {
            "no contact can occur, hence no critical step".to_owned()
        };
        if let Some(header) = self.header.take() {
            let estimate = self.estimate(steps);
            let steps = number::count(steps);
            // A header that nobody reads any more is no reason to give up the run.
            let _ =
                print(&format!("{header}time step  {time_step:.6e} s, {of_critical}\nsteps      {steps}{estimate}\n"));
        }
        self.progress = Some(Progress::new(steps, "steps"));
    }

    fn progress(&mut self, done: u64, total: u64) {
        if let Some(progress) = &self.progress {
            progress.set(done, total);
        }
    }

    fn checkpoint_interval(&self) -> Option<u64> {
        self.store.as_ref().map(|store| store.every)
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.store.as_ref().map_or(Ok(()), |store| store.put(&checkpoint))
    }
}

/// A run in short, for programs.
#[derive(Serialize)]
struct Summary<'a> {
    provenance: &'a Provenance,
    cost: &'a Cost,
    end: Option<End>,
    snapshots: usize,
    out: String,
}

/// The last snapshot in short.
#[derive(Serialize)]
struct End {
    step: u64,
    time: f64,
    grains: usize,
    contacts: usize,
    slipping_contacts: usize,
    kinetic_energy: f64,
    fastest: f64,
}

impl<'a> Summary<'a> {
    fn of(record: &'a Record, arguments: &Arguments) -> Self {
        Self {
            provenance: &record.provenance,
            cost: &record.cost,
            end: record.snapshots.last().map(End::of),
            snapshots: record.snapshots.len(),
            out: arguments.out.display().to_string(),
        }
    }
}

impl End {
    fn of(snapshot: &Snapshot) -> Self {
        let grains = &snapshot.grains;
        Self {
            step: snapshot.step,
            time: snapshot.time,
            grains: grains.len(),
            contacts: snapshot.contacts.len(),
            slipping_contacts: snapshot.contacts.iter().filter(|contact| contact.slipping).count(),
            kinetic_energy: grains.iter().map(|grain| 0.5 * grain.mass * grain.velocity.norm_squared()).sum(),
            fastest: grains.iter().map(|grain| grain.velocity.norm()).fold(0.0, f64::max),
        }
    }
}
