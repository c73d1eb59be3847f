//! What fails, and what accuracy costs over all cases.

use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::verdict::Outcome;
use maud::{Markup, html};

use crate::line;
use crate::measured::{Costs, Factor, TARGETS};
use crate::number;
use crate::report::Report;

/// More failing lines than this are left to the sections.
const LINES: usize = 12;
/// Errors and times outside of these are not drawn in the picture over all cases.
const LEAST: f64 = 1e-10;

/// What fails, a line each.
pub(crate) fn failing(report: &Report, anchors: &[String]) -> Markup {
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

/// Error against time over all cases.
pub(crate) fn picture(costs: &Costs) -> Figure {
    let mut curves = Vec::new();
    for line in &costs.lines {
        let means =
            line.factors.iter().zip(TARGETS).filter_map(|(factor, target)| Some((factor.as_ref()?.place, target)));
        let old = if costs.stamp.is_old(&line.solver) { " (changed since)" } else { "" };
        curves.push(Curve::new(format!("{}{old}", line.solver), Stroke::MarkedLine, means.collect()));
        let points = line.points.iter().copied().filter(|(_, error)| *error >= LEAST).collect();
        curves.push(Curve::new("", Stroke::Beside, points));
    }
    Figure::graph(
        "what-accuracy-costs",
        "Error against time, over all cases",
        "",
        [Axis::log("time over the cheapest solver's at 1 %"), Axis::log("|error|")],
        curves,
    )
}

/// The factors in a table, and how they were made.
pub(crate) fn factors(costs: &Costs) -> Markup {
    let stamp = &costs.stamp;
    html! {
        p.note {
            "Filled: geometric mean over the quantities in which a solver reaches 10, 1 and .1 %. Hollow: every setting that no other "
            "of its settings beats, errors below 10⁻¹⁰ left out. Times are of the stepping loop."
        }
        table {
            thead {
                tr {
                    th scope="col" { "× the cheapest" }
                    @for target in TARGETS { th.n scope="col" { (number::fraction(target)) } }
                }
            }
            tbody {
                @for line in &costs.lines {
                    tr class=[stamp.is_old(&line.solver).then_some("old")] {
                        th scope="row" { (line.solver) span.fine { (line.asked) " of " (costs.quantities) " asked" } }
                        @for factor in &line.factors {
                            td.n { @if let Some(factor) = factor { (cell(factor)) } @else { "not reached" } }
                        }
                    }
                }
            }
        }
        p.note {
            "Measured " (stamp.day()) " on " (stamp.provenance.machine) ", commit " (stamp.provenance.commit) ", and not by this run. "
            @if !stamp.changed.is_empty() {
                "Hatched: the sources of " (stamp.changed.join(", ")) " have changed since, or are not known to be the same. "
            }
            code { "grainbench cost --keep" } " measures them again."
        }
    }
}

fn cell(factor: &Factor) -> Markup {
    let [least, largest] = factor.seconds.map(number::seconds);
    html! {
        "× " (number::significant(factor.times, 2)) " (" (factor.reached) ")"
        span.fine { (least) " … " (largest) }
        @if let Some((times, count)) = factor.over_dem {
            span.fine { "× " (number::significant(times, 2)) " dem (" (count) ")" }
        }
    }
}
