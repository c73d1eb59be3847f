//! `grainbench report`: writes a page from stored results.

use super::exit::{Fault, Outcome, exit_code, print, print_text, refuse};
use super::jobs::collect::{CollectOptions, collect, status};
use super::terminal::width;
use super::value::{positive, whole, window};
use grainbench::harness::figure::Figure;
use grainbench::jobs::plan::Plan;
use grainbench::publication::{FORMATS, convert_figures, write_figures};
use grainbench::reports::export::BROKEN_FILE;
use grainbench::reports::export::record_json::{self, RECORD_FILE};
use grainbench::reports::pictures;
use grainbench::reports::plot::style::FigureStyle;
use grainbench::reports::record_figures::{self, FigureOptions, NamedRecord};
use grainbench::reports::report::Report;
use grainbench::reports::store::{REPORT_FILE, named_figures};
use grainbench::reports::study::{self, STUDY_FILE, write_study};
use grainbench::reports::{summary_table_within, write_pictures, write_report};
use grainbench::solver::record::Record;
use grainbench::store::artifact::read_json;
use grainbench::store::refuse_mixed;
use std::borrow::Borrow;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Directory written by `run`, `cost`, `stability`, `effects` or `simulate`, or the directory of a plan.
    dir: PathBuf,
    /// Print the numbers of finished, running and failed tasks of a plan.
    #[arg(long)]
    progress: bool,
    #[command(flatten)]
    collect: CollectOptions,
    /// Further directory written by `simulate`, which is compared with DIR at equal times. Repeatable.
    #[arg(long, value_name = "DIR")]
    beside: Vec<PathBuf>,
    /// Stress f of the photoelastic fringes cos((σ₁ − σ₂)/f) in Pa, for figures of a simulation. Default: about three fringes.
    #[arg(long, value_name = "PA", value_parser = positive, allow_hyphen_values = true)]
    fringe_stress: Option<f64>,
    /// Time interval of the figures in seconds, such as `.2..1`. Each end is optional.
    #[arg(long, value_name = "FROM..TO", value_parser = window, allow_hyphen_values = true)]
    window: Option<(f64, f64)>,
    /// Largest number of frames of a film. Default: 60.
    #[arg(long, value_name = "N", value_parser = whole::<u16>(2, 500))]
    frames: Option<u16>,
    /// Draw the figures again for a publication: `width` in mm, `font_size` in pt, `font`, and `colors` as a
    /// list of `#rrggbb`.
    #[arg(long, value_name = "FILE.toml")]
    style: Option<PathBuf>,
    /// Write each figure also as PDF, or as PNG with 300 pixels in an inch; SVG is always written. Repeatable.
    #[arg(long, value_name = "FORMAT", value_parser = ["svg", "pdf", "png"])]
    figures: Vec<String>,
}

/// Reads a directory and writes its page, figures and result files again. The exit code is that of the stored results.
/// For a plan, makes the report of the finished tasks.
pub(crate) fn report(arguments: &Arguments) -> Outcome {
    if Plan::is_in(&arguments.dir) {
        if arguments.style.is_some() || !arguments.figures.is_empty() {
            let found = "found a plan, whose report is in its own directory";
            refuse!("--style, --figures: expected the directory of a report, {found}");
        }
        return if arguments.progress {
            status(&arguments.dir, arguments.collect.json)
        } else {
            collect(&arguments.dir, &arguments.collect)
        };
    }
    if let Some(option) = arguments.collect.given().or_else(|| arguments.progress.then_some("--progress")) {
        let there = arguments.dir.display();
        refuse!("{option}: expected the directory of a plan, found {there}, which has no plan");
    }
    for dir in std::iter::once(&arguments.dir).chain(&arguments.beside) {
        refuse_mixed(dir).map_err(Fault::input)?;
    }
    let holds = |file: &str| arguments.dir.join(file).is_file();
    if ![RECORD_FILE, BROKEN_FILE, REPORT_FILE, STUDY_FILE].into_iter().any(holds) {
        let found = if arguments.dir.is_dir() { "another" } else { "none" };
        let there = arguments.dir.display();
        refuse!(
            "{there}: expected a directory written by `run`, `cost`, `stability`, `effects` or `simulate`, found \
             {found}"
        );
    }
    let style = arguments.style.as_deref().map(style).transpose()?.unwrap_or_default();
    if (holds(RECORD_FILE) || holds(BROKEN_FILE)) && !holds(REPORT_FILE) && !holds(STUDY_FILE) {
        return publish(arguments, &style, &pictures::named_figures(&pictures(arguments)?));
    }
    let Arguments { beside, fringe_stress, window, frames, .. } = arguments;
    if !beside.is_empty() || fringe_stress.is_some() || window.is_some() || frames.is_some() {
        let there = arguments.dir.display();
        refuse!("{there}: expected {RECORD_FILE} of `simulate` for figures");
    }
    if holds(STUDY_FILE) {
        let study = read_json(&arguments.dir.join(STUDY_FILE))?;
        write_study(&arguments.dir, &study)?;
        publish(arguments, &style, &study::named_figures(&study))?;
        return Ok(exit_code(study.is_red()));
    }
    let report = Report::load(&arguments.dir)?;
    write_report(&arguments.dir, &report, false)?;
    print_text(&format!("{}\n", summary_table_within(&report, width())))?;
    publish(arguments, &style, &named_figures(&report))?;
    Ok(exit_code(!report.passes()))
}

/// Draws figures in a style, converts them to the requested formats and prints the path of the page.
fn publish<F: Borrow<Figure>>(arguments: &Arguments, style: &FigureStyle, figures: &[(String, F)]) -> Outcome {
    let dir = &arguments.dir;
    if arguments.style.is_some() {
        write_figures(dir, figures, style)?;
    }
    for format in FORMATS {
        if arguments.figures.iter().any(|asked| asked == format.0) {
            let names = figures.iter().map(|(name, _)| name.as_str());
            convert_figures(dir, names, format, style.font.as_deref())?;
        }
    }
    print(&format!("{}\n", dir.join("index.html").display()))
}

fn style(path: &Path) -> Result<FigureStyle, Fault> {
    let named = |reason: String| Fault::input(format!("{}: {reason}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| named(error.to_string()))?;
    let style: FigureStyle = toml::from_str(&text).map_err(|error| named(error.to_string()))?;
    match style.wrong() {
        Some((key, expected, found)) => Err(named(format!("{key}: expected {expected}, found {found}"))),
        None => Ok(style),
    }
}

/// Writes and returns the figures of a simulation and of the simulations compared with it.
fn pictures(arguments: &Arguments) -> Result<Vec<Figure>, Fault> {
    let dirs = std::iter::once(&arguments.dir).chain(&arguments.beside);
    let records = dirs.map(|dir| record_json::load(dir)).collect::<Result<Vec<Record>, _>>()?;
    let named: Vec<NamedRecord<'_>> =
        records.iter().map(|record| NamedRecord { name: name(record, &records), record }).collect();
    let &Arguments { fringe_stress: fringe, window, frames, .. } = arguments;
    let shown = FigureOptions { fringe, window, frames: frames.map(usize::from) };
    let figures = record_figures::figures(&named, &shown);
    if figures.is_empty() {
        let file = arguments.dir.join(RECORD_FILE);
        refuse!(
            "{}: expected snapshots or samples of probes, found none (`simulate --write parquet` stores the snapshots \
             of a large run)",
            file.display()
        );
    }
    write_pictures(&arguments.dir, &records.iter().collect::<Vec<_>>(), &figures)?;
    Ok(figures)
}

/// Returns a name that distinguishes a record from all records: empty for a single record, else the solver, or the
/// solver and the resolution.
fn name(record: &Record, all: &[Record]) -> String {
    let from = &record.provenance;
    let alike = all.iter().filter(|other| other.provenance.solver == from.solver).count();
    match (all.len(), alike) {
        (1, _) => String::new(),
        (_, 1) => from.solver.clone(),
        _ => format!("{}, {}", from.solver, from.resolution),
    }
}
