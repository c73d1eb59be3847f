//! Commands of the command line.

mod cache;
mod check;
mod checkpoint;
mod claims;
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
mod init;
mod interrupt;
mod jobs;
mod judge;
mod keep;
mod kept_runs;
mod list;
mod names;
mod own;
mod pattern;
mod progress;
mod provenance;
mod publish;
mod race;
mod reference;
mod report;
mod run;
mod scene;
mod select;
mod simulate;
mod solver;
mod spelling;
mod stability;
mod subject;
mod terminal;
mod value;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use exit::Fault;
use grainbench::lanes::Processor;
use std::path::PathBuf;
use std::process::ExitCode;

/// Version of the program, and the commit from which it is built.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("GRAINBENCH_COMMIT"), ")");

/// Benchmarks for the accuracy and the computing cost of solvers for granular mechanics.
///
/// `grainbench run` runs benchmark cases, judges their claims and writes a report.
#[derive(Parser)]
#[command(name = "grainbench", version = VERSION, arg_required_else_help = true)]
struct Cli {
    /// Use of colours. By default, `NO_COLOR` turns them off.
    // The help of each command would repeat the option.
    #[arg(long, value_enum, default_value = "auto", global = true, hide = true)]
    color: terminal::Color,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the cases with title, variants, number of claims, default level and solvers.
    List(list::Arguments),
    /// Run cases, judge their claims and write a report.
    Run(run::Arguments),
    /// Judge one solver by the claims that apply to it: a manifest, a built-in solver or a Python function.
    Judge(judge::Arguments),
    /// Write the files of a new solver, case or scene, ready to run.
    #[command(subcommand)]
    Init(init::Command),
    /// Simulate a scene and write its record.
    Simulate(simulate::Arguments),
    /// Write the LAMMPS or LIGGGHTS input for a case or a scene.
    Deck(deck::Arguments),
    /// Judge the output of any program for a case or a scene. Formats: dumps, VTK files, NumPy arrays and CSV tables.
    Check(check::Arguments),
    /// Compute continuum fields cell by cell: packing fraction, stress, friction and shear rate.
    Fields(fields::Arguments),
    /// Compare two outputs column by column.
    Compare(compare::Arguments),
    /// Measure the error of each solver against its computing time.
    Cost(cost::Arguments),
    /// Find the largest stable time step of each solver, and run hard cases.
    Stability(stability::Arguments),
    /// Measure the influence of each physical effect, by switching it off or giving it a neutral value.
    Effects(effects::Arguments),
    /// Compare throughput with LAMMPS and LIGGGHTS, in particle-steps per second of processor time.
    Race(race::Arguments),
    /// Make, verify and update stored runs of other programs and stored results.
    #[command(subcommand)]
    Reference(reference::Command),
    /// Test the conformance properties of solvers: conservation, symmetries, free flight, order and determinism.
    Conform(conform::Arguments),
    /// Print the resolved scene that external solvers get, in SI units, or the schema of scene files.
    Scene(scene::Arguments),
    /// Old spelling of `scene --schema`.
    #[command(hide = true)]
    Schema {
        /// Print the schema of resolved scenes.
        #[arg(long)]
        resolved: bool,
    },
    /// Write the page and figures of a stored report, simulation or plan. No solver runs.
    Report(report::Arguments),
    /// Print the completion script of a shell.
    #[command(hide = true)]
    Completions {
        /// Shell that reads the completion script.
        shell: clap_complete::Shell,
    },
    /// Print the manual page of grainbench, or write one page for each command to a directory.
    #[command(hide = true)]
    Man {
        /// Directory for the pages of all commands. Default: print the page of `grainbench`.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Groups of commands in the help text.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Judge solvers with the cases", &["run", "judge", "conform", "list"]),
    ("Judge output of other programs", &["check", "compare", "deck", "fields"]),
    ("Simulate", &["simulate", "scene", "report"]),
    ("Cost, stability, effects", &["cost", "stability", "effects", "race"]),
    ("Files", &["init", "reference"]),
];

/// Line of the help for the option that every command accepts.
const COLOR: &str = "      --color <auto|always|never>
          Use of colours [default: auto]. By default, `NO_COLOR` turns them off";

/// Returns the command line. Options that make no sense for `judge` are hidden.
fn command_line() -> clap::Command {
    let hide = |judge: clap::Command| {
        judge::HIDDEN.iter().fold(judge, |judge, name| judge.mut_arg(name, |option| option.hide(true)))
    };
    Cli::command().mut_subcommand("judge", hide)
}

/// Returns the command line with a help text that lists the commands by group.
fn grouped() -> clap::Command {
    let command = command_line();
    let is_grouped = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    let line = |subcommand: &clap::Command| {
        format!("  {:<11}{}\n", subcommand.get_name(), subcommand.get_about().unwrap_or_default())
    };
    let mut text = String::new();
    for (task, names) in GROUPS {
        let lines = names.iter().filter_map(|name| command.find_subcommand(name)).map(line);
        text += &format!("{task}:\n{}\n", lines.collect::<String>());
    }
    let others =
        command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set() && !is_grouped(subcommand.get_name()));
    let others: String = others.map(line).collect();
    if !others.is_empty() {
        text += &format!("Others:\n{others}\n");
    }
    let template = format!("{{about-section}}\n{{usage-heading}} {{usage}}\n\n{text}Options:\n{{options}}\n{COLOR}\n");
    command.help_template(template)
}

/// Parses the command line, runs the command and returns its exit code.
pub(crate) fn main() -> ExitCode {
    let arguments = spelling::present(std::env::args_os());
    let command = grouped().color(terminal::choice_in(&arguments));
    let matches = command.get_matches_from(arguments);
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    terminal::choose(cli.color);
    if let Err(reason) = Processor::forced() {
        return Fault::input(reason).report();
    }
    let done = match cli.command {
        Command::List(arguments) => list::list(&arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Judge(arguments) => judge::judge(arguments),
        Command::Init(command) => init::init(&command),
        Command::Simulate(arguments) => simulate::simulate(&arguments),
        Command::Deck(arguments) => deck::deck(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Fields(arguments) => fields::fields(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Cost(arguments) => cost::cost(&arguments),
        Command::Stability(arguments) => stability::stability(&arguments),
        Command::Effects(arguments) => effects::effects(&arguments),
        Command::Race(arguments) => race::race(&arguments),
        Command::Reference(command) => reference::reference(&command),
        Command::Conform(arguments) => conform::conform(&arguments),
        Command::Scene(arguments) => scene::scene(&arguments),
        Command::Schema { resolved } => {
            spelling::say_command("schema", "scene --schema");
            scene::print_schema(if resolved { scene::Schema::Resolved } else { scene::Schema::File })
        }
        Command::Report(arguments) => report::report(&arguments),
        Command::Completions { shell } => completions::completions(shell, command_line()),
        Command::Man { out } => completions::man(out.as_deref(), command_line()),
    };
    done.unwrap_or_else(|fault: Fault| fault.report())
}
