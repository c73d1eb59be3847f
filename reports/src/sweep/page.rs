//! Page of a sweep.

use super::figures::levels;
use super::{KINDS, Sweep, counts};
use crate::number;
use crate::page::{provenance, shell};
use crate::row;
use crate::table::{Cell, Column, Format, Table};
use crate::{class, quantile};
use grainbench_harness::verdict::Severity;
use maud::{Markup, PreEscaped, html};

/// Largest number of points that the page lists one by one.
const MOST: usize = 50;

/// Renders the page. `drawings` contains name, caption and SVG of each drawing.
pub(super) fn render(sweep: &Sweep, drawings: &[(&str, String, String)]) -> String {
    let counts = KINDS.into_iter().zip(counts(&sweep.points));
    let factors = sweep.factors.iter().map(|factor| factor.label.as_str()).collect::<Vec<_>>().join(", ");
    let factors = if sweep.factors.is_empty() { "nothing: one point" } else { &factors };
    let body = html! {
        main.alone {
            header id="summary" {
                p.kicker { "grainbench" }
                h1 { (sweep.title) }
                @if !sweep.about.is_empty() { p.lead { (sweep.about) } }
                ul.counts {
                    @for ((severity, word), count) in counts.filter(|((severity, _), count)| severity.is_some() || *count > 0) {
                        li class=(severity.map_or("amber", class)) { b { (number::count(count as u64)) } " " span { (word) } }
                    }
                    @if sweep.missing > 0 {
                        li.amber { b { (number::count(sweep.missing as u64)) } " " span { "not finished" } }
                    }
                }
                p { "Scene " code { (sweep.scene) } ", over " (factors) ". Every row is in " code { "rows.csv" } " and "
                    code { "rows.parquet" } "." }
            }
            @for (_, caption, svg) in drawings {
                figure { div class="plot graph" { (PreEscaped(svg)) } figcaption { (caption) } }
            }
            (table(sweep))
            (worst(sweep))
            (provenance::render(&sweep.provenance))
        }
    };
    shell(&format!("grainbench · {}", sweep.title), &body)
}

/// Renders a table with one row per solver and level: numbers of points by status, and errors.
fn table(sweep: &Sweep) -> Markup {
    let rows = levels(sweep).into_iter().map(|(solver, level, points)| {
        let mut errors: Vec<f64> = points.iter().filter_map(|point| point.error()).collect();
        let [half, most, worst] = [0.5, 0.9, 1.0].map(|part| quantile(&mut errors, part));
        let ran = points.iter().filter_map(|point| point.left.ran);
        let mut steps: Vec<u64> = ran.map(|ran| ran.particle_steps).collect();
        steps.sort_unstable();
        let [within, outside, amber, unjudged] = counts(points);
        let steps = steps.get(steps.len() / 2).copied();
        row![solver, level, within, outside, amber, unjudged, half, most, worst, steps]
    });
    let counts = ["Within", "Outside or broken", "Amber", "Not judged"].map(|name| Column::new(name, Format::Count));
    let errors = ["Median |error|", "90 % below", "Worst"].map(|name| Column::new(name, Format::Fraction));
    let columns = [Column::text("Solver"), Column::text("Level")].into_iter().chain(counts).chain(errors);
    let columns = columns.chain([Column::new("Particle-steps, median", Format::Count)]);
    let table = Table::new("Solvers and levels", columns, rows);
    html! { section id="levels" { h2 { "Solvers and levels" } (table.page("")) } }
}

/// Renders the points outside the tolerance, crashed runs first and then by decreasing error.
fn worst(sweep: &Sweep) -> Markup {
    let mut points: Vec<&super::Point> =
        sweep.points.iter().filter(|point| point.severity() == Some(Severity::Red)).collect();
    let size = |point: &super::Point| point.error().unwrap_or(f64::INFINITY);
    points.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let count = points.len();
    let words = |point: &super::Point| {
        let detail = point.left.detail.clone();
        detail.or_else(|| point.left.looked.iter().find_map(|looked| looked.detail.clone())).unwrap_or_default()
    };
    let factors = sweep.factors.iter().map(|factor| Column::text(&factor.label));
    let error = Column::new("|error|", Format::Fraction);
    let columns = [Column::text("Solver"), Column::text("Level"), error, Column::text("Why")];
    let row = |point: &&super::Point| {
        let mut cells: Vec<Cell> = point.factors.iter().map(|value| value_words(value).into()).collect();
        cells.extend([&point.solver, &point.resolution].map(Cell::from));
        cells.extend([point.error().into(), words(point).into()]);
        cells.into_iter().collect()
    };
    let table = Table::new("Farthest outside", factors.chain(columns), points.iter().take(MOST).map(row));
    html! {
        @if count > 0 {
            section id="outside" {
                h2 { "Farthest outside" }
                @if count > MOST { p.note { "The first " (MOST) " of " (number::count(count as u64)) "." } }
                (table.page(""))
            }
        }
    }
}

fn value_words(value: &serde_json::Value) -> String {
    match value.as_f64() {
        Some(number) => number::significant(number, 5),
        None => value.as_str().map_or_else(|| value.to_string(), str::to_owned),
    }
}
