//! Page of a study.

use super::point::{Diagram, Point, PointStatus};
use super::{Study, cost, effects, estimate, load, stability_page, step};
use crate::measured::{Costs, Factor, Line};
use crate::number::{self, TimeUnit};
use crate::page::{captioned, provenance, shell, slug, summary, unique};
use crate::table::{Cell, Column, Columns, Format, Table};
use maud::{Markup, PreEscaped, html};
use std::collections::BTreeSet;

pub(crate) fn render(study: &Study) -> String {
    let mut taken = BTreeSet::from(["summary".to_owned(), "provenance".to_owned()]);
    let is_cost = !(study.diagrams.is_empty() && study.scenes.is_empty());
    let has_limits = !(study.limits.is_empty() && study.hard.is_empty());
    let title = match (is_cost, study.ledger.is_empty()) {
        (false, false) => "influence of each effect",
        (false, true) if has_limits => "what stays stable",
        _ => "what accuracy costs",
    };
    let body = html! {
        main.alone {
            @if !study.diagrams.is_empty() { (cost_summary(study)) }
            @for diagram in &study.diagrams {
                (cost_section(diagram, &unique(&slug(&format!("cost-{}-{}", diagram.case, diagram.variant)), &mut taken)))
            }
            @for cost in &study.scenes { (estimate::render(cost, &study.limits)) }
            @if has_limits {
                @if study.scenes.is_empty() { (stability_page::render(study)) }
                @else { (stability_page::largest_steps(&study.limits)) }
            }
            @if !study.ledger.is_empty() {
                @if study.scenes.is_empty() { (effects::render(&study.ledger)) }
                @else { (effects::important(&study.ledger)) }
            }
            (provenance::render(&study.provenance))
        }
    };
    shell(&format!("grainbench · {title}"), &body)
}

/// Returns one sentence for each error, about the cost over all cases.
fn conclusions(study: &Study, costs: &Costs) -> Vec<String> {
    let sentence = |(at, target): (usize, f64)| {
        let part = |line: &Line| {
            let Factor { times, compared, reached, .. } = line.factors[at]?;
            let Line { solver, asked, .. } = line;
            let wins = study.diagrams.iter().filter(|diagram| cost::is_cheapest(diagram, solver, target)).count();
            let times = number::significant(times, 2);
            Some(format!(
                "{solver} reaches it in {reached} of {asked} quantities and is the cheapest in {wins}; its mean cost is \
                 {times} times the cheapest over the {compared} quantities that other solvers also reach"
            ))
        };
        let parts: Vec<String> = costs.lines.iter().filter_map(part).collect();
        let parts = if parts.is_empty() { "no solver reaches it".to_owned() } else { parts.join("; ") };
        format!("{}: {parts}.", number::fraction(target))
    };
    cost::TARGETS.into_iter().enumerate().map(sentence).collect()
}

fn cost_summary(study: &Study) -> Markup {
    let costs = Costs::from_study(study, &|solver| study.sources.get(solver).cloned());
    html! {
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
            @if !study.loads.is_empty() { (load::render(&study.loads)) }
            @for scatter in cost::scatters(&study.diagrams) { (captioned(&scatter)) }
            @if let Some(model) = &study.model { (step::render(model)) }
        }
    }
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
    let columns = [Column::heading("Scene and quantity")].into_iter().chain(lines.iter().copied().map(Column::text));
    let row = |diagram: &Diagram| {
        let time = |line: &&str| cost::time(diagram, line, 0.01);
        let best = lines.iter().filter_map(time).fold(f64::INFINITY, f64::min);
        let unit = TimeUnit::of(lines.iter().filter_map(time));
        let cell = |line: &&str| {
            let Some(point) = cost::cheapest(diagram, line, 0.01) else { return not_reached(diagram, line).into() };
            let wall = point.wall_seconds.unwrap_or(f64::NAN);
            let times = number::significant(wall / best, 2);
            Cell::from(html! {
                @if wall <= best { b { (unit.with_symbol(wall)) } } @else { (unit.with_symbol(wall)) " (× " (times) ")" }
                span.fine { (point.setting()) }
            })
        };
        let name = html! { (diagram.case) "/" (diagram.variant) span.title { (diagram.quantity) } };
        [Cell::from(name)].into_iter().chain(lines.iter().map(cell)).collect()
    };
    Table::new("Which solver for which scene at 1 %", columns, study.diagrams.iter().map(row)).page("cases")
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

fn cost_section(diagram: &Diagram, anchor: &str) -> Markup {
    html! {
        section.case id=(anchor) {
            p.kicker { (diagram.case) "/" (diagram.variant) }
            h2 { (diagram.quantity) }
            (captioned(&cost::figure(diagram)))
            ul { @for target in cost::TARGETS { li { (cost::sentence(diagram, target)) } } }
            (reasons(diagram))
            details {
                summary { "Every point" }
                (points(diagram))
            }
            p.back { a href="#summary" { "↑ Summary" } }
        }
    }
}

/// Renders the reasons why points have no error. Each reason appears once per solver.
fn reasons(diagram: &Diagram) -> Markup {
    let points = diagram.points.iter().filter(|point| point.standing != PointStatus::Failed);
    let reasons: BTreeSet<_> =
        points.filter_map(|point| point.detail.as_ref().map(|detail| (&point.solver, detail))).collect();
    html! { @for (solver, reason) in reasons { p.note { (solver) ": " (reason) } } }
}

fn points(diagram: &Diagram) -> Markup {
    let [time, fraction, count] =
        [Format::Seconds, Format::Fraction, Format::Count].map(|format| move |name| Column::new(name, format));
    let class = |point: &Point| match point.standing {
        PointStatus::Measured => "",
        PointStatus::Failed => "fail",
        PointStatus::OverBudget | PointStatus::Unsupported | PointStatus::NotAvailable => "amber",
    };
    Columns::<&Point>::new(Column::heading("Solver"), |point| &point.solver)
        .and(Column::text("Setting"), Point::setting)
        .and(fraction("Error"), |point| point.error)
        .and(time("Wall time"), |point| point.wall_seconds)
        .and(fraction("Spread"), |point| point.wall_spread)
        .and(time("CPU time"), |point| point.cpu_seconds)
        .and(time("Start-up"), |point| point.start_up_seconds)
        .and(count("Steps"), |point| point.counts.steps)
        .and(count("Particle-steps"), |point| point.counts.particle_steps)
        .and(count("Contact evaluations"), |point| point.counts.contact_evaluations)
        .and(count("Node updates"), |point| point.counts.node_updates)
        .and(count("Bytes"), |point| point.counts.bytes)
        .and(Column::text("Parts of the error").class("wide"), |point| {
            point.floor.as_deref().or(point.detail.as_deref()).unwrap_or("")
        })
        .table("Every point", &diagram.points, class)
        .page("rows costs")
}
