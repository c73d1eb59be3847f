//! What a reader sees first: the counts, what fails, and a row a case.

use grainbench_harness::verdict::Outcome;
use maud::{Markup, html};

use super::{scrolling, sign};
use crate::headline::{self, Headline, OUTCOMES};
use crate::line;
use crate::number;
use crate::report::{Report, Section};

/// More failing lines than this are left to the sections.
const LINES: usize = 12;

/// Renders the head of the page.
pub(crate) fn render(report: &Report, anchors: &[String]) -> Markup {
    let counts = Headline::of_report(report);
    let wrong = counts.fail + counts.broken;
    let cases = report.sections.len();
    html! {
        header id="summary" {
            p.kicker { "grainbench " (report.provenance.version) " · " (report.provenance.date) }
            h1 {
                @if counts.rows() == 0 {
                    "Nothing was judged"
                } @else if wrong > 0 {
                    (wrong) " of " (counts.rows()) " rows " (if wrong == 1 { "fails" } else { "fail" })
                } @else if counts.amber() > 0 {
                    (counts.pass) " of " (counts.rows()) " rows pass, none fails"
                } @else {
                    "All " (counts.rows()) " rows pass"
                }
            }
            p.lead {
                (cases) (if cases == 1 { " case" } else { " cases" })
                " of granular mechanics, each judged against an answer with a stated source and tolerance."
            }
            ul.counts aria-label="Rows by outcome" {
                @for outcome in OUTCOMES {
                    @let count = counts.count(outcome);
                    @let (symbol, class) = sign(outcome);
                    li class={ (class) @if count == 0 { " none" } } {
                        b { (count) }
                        span {
                            (symbol) " " (outcome.word())
                            @if outcome == Outcome::Pass && counts.regression > 0 {
                                ", " (counts.regression) " of them regression"
                            }
                        }
                    }
                }
                li class={ "controls " @if counts.controls_red < counts.controls { "fail" } } {
                    b { (counts.controls_red) " of " (counts.controls) }
                    span {
                        "negative controls turned red"
                        @if counts.controls_broken > 0 { ", " (counts.controls_broken) " by breaking" }
                    }
                }
            }
            (failing(report, anchors))
            (cases_table(report, anchors))
        }
    }
}

fn failing(report: &Report, anchors: &[String]) -> Markup {
    let mut lines = Vec::new();
    for (section, anchor) in report.sections.iter().zip(anchors) {
        for verdict in &section.verdicts {
            if matches!(verdict.outcome, Outcome::Fail | Outcome::Broken) {
                lines.push((anchor, line::verdict(verdict)));
            }
        }
        for control in &section.controls {
            if !control.turned_red {
                lines.push((anchor, line::control(control)));
            }
        }
    }
    let more = lines.len().saturating_sub(LINES);
    html! {
        @if !lines.is_empty() {
            ul.failing aria-label="What fails" {
                @for (anchor, line) in lines.iter().take(LINES) {
                    li { a href={ "#" (anchor) } { (line) } }
                }
                @if more > 0 { li.more { "and " (more) " more in the sections below" } }
            }
        }
    }
}

fn cases_table(report: &Report, anchors: &[String]) -> Markup {
    let table = html! {
        table.cases {
            thead {
                tr {
                    th scope="col" { "Case" }
                    th scope="col" { "Solvers" }
                    th scope="col" { "Rows passed" }
                    th scope="col" { "Worst error, of allowed" }
                    th scope="col" { "Controls red" }
                }
            }
            tbody {
                @for (section, anchor) in report.sections.iter().zip(anchors) { (case_row(section, anchor)) }
            }
        }
    };
    scrolling("Cases", &table)
}

fn case_row(section: &Section, anchor: &str) -> Markup {
    let counts = Headline::of_section(section);
    let wrong = counts.fail + counts.broken;
    let controls = if counts.controls_red < counts.controls { "fail" } else { "" };
    html! {
        tr {
            th scope="row" {
                a href={ "#" (anchor) } { (section.name) }
                span.title { (section.title) }
            }
            td { (headline::solvers(section).join(", ")) }
            td {
                @if counts.rows() == 0 { "—" } @else {
                    span.tally { (counts.pass) " / " (counts.rows()) }
                    @if wrong > 0 { span.mark.fail { "✗ " (wrong) } }
                    @if counts.amber() > 0 { span.mark.amber { "▲ " (counts.amber()) } }
                    @if counts.pass == counts.rows() { span.mark.pass { "✓" } }
                }
            }
            td {
                @if let Some(worst) = headline::worst(section) {
                    @let used = headline::used_tolerance(worst);
                    span.used {
                        // The bar is full at the tolerance; beyond it, colour and number tell.
                        i.bar aria-hidden="true" {
                            i class=(if used > 1.0 { "over" } else { "" })
                                style={ "width:" (format!("{:.0}", 100.0 * used.clamp(0.02, 1.0))) "%" } {}
                        }
                        b { (number::significant(used, 2)) }
                    }
                    span.what { (worst.quantity) ", " (worst.solver) " " (worst.resolution) }
                } @else { "—" }
            }
            td class=(controls) {
                @if counts.controls == 0 { "none" } @else {
                    (counts.controls_red) " of " (counts.controls)
                }
            }
        }
    }
}
