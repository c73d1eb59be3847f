//! `grainbench check`: what any program left of a case, judged.

use super::exit::{Fault, Outcome, RED, check_writable, print};
use super::provenance::provenance;
use super::run::{exit_code, is_judged};
use super::simulate::{path_and_value, positive};
use super::subject::Variant;
use grainbench::check::check as judge;
use grainbench::harness::case::Case;
use grainbench::harness::verdict;
use grainbench::reference::observer::Names;
use grainbench::reference::outputs::{Outputs, Sources};
use grainbench::reports::results::results_json;
use grainbench::reports::{Report, line, write_report};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The case, or one variant of it.
    #[arg(value_name = "CASE|CASE/VARIANT")]
    case: String,
    /// Dumps of grains that follow one another, dumps of their contacts (`dump local`) at the same steps beside them;
    /// or one CSV table; plain, gzip or zstd.
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    dump: Vec<PathBuf>,
    /// The run's log.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Time step in seconds, where neither dump nor log tells it.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    dt: Option<f64>,
    /// What columns are called in the files, such as `x=xu,omegaz=wz`. Of contacts `id1`, `id2`, `force_x` (on the
    /// first), and `tangential_x` where it stands apart; `WALL.force_x` is the force of a wall on a grain, `angle` that
    /// of a disc.
    #[arg(long, value_name = "OURS=THEIRS,…", value_delimiter = ',', value_parser = path_and_value)]
    map: Vec<(String, String)>,
    /// A part of the run is meant: that the files end before it does is amber and not red.
    #[arg(long)]
    partial: bool,
    /// Everything that is not green is red.
    #[arg(long)]
    strict: bool,
    /// Directory for the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Judges and writes the report.
pub(crate) fn check(arguments: &Arguments) -> Outcome {
    let named = Variant::read(&arguments.case)?;
    let start = Instant::now();
    let sources = Sources {
        files: arguments.dump.clone(),
        log: arguments.log.clone(),
        names: Names(arguments.map.clone()),
        time_step: arguments.dt,
        most_rows: Some(most_rows(named.case)?),
    };
    let outputs = Outputs::survey(sources).map_err(Fault::input)?;
    check_writable(&arguments.out)?;
    let section = judge(named.case, named.variant, &outputs, arguments.partial).map_err(Fault::input)?;
    let words = vec!["check".to_owned(), arguments.case.clone(), outputs.name()];
    let report = Report { provenance: provenance(words, start.elapsed().as_secs_f64()), sections: vec![section] };
    write_report(&arguments.out, &report).map_err(Fault::writing)?;
    if arguments.json {
        print(&results_json(&report).map_err(Fault::input)?)?;
    } else {
        print(&format!("{}{}\n", rows(&report), arguments.out.join("index.html").display()))?;
    }
    // That a file reaches the end says nothing of what is in it.
    let mut of_quantities = report.sections.iter().flat_map(|section| section.verdicts.iter().skip(1));
    if of_quantities.any(is_judged) { Ok(exit_code(&report, arguments.strict)) } else { Ok(ExitCode::from(RED)) }
}

/// Most rows that a snapshot of a case can have: a grain has a dozen contacts at most, and walls.
fn most_rows(case: &Case) -> Result<u64, Fault> {
    let mut most = 0;
    for variant in case.variants()? {
        let scene = case.variant(&variant)?;
        most = most.max(scene.grains.len() * (16 + scene.walls.len()));
    }
    Ok(most as u64)
}

/// A line a row, and how many passed.
pub(crate) fn rows(report: &Report) -> String {
    let rows = report.sections.iter().flat_map(|section| &section.verdicts);
    let count = |outcome| rows.clone().filter(|row| row.outcome == outcome).count();
    let (pass, fail) = (count(verdict::Outcome::Pass), count(verdict::Outcome::Fail));
    let amber = rows.clone().count() - pass - fail;
    let mut text = String::new();
    for row in rows {
        text.push_str(&format!("{:<12} {}\n", row.outcome.word(), line::verdict_in_section(row)));
        text.push_str(&format!("{:<12} {}\n", "", row.because));
    }
    text + &format!("{pass} pass, {fail} fail, {amber} amber\n")
}
