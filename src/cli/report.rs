//! `grainbench report`: a page made from what a run left.

use super::exit::{Fault, Outcome, print};
use super::run;
use super::simulate::positive;
use grainbench::reports::export::BROKEN_FILE;
use grainbench::reports::export::record_json::{self, RECORD_FILE};
use grainbench::reports::record_figures::{self, Named, is_plane};
use grainbench::reports::report::Report;
use grainbench::reports::store::REPORT_FILE;
use grainbench::reports::study::{STUDY_FILE, load_study, write_study};
use grainbench::reports::{refuse_mixed, summary_table, write_pictures, write_report};
use grainbench::scene::record::Record;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Directory that `run`, `cost`, `stability`, `effects` or `simulate` left.
    dir: PathBuf,
    /// Another directory that `simulate` left, shown beside the first at equal times; may be given more than once.
    #[arg(long, value_name = "DIR")]
    beside: Vec<PathBuf>,
    /// Stress c of photoelastic fringes cos((σ₁ − σ₂)/c) in pictures of a simulation; three fringes when absent.
    #[arg(long, value_name = "PA", value_parser = positive, allow_hyphen_values = true)]
    fringe_stress: Option<f64>,
}

/// Reads what stands in a directory and writes page, figures and result files again. Ends as the run ended.
pub(crate) fn report(arguments: &Arguments) -> Outcome {
    let page = format!("{}\n", arguments.dir.join("index.html").display());
    for dir in std::iter::once(&arguments.dir).chain(&arguments.beside) {
        refuse_mixed(dir).map_err(Fault::input)?;
    }
    let holds = |file: &str| arguments.dir.join(file).is_file();
    if (holds(RECORD_FILE) || holds(BROKEN_FILE)) && !holds(REPORT_FILE) && !holds(STUDY_FILE) {
        pictures(arguments)?;
        print(&page)?;
        return Ok(ExitCode::SUCCESS);
    }
    if !arguments.beside.is_empty() || arguments.fringe_stress.is_some() {
        let there = arguments.dir.display();
        return Err(Fault::input(format!(
            "{there}: expected {RECORD_FILE}, which `simulate` leaves, to make pictures of"
        )));
    }
    if holds(STUDY_FILE) {
        let study = load_study(&arguments.dir).map_err(Fault::input)?;
        write_study(&arguments.dir, &study).map_err(Fault::writing)?;
        print(&page)?;
        return Ok(ExitCode::SUCCESS);
    }
    let report = Report::load(&arguments.dir).map_err(Fault::input)?;
    write_report(&arguments.dir, &report).map_err(Fault::writing)?;
    print(&format!("{}\n{page}", summary_table(&report)))?;
    Ok(run::exit_code(&report, false))
}

/// Pictures of a simulation, and of others beside it.
fn pictures(arguments: &Arguments) -> Result<(), Fault> {
    let read = |dir: &Path| {
        let record = record_json::load(dir).map_err(Fault::input)?;
        if is_plane(&record) {
            Ok(record)
        } else {
            let file = dir.join(RECORD_FILE);
            Err(Fault::input(format!("{}: expected snapshots of a plane scene, found others or none", file.display())))
        }
    };
    let dirs = std::iter::once(&arguments.dir).chain(&arguments.beside);
    let records: Vec<Record> = dirs.map(|dir| read(dir)).collect::<Result<_, _>>()?;
    let named: Vec<Named<'_>> = records.iter().map(|record| Named { name: name(record, &records), record }).collect();
    let figures = record_figures::figures(&named, arguments.fringe_stress);
    write_pictures(&arguments.dir, &records.iter().collect::<Vec<_>>(), &figures).map_err(Fault::writing)
}

/// What tells a record from the others: nothing, the solver, or solver and resolution.
fn name(record: &Record, all: &[Record]) -> String {
    let from = &record.provenance;
    let alike = all.iter().filter(|other| other.provenance.solver == from.solver).count();
    match (all.len(), alike) {
        (1, _) => String::new(),
        (_, 1) => from.solver.clone(),
        _ => format!("{}, {}", from.solver, from.resolution),
    }
}
