//! Page of a sweep.

use super::figures::levels;
use super::{Sweep, SweepStatus};
use crate::number;
use crate::page::{provenance, scrolling, shell};
use maud::{Markup, PreEscaped, html};

/// Largest number of points that the page lists one by one.
const MOST: usize = 50;

/// Renders the page. `drawings` contains name, caption and SVG of each drawing.
pub(super) fn render(sweep: &Sweep, drawings: &[(String, String, String)]) -> String {
    let [within, outside, amber, unjudged] = sweep.counts();
    let body = html! {
        main.alone {
            header id="summary" {
                p.kicker { "grainbench" }
                h1 { (sweep.title) }
                @if !sweep.about.is_empty() { p.lead { (sweep.about) } }
                ul.counts {
                    li.pass { b { (number::count(within as u64)) } " " span { "within" } }
                    li.fail { b { (number::count(outside as u64)) } " " span { "outside or broken" } }
                    li.amber { b { (number::count(amber as u64)) } " " span { "amber" } }
                    @if unjudged > 0 {
                        li.amber { b { (number::count(unjudged as u64)) } " " span { "not judged" } }
                    }
                    @if sweep.missing > 0 {
                        li.amber { b { (number::count(sweep.missing as u64)) } " " span { "not finished" } }
                    }
                }
                p { "Scene " code { (sweep.scene) } ", over " (factors(sweep)) ". Every row is in " code { "rows.csv" } " and "
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

fn factors(sweep: &Sweep) -> String {
    let words: Vec<&str> = sweep.factors.iter().map(|factor| factor.label.as_str()).collect();
    if words.is_empty() { "nothing: one point".to_owned() } else { words.join(", ") }
}

/// Renders a table with one row per solver and level: numbers of points by status, and errors.
fn table(sweep: &Sweep) -> Markup {
    let rows = levels(sweep).into_iter().map(|(solver, level)| {
        let level_points = || sweep.points.iter().filter(|point| point.solver == solver && point.resolution == level);
        let count = |standing| level_points().filter(|point| point.standing() == standing).count() as u64;
        let mut errors: Vec<f64> = level_points().filter_map(super::Point::error).collect();
        errors.sort_by(f64::total_cmp);
        let at = |part: f64| {
            errors.get(((errors.len() as f64 * part) as usize).min(errors.len().saturating_sub(1))).copied()
        };
        let mut steps: Vec<u64> =
            level_points().filter_map(|point| point.left.ran.map(|ran| ran.particle_steps)).collect();
        steps.sort_unstable();
        let error = |value: Option<f64>| value.map_or_else(|| "—".to_owned(), number::fraction);
        [
            solver.clone(),
            level.clone(),
            number::count(count(SweepStatus::Within)),
            number::count(count(SweepStatus::Outside)),
            number::count(count(SweepStatus::Amber)),
            number::count(count(SweepStatus::Unjudged)),
            error(at(0.5)),
            error(at(0.9)),
            error(errors.last().copied()),
            steps.get(steps.len() / 2).map_or_else(|| "—".to_owned(), |count| number::count(*count)),
        ]
    });
    let head = [
        "Solver",
        "Level",
        "Within",
        "Outside or broken",
        "Amber",
        "Not judged",
        "Median |error|",
        "90 % below",
        "Worst",
        "Particle-steps, median",
    ];
    let table = html! {
        table {
            thead { tr { @for word in head { th scope="col" { (word) } } } }
            tbody { @for row in rows { tr { @for cell in row { td { (cell) } } } } }
        }
    };
    html! { section id="levels" { h2 { "Solvers and levels" } (scrolling("Solvers and levels", &table)) } }
}

/// Renders the points outside the tolerance, crashed runs first and then by decreasing error.
fn worst(sweep: &Sweep) -> Markup {
    let mut points: Vec<&super::Point> =
        sweep.points.iter().filter(|point| point.standing() == SweepStatus::Outside).collect();
    let size = |point: &super::Point| point.error().unwrap_or(f64::INFINITY);
    points.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let count = points.len();
    let words = |point: &super::Point| {
        let detail = point.left.detail.clone();
        detail.or_else(|| point.left.looked.iter().find_map(|looked| looked.detail.clone())).unwrap_or_default()
    };
    let table = html! {
        table {
            thead { tr {
                @for factor in &sweep.factors { th scope="col" { (factor.label) } }
                @for word in ["Solver", "Level", "|error|", "Why"] { th scope="col" { (word) } }
            } }
            tbody { @for point in points.iter().take(MOST) { tr {
                @for value in &point.factors { td { (value_words(value)) } }
                td { (point.solver) } td { (point.resolution) }
                td { (point.error().map_or_else(|| "—".to_owned(), number::fraction)) } td { (words(point)) }
            } } }
        }
    };
    html! {
        @if count > 0 {
            section id="outside" {
                h2 { "Farthest outside" }
                @if count > MOST { p.note { "The first " (MOST) " of " (number::count(count as u64)) "." } }
                (scrolling("Farthest outside", &table))
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
