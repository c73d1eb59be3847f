//! Tables of negative controls and of costs of a case.

use grainbench_harness::verdict::ControlResult;
use maud::{Markup, html};

use crate::number;
use crate::report::RunCost;
use crate::table::{Cell, Column, Columns, Format};

pub(crate) fn controls(controls: &[ControlResult]) -> Markup {
    let class = |control: &ControlResult| if control.turned_red { "pass" } else { "fail" };
    let result = |control: &ControlResult| {
        let result = if control.turned_red { "✓ turned red" } else { "✗ not red" };
        html! { span class={ "mark " (class(control)) } { (result) } " by " (control.how.word()) }
    };
    let quantity = |control: &ControlResult| {
        html! { (control.quantity) @if !control.variant.is_empty() { span.fine { (control.variant) } } }
    };
    let error = |control: &ControlResult| {
        let allowed = html! { span.fine { "allowed " (number::fraction(control.allowed)) } };
        let key = control.error.map(|error| error.abs().to_string());
        Cell::Page(html! { (number::error(control.error)) (allowed) }, key)
    };
    let columns = Columns::<&ControlResult>::new(Column::text("Result"), result)
        .and(Column::heading("Quantity"), quantity)
        .and(Column::text("Solver"), |control| &control.solver)
        .and(Column::text("Wrong physics"), |control| &control.wrong_physics)
        .and(Column::new("Error found, allowed", Format::Error), error);
    html! {
        p.note { "Each claim is evaluated with wrong physics and must fail." }
        (columns.table("", controls, class).page("rows sorts"))
    }
}

pub(crate) fn costs(runs: &[RunCost]) -> Markup {
    let mut columns = Columns::<&RunCost>::new(Column::heading("Solver"), |run| &run.solver);
    if runs.iter().any(|run| !run.variant.is_empty()) {
        columns = columns.and(Column::text("Variant"), |run| &run.variant);
    }
    let columns = columns
        .and(Column::text("Resolution"), |run| &run.resolution)
        .and(Column::new("Δt", Format::Seconds), |run| run.time_step)
        .and(Column::number("Δt / critical"), |run| run.fraction_of_critical)
        .and(Column::new("Steps", Format::Count), |run| run.steps)
        .and(Column::new("Particle-steps", Format::Count), |run| run.particle_steps)
        .and(Column::new("Contact evaluations", Format::Count), |run| run.contact_evaluations)
        .and(Column::new("Wall time", Format::Seconds), |run| Cell::finite(Some(run.wall_seconds)));
    html! {
        p.note { "Counts do not depend on the machine, but the wall time does." }
        (columns.table("Costs", runs, |_| "").page("sorts"))
    }
}
