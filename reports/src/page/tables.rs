//! Tables of negative controls and of costs of a case.

use grainbench_harness::verdict::ControlResult;
use maud::{Markup, html};

use crate::number;
use crate::report::RunCost;
use crate::row;
use crate::table::{Cell, Column, Format, Table};

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
    let has_variants = runs.iter().any(|run| !run.variant.is_empty());
    let columns = [Column::heading("Solver")].into_iter().chain(has_variants.then(|| Column::text("Variant")));
    let columns = columns.chain([
        Column::text("Resolution"),
        Column::new("Δt", Format::Seconds),
        Column::number("Δt / critical"),
        Column::new("Steps", Format::Count),
        Column::new("Particle-steps", Format::Count),
        Column::new("Contact evaluations", Format::Count),
        Column::new("Wall time", Format::Seconds),
    ]);
    let row = |run: &RunCost| {
        let names = [Cell::from(&run.solver)].into_iter().chain(has_variants.then(|| Cell::from(&run.variant)));
        let steps = [Cell::from(&run.resolution), run.time_step.into(), run.fraction_of_critical.into()];
        let counts = [Cell::from(run.steps), run.particle_steps.into(), run.contact_evaluations.into()];
        names.chain(steps).chain(counts).chain([Cell::finite(Some(run.wall_seconds))]).collect()
    };
    html! {
        p.note { "Counts do not depend on the machine, but the wall time does." }
        (Table::new("Costs", columns, runs.iter().map(row)).page("sorts"))
    }
}
