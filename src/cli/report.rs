//! `grainbench report`: a page made again from what a run left.

use super::exit::{Fault, Outcome, print};
use super::run;
use grainbench::reports::report::Report;
use grainbench::reports::study::{STUDY_FILE, load_study, write_study};
use grainbench::reports::{summary_table, write_report};
use std::path::PathBuf;
use std::process::ExitCode;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Directory that a run left.
    dir: PathBuf,
}

/// Reads the report of a directory and writes page, figures and result files again. Ends as the run ended.
pub(crate) fn report(arguments: &Arguments) -> Outcome {
    if arguments.dir.join(STUDY_FILE).is_file() {
        let study = load_study(&arguments.dir).map_err(Fault::input)?;
        write_study(&arguments.dir, &study).map_err(Fault::input)?;
        print(&format!("{}\n", arguments.dir.join("index.html").display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let report = Report::load(&arguments.dir).map_err(Fault::input)?;
    write_report(&arguments.dir, &report).map_err(Fault::input)?;
    print(&format!("{}\n{}\n", summary_table(&report), arguments.dir.join("index.html").display()))?;
    Ok(run::exit_code(&report))
}
