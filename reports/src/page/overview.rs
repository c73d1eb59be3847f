//! Top of the page: counts, failures, one card per solver, the matrix of cases and solvers, and the cost of accuracy.

use maud::{Markup, PreEscaped, html};

use super::{cards, matrix, sign, summary};
use crate::headline::{Headline, OUTCOMES};
use crate::report::Report;
use grainbench_harness::verdict::Outcome;

/// Renders the top of the page; `is_there` returns true if the page has an anchor for a result.
///
/// `counts` are the counts of all results; `report` holds only the results that are shown.
pub(crate) fn render(report: &Report, counts: Headline, anchors: &[String], is_there: &dyn Fn(&str) -> bool) -> Markup {
    let shown = Headline::of_report(report).rows();
    let wrong = counts.red();
    let cases = report.sections.len();
    let costs = report.measured.cost.as_ref();
    html! {
        header id="summary" {
            p.kicker {
                "grainbench " (report.provenance.version) " · " (report.provenance.date)
                " · commit " (report.provenance.commit)
            }
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
            @if shown < counts.rows() {
                p.back { "This page shows " (shown) " of " (counts.rows()) " results." }
            }
            ul.counts aria-label="Rows by outcome" {
                li { (cases) (if cases == 1 { " case" } else { " cases" }) }
                @for outcome in OUTCOMES {
                    @let count = counts.count(outcome);
                    @let (symbol, class) = sign(outcome);
                    @if count > 0 || matches!(outcome, Outcome::Pass | Outcome::Fail) {
                        li class={ (class) @if count == 0 { " none" } } {
                            b { (count) } " "
                            span {
                                (symbol) " " (outcome.word())
                                @if outcome == Outcome::Pass && counts.regression > 0 {
                                    ", " (counts.regression) " of them regression"
                                }
                            }
                        }
                    }
                }
                li class={ "controls " @if counts.controls_red < counts.controls { "fail" } } {
                    b { (counts.controls_red) " of " (counts.controls) } " "
                    span {
                        "negative controls turned red"
                        @if counts.controls_broken > 0 { ", " (counts.controls_broken) " by breaking" }
                    }
                }
            }
            (summary::failing(report, anchors))
        }
        (tools())
        (cards::render(report, anchors, is_there))
        div.overview {
            (matrix::render(report, anchors))
            @if let Some(costs) = costs {
                div {
                    h2 id="costs" { "What accuracy costs" }
                    div.plot.small { (PreEscaped(summary::picture(costs))) }
                    (summary::factors(costs))
                }
            }
        }
    }
}

/// Renders search and filters, which need the script. They are hidden until it runs.
fn tools() -> Markup {
    html! {
        div.tools id="tools" hidden {
            input id="search" type="search" placeholder="Search rows ( / )" aria-label="Search rows";
            @for kind in ["solver", "case", "source", "outcome", "evidence"] {
                select id={ "by-" (kind) } aria-label={ "Only this " (kind) } { option value="" { "any " (kind) } }
            }
            button id="clear" type="button" { "Clear" }
        }
        div.found id="found" hidden aria-live="polite" {}
    }
}
