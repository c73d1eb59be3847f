//! One card per solver: passed results, worst error, stability and cost.

use grainbench_harness::evidence::Evidence;
use grainbench_harness::verdict::{Outcome, Verdict};
use maud::{Markup, html};

use super::rows::address;
use super::rows_of;
use crate::distinct;
use crate::measured::{AT, Costs, Hold, Line, Measurements, Stability};
use crate::number;
use crate::report::Report;

/// Solvers whose names do not explain themselves, with the meaning of each name.
const NAMES: [(&str, &str); 8] = [
    ("dem:lammps", "dem with the contact conventions of LAMMPS"),
    ("dem:liggghts", "dem with the contact conventions of LIGGGHTS"),
    ("dem:1979", "dem with the conventions of Cundall & Strack (1979)"),
    ("mpm:2000", "mpm with nodal contact while bodies approach (Bardenhagen et al. 2000)"),
    ("mpm:2001", "mpm with nodal contact under compressive traction (Bardenhagen et al. 2001)"),
    ("mpm:gap", "mpm with nodal contact where surfaces have met"),
    ("mpm:penalty", "mpm with springs between surfaces"),
    ("mpm:no-slip", "mpm with one velocity field, so that bodies stick together"),
];

/// Returns the meaning of a solver's name; `None` if the name needs no explanation.
#[must_use]
pub fn meaning(solver: &str) -> Option<&'static str> {
    NAMES.iter().find(|(name, _)| *name == solver).map(|(_, meaning)| *meaning)
}

/// Returns the solvers of a report. Methods and programs come first, in a fixed order, then conventions such as `dem:lammps`.
/// Solvers with settings for single cases, such as `mpm+…`, are last.
pub(crate) fn solvers(report: &Report) -> Vec<&str> {
    let mut names = distinct(report.verdicts().map(|row| row.solver.as_str()));
    const METHODS: [&str; 5] = ["dem", "mpm", "rigid", "lammps", "liggghts"];
    let place = |name: &&str| {
        let method = name.split([':', '+']).next().unwrap_or_default();
        let known = METHODS.iter().position(|known| *known == method).unwrap_or(METHODS.len());
        (name.contains('+'), name.contains(':'), known)
    };
    // The sort is stable, so all other solvers stay in the order of the report.
    names.sort_by_key(place);
    names
}

/// Renders the cards. `has_rows` returns true if the page contains the results of a case.
pub(crate) fn render(report: &Report, anchors: &[String], has_rows: &dyn Fn(&str) -> bool) -> Markup {
    // Solvers with settings for single cases have no card; the matrix shows them.
    let solvers: Vec<&str> = solvers(report).into_iter().filter(|name| !name.contains('+')).collect();
    let lead = |row: &Verdict| {
        let at = report.sections.iter().position(|section| section.name == row.case);
        let table = at.and_then(|at| anchors.get(at)).map_or_else(|| "matrix".to_owned(), |anchor| rows_of(anchor));
        if has_rows(&row.case) { address(row) } else { table }
    };
    html! {
        @if !solvers.is_empty() {
            div.cards id="solvers" aria-label="Solvers" role="group" {
                @for solver in solvers { (card(report, &lead, solver)) }
            }
        }
    }
}

pub(crate) fn rows<'a>(report: &'a Report, solver: &'a str) -> impl Iterator<Item = &'a Verdict> {
    report.verdicts().filter(move |row| row.solver == solver)
}

/// Returns the rank of a wrong result, from crashed runs to known errors, and within the rank the size of the error.
fn wrongness(row: &Verdict) -> Option<(u8, f64)> {
    match row.outcome {
        Outcome::Broken => Some((2, f64::INFINITY)),
        Outcome::Stale => Some((1, f64::INFINITY)),
        Outcome::Fail => Some((1, size(row))),
        Outcome::Known => Some((0, size(row))),
        _ => None,
    }
}

/// Returns |error| as a fraction of the scale; infinity if there is no finite error.
fn size(row: &Verdict) -> f64 {
    row.error.map_or(f64::INFINITY, f64::abs)
}

/// Renders the card of a solver. `lead` returns the anchor of a result.
fn card(report: &Report, lead: &dyn Fn(&Verdict) -> String, solver: &str) -> Markup {
    let count = |outcome: Outcome| rows(report, solver).filter(|row| row.outcome == outcome).count();
    let (all, pass) = (rows(report, solver).count(), count(Outcome::Pass));
    let not_judged = rows(report, solver).filter(|row| !row.outcome.is_judged()).count();
    let worst = rows(report, solver).map(|row| row.outcome.severity()).max();
    let class = worst.filter(|_| not_judged < all).map_or("", crate::class);
    let worst = rows(report, solver)
        .filter_map(|row| Some((wrongness(row)?, row)))
        .max_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let Measurements { cost, stability, .. } = &report.measured;
    let line = cost.as_ref().and_then(|cost| Some((cost, cost.lines.iter().find(|line| line.solver == solver)?)));
    let stability = stability.as_ref();
    let hold = stability.and_then(|all| Some((all, all.lines.iter().find(|line| line.solver == solver)?)));
    let filter = |outcome: Option<&'static str>, text: Markup| {
        html! {
            a href="#matrix" title=[meaning(solver)] data-solver=(solver) data-outcome=[outcome] { (text) }
        }
    };
    html! {
        div class={ "card " (class) } data-card=(solver) {
            h3 {
                (filter(None, html! { (solver) }))
                span { @if not_judged < all { (pass) "/" (all - not_judged) } @else { "none judged" } }
            }
            dl {
                (compared(report, solver))
                @if let Some((_, row)) = worst {
                    div {
                        dt { (filter(Some(row.outcome.word()), html! { (count(row.outcome)) " " (row.outcome.word()) })) }
                        dd {
                            "worst "
                            @if size(row).is_finite() { "error " (number::significant(100.0 * size(row), 2)) " %, " }
                            a.bad href={ "#" (lead(row)) } title=(row.quantity) { (row.case) }
                        }
                    }
                }
                @if (1..all).contains(&not_judged) { div { dt { "not judged" } dd { (not_judged) } } }
                @if let Some((stability, hold)) = hold { (stable(stability, hold)) }
                @if let Some((costs, line)) = line { (price(costs, line)) }
            }
        }
    }
}

/// Renders the number of results of other solvers that are compared with this solver, and the number of them that pass.
fn compared(report: &Report, solver: &str) -> Markup {
    let against = format!("against {solver}");
    let by_it = |row: &&Verdict| {
        let is_named = row.quantity.contains(&against) || row.source.to_lowercase().contains(solver);
        row.evidence == Evidence::OtherCode && row.solver != solver && is_named
    };
    let rows: Vec<&Verdict> = report.verdicts().filter(by_it).collect();
    let agree = rows.iter().filter(|row| row.outcome == Outcome::Pass).count();
    html! {
        @if !rows.is_empty() {
            div { dt { "its runs" } dd { (agree) " of " (rows.len()) " of our results agree" } }
        }
    }
}

fn stable(stability: &Stability, hold: &Hold) -> Markup {
    let class = stability.stamp.is_old(&hold.solver).then_some("old");
    let range = |[low, high]: [f64; 2]| format!("{}–{}", number::significant(low, 3), number::significant(high, 3));
    html! {
        @if let Some((ends, _)) = hold.limit {
            div class=[class] { dt { "stable step" } dd { (range(ends)) " of the exact limit" } }
        } @else if let Some((ends, unit)) = &hold.found {
            div class=[class] { dt { "stable step" } dd { (range(*ends)) " " (unit) } }
        }
        @if hold.asked() > 0 {
            div class=[class] {
                dt { "hard cases" }
                dd {
                    (hold.holds) " of " (hold.asked()) " hold"
                    @if hold.smaller > 0 { ", " (hold.smaller) " at a smaller step" }
                    @if hold.wrong > 0 { ", " b.bad { (hold.wrong) " wrong without an error" } }
                }
            }
        }
    }
}

fn price(costs: &Costs, line: &Line) -> Markup {
    html! {
        div class=[costs.stamp.is_old(&line.solver).then_some("old")] {
            dt { "1 % costs" }
            dd {
                @if let Some(factor) = line.factors[AT] {
                    @if factor.compared > 0 {
                        "× " (number::significant(factor.times, 2)) " the cheapest (" (factor.compared) " compared)"
                    } @else { "reached alone" }
                    ", in " (factor.reached) " of " (line.asked)
                } @else { "reached for none of " (line.asked) }
            }
        }
    }
}
