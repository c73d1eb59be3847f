//! Page of a study.

use super::point::{Diagram, Point, PointStatus};
use super::{Study, cost, effects, estimate, load, stability, step};
use crate::measured::Costs;
use crate::number::{self, TimeUnit};
use crate::page::{provenance, scrolling, shell, slug, summary, unique};
use crate::plot::{self, DrawError};
use grainbench_harness::figure::Figure;
use maud::{Markup, PreEscaped, html};
use std::collections::BTreeSet;

/// Renders the page of a study.
///
/// # Errors
/// When a figure cannot be drawn.
pub(crate) fn render(study: &Study) -> Result<String, DrawError> {
    let mut taken = BTreeSet::from(["summary".to_owned(), "provenance".to_owned()]);
    let mut sections = Vec::new();
    if !study.diagrams.is_empty() {
        sections.push(cost_summary(study)?);
        for diagram in &study.diagrams {
            let anchor = unique(&slug(&format!("cost-{}-{}", diagram.case, diagram.variant)), &mut taken);
            sections.push(cost_section(diagram, &anchor)?);
        }
    }
    for cost in &study.scenes {
        sections.push(estimate::render(cost)?);
    }
    let is_cost = !(study.diagrams.is_empty() && study.scenes.is_empty());
    let mut title = "what accuracy costs";
    if !(study.limits.is_empty() && study.hard.is_empty()) {
        title = if is_cost { title } else { "what stays stable" };
        sections.push(if study.scenes.is_empty() {
            stability::render(study)?
        } else {
            stability::largest_steps(&study.limits)
        });
    }
    if !study.ledger.is_empty() {
        title = if is_cost { title } else { "influence of each effect" };
        sections.push(if study.scenes.is_empty() { effects::render(study) } else { effects::important(&study.ledger) });
    }
    let body = html! {
        main.alone {
            @for section in &sections { (section) }
            (provenance::render(&study.provenance))
        }
    };
    Ok(shell(&format!("grainbench · {title}"), &body))
}

/// Renders a figure with its caption.
pub(crate) fn figure(figure: &Figure) -> Result<Markup, DrawError> {
    Ok(html! {
        figure {
            div class="plot graph" { (PreEscaped(plot::draw(figure)?)) }
            figcaption { (figure.caption) }
        }
    })
}

/// Returns one sentence for each error, about the cost over all cases.
fn conclusions(study: &Study, costs: &Costs) -> Vec<String> {
    let sentence = |(at, target): (usize, f64)| {
        let parts: Vec<String> = costs
            .lines
            .iter()
            .filter_map(|line| {
                let factor = line.factors[at]?;
                let wins =
                    study.diagrams.iter().filter(|diagram| cost::is_cheapest(diagram, &line.solver, target)).count();
                Some(format!(
                    "{} reaches it in {} of {} quantities and is the cheapest in {wins}; its mean cost is {} times the \
                     cheapest over the {} quantities that other solvers also reach",
                    line.solver,
                    factor.reached,
                    line.asked,
                    number::significant(factor.times, 2),
                    factor.compared
                ))
            })
            .collect();
        let parts = if parts.is_empty() { "no solver reaches it".to_owned() } else { parts.join("; ") };
        format!("{}: {parts}.", number::fraction(target))
    };
    cost::TARGETS.into_iter().enumerate().map(sentence).collect()
}

fn cost_summary(study: &Study) -> Result<Markup, DrawError> {
    let costs = Costs::from_study(study, &|solver| study.sources.get(solver).cloned());
    let scatters: Vec<Markup> = cost::scatters(study).iter().map(figure).collect::<Result<_, _>>()?;
    Ok(html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What accuracy costs" }
            p.lead {
                "Error against computing time of each solver over its parameters, for each quantity with an exact \
                 solution. Times are medians of interleaved repetitions, one run at a time. Counts do not depend on \
                 the machine."
            }
            @if let Some(old) = &study.against { (changes(study, old)) }
            div.overview {
                div.plot.small { (PreEscaped(summary::picture(&costs))) }
                div {
                    (summary::factors(&costs))
                    h3 { "Over all cases" }
                    ul { @for line in conclusions(study, &costs) { li { (line) } } }
                }
            }
            h3 { "Which solver for which scene at 1 %" }
            (which(study))
            @if !study.loads.is_empty() { (load::render(&study.loads)?) }
            @for scatter in &scatters { (scatter) }
            @if let Some(model) = &study.model { (step::render(model)) }
        }
    })
}

fn changes(study: &Study, old: &str) -> Markup {
    html! {
        h3 { "Against " (old) }
        @if study.changes.is_empty() {
            p { "All counts are equal, and no time differs by more than noise." }
        } @else {
            ul.failing aria-label="What changed" {
                @for change in &study.changes { li { (change.what) ": " (change.how) } }
            }
        }
    }
}

/// Renders a table with one row per diagram and the cheapest setting of each solver at an error of 1 %.
fn which(study: &Study) -> Markup {
    let lines = cost::lines(&study.diagrams);
    let table = html! {
        table.cases {
            thead {
                tr {
                    th scope="col" { "Scene and quantity" }
                    @for line in &lines { th scope="col" { (line) } }
                }
            }
            tbody {
                @for diagram in &study.diagrams {
                    @let best = lines.iter().filter_map(|line| cost::cheapest(diagram, line, 0.01)?.wall_seconds)
                        .fold(f64::INFINITY, f64::min);
                    @let walls = lines.iter().filter_map(|line| cost::cheapest(diagram, line, 0.01)?.wall_seconds);
                    @let unit = TimeUnit::of(walls);
                    tr {
                        th scope="row" { (diagram.case) "/" (diagram.variant) span.title { (diagram.quantity) } }
                        @for line in &lines {
                            @match cost::cheapest(diagram, line, 0.01) {
                                Some(point) => {
                                    @let wall = point.wall_seconds.unwrap_or(f64::NAN);
                                    td {
                                        @if wall <= best { b { (unit.with_symbol(wall)) } }
                                        @else { (unit.with_symbol(wall)) " (× " (number::significant(wall / best, 2)) ")" }
                                        span.fine { (point.setting()) }
                                    }
                                }
                                None => { td { (not_reached(diagram, line)) } }
                            }
                        }
                    }
                }
            }
        }
    };
    scrolling("Which solver for which scene at 1 %", &table)
}

/// Returns the reason why a solver has no setting with an error of at most 1 %.
fn not_reached(diagram: &Diagram, line: &str) -> String {
    if cost::is_hidden(diagram, line, 0.01) {
        return "in less time than the variation of its start-up".to_owned();
    }
    let best = cost::of_line(diagram, line).filter_map(|point| point.error).min_by(f64::total_cmp);
    match (best, cost::of_line(diagram, line).next().map(|point| point.standing)) {
        (Some(best), _) => format!("at best {}", number::fraction(best)),
        (None, Some(PointStatus::Failed)) => "fails".to_owned(),
        (None, Some(PointStatus::NotAvailable)) => "not installed".to_owned(),
        (None, Some(_)) => "cannot express it".to_owned(),
        (None, None) => "—".to_owned(),
    }
}

fn cost_section(diagram: &Diagram, anchor: &str) -> Result<Markup, DrawError> {
    let picture = figure(&cost::figure(diagram))?;
    Ok(html! {
        section.case id=(anchor) {
            p.kicker { (diagram.case) "/" (diagram.variant) }
            h2 { (diagram.quantity) }
            (picture)
            ul { @for target in cost::TARGETS { li { (cost::sentence(diagram, target)) } } }
            (reasons(diagram))
            details {
                summary { "Every point" }
                (points(diagram))
            }
            p.back { a href="#summary" { "↑ Summary" } }
        }
    })
}

/// Renders the reasons why points have no error. Each reason appears once per solver.
fn reasons(diagram: &Diagram) -> Markup {
    let mut reasons: Vec<(&str, &str)> = diagram
        .points
        .iter()
        .filter(|point| point.standing != PointStatus::Failed)
        .filter_map(|point| point.detail.as_deref().map(|detail| (point.solver.as_str(), detail)))
        .collect();
    reasons.sort_unstable();
    reasons.dedup();
    html! { @for (solver, reason) in reasons { p.note { (solver) ": " (reason) } } }
}

fn points(diagram: &Diagram) -> Markup {
    let times = |point: &Point| [point.wall_seconds, point.cpu_seconds, point.start_up_seconds];
    let unit = TimeUnit::of(diagram.points.iter().flat_map(times).flatten());
    let table = html! {
        table.rows.costs {
            thead {
                tr {
                    th scope="col" { "Solver" }
                    th scope="col" { "Setting" }
                    th.n scope="col" { "Error" }
                    th.n scope="col" { "Wall time" }
                    th.n scope="col" { "Spread" }
                    th.n scope="col" { "CPU time" }
                    th.n scope="col" { "Start-up" }
                    th.n scope="col" { "Steps" }
                    th.n scope="col" { "Particle-steps" }
                    th.n scope="col" { "Contact evaluations" }
                    th.n scope="col" { "Node updates" }
                    th.n scope="col" { "Bytes" }
                    th scope="col" { "Parts of the error" }
                }
            }
            tbody { @for point in &diagram.points { (row(point, unit)) } }
        }
    };
    scrolling("Every point", &table)
}

fn row(point: &Point, unit: TimeUnit) -> Markup {
    let seconds = |value: Option<f64>| value.map_or("—".to_owned(), |seconds| unit.with_symbol(seconds));
    let class = match point.standing {
        PointStatus::Measured => "",
        PointStatus::Failed => "fail",
        PointStatus::Unsupported | PointStatus::NotAvailable => "amber",
    };
    html! {
        tr class=(class) {
            th scope="row" { (point.solver) }
            td { (point.setting()) }
            td.n { (point.error.map_or("—".to_owned(), number::fraction)) }
            td.n { (seconds(point.wall_seconds)) }
            td.n { (point.wall_spread.map_or("—".to_owned(), number::fraction)) }
            td.n { (seconds(point.cpu_seconds)) }
            td.n { (seconds(point.start_up_seconds)) }
            td.n { (number::count(point.counts.steps)) }
            td.n { (number::count(point.counts.particle_steps)) }
            @for count in [point.counts.contact_evaluations, point.counts.node_updates, point.counts.bytes] {
                td.n { (count.map_or("—".to_owned(), number::count)) }
            }
            td.wide { (point.floor.as_deref().or(point.detail.as_deref()).unwrap_or("")) }
        }
    }
}
