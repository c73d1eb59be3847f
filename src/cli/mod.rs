//! Commands: what can be asked for, and who answers.

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

/// The version, with the commit that the program is built from.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("GRAINBENCH_COMMIT"), ")");

/// How far to trust a solver of granular simulations, and what that trust costs.
///
/// Runs benchmark cases, judges their gates, and leaves a page with the results. Without a command: `run`, with the
/// options below.
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
    /// List the cases: title, variants, gates, default level, solvers.
    List(list::Arguments),
    /// Judge the gates of cases and write the report.
    Run(run::Arguments),
    /// Simulate one scene and write its record.
    Simulate(simulate::Arguments),
    /// Write the input of LAMMPS or LIGGGHTS for a case or a scene.
    Deck(deck::Arguments),
    /// Judge what any program left of a case: dumps of LAMMPS' kind, or a CSV table.
    Check(check::Arguments),
    /// Read grains or material points as a continuum, cell by cell: packing, stress, friction, rate of shear.
    Fields(fields::Arguments),
    /// Compare two outputs, column by column.
    Compare(compare::Arguments),
    /// Measure what accuracy costs: error against time, each solver over its knobs.
    Cost(cost::Arguments),
    /// Find the largest stable step of every solver, and try hard cases.
    Stability(stability::Arguments),
    /// Tell what each effect is worth: each switched off in turn, each absent one compiled in.
    Effects(effects::Arguments),
    /// Plan many runs: gates, costs, limits, or a sweep over the keys of a scene.
    Plan(campaign::plan::Arguments),
    /// Do a plan or a chunk of it, here or by a batch system; what is finished is not done again.
    Work(campaign::work::Arguments),
    /// Tell how far a plan is.
    Status(campaign::status::Arguments),
    /// Make the report of a plan, as if all of it had been run here.
    Collect(campaign::collect::Arguments),
    /// Race with LAMMPS and LIGGGHTS, in turn on the same scenes: grains stepped in a second of processor time.
    Race(race::Arguments),
    /// Make the stored runs of LAMMPS and LIGGGHTS, or run these again and compare.
    #[command(subcommand)]
    Reference(reference::Command),
    /// Try what every solver owes: conservation, symmetries, free flight, order, determinism.
    Conform(conform::Arguments),
    /// Print a scene as programs are given it: everything definite, in SI.
    Scene(scene::Arguments),
    /// Print the JSON schema of scene files, or of the scenes that programs are given.
    Schema(schema::Arguments),
    /// Make page and figures from what a run left, without any solver: of a report again, or pictures of a simulation.
    Report(report::Arguments),
    /// Print what a shell needs to complete commands and options.
    Completions(completions::Arguments),
    /// Print the manual page, or leave one for each command in a directory.
    Man(completions::ManArguments),
}

/// Reads the command line, does what it says, and says how it went.
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
