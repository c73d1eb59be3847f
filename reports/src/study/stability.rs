//! What stays stable, drawn and tabulated.

use super::Study;
use super::page::figure;
use crate::number;
use crate::page::scrolling;
use crate::plot::DrawError;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::study::stability::{Hard, Hardness, Limit};
use maud::{Markup, html};

/// Each value once, in the order of first sight.
fn distinct<'a>(values: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}

/// Largest stable step against the knob, a figure a unit of steps.
#[must_use]
pub fn figures(study: &Study) -> Vec<Figure> {
    distinct(study.limits.iter().map(|limit| limit.unit.as_str()))
        .into_iter()
        .filter_map(|unit| {
            map(study.limits.iter().filter(|limit| limit.unit == unit && limit.at.is_some()).collect(), unit)
        })
        .collect()
}

fn map(rows: Vec<&Limit>, unit: &str) -> Option<Figure> {
    let mut curves = Vec::new();
    let knob = rows.first()?.knob.clone();
    let exact = rows.iter().any(|row| row.exact.is_some());
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let of = |solver: &str, value: fn(&Limit) -> Option<f64>| -> Vec<(f64, f64)> {
            let mine = rows.iter().filter(|row| row.scene == scene && row.solver == solver);
            let mut points: Vec<(f64, f64)> = mine.filter_map(|row| Some((row.at?, value(row)?))).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points
        };
        for solver in distinct(rows.iter().filter(|row| row.scene == scene).map(|row| row.solver.as_str())) {
            let found = of(solver, |row| row.found);
            if !found.is_empty() {
                let stroke = if exact { Stroke::Markers } else { Stroke::MarkedLine };
                curves.push(Curve::new(
                    if exact { format!("{scene}, {solver}") } else { solver.to_owned() },
                    stroke,
                    found,
                ));
            }
        }
        let first = rows.iter().find(|row| row.scene == scene).map_or("", |row| row.solver.as_str());
        let line = of(first, |row| row.exact);
        if line.len() > 1 {
            curves.push(Curve::new(format!("{scene}, exact"), Stroke::Dashed, line));
        }
    }
    let name = if exact { "stable-step-springs" } else { "stable-step-grid" };
    let title = if exact {
        "Largest stable step of assemblies on springs"
    } else {
        "Largest stable step of the method with a grid"
    };
    let caption = if exact {
        "Found by bisection on the growth of a random perturbation of every degree of freedom; dashed, joined by straight \
         lines, the exact limits."
    } else {
        "Courant number up to which a vibrating bar keeps its energy to a tenth over two periods."
    };
    let x = if exact { Axis::linear(&knob) } else { Axis::log(&knob) };
    (!curves.is_empty())
        .then(|| Figure::graph(name, title, caption, [x, Axis::linear(&format!("Δt / ({unit})"))], curves))
}

/// The section of the page.
pub(crate) fn render(study: &Study) -> Result<Markup, DrawError> {
    let pictures: Vec<Markup> = figures(study).iter().map(figure).collect::<Result<_, _>>()?;
    Ok(html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What stays stable" }
            p.lead {
                "The largest stable step of every solver, found by bisection on a typed failure, beside the \
                 exact limit where there \
                 is one; and hard cases, each with what must hold."
            }
            @if !study.hard.is_empty() {
                h3 { "Hard cases" }
                (matrix(&study.hard))
                (details_of(&study.hard))
            }
            @if !study.limits.is_empty() {
                h3 { "Largest stable steps" }
                @for picture in &pictures { (picture) }
                (limits(&study.limits))
            }
        }
    })
}

const fn sign(standing: Hardness) -> (&'static str, &'static str) {
    match standing {
        Hardness::Holds => ("✓", "pass"),
        Hardness::HoldsAtASmallerStep | Hardness::TypedFailure => ("▲", "amber"),
        Hardness::QuietlyWrong => ("✗", "fail"),
        Hardness::Unsupported | Hardness::NotAvailable => ("–", ""),
    }
}

fn matrix(rows: &[Hard]) -> Markup {
    let solvers = distinct(rows.iter().map(|row| row.solver.as_str()));
    let table = html! {
        table.cases {
            thead { tr { th scope="col" { "Case and what must hold" } @for solver in &solvers { th scope="col" { (solver) } } } }
            tbody {
                @for case in distinct(rows.iter().map(|row| row.case.as_str())) {
                    tr {
                        th scope="row" {
                            (case)
                            span.title { (rows.iter().find(|row| row.case == case).map_or("", |row| row.must.as_str())) }
                        }
                        @for solver in &solvers {
                            td {
                                @if let Some(row) = rows.iter().find(|row| row.case == case && row.solver == *solver) {
                                    @let (symbol, class) = sign(row.standing);
                                    span.mark class=(class) { (symbol) " " (row.standing.word()) }
                                    @if row.standing == Hardness::HoldsAtASmallerStep { span.fine { (row.resolution) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    };
    scrolling("Hard cases", &table)
}

fn details_of(rows: &[Hard]) -> Markup {
    let telling = |row: &&Hard| !row.detail.is_empty() && !matches!(row.standing, Hardness::NotAvailable);
    html! {
        details {
            summary { "What was seen" }
            ul {
                @for row in rows.iter().filter(telling) {
                    li { (row.case) " · " (row.solver) " · " (row.standing.word()) ": " (row.detail) }
                }
            }
        }
    }
}

fn limits(rows: &[Limit]) -> Markup {
    let number = |value: Option<f64>| value.map_or("—".to_owned(), |value| number::significant(value, 4));
    let table = html! {
        table.rows {
            thead {
                tr {
                    th scope="col" { "Assembly" }
                    th scope="col" { "Solver" }
                    th.n scope="col" { "Found" }
                    th.n scope="col" { "Exact" }
                    th.n scope="col" { "Error" }
                    th scope="col" { "Unit" }
                    th.n scope="col" { "Default" }
                    th.n scope="col" { "Margin" }
                    th scope="col" { "How it fails above" }
                }
            }
            tbody {
                @for row in rows {
                    tr {
                        th scope="row" {
                            (row.scene)
                            @if let Some(at) = row.at { span.fine { (row.knob) " = " (number::significant(at, 4)) } }
                        }
                        td { (row.solver) }
                        td.n { (number(row.found)) }
                        td.n { (number(row.exact)) }
                        td.n { (number::error(row.error)) }
                        td { (row.unit) }
                        td.n { (number(row.default)) }
                        td.n { (number(row.margin)) }
                        td.wide { (row.detail) }
                    }
                }
            }
        }
    };
    scrolling("Largest stable steps", &table)
}
