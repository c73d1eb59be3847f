//! One case: claim, figures, what fails, every row, controls, costs, derivation, weaknesses.

use std::collections::BTreeSet;

use grainbench_harness::figure::Drawing;
use grainbench_harness::verdict::{Control, Outcome, Verdict};
use maud::{Markup, PreEscaped, html};

use super::{prose, scrolling, sign, slug, unique};
use crate::line;
use crate::number;
use crate::plot::{self, DrawError};
use crate::report::{RunCost, Section};

/// Graphs scroll on a phone, for their text would be too small; force plots have hardly any and shrink.
const fn plot_class(drawing: &Drawing) -> &'static str {
    match drawing {
        Drawing::Graph(_) => "plot graph",
        Drawing::Forces(_) | Drawing::Field(_) => "plot",
    }
}

/// Renders a case under `anchor`; `taken` are the anchors of the page.
pub(crate) fn render(section: &Section, anchor: &str, taken: &mut BTreeSet<String>) -> Result<Markup, DrawError> {
    let mut figures = Vec::new();
    for figure in &section.figures {
        let id = unique(&format!("{anchor}-{}", slug(&figure.name)), taken);
        figures.push(html! {
            figure id=(id) {
                div class=(plot_class(&figure.drawing)) { (PreEscaped(plot::draw(figure)?)) }
                figcaption { (figure.caption) }
            }
        });
    }
    // In order of the gates, but what fails first.
    let mut rows: Vec<&Verdict> = section.verdicts.iter().collect();
    rows.sort_by_key(|verdict| match verdict.outcome {
        Outcome::Fail => 0,
        Outcome::Broken => 1,
        Outcome::Pass => 3,
        _ => 2,
    });
    let failing = rows.iter().filter(|verdict| matches!(verdict.outcome, Outcome::Fail | Outcome::Broken));
    let green_controls = section.controls.iter().filter(|control| !control.turned_red);
    let fails = failing.clone().count() + green_controls.clone().count();
    Ok(html! {
        section.case id=(anchor) {
            p.kicker { (section.name) }
            h2 { (section.title) }
            p.claim { (section.claim) }
            @if fails > 0 {
                ul.failing aria-label="What fails in this case" {
                    @for verdict in failing { li { (line::verdict_in_section(verdict)) } }
                    @for control in green_controls { li { (line::control_in_section(control)) } }
                }
            }
            @for figure in &figures { (figure) }
            @if !rows.is_empty() {
                h3 { "Verdicts" }
                (verdict_table(&rows))
            }
            @if !section.controls.is_empty() {
                h3 { "Negative controls" }
                p.note { "Each gate is fed with wrong physics, which it must refuse." }
                (control_table(&section.controls))
            }
            @if !section.runs.is_empty() {
                h3 { "Costs" }
                p.note { "Counts do not depend on the machine; wall time does." }
                (cost_table(&section.runs))
            }
            @if !section.derivation.is_empty() {
                // Open, so that it is in print too.
                details open { summary { "Derivation" } div.prose { (prose::render(&section.derivation)) } }
            }
            @if !section.weak.is_empty() {
                h3 { "Where this test is weak" }
                div.prose.weak { (prose::render(&section.weak)) }
            }
            p.back { a href="#summary" { "↑ Summary" } }
        }
    })
}

fn verdict_table(rows: &[&Verdict]) -> Markup {
    let variants = rows.iter().any(|verdict| !verdict.variant.is_empty());
    let table = html! {
        table.rows {
            thead {
                tr {
                    th scope="col" { "Verdict" }
                    th scope="col" { "Quantity" }
                    @if variants { th scope="col" { "Variant" } }
                    th scope="col" { "Solver" }
                    th scope="col" { "Resolution" }
                    th.n scope="col" { "Value" }
                    th.n scope="col" { "Expected" }
                    th.n scope="col" { "Error" }
                    th.n scope="col" { "Allowed" }
                    th scope="col" { "Evidence" }
                    th scope="col" { "Source" }
                }
            }
            tbody { @for verdict in rows { (verdict_row(verdict, variants)) } }
        }
    };
    scrolling("Verdicts", &table)
}

fn verdict_row(verdict: &Verdict, variants: bool) -> Markup {
    let (symbol, class) = sign(verdict.outcome);
    let number =
        |value: Option<f64>| value.map_or_else(|| "—".to_owned(), |value| number::with_unit(value, &verdict.unit));
    html! {
        tr class=(class) {
            td.verdict {
                span.mark class=(class) { (symbol) " " (verdict.outcome.word()) }
                @if let Some(detail) = &verdict.detail { span.fine { (detail) } }
            }
            th scope="row" { (verdict.quantity) }
            @if variants { td { (verdict.variant) } }
            td { (verdict.solver) }
            td { (verdict.resolution) }
            td.n { (number(verdict.value)) }
            td.n { (line::expected(verdict.expected, &verdict.unit)) }
            td.n {
                (number::error(verdict.error))
                @if let (Some(scale), Some(_)) = (line::scale_note(verdict), verdict.error) {
                    span.fine { (scale) }
                }
            }
            td.n {
                (number::fraction(verdict.allowed))
                span.fine { (verdict.tolerance.word()) }
                @if let Some(used) = verdict.closeness() {
                    span.fine { (number::significant(used, 2)) (if used > 1.0 { " times it" } else { " of it used" }) }
                }
            }
            td { (verdict.evidence.word()) }
            td.wide {
                (verdict.source)
                @if !verdict.because.is_empty() { span.fine { "allowed: " (verdict.because) } }
            }
        }
    }
}

fn control_table(controls: &[Control]) -> Markup {
    let variants = controls.iter().any(|control| !control.variant.is_empty());
    let table = html! {
        table.rows {
            thead {
                tr {
                    th scope="col" { "Quantity" }
                    @if variants { th scope="col" { "Variant" } }
                    th scope="col" { "Solver" }
                    th scope="col" { "Wrong physics" }
                    th scope="col" { "Red by" }
                    th.n scope="col" { "Error seen" }
                    th.n scope="col" { "Allowed" }
                    th scope="col" { "Result" }
                }
            }
            tbody {
                @for control in controls {
                    @let (class, result) = if control.turned_red {
                        ("pass", "✓ turned red")
                    } else {
                        ("fail", "✗ not red")
                    };
                    tr class=(class) {
                        th scope="row" { (control.quantity) }
                        @if variants { td { (control.variant) } }
                        td { (control.solver) }
                        td.wide { (control.wrong_physics) }
                        td { (control.how.word()) }
                        td.n { (number::error(control.error)) }
                        td.n { (number::fraction(control.allowed)) }
                        td.verdict { span.mark class=(class) { (result) } }
                    }
                }
            }
        }
    };
    scrolling("Negative controls", &table)
}

fn cost_table(runs: &[RunCost]) -> Markup {
    let variants = runs.iter().any(|run| !run.variant.is_empty());
    let table = html! {
        table.rows.costs {
            thead {
                tr {
                    th scope="col" { "Solver" }
                    @if variants { th scope="col" { "Variant" } }
                    th scope="col" { "Resolution" }
                    th.n scope="col" { "Δt" }
                    th.n scope="col" { "Δt / critical" }
                    th.n scope="col" { "Steps" }
                    th.n scope="col" { "Particle-steps" }
                    th.n scope="col" { "Contact evaluations" }
                    th.n scope="col" { "Wall time" }
                }
            }
            tbody {
                @for run in runs {
                    tr {
                        th scope="row" { (run.solver) }
                        @if variants { td { (run.variant) } }
                        td { (run.resolution) }
                        td.n { (number::seconds(run.time_step)) }
                        td.n {
                            (run.fraction_of_critical.map_or("—".to_owned(), |part| number::significant(part, 3)))
                        }
                        td.n { (number::count(run.steps)) }
                        td.n { (number::count(run.particle_steps)) }
                        td.n { (run.contact_evaluations.map_or("—".to_owned(), number::count)) }
                        td.n { (number::seconds(run.wall_seconds)) }
                    }
                }
            }
        }
    };
    scrolling("Costs", &table)
}
