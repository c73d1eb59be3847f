//! Commands of the program.

mod cache;
mod campaign;
mod check;
mod checkpoint;
mod compare;
mod completions;
mod conform;
mod cores;
mod cost;
mod deck;
mod earlier;
mod effects;
mod exit;
mod fields;
mod filter;
mod github;
mod import;
mod interrupt;
mod keep;
mod kept_runs;
mod list;
mod pattern;
mod progress;
mod provenance;
mod race;
mod reference;
mod report;
mod run;
mod scene;
mod schema;
mod select;
mod simulate;
mod solver;
mod stability;
mod step;
mod strangers;
mod subject;
mod value;

use clap::{CommandFactory, Parser, Subcommand};
use exit::Fault;
use grainbench::lanes::Processor;
use std::process::ExitCode;

/// Version, and the commit that the program is built from.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("GRAINBENCH_COMMIT"), ")");

/// Benchmarks for solvers of granular mechanics: accuracy, and its computing cost.
///
/// Runs benchmark cases, judges their claims and writes a report. Without a command it runs all cases, with the options
/// below.
#[derive(Parser)]
#[command(name = "grainbench", version = VERSION, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: run::Options,
}

#[derive(Subcommand)]
enum Command {
    /// List the cases: title, variants, number of claims, default level, solvers.
    List(list::Arguments),
    /// Run cases and judge their claims.
    Run(run::Arguments),
    /// Simulate one scene and write its record.
    Simulate(simulate::Arguments),
    /// Write the LAMMPS or LIGGGHTS input for a case or a scene.
    Deck(deck::Arguments),
    /// Judge the output of any program for a case or a scene: dumps, VTK files, arrays or a CSV table.
    Check(check::Arguments),
    /// Compute continuum fields cell by cell: packing fraction, stress, friction, shear rate.
    Fields(fields::Arguments),
    /// Compare two outputs column by column.
    Compare(compare::Arguments),
    /// Measure error against computing time, for each solver over its parameters.
    Cost(cost::Arguments),
    /// Find the largest stable time step of each solver, and run difficult cases.
    Stability(stability::Arguments),
    /// Measure the influence of each physical effect by switching it off or compiling it in.
    Effects(effects::Arguments),
    /// Write a plan of many runs: claims, costs, stability limits, or a parameter sweep.
    Plan(campaign::plan::Arguments),
    /// Do the unfinished tasks of a plan, here or with a batch system.
    Work(campaign::work::Arguments),
    /// Show the progress of a plan.
    Status(campaign::status::Arguments),
    /// Make the report of a plan.
    Collect(campaign::collect::Arguments),
    /// Measure throughput beside LAMMPS and LIGGGHTS: particle steps per second of processor time.
    Race(race::Arguments),
    /// Build, verify and update stored runs and references.
    #[command(subcommand)]
    Reference(reference::Command),
    /// Test the conformance properties of solvers: conservation, symmetries, free flight, order, determinism.
    Conform(conform::Arguments),
    /// Print the resolved scene that external solvers receive, in SI units.
    Scene(scene::Arguments),
    /// Print the JSON schema of scene files or of resolved scenes.
    Schema(schema::Arguments),
    /// Make the page and figures of a stored report or simulation, without running a solver.
    Report(report::Arguments),
    /// Print the completion script of a shell.
    Completions(completions::Arguments),
    /// Print the manual page, or write one for each command to a directory.
    Man(completions::ManArguments),
}

/// Parses the command line, runs the command and returns its exit code.
pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Err(reason) = Processor::forced() {
        return Fault::input(reason).report();
    }
    let done = match cli.command {
        None => run::run(&[], &cli.run),
        Some(Command::List(arguments)) => list::list(&arguments),
        Some(Command::Run(arguments)) => run::run(&arguments.cases, &arguments.options),
        Some(Command::Simulate(arguments)) => simulate::simulate(&arguments),
        Some(Command::Deck(arguments)) => deck::deck(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        Some(Command::Fields(arguments)) => fields::fields(&arguments),
        Some(Command::Compare(arguments)) => compare::compare(&arguments),
        Some(Command::Cost(arguments)) => cost::cost(&arguments),
        Some(Command::Stability(arguments)) => stability::stability(&arguments),
        Some(Command::Effects(arguments)) => effects::effects(&arguments),
        Some(Command::Plan(arguments)) => campaign::plan::plan(&arguments),
        Some(Command::Work(arguments)) => campaign::work::work(&arguments),
        Some(Command::Status(arguments)) => campaign::status::status(&arguments),
        Some(Command::Collect(arguments)) => campaign::collect::collect(&arguments),
        Some(Command::Race(arguments)) => race::race(&arguments),
        Some(Command::Reference(command)) => reference::reference(&command),
        Some(Command::Conform(arguments)) => conform::conform(&arguments),
        Some(Command::Scene(arguments)) => scene::scene(&arguments),
        Some(Command::Schema(arguments)) => schema::schema(&arguments),
        Some(Command::Report(arguments)) => report::report(&arguments),
        Some(Command::Completions(arguments)) => completions::completions(&arguments, Cli::command()),
        Some(Command::Man(arguments)) => completions::man(&arguments, Cli::command()),
    };
    done.unwrap_or_else(|fault: Fault| fault.report())
}
