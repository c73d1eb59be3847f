//! Output of commands: files and text of a report, and the exit code.

use super::exit::{Fault, Outcome, exit_code, print, print_text};
use super::terminal::width;
use grainbench::reports::github::{annotations, summary};
use grainbench::reports::results::results_json;
use grainbench::reports::study::{Study, study_json, write_study};
use grainbench::reports::terminal::failing_lines;
use grainbench::reports::{Headline, Report, summary_table_within, write_report};
use grainbench::store::StagedDir;
use std::env;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Options for the report of `check`, `compare` and `conform`.
#[derive(Clone, clap::Args)]
pub(crate) struct ReportArguments {
    /// Treat amber results as red.
    #[arg(long)]
    strict: bool,
    /// Directory of the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

impl ReportArguments {
    /// Writes and prints a report, and returns the exit code. If `is_mute` is true, nothing was judged. The default of `text`
    /// is the summary of the results.
    pub(crate) fn publish(&self, mut report: Report, is_mute: bool, text: Option<String>) -> Outcome {
        add_reasons(&mut report, is_mute, self.strict);
        publish(&report, &Output { text, ..Output::new(&self.out, self.json) })
    }
}

/// Directory and form of a report.
pub(crate) struct Output<'a> {
    pub(crate) out: &'a Path,
    /// True to write `rows.parquet` in addition to `rows.csv`.
    pub(crate) parquet: bool,
    /// True to print the results as JSON instead of text.
    pub(crate) json: bool,
    /// True to print only the counts and the failed results.
    pub(crate) quiet: bool,
    /// Text that is printed before the path of the page. Default: the summary of the results.
    pub(crate) text: Option<String>,
}

impl<'a> Output<'a> {
    pub(crate) const fn new(out: &'a Path, json: bool) -> Self {
        Self { out, json, parquet: false, quiet: false, text: None }
    }
}

/// Writes files to a directory, all or none.
pub(crate) fn write_files<N: AsRef<Path>, B: AsRef<[u8]>>(mut out: StagedDir, files: &[(N, B)]) -> Result<(), Fault> {
    files.iter().try_for_each(|(name, bytes)| out.write(name, bytes))?;
    Ok(out.commit()?)
}

/// Writes and prints a report, and returns the exit code.
pub(crate) fn publish(report: &Report, output: &Output<'_>) -> Outcome {
    write_report(output.out, report, output.parquet)?;
    if output.json {
        print(&results_json(report)?)?;
    } else if output.quiet {
        let failing: String = failing_lines(report).into_iter().map(|line| line + "\n").collect();
        print_text(&format!("{failing}{}\n", Headline::of_report(report).sentence()))?;
    } else {
        let text = output.text.clone().unwrap_or_else(|| format!("{}\n", summary_table_within(report, width())));
        print_text(&text)?;
        print(&format!("{}\n", output.out.join("index.html").display()))?;
    }
    tell_github(report, output.json)?;
    Ok(exit_code(!report.passes()))
}

/// In GitHub Actions, appends to the job summary and prints annotations. If the standard output is JSON, no annotations are
/// printed.
fn tell_github(report: &Report, is_json: bool) -> Result<(), Fault> {
    if let Some(path) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) {
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let written = file.and_then(|mut file| file.write_all(summary(report).as_bytes()));
        written.map_err(|error| Fault::input(format!("GITHUB_STEP_SUMMARY: {}: {error}", path.display())))?;
    }
    if !is_json && env::var_os("GITHUB_ACTIONS").is_some_and(|set| set == "true") {
        for line in annotations(report) {
            print(&(line + "\n"))?;
        }
    }
    Ok(())
}

/// Writes and prints a study, and returns the exit code.
pub(crate) fn publish_study(study: &Study, output: Output<'_>) -> Outcome {
    write_study(output.out, study)?;
    if output.json {
        print(&study_json(study)?)?;
    } else {
        print_text(&output.text.unwrap_or_else(|| study.text()))?;
        print(&format!("{}\n", output.out.join("index.html").display()))?;
    }
    Ok(exit_code(study.is_red()))
}

/// Adds reasons why a report is red although no result is red: nothing was judged, or amber results count as red.
pub(crate) fn add_reasons(report: &mut Report, is_mute: bool, strict: bool) {
    if is_mute || !report.verdicts().any(|row| row.outcome.is_judged()) {
        let reason = report.verdicts().find_map(|row| row.detail.clone());
        let reason = reason.unwrap_or_else(|| "no result describes its quantity".to_owned());
        report.red_because.push(format!("nothing judged: {reason}"));
    }
    let amber = Headline::of_report(report).amber();
    if strict && amber > 0 {
        report.red_because.push(format!("strict: {amber} amber"));
    }
}
