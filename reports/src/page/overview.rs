//! Contents and first screen of the page: counts, failures, three questions, one card per solver, and the matrix of
//! cases and solvers.

use maud::{Markup, PreEscaped, html};

use super::{cards, matrix, questions, sign, summary};
use crate::headline::{Headline, OUTCOMES};
use crate::report::Report;
use grainbench_harness::verdict::{Outcome, Severity};

/// Renders the first screen. `has_rows` returns true if the page contains the results of a case. `counts` counts all
/// results, and `report` contains only the results that are shown.
pub(crate) fn render(report: &Report, counts: Headline, anchors: &[String], has_rows: &dyn Fn(&str) -> bool) -> Markup {
    let shown = Headline::of_report(report).rows();
    let cases = report.sections.len();
    let external = report.judged.iter().flat_map(|results| &results.rows).map(|row| row.result.outcome);
    let external = external.filter(|outcome| outcome.is_judged());
    let external = external.fold((0, 0), |(red, all), outcome| (red + usize::from(outcome.is_red()), all + 1));
    html! {
        header id="summary" {
            p.kicker {
                "grainbench " (report.provenance.version) " · " (report.provenance.date)
                " · commit " (report.provenance.commit) " · " (cases) (if cases == 1 { " case" } else { " cases" })
            }
            h1 { (headline(counts)) }
            @if shown < counts.rows() {
                p.back { "This page shows " (shown) " of " (counts.rows()) " results." }
            }
            ul.counts aria-label="Results that are not green, by outcome and solver" {
                @for outcome in OUTCOMES.into_iter().filter(|outcome| outcome.severity() != Severity::Green) {
                    @let (symbol, class) = sign(outcome);
                    @if counts.count(outcome) > 0 {
                        li class=(class) {
                            a href="#matrix" title=(meaning(outcome)) data-outcome=(outcome.word()) {
                                b { (counts.count(outcome)) } " "
                                span { (symbol) " " (outcome.word()) }
                            }
                            (by_solver(report, outcome))
                        }
                    }
                }
                @if counts.regression > 0 {
                    @let verb = if counts.regression == 1 { "is" } else { "are" };
                    li { b { (counts.regression) } " of the passed results " (verb) " compared only with earlier values" }
                }
                @if external.0 > 0 {
                    li {
                        b { (external.0) } " of " (external.1) " results of " a href="#peers" { "external solvers" } " fail"
                    }
                }
                @if counts.controls_broken > 0 { li { b { (counts.controls_broken) } " controls failed by an error" } }
            }
            (summary::failing(report, anchors))
        }
        (questions::render(report, &matrix::by_physics(report)))
        (cards::render(report, anchors, has_rows))
        (tools())
        div.overview {
            (matrix::render(report, anchors))
            @if let Some(costs) = &report.measured.cost {
                div {
                    h2 id="costs" { "What accuracy costs" }
                    div.plot.small { (PreEscaped(summary::picture(costs))) }
                    (summary::factors(costs))
                }
            }
        }
    }
}

/// Renders the table of contents, which stays visible while the page scrolls. Each case shows its number of red or amber
/// results.
pub(crate) fn contents(report: &Report, anchors: &[String]) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            details open {
                summary { "Contents" }
                ul {
                    li { a href="#summary" { "Summary" } }
                    @for (id, heading, _) in questions::stored(&report.measured) { li { a href={ "#" (id) } { (heading) } } }
                    @for (section, anchor) in report.sections.iter().zip(anchors) {
                        @let counts = Headline::of_section(section);
                        @let wrong = counts.red();
                        li {
                            a href={ "#" (anchor) } data-case=(section.name) {
                                @if wrong > 0 { span.n.fail { "✗ " (wrong) } }
                                @else if counts.amber() > 0 {
                                    span.n.amber title={ (counts.amber()) " amber results" } { "▲ " (counts.amber()) }
                                }
                                (section.name)
                            }
                        }
                    }
                    @if !report.judged.is_empty() { li { a href="#peers" { "External solvers" } } }
                    li { a href="#provenance" { "Provenance" } }
                }
            }
            button #theme type="button" hidden { "Dark or light" }
        }
    }
}

/// Returns the meaning of an outcome. The page shows it beside the results with this outcome.
const fn meaning(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Pass => "the error is within the tolerance",
        Outcome::Fail => "the error is larger than the tolerance",
        Outcome::Broken => "the run ended with an error",
        Outcome::Stale => "the reference belongs to another scene",
        Outcome::Known => "a documented error of the method or program",
        Outcome::Outdated => "a stored result passes, but older solver sources made it",
        Outcome::NoReference => "there is no reference, or the tolerance is too large for a conclusion",
        Outcome::Unsupported => "the solver cannot represent the scene",
        Outcome::NotAvailable => "the program is not installed, or third-party data are missing",
    }
}

fn headline(counts: Headline) -> String {
    if counts.rows() == 0 {
        return "Nothing was judged".to_owned();
    }
    let colour = |count: usize, word: &str| match count {
        0 => format!("no result is {word}"),
        1 => format!("1 is {word}"),
        _ => format!("{count} are {word}"),
    };
    let [red, amber] = [colour(counts.red(), "red"), colour(counts.amber(), "amber")];
    let results = format!("{} of {} results pass, {red}, {amber}", counts.pass(), counts.rows());
    match counts.controls {
        0 => results,
        controls => format!("{results}; {} of {controls} negative controls fail as they must", counts.controls_red),
    }
}

/// Renders the number of known errors of each solver; empty for an outcome other than `known`.
fn by_solver(report: &Report, outcome: Outcome) -> Markup {
    let count = |solver: &str| cards::rows(report, solver).filter(|row| row.outcome == outcome).count();
    let counts = cards::solvers(report).into_iter().map(|solver| (solver, count(solver)));
    let counts: Vec<(&str, usize)> = counts.filter(|(_, count)| *count > 0 && outcome == Outcome::Known).collect();
    html! {
        @if !counts.is_empty() {
            " errors: "
            @for (at, (solver, count)) in counts.into_iter().enumerate() {
                @if at > 0 { ", " }
                a href="#matrix" title=[cards::meaning(solver)] data-solver=(solver) data-outcome=(outcome.word()) {
                    (solver)
                }
                " " (count)
            }
        }
    }
}

/// Renders the search field and the filters. They need the script, and stay hidden until it runs.
fn tools() -> Markup {
    html! {
        div.tools id="tools" hidden {
            input id="search" type="search" placeholder="Search rows ( / )" title="Enter: first hit" aria-label="Search rows";
            @for kind in ["solver", "case", "source", "outcome", "evidence"] {
                select id={ "by-" (kind) } aria-label={ "Only this " (kind) } { option value="" { "any " (kind) } }
            }
            button id="clear" type="button" { "Clear" }
        }
        div.found id="found" hidden aria-live="polite" {}
    }
}
