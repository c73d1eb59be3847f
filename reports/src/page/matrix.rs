//! Matrix of cases and solvers. Each cell shows the largest |error|/allowed as colour and number.

use grainbench_harness::verdict::{Outcome, Severity, Verdict};
use maud::{Markup, html};

use super::cards::{self, meaning};
use crate::headline::used_tolerance;
use crate::judged::{ExternalResults, Row};
use crate::number;
use crate::report::{Report, Section};

/// Heading of the column of all solvers with settings for single cases.
const OTHERS: &str = "mpm+…";

/// Content of a cell: the results of one case with one solver.
struct Cell<'a> {
    /// Largest |error|/allowed; none if no result has an error.
    worst: Option<f64>,
    /// Outcome of the worst result.
    outcome: Outcome,
    /// Number of results of each outcome, with the most important outcome first.
    counts: Vec<(Outcome, usize)>,
    /// Solver of the results.
    solver: &'a str,
}

/// Returns the rank of an outcome. From high to low, the order is: red, known error, outdated, passed, and outcomes without
/// a judged value.
const fn order(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::Broken => 6,
        Outcome::Fail => 5,
        Outcome::Stale => 4,
        Outcome::Known => 3,
        Outcome::Outdated => 2,
        Outcome::Pass => 1,
        Outcome::NoReference | Outcome::Unsupported | Outcome::NotAvailable => 0,
    }
}

fn cell<'a>(rows: &[&'a Verdict]) -> Option<Cell<'a>> {
    let worst = rows.iter().max_by_key(|row| order(row.outcome))?;
    let has_error = rows.iter().filter(|row| row.error.is_some());
    Some(Cell {
        worst: has_error.map(|row| used_tolerance(row)).reduce(f64::max),
        outcome: worst.outcome,
        counts: counts(rows.iter().map(|row| row.outcome)),
        solver: &rows.first()?.solver,
    })
}

/// Counts results by outcome, with the most important outcome first.
fn counts(outcomes: impl Iterator<Item = Outcome>) -> Vec<(Outcome, usize)> {
    let mut outcomes: Vec<Outcome> = outcomes.collect();
    outcomes.sort_by_key(|&outcome| std::cmp::Reverse((order(outcome), outcome.word())));
    outcomes.chunk_by(|a, b| a == b).filter_map(|same| Some((*same.first()?, same.len()))).collect()
}

/// Returns the CSS class of a stripe if a cell has amber results with an outcome other than the one that it shows.
/// Without the stripe, passed results would hide results that were not judged.
fn stripe(counts: &[(Outcome, usize)]) -> &'static str {
    let is_hidden = |&(outcome, _): &(Outcome, usize)| outcome.severity() == Severity::Amber;
    if counts.iter().skip(1).any(is_hidden) { " part" } else { "" }
}

/// Describes the results of a cell.
fn description(case: &str, solver: &str, counts: &[(Outcome, usize)]) -> String {
    let parts: Vec<String> = counts.iter().map(|(outcome, count)| format!("{count} {}", outcome.word())).collect();
    format!("{case}, {solver}: {}", parts.join(", "))
}

/// Returns the CSS class of a cell. Its shade depends on |error|/allowed for passed results and for known errors.
fn class(outcome: Outcome, worst: Option<f64>) -> &'static str {
    let worst = worst.unwrap_or(f64::INFINITY);
    match outcome {
        outcome if outcome.is_red() => "f0",
        Outcome::Pass if worst <= 0.1 => "c0",
        Outcome::Pass if worst <= 0.5 => "c1",
        Outcome::Pass => "c2",
        Outcome::Known if worst <= 10.0 => "k0",
        Outcome::Known if worst <= 1e3 => "k1",
        Outcome::Known => "k2",
        Outcome::Outdated => "old",
        _ => "cannot",
    }
}

/// Returns |error|/allowed in few characters, because the cell is small.
fn short(worst: f64) -> String {
    if worst >= 1e3 {
        format!("1e{}", worst.log10().round())
    } else if worst >= 0.995 {
        number::significant(worst, 2)
    } else if worst < 0.005 {
        "0".to_owned()
    } else {
        format!("{worst:.2}").trim_start_matches('0').to_owned()
    }
}

/// Renders the matrix.
pub(crate) fn render(report: &Report, anchors: &[String]) -> Markup {
    let all = cards::solvers(report);
    let mut columns: Vec<&str> = all.iter().copied().filter(|name| !name.contains('+')).collect();
    if columns.len() < all.len() {
        columns.push(OTHERS);
    }
    let table = html! {
        table {
            thead {
                tr {
                    td {}
                    @for column in &columns { th scope="col" { span { (column) } } }
                    @for results in &report.judged { th scope="col" { span { (results.program) } } }
                }
            }
            tbody {
                @for (section, anchor) in report.sections.iter().zip(anchors) {
                    tr data-case=(section.name) {
                        th scope="row" { a href={ "#" (anchor) } { (section.name) } }
                        @for column in &columns { td { (ours(section, column, anchor)) } }
                        @for results in &report.judged { td { (theirs(results, &section.name)) } }
                    }
                }
            }
        }
    };
    html! {
        div.matrix {
            h2 id="matrix" { "Largest error / tolerance, by case and solver" }
            (super::scrolling("Cases by solvers", &table))
            p.key {
                span { i.c0 {} "≤ .1" } span { i.c1 {} "≤ .5" } span { i.c2 {} "≤ 1 × tolerance" }
                span { i.k0 {} i.k1 {} i.k2 {} "known error of a published method: ≤ 10, ≤ 1000, > 1000 × tolerance" }
                span { i.f0 {} "fails" } span { i.old {} "stored result of older solver sources" }
                span { i.cannot {} "unsupported, no reference, or data not available" }
                span { i.c2.part {} "stripe: further results are amber" }
            }
            @let named: Vec<_> = columns.iter().filter_map(|name| Some((name, meaning(name)?))).collect();
            @if !named.is_empty() {
                p.note { "Names: " @for (name, meaning) in named { code { (name) } ": " (meaning) ". " } }
            }
            @if !report.judged.is_empty() {
                p.note {
                    "The last columns show external solvers with stored results of earlier runs ("
                    a href="#peers" { "details" } ")."
                }
            }
        }
    }
}

fn ours(section: &Section, column: &str, anchor: &str) -> Markup {
    let is_mine = |row: &&Verdict| if column == OTHERS { row.solver.contains('+') } else { row.solver == column };
    let rows: Vec<&Verdict> = section.verdicts.iter().filter(is_mine).collect();
    let Some(cell) = cell(&rows) else { return html! {} };
    let words = description(&section.name, column, &cell.counts);
    html! {
        a class={ (class(cell.outcome, cell.worst)) (stripe(&cell.counts)) } href={ "#" (super::rows_of(anchor)) }
            title=(words) data-solver=(cell.solver)
            data-case=(section.name) { (text(cell.outcome, cell.worst)) }
    }
}

fn text(outcome: Outcome, worst: Option<f64>) -> String {
    match (worst, outcome) {
        (_, Outcome::Broken | Outcome::Stale) => "✗".to_owned(),
        (Some(worst), _) if worst.is_finite() => short(worst),
        (Some(_), _) => "∞".to_owned(),
        (None, _) => "–".to_owned(),
    }
}

fn theirs(results: &ExternalResults, case: &str) -> Markup {
    let rows: Vec<&Row> = results.rows.iter().filter(|row| row.case == case).collect();
    let Some(worst) = rows.iter().max_by_key(|row| order(row.verdict)) else { return html! {} };
    let used = results.count(Some(case)).worst;
    let counts = counts(rows.iter().map(|row| row.verdict));
    let words = description(case, &results.program, &counts);
    html! { span class={ (class(worst.verdict, used)) (stripe(&counts)) } title=(words) { (text(worst.verdict, used)) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A passed result does not hide amber results, and a cell with one outcome has no stripe.
    #[test]
    fn a_stripe_shows_hidden_amber_results() {
        let of = |outcomes: &[Outcome]| counts(outcomes.iter().copied());
        let mixed = of(&[Outcome::Pass, Outcome::Unsupported, Outcome::Pass]);
        assert_eq!(stripe(&mixed), " part");
        assert_eq!(description("chain", "dem", &mixed), "chain, dem: 2 pass, 1 unsupported");
        assert_eq!(stripe(&of(&[Outcome::Known, Outcome::Pass, Outcome::Outdated])), " part");
        for alike in [&[Outcome::Pass; 3][..], &[Outcome::Known; 2], &[Outcome::Known, Outcome::Pass], &[]] {
            assert_eq!(stripe(&of(alike)), "");
        }
    }
}
