//! Failures, and computing cost of accuracy over all cases.

use grainbench_harness::figure::{Axis, Curve, Graph, Stroke};
use maud::{Markup, html};

use crate::line;
use crate::measured::{Costs, Factor, Line};
use crate::number;
use crate::plot;
use crate::plot::graph::{self, Form};
use crate::report::Report;
use crate::study::cost::TARGETS;
use crate::table::{Cell, Column, Row, Table};

/// Largest number of failures on the first screen.
const LINES: usize = 6;
/// Smallest error that the figure over all cases shows.
const LEAST: f64 = 1e-10;

pub(crate) fn failing(report: &Report, anchors: &[String]) -> Markup {
    let failures = report.sections.iter().zip(anchors).flat_map(|(section, anchor)| {
        section.failures(line::verdict, line::control).map(move |(_, line)| (anchor, line))
    });
    let lines: Vec<_> = failures.collect();
    let more = lines.len().saturating_sub(LINES);
    html! {
        @if !lines.is_empty() || !report.red_because.is_empty() {
            ul.failing aria-label="What fails" {
                @for reason in &report.red_because { li { (reason) } }
                @for (anchor, line) in lines.iter().take(LINES) {
                    li { a href={ "#" (anchor) } { (line) } }
                }
                @if more > 0 { li.more { "and " (more) " more in the sections below" } }
            }
        }
    }
}

/// Returns the graph of error against time over all cases. The table of factors is its legend.
fn over_cases(costs: &Costs) -> Graph {
    let points = |line: &Line| line.points.iter().copied().filter(|(_, error)| *error >= LEAST).collect::<Vec<_>>();
    // The points of each solver follow its line and have the style of the line.
    let curves = costs.lines.iter().flat_map(|line| {
        let means = line.factors.iter().zip(TARGETS);
        let means = means.filter_map(|(factor, target)| Some((factor.as_ref()?.place?, target)));
        let means = Curve::new(line.solver.clone(), Stroke::MarkedLine, means.collect());
        [means, Curve::new("", Stroke::Beside, points(line))]
    });
    let curves = curves.collect();
    Graph { x: Axis::log("time / least time for 1 % error"), y: Axis::log("|error| / scale"), curves }
}

/// Returns the figure of error against time over all cases as SVG.
pub(crate) fn picture(costs: &Costs) -> String {
    let form = Form { width: 560.0, height: 470.0, legend: false };
    plot::markup(&graph::draw_as("Error against time, over all cases", &over_cases(costs), form))
}

/// Renders the table of factors, and a note with their definition.
pub(crate) fn factors(costs: &Costs) -> Markup {
    let stamp = &costs.stamp;
    let graph = over_cases(costs);
    let columns = [Column::heading("Time over the cheapest at the same error")].into_iter();
    let columns = columns.chain(TARGETS.map(|target| Column::number(number::fraction(target))));
    let row = |(line, (_, key)): (&Line, _)| {
        let factors = line.factors.iter().map(|factor| Cell::from(cell(factor.as_ref(), line.asked)));
        let cells = [Cell::from(html! { (key) " " (line.solver) })].into_iter().chain(factors);
        cells.collect::<Row>().class(if stamp.is_old(&line.solver) { "old" } else { "" })
    };
    html! {
        (Table::new("", columns, costs.lines.iter().zip(graph::keys(&graph)).map(row)).page(""))
        (over_dem(costs))
        p.note {
            "The table shows the geometric mean over the target quantities for which the solver and at least one more \
             solver reach the error, and below it the number of quantities for which the solver reaches the error. \
             The figure shows times divided by the time of the cheapest solver at 1 %. Joined markers are errors of \
             10, 1 and 0.1 %. Small markers are settings for which no other setting of this solver is both faster and \
             more accurate. Errors below 10⁻¹⁰ are omitted. Times are those of the stepping loop. Measured " "
            "(stamp.provenance.day()) " on " (stamp.provenance.machine) ", commit " (stamp.provenance.commit)
            "; " code { "grainbench cost --update-stored" } " repeats the measurement, also for the report of all \
                 cases."
            @if !stamp.changed.is_empty() {
                " A dotted line marks measurements of older sources: " (stamp.changed.join(", "))
                " changed since then, or it is unknown if they changed."
            }
        }
    }
}

fn cell(factor: Option<&Factor>, asked: usize) -> Markup {
    html! {
        @match factor {
            Some(factor) if factor.compared > 0 => { "× " (number::significant(factor.times, 2)) }
            Some(_) => "alone",
            None => "—",
        }
        span.fine { (factor.map_or(0, |factor| factor.reached)) " of " (asked) }
    }
}

/// Renders the cost of `mpm` divided by the cost of `dem`, for each error that both reach.
fn over_dem(costs: &Costs) -> Markup {
    let Some(line) = costs.lines.iter().find(|line| line.solver == "mpm") else { return html! {} };
    let part = |(factor, target): (&Option<Factor>, f64)| {
        let (times, count) = factor.as_ref()?.over_dem?;
        Some(format!("at {} × {} ({count} quantities)", number::fraction(target), number::significant(times, 2)))
    };
    let parts: Vec<String> = line.factors.iter().zip(TARGETS).filter_map(part).collect();
    html! { @if !parts.is_empty() { p { b { "mpm / dem" } ", time at an equal error: " (parts.join(", ")) "." } } }
}
