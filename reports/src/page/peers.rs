//! Results of external solvers beside ours, from the last stored run of each solver.

use grainbench_harness::verdict::{Outcome, Verdict};
use maud::{Markup, html};

use super::scrolling;
use crate::headline;
use crate::judged::{self, Count, ExternalResults, Row};
use crate::number;
use crate::report::Report;

/// Renders the section; it is empty if there are no external solvers.
pub(crate) fn render(report: &Report) -> Markup {
    let judged = &report.judged;
    html! {
        @if !judged.is_empty() {
            section id="peers" {
                h2 { "External solvers" }
                p.claim {
                    "Results of external programs (SOLVER.toml) for the solver-independent claims, each with its "
                    "negative control. The first table states where and when the programs ran. They did not run for \
                     this report."
                }
                (scrolling("Programs", &programs(judged)))
                p.note {
                    "For each case the table shows the largest error / tolerance, and passed / applicable results. \
                     Other results are unsupported. "
                    "The second column shows the largest error / tolerance of the same claims with our solvers, if \
                     this run "
                    "evaluated them."
                }
                (scrolling("Programs by case", &by_case(report)))
            }
        }
    }
}

fn programs(judged: &[ExternalResults]) -> Markup {
    html! {
        table.cases {
            thead {
                tr {
                    th scope="col" { "Program" }
                    th scope="col" { "Rows passed" }
                    th scope="col" { "Controls red" }
                    th scope="col" { "Judged" }
                    th scope="col" { "On" }
                }
            }
            tbody {
                @for results in judged {
                    @let count = results.count(None);
                    tr {
                        th scope="row" { (results.program) span.title { (results.version) } }
                        td { (tally(&count)) }
                        td { (count.controls_red) " of " (count.controls) }
                        td { (results.day()) ", commit " (results.provenance.commit) }
                        td { (results.provenance.machine) }
                    }
                }
            }
        }
    }
}

fn tally(count: &Count) -> Markup {
    html! {
        span.tally { (count.pass) " / " (count.pass + count.red + count.amber) }
        @if count.red > 0 { span.mark.fail { "✗ " (count.red) } }
        @if count.amber > 0 { span.mark.amber { "▲ " (count.amber) } }
    }
}

fn by_case(report: &Report) -> Markup {
    html! {
        table.cases {
            thead {
                tr {
                    th scope="col" { "Case" }
                    th scope="col" { "ours" }
                    @for results in &report.judged { th scope="col" { (results.program) } }
                }
            }
            tbody {
                @for case in judged::cases(&report.judged) {
                    tr {
                        th scope="row" { (case) }
                        td { @if let Some(worst) = ours(report, case) { (number::significant(worst, 2)) } @else { "—" } }
                        @for results in &report.judged { (cell(&results.count(Some(case)))) }
                    }
                }
            }
        }
    }
}

fn cell(count: &Count) -> Markup {
    html! {
        td {
            @if let Some(worst) = count.worst { (number::significant(worst, 2)) " · " } @else if count.red == 0 { "— " }
            @if count.pass + count.red > 0 { (count.pass) "/" (count.pass + count.red + count.amber) }
            @if count.red > 0 { " " span.mark.fail { "✗ " (count.red) } }
        }
    }
}

/// Returns the largest |error|/allowed of our results in a case, over the quantities and resolutions that external
/// solvers also have.
fn ours(report: &Report, case: &str) -> Option<f64> {
    let asked = report.judged.iter().flat_map(|results| &results.rows).filter(|row| row.case == case);
    let is_asked = |row: &&Verdict| {
        let is_judged = matches!(row.outcome, Outcome::Pass | Outcome::Fail);
        let is_it = |theirs: &Row| {
            (&theirs.variant, &theirs.quantity, &theirs.resolution) == (&row.variant, &row.quantity, &row.resolution)
        };
        is_judged && asked.clone().any(is_it)
    };
    let section = report.sections.iter().find(|section| section.name == case)?;
    section.verdicts.iter().filter(is_asked).map(headline::used_tolerance).reduce(f64::max)
}
