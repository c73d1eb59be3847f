//! Results of external solvers beside ours, from the last stored run of each solver.

use grainbench_harness::verdict::Verdict;
use maud::{Markup, html};

use crate::headline::{self, Headline};
use crate::judged::{self, ExternalResults};
use crate::number;
use crate::report::Report;
use crate::row;
use crate::table::{Column, Columns, Table};

/// Renders the section; it is empty if there are no external solvers.
pub(crate) fn render(report: &Report) -> Markup {
    let judged = &report.judged;
    html! {
        @if !judged.is_empty() {
            section id="peers" {
                h2 { "External solvers" }
                p.claim {
                    "Results of external programs (SOLVER.toml) for the solver-independent claims, each with its \
                     negative control. The first table states where and when the programs ran. They did not run for \
                     this report."
                }
                (programs(judged).page("cases"))
                p.note {
                    "For each case the table shows the largest error / tolerance, and passed / applicable results. \
                     Other results are unsupported. The second column shows the largest error / tolerance of the same \
                     claims with our solvers, if this run evaluated them."
                }
                (by_case(report).page("cases"))
            }
        }
    }
}

fn programs(judged: &[ExternalResults]) -> Table<'_> {
    let columns = ["Rows passed", "Controls red", "Judged", "On"].map(Column::text);
    let row = |results: &ExternalResults| {
        let count = results.count(None);
        row![
            html! { (results.program) span.title { (results.version) } },
            tally(count),
            format!("{} of {}", count.controls_red, count.controls),
            format!("{}, commit {}", results.provenance.day(), results.provenance.commit),
            &results.provenance.machine
        ]
    };
    let columns = [Column::heading("Program")].into_iter().chain(columns);
    Table::new("Programs", columns, judged.iter().map(row))
}

fn tally(count: Headline) -> Markup {
    html! {
        span.tally { (count.pass()) " / " (count.rows()) }
        @if count.red() > 0 { span.mark.fail { "✗ " (count.red()) } }
        @if count.amber() > 0 { span.mark.amber { "▲ " (count.amber()) } }
    }
}

fn by_case(report: &Report) -> Table<'_> {
    let worst = |case| ours(report, case).map(|worst| number::significant(worst, 2));
    let columns = Columns::<&str>::new(Column::heading("Case"), |case| case).and(Column::text("ours"), worst);
    let columns = report.judged.iter().fold(columns, |columns, results| {
        columns.and(Column::text(&results.program), |case| cell(results.count(Some(case)), results.worst(case)))
    });
    columns.table("Programs by case", judged::cases(&report.judged), |_| "")
}

fn cell(count: Headline, worst: Option<f64>) -> Markup {
    html! {
        @if let Some(worst) = worst { (number::significant(worst, 2)) " · " } @else if count.red() == 0 { "— " }
        @if count.conclusive() > 0 { (count.pass()) "/" (count.rows()) }
        @if count.red() > 0 { " " span.mark.fail { "✗ " (count.red()) } }
    }
}

/// Returns the largest |error|/allowed of our results that external solvers also have.
fn ours(report: &Report, case: &str) -> Option<f64> {
    let asked = report.judged.iter().flat_map(|results| &results.rows).map(|row| &row.result);
    let asked = asked.filter(|row| row.case == case);
    let is_asked = |row: &&Verdict| {
        asked.clone().any(|theirs| {
            (&theirs.variant, &theirs.quantity, &theirs.resolution) == (&row.variant, &row.quantity, &row.resolution)
        })
    };
    let section = report.sections.iter().find(|section| section.name == case)?;
    headline::worst(section.verdicts.iter().filter(is_asked)).map(headline::used_tolerance)
}
