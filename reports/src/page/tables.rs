//! Tables of negative controls and of costs of a case.

use grainbench_harness::verdict::ControlResult;
use maud::{Markup, html};

use crate::number;
use crate::report::RunCost;
use crate::row;
use crate::table::{Cell, Column, Columns, Format, Table};

pub(crate) fn controls(controls: &[ControlResult]) -> Markup {
    let columns = [
        Column::text("Result"),
        Column::heading("Quantity"),
        Column::text("Solver"),
        Column::text("Wrong physics"),
        Column::new("Error found, allowed", Format::Error),
    ];
    let row = |control: &ControlResult| {
        let (class, result) = if control.turned_red { ("pass", "✓ turned red") } else { ("fail", "✗ not red") };
        let variant = html! { @if !control.variant.is_empty() { span.fine { (control.variant) } } };
        let allowed = html! { span.fine { "allowed " (number::fraction(control.allowed)) } };
        let error = Cell::Page(
            html! { (number::error(control.error)) (allowed) },
            control.error.map(|error| error.abs().to_string()),
        );
        let result = html! { span class={ "mark " (class) } { (result) } " by " (control.how.word()) };
        let quantity = html! { (control.quantity) (variant) };
        row![result, quantity, &control.solver, &control.wrong_physics, error].class(class)
    };
    html! {
        p.note { "Each claim is evaluated with wrong physics and must fail." }
        (Table::new("", columns, controls.iter().map(row)).page("rows sorts"))
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
