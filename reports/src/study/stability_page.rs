//! Page of stability: largest stable time steps and hard cases.

use super::Study;
use super::stability::{HardCaseResult, Hardness, Limit, figures};
use crate::measured::{Hold, Stability};
use crate::number;
use crate::page::captioned;
use crate::row;
use crate::table::{Cell, Column, Columns, Format, Table};
use crate::{class, distinct};
use maud::{Markup, html};

/// Renders a table with one row per solver: its largest stable time steps, and its outcomes in hard cases.
fn totals(lines: &[Hold]) -> Markup {
    let numbers = ["Hard cases that hold", "at a smaller step", "end in an error", "wrong without an error"];
    let columns = [Column::heading("Solver"), Column::text("Largest stable step over the exact limit")].into_iter();
    let columns = columns.chain(numbers.map(|name| Column::new(name, Format::Count)));
    let row = |line: &Hold| {
        let limit = line.limit.map(|([low, high], count)| {
            let [low, high] = [low, high].map(|end| number::significant(end, 4));
            format!("{low} … {high} in {count} assemblies")
        });
        let holds = format!("{} of {}", line.holds, line.asked());
        row![&line.solver, limit, holds, line.smaller, line.typed, line.wrong]
    };
    Table::new("Totals", columns, lines.iter().map(row)).page("")
}

pub(crate) fn render(study: &Study) -> Markup {
    if let ([first, ..], []) = (&study.limits[..], &study.hard[..])
        && first.scene.ends_with(".toml")
    {
        return html! {
            header id="summary" {
                p.kicker { "grainbench" }
                h1 { "What stays stable in " (first.scene) }
            }
            (largest_steps(&study.limits))
        };
    }
    html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What stays stable" }
            (tables(&Stability::from_study(study, &|_| None)))
        }
    }
}

/// Renders the table of the largest stable steps in one scene.
pub(crate) fn largest_steps(rows: &[Limit]) -> Markup {
    html! {
        section {
            h3 { "Largest stable steps" }
            p.note {
                "Bisection between runs that end and runs that break, or whose kinetic energy grows tenfold, or whose \
                 elastic energy grows threefold. 2√(m/k) is the critical time step of the scene, and h/c is the time in \
                 which a wave crosses a cell."
            }
            (limits(rows, "Scene", with_parameter).page("rows"))
        }
    }
}

pub(crate) fn tables(stability: &Stability) -> Markup {
    html! {
        p.lead {
            "The largest stable step of each solver, found by bisection between stable and failed runs, with the \
             exact limit if there is one. Hard cases follow, each with its requirement."
        }
        h3 { "Totals" }
        (totals(&stability.lines))
        @if !stability.hard.is_empty() {
            h3 { "Hard cases" }
            (matrix(&stability.hard))
            (details_of(&stability.hard))
        }
        @if !stability.limits.is_empty() {
            h3 { "Largest stable steps" }
            div.figures { @for figure in figures(&stability.limits) { (captioned(&figure)) } }
            (limits(&stability.limits, "Assembly", with_parameter).page("rows"))
        }
    }
}

/// Returns the symbol and the CSS class of a result.
pub(crate) fn sign(row: &HardCaseResult) -> (&'static str, &'static str) {
    (row.standing.sign().0, row.severity().map_or("", class))
}

fn matrix(rows: &[HardCaseResult]) -> Markup {
    let solvers = distinct(rows.iter().map(|row| row.solver.as_str()));
    let name = |case: &str| {
        let must = rows.iter().find(|row| row.case == case).map_or("", |row| row.must.as_str());
        html! { (case) span.title { (must) } }
    };
    let result = |case: &str, solver: &str| {
        let Some(row) = rows.iter().find(|row| row.case == case && row.solver == solver) else { return "".into() };
        let (symbol, class) = sign(row);
        Cell::from(html! {
            span class={ "mark " (class) } { (symbol) " " (row.standing.word()) }
            @if row.standing == Hardness::HoldsAtASmallerStep { span.fine { (row.resolution) } }
        })
    };
    let cases = distinct(rows.iter().map(|row| row.case.as_str()));
    let columns = Columns::new(Column::heading("Case and requirement"), name).and_each(solvers, result);
    columns.table("Hard cases", cases, |_| "").page("cases")
}

fn details_of(rows: &[HardCaseResult]) -> Markup {
    let telling = |row: &&HardCaseResult| !row.detail.is_empty() && !matches!(row.standing, Hardness::NotAvailable);
    html! {
        details {
            summary { "Observations" }
            ul {
                @for row in rows.iter().filter(telling) {
                    li { (row.case) " · " (row.solver) " · " (row.standing.word()) ": " (row.detail) }
                }
            }
        }
    }
}

/// Returns the table of hard cases for the terminal.
pub(super) fn hard_table(rows: &[HardCaseResult]) -> Table<'_> {
    let columns = ["Hard case", "Solver", "Result", "Resolution", "Detail"].map(Column::text);
    let row = |row: &HardCaseResult| {
        let HardCaseResult { case, solver, standing, resolution, detail, .. } = row;
        row![case, solver, standing.word(), resolution, detail]
    };
    Table::new("", columns, rows.iter().map(row))
}

/// Returns the table of largest stable steps for the terminal.
pub(super) fn limits_table(rows: &[Limit]) -> Table<'_> {
    let scene = |row: &Limit| parameter(row).map_or_else(|| row.scene.clone(), |at| format!("{}, {at}", row.scene));
    limits(rows, "Scene", move |row| scene(row).into())
}

/// Returns the name and the value of a parameter; none if there is no parameter.
fn parameter(row: &Limit) -> Option<String> {
    row.at.map(|at| format!("{} = {}", row.knob, number::significant(at, 4)))
}

fn with_parameter(row: &Limit) -> Cell {
    html! { (row.scene) @if let Some(at) = parameter(row) { span.fine { (at) } } }.into()
}

/// Returns a table of largest stable steps. It has exact limits only if at least one is known.
fn limits<'a>(rows: &'a [Limit], heading: &str, scene: impl Fn(&Limit) -> Cell + 'a) -> Table<'a> {
    let number = |name| Column::new(name, Format::Digits(4));
    let mut columns = Columns::<&Limit>::new(Column::heading(heading), scene)
        .and(Column::text("Solver"), |row| &row.solver)
        .and(number("Found"), |row| row.found);
    if rows.iter().any(|row| row.exact.is_some()) {
        columns = columns.and(number("Exact"), |row| row.exact);
        columns = columns.and(Column::new("Error", Format::Error), |row| row.error);
    }
    columns
        .and(Column::text("Unit"), |row| &row.unit)
        .and(number("Default"), |row| row.default)
        .and(number("Margin"), |row| row.margin)
        .and(Column::text("How it fails above").class("wide"), |row| &row.detail)
        .table("Largest stable steps", rows, |_| "")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns without a value are left out. Negative control: a known exact limit.
    #[test]
    fn exact_limits_have_columns_only_if_one_is_known() {
        let mut limit = Limit {
            scene: "heap.toml".to_owned(),
            solver: "dem".to_owned(),
            unit: "2√(m/k)".to_owned(),
            found: Some(0.5),
            default: Some(0.1),
            margin: Some(5.0),
            ..Limit::default()
        };
        let page = largest_steps(std::slice::from_ref(&limit)).into_string();
        assert!(page.contains("Scene") && !page.contains("Assembly") && !page.contains("Exact"), "{page}");
        (limit.exact, limit.error) = (Some(0.5), Some(0.0));
        assert!(largest_steps(&[limit]).into_string().contains("Exact"));
    }
}
