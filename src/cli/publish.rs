//! Output of the commands: files and text of a report, and the exit code.

use super::exit::{Fault, Outcome, RED, print};
use super::github;
use grainbench::harness::verdict::{self, Severity, Verdict};
use grainbench::reports::results::results_json;
use grainbench::reports::study::{Study, study_json, write_study};
use grainbench::reports::terminal::failing_lines;
use grainbench::reports::{Headline, Report, summary_table, write_report, write_report_and_parquet};
use std::path::Path;
use std::process::ExitCode;

/// Place and form of a report.
pub(crate) struct Output<'a> {
    pub(crate) out: &'a Path,
    /// True to write `rows.parquet` in addition to `rows.csv`.
    pub(crate) parquet: bool,
    /// True to print the results as JSON instead of text.
    pub(crate) json: bool,
    /// True to print only the counts and the failed results.
    pub(crate) quiet: bool,
    /// Text to print before the place of the page; by default the summary.
    pub(crate) text: Option<String>,
    /// True to treat amber results as red.
    pub(crate) strict: bool,
}

impl<'a> Output<'a> {
    pub(crate) const fn new(out: &'a Path, json: bool, strict: bool) -> Self {
        Self { out, json, strict, parquet: false, quiet: false, text: None }
    }
}

/// Writes and prints a report. Returns its exit code.
pub(crate) fn publish(report: &Report, output: &Output<'_>) -> Outcome {
    let write = if output.parquet { write_report_and_parquet } else { write_report };
    write(output.out, report).map_err(Fault::writing)?;
    if output.json {
        print(&results_json(report).map_err(Fault::input)?)?;
    } else if output.quiet {
        print(&quiet_text(report))?;
    } else {
        let text = output.text.clone().unwrap_or_else(|| format!("{}\n", summary_table(report)));
        print(&format!("{text}{}\n", output.out.join("index.html").display()))?;
    }
    github::tell(report, output.json)?;
    Ok(exit_code(report, output.strict))
}

/// Writes and prints a study. Returns its exit code.
pub(crate) fn publish_study(study: &Study, output: Output<'_>, is_red: bool) -> Outcome {
    write_study(output.out, study).map_err(Fault::writing)?;
    if output.json {
        print(&study_json(study).map_err(Fault::input)?)?;
    } else {
        print(&format!("{}{}\n", output.text.unwrap_or_default(), output.out.join("index.html").display()))?;
    }
    Ok(if is_red { ExitCode::from(RED) } else { ExitCode::SUCCESS })
}

/// Adds the reasons why a run is red although no result is: nothing was judged, or amber results count as red.
pub(crate) fn add_reasons(report: &mut Report, is_mute: bool, strict: bool) {
    if is_mute {
        let mut rows = report.sections.iter().flat_map(|section| &section.verdicts);
        let reason = rows.find_map(|row| row.detail.clone());
        let reason = reason.unwrap_or_else(|| "no result describes its quantity".to_owned());
        report.red_because.push(format!("nothing judged: {reason}"));
    }
    let amber = Headline::of_report(report).amber();
    if strict && amber > 0 {
        report.red_because.push(format!("strict: {amber} amber"));
    }
}

/// Returns the failed rows and the counts.
fn quiet_text(report: &Report) -> String {
    let failing: String = failing_lines(report).into_iter().map(|line| line + "\n").collect();
    format!("{failing}{}\n", Headline::of_report(report).sentence())
}

/// Returns success, or red if a result is red, a control stayed green, nothing was evaluated, or the report states
/// another reason. With `strict`, amber results are red too.
pub(crate) fn exit_code(report: &Report, strict: bool) -> ExitCode {
    let least = if strict { Severity::Amber } else { Severity::Red };
    let red_row = |verdict: &Verdict| verdict.outcome.severity() >= least;
    let rows = || report.sections.iter().flat_map(|section| &section.verdicts);
    let mut controls = report.sections.iter().flat_map(|section| &section.controls);
    let is_red = !report.red_because.is_empty()
        || rows().any(red_row)
        || !rows().any(is_judged)
        || controls.any(|control| !control.turned_red);
    if is_red { ExitCode::from(RED) } else { ExitCode::SUCCESS }
}

/// Returns true if the outcome is a statement about the solver. An unsupported scene is one, and a missing solver is
/// not.
pub(crate) const fn is_judged(verdict: &Verdict) -> bool {
    use verdict::Outcome::{Broken, Fail, Known, Outdated, Pass, Unsupported};
    matches!(verdict.outcome, Pass | Fail | Known | Outdated | Unsupported | Broken)
}

/// Returns true if no result is a statement about the measured quantity. Here, an unsupported scene does not count.
pub(crate) fn says_nothing(report: &Report) -> bool {
    let mut rows = report.sections.iter().flat_map(|section| &section.verdicts);
    rows.all(|row| row.outcome == verdict::Outcome::Unsupported || !is_judged(row))
}
