//! Tables of negative controls and of costs of a case.

use grainbench_harness::verdict::Control;
use maud::{Markup, html};

use super::scrolling;
use crate::number::{self, TimeUnit};
use crate::report::RunCost;

/// Renders the table of negative controls with their results.
pub(crate) fn controls(controls: &[Control]) -> Markup {
    html! {
        p.note { "Each claim is evaluated with wrong physics and must fail." }
        table.rows.sorts {
            thead {
                tr {
                    th scope="col" { "Result" }
                    th scope="col" { "Quantity" }
                    th scope="col" { "Solver" }
                    th scope="col" { "Wrong physics" }
                    th.n scope="col" { "Error found, allowed" }
                }
            }
            tbody {
                @for control in controls {
                    @let (class, result) = if control.turned_red { ("pass", "✓ turned red") } else { ("fail", "✗ not red") };
                    tr class=(class) {
                        td { span class={ "mark " (class) } { (result) } " by " (control.how.word()) }
                        th scope="row" {
                            (control.quantity)
                            @if !control.variant.is_empty() { span.fine { (control.variant) } }
                        }
                        td { (control.solver) }
                        td { (control.wrong_physics) }
                        td.n data-v=[control.error.map(f64::abs)] {
                            (number::error(control.error)) span.fine { "allowed " (number::fraction(control.allowed)) }
                        }
                    }
                }
            }
        }
    }
}

/// Renders the table with the cost of every run.
pub(crate) fn costs(runs: &[RunCost]) -> Markup {
    let variants = runs.iter().any(|run| !run.variant.is_empty());
    let (step, wall) =
        (TimeUnit::of(runs.iter().map(|run| run.time_step)), TimeUnit::of(runs.iter().map(|run| run.wall_seconds)));
    let table = html! {
        table.sorts {
            thead {
                tr {
                    th scope="col" { "Solver" }
                    @if variants { th scope="col" { "Variant" } }
                    th scope="col" { "Resolution" }
                    th.n scope="col" { "Δt (" (step.symbol) ")" }
                    th.n scope="col" { "Δt / critical" }
                    th.n scope="col" { "Steps" }
                    th.n scope="col" { "Particle-steps" }
                    th.n scope="col" { "Contact evaluations" }
                    th.n scope="col" { "Wall time (" (wall.symbol) ")" }
                }
            }
            tbody {
                @for run in runs {
                    tr {
                        th scope="row" { (run.solver) }
                        @if variants { td { (run.variant) } }
                        td { (run.resolution) }
                        td.n data-v=(run.time_step) { (step.number(run.time_step)) }
                        td.n { (run.fraction_of_critical.map_or("—".to_owned(), |part| number::significant(part, 3))) }
                        td.n data-v=(run.steps) { (number::count(run.steps)) }
                        td.n data-v=(run.particle_steps) { (number::count(run.particle_steps)) }
                        td.n { (run.contact_evaluations.map_or("—".to_owned(), number::count)) }
                        @if run.wall_seconds.is_finite() {
                            td.n data-v=(run.wall_seconds) { (wall.number(run.wall_seconds)) }
                        } @else {
                            td.n { "—" }
                        }
                    }
                }
            }
        }
    };
    html! { p.note { "Counts do not depend on the machine, but the wall time does." } (scrolling("Costs", &table)) }
}
