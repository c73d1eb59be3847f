//! Matrix of cases and solvers. Each cell shows the largest |error|/allowed as colour and number.

use grainbench_harness::case::Physics;
use grainbench_harness::verdict::{Outcome, Severity, Verdict};
use maud::{Markup, html};
use std::collections::BTreeSet;

use super::cards::{self, meaning};
use crate::headline::used_tolerance;
use crate::judged::ExternalResults;
use crate::number;
use crate::quantile;
use crate::report::{Report, Section};
use crate::table::{Cell, Column, Columns, scrolling};

/// Heading of the column of all solvers with settings for single cases.
const OTHERS: &str = "mpm+…";

/// Outcomes from the most important one: red, known error, outdated, passed, and outcomes without a judged value.
const ORDER: [Outcome; 9] = {
    use Outcome::{Broken, Fail, Known, NoReference, NotAvailable, Outdated, Pass, Stale, Unsupported};
    [Broken, Fail, Stale, Known, Outdated, Pass, Unsupported, NotAvailable, NoReference]
};

/// Counts results by outcome, with the most important outcome first.
fn counts(outcomes: impl Iterator<Item = Outcome>) -> Vec<(Outcome, usize)> {
    let outcomes: Vec<Outcome> = outcomes.collect();
    let count = |outcome| outcomes.iter().filter(|other| **other == outcome).count();
    ORDER.map(|outcome| (outcome, count(outcome))).into_iter().filter(|(_, count)| *count > 0).collect()
}

/// Returns the CSS class of a stripe if a cell has amber results with an outcome other than the one that it shows.
/// Without the stripe, passed results would hide results that were not judged.
fn stripe(counts: &[(Outcome, usize)]) -> &'static str {
    let is_hidden = |&(outcome, _): &(Outcome, usize)| outcome.severity() == Severity::Amber;
    if counts.iter().skip(1).any(is_hidden) { " part" } else { "" }
}

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

/// Returns the fields of physics of a report in their order.
fn fields_of(report: &Report) -> Vec<Physics> {
    report.sections.iter().map(|section| section.physics).collect::<BTreeSet<_>>().into_iter().collect()
}

struct FieldResults {
    /// Median |error| / scale of the judged results; none if no result has an error. The largest error would be that of the
    /// claim with the widest tolerance.
    error: Option<f64>,
    counts: Vec<(Outcome, usize)>,
}

impl FieldResults {
    fn new(report: &Report, physics: Physics, solver: &str) -> Option<Self> {
        let sections = report.sections.iter().filter(|section| section.physics == physics);
        let of_solver = sections.flat_map(|section| &section.verdicts).filter(|row| row.solver == solver);
        let rows: Vec<&Verdict> = of_solver.filter(|row| row.outcome.is_judged()).collect();
        let errors = rows.iter().filter_map(|row| row.error).map(f64::abs).filter(|error| error.is_finite());
        let mut errors: Vec<f64> = errors.collect();
        let error = quantile(&mut errors, 0.5);
        (!rows.is_empty()).then(|| Self { error, counts: counts(rows.iter().map(|row| row.outcome)) })
    }

    fn passes(&self) -> bool {
        self.counts.iter().all(|(outcome, _)| *outcome == Outcome::Pass)
    }
}

/// Renders the median error by field of physics and solver, for solvers without settings for single cases.
/// Empty if all cases are in one field.
pub(crate) fn by_physics(report: &Report) -> Markup {
    const MAIN: [&str; 5] = ["dem", "rigid", "mpm", "dem:lammps", "dem:liggghts"];
    let fields = fields_of(report);
    let columns: Vec<(&str, Vec<Option<FieldResults>>)> = MAIN
        .into_iter()
        .map(|solver| (solver, fields.iter().map(|physics| FieldResults::new(report, *physics, solver)).collect()))
        .filter(|(_, results): &(&str, Vec<Option<FieldResults>>)| results.iter().any(Option::is_some))
        .collect();
    if fields.len() < 2 || columns.is_empty() {
        return html! {};
    }
    let least = |field: usize| -> Option<f64> {
        let results = columns.iter().filter_map(|(_, results)| results[field].as_ref());
        results.filter(|results| results.passes()).filter_map(|results| results.error).reduce(f64::min)
    };
    let least: Vec<Option<f64>> = (0..fields.len()).map(least).collect();
    let is_least = |field: usize, results: &FieldResults| {
        results.passes() && results.error.is_some() && results.error == least[field]
    };
    let cell = |field: usize, solver: &str, results: &FieldResults| {
        let class = match results.counts.first().map_or(Outcome::Pass, |(worst, _)| *worst) {
            Outcome::Pass if is_least(field, results) => "c2",
            Outcome::Pass => "c0",
            worst => class(worst, Some(1.0)),
        };
        let title = description(fields[field].title(), solver, &results.counts);
        let error = results.error.map_or("–".to_owned(), percent);
        html! { a class=(class) href="#matrix" title=(title) data-solver=(solver) { (error) } }
    };
    let first = Columns::<(usize, Physics)>::new(Column::heading("Median error"), |(_, physics)| physics.title());
    let all = columns.iter().fold(first, |all, (solver, results)| {
        all.and(Column::text(*solver), move |(field, _)| {
            results[field].as_ref().map_or(Cell::from(""), |results| cell(field, solver, results).into())
        })
    });
    let rows = fields.iter().copied().enumerate();
    let table = all.table("Median error by field of physics and solver", rows, |_| "");
    html! {
        h3 { a href="#matrix" { "Which solver for which physics" } }
        (table.page("physics"))
        p.note { "Median |error| / scale of the judged results. Dark: the smallest of its row." }
    }
}

/// Returns an error with one significant digit, because the cell is small: in percent, or as a power of ten.
fn percent(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else if (1e-4..100.0).contains(&error) {
        format!("{}\u{202f}%", number::significant(100.0 * error, 1))
    } else {
        number::power_of_ten(error.log10().floor() as i32)
    }
}

/// Renders the matrix. The cases are grouped by field of physics.
pub(crate) fn render(report: &Report, anchors: &[String]) -> Markup {
    let all = cards::solvers(report);
    let mut columns: Vec<&str> = all.iter().copied().filter(|name| !name.contains('+')).collect();
    if columns.len() < all.len() {
        columns.push(OTHERS);
    }
    let of_field = |physics| report.sections.iter().zip(anchors).filter(move |(section, _)| section.physics == physics);
    let table = html! {
        table {
            thead {
                tr {
                    td {}
                    @for column in &columns { th scope="col" { span { (column) } } }
                    @for results in &report.judged { th scope="col" { span { (results.program) } } }
                }
            }
            @for physics in fields_of(report) {
                tbody {
                    tr.field { th scope="rowgroup" colspan=(columns.len() + report.judged.len() + 1) { (physics.title()) } }
                    @for (section, anchor) in of_field(physics) {
                        tr data-case=(section.name) {
                            th scope="row" { a href={ "#" (anchor) } { (section.name) } }
                            @for column in &columns { td { (ours(section, column, anchor)) } }
                            @for results in &report.judged { td { (theirs(results, &section.name)) } }
                        }
                    }
                }
            }
        }
    };
    html! {
        div.matrix {
            h2 id="matrix" { "Largest error / tolerance, by case and solver" }
            (scrolling("Cases by solvers", &table))
            p.key {
                span { i.c0 {} "≤ .1" } span { i.c1 {} "≤ .5" } span { i.c2 {} "≤ 1 × tolerance" }
                span { i.k0 {} i.k1 {} i.k2 {} "known error: ≤ 10, ≤ 1000, > 1000 × tolerance" }
                span { i.f0 {} "fails" } span { i.old {} "stored result from older solver code" }
                span { i.cannot {} "unsupported, no reference, or not available" }
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
    let counts = counts(rows.iter().map(|row| row.outcome));
    let (Some((outcome, _)), Some(first)) = (counts.first(), rows.first()) else { return html! {} };
    let has_error = rows.iter().filter(|row| row.error.is_some());
    let worst = has_error.map(|row| used_tolerance(row)).reduce(f64::max);
    let words = description(&section.name, column, &counts);
    html! {
        a class={ (class(*outcome, worst)) (stripe(&counts)) } href={ "#" (super::rows_of(anchor)) } title=(words)
            data-solver=(first.solver) data-case=(section.name) { (text(*outcome, worst)) }
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
    let rows = results.rows.iter().filter(|row| row.result.case == case);
    let counts = counts(rows.map(|row| row.result.outcome));
    let Some((outcome, _)) = counts.first() else { return html! {} };
    let worst = results.worst(case);
    let words = description(case, &results.program, &counts);
    html! { span class={ (class(*outcome, worst)) (stripe(&counts)) } title=(words) { (text(*outcome, worst)) } }
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

    /// The smallest error of a field is dark. A solver with a failed result is red and never the best.
    #[test]
    fn the_smallest_error_of_a_field_is_dark() {
        let mut report = crate::sample::report();
        for (at, section) in report.sections.iter_mut().enumerate() {
            section.verdicts.truncate(3);
            let results = [("dem", 0.02), ("dem", -0.01), ("rigid", if at == 0 { 3e-6 } else { 0.01 })];
            for (row, (solver, error)) in section.verdicts.iter_mut().zip(results) {
                (row.solver, row.outcome, row.error) = (solver.to_owned(), Outcome::Pass, Some(error));
            }
        }
        let cells = |report: &Report| -> Vec<String> {
            let page = by_physics(report).into_string();
            let cell = |cell: &str| {
                let class = cell.split('"').nth(1).unwrap().to_owned();
                format!("{class} {}", cell.split("</a>").next().unwrap().rsplit('>').next().unwrap())
            };
            page.split("<td>").skip(1).map(cell).collect()
        };
        let page = by_physics(&report).into_string();
        assert!(page.contains("title=\"rolling, sliding, dem: 2 pass\""), "{page}");
        assert_eq!(cells(&report), ["c0 2\u{202f}%", "c2 1\u{202f}%", "c0 2\u{202f}%", "c2 10⁻⁶"]);
        let rolling = report.sections.iter().position(|section| section.physics == Physics::Rolling).unwrap();
        report.sections[rolling].verdicts[2].outcome = Outcome::Fail;
        assert_eq!(cells(&report)[2..], ["c2 2\u{202f}%", "f0 10⁻⁶"], "both are best in one field");
        report.sections[rolling].verdicts[2].outcome = Outcome::Unsupported;
        // An unsupported result has no cell.
        assert_eq!(by_physics(&report).into_string().matches("<a class").count(), 3);
        report.sections.remove(rolling);
        assert_eq!(by_physics(&report).into_string(), "");
    }
}
