//! Section of one case: claim, failures and figures. Closed details contain all results, controls, costs, derivation
//! and limitations.

use std::collections::BTreeSet;

use grainbench_harness::verdict::ControlResult;
use maud::{Markup, Render, html};

use super::budget::{Part, Rank};
use super::{figures, prose, rows};
use crate::headline::Headline;
use crate::line;
use crate::number;
use crate::plot::DrawError;
use crate::report::{RunCost, Section};
use crate::table::{Cell, Column, Columns, Format};

/// Section of a case. Its figures, tables and derivations are parts that can be moved out of the page.
pub(crate) struct CaseSection<'a> {
    section: &'a Section,
    anchor: &'a str,
    figures: Vec<Part>,
    details: Vec<Details>,
}

struct Details {
    id: Option<String>,
    class: &'static str,
    summary: Markup,
    part: Part,
}

impl<'a> CaseSection<'a> {
    /// Returns the section. `names` are the file names of its figures, and `taken` the anchors of the page so far.
    pub(crate) fn new(
        section: &'a Section,
        anchor: &'a str,
        names: &[String],
        taken: &mut BTreeSet<String>,
    ) -> Result<Self, DrawError> {
        let figures = figures::parts(section, anchor, names, taken)?;
        let mut details = Vec::new();
        let mut add = |id, class, summary, (rank, name, title): (Rank, &str, &str), whole| {
            let title = format!("{}: {title}", section.name);
            let part = Part::text(rank, &title, format!("tables/{anchor}-{name}.html"), whole);
            details.push(Details { id, class, summary, part });
        };
        let sorted = rows::sorted(&section.verdicts);
        if !sorted.is_empty() {
            let counts = Headline::of_section(section);
            let summary = html! { "Rows " span.of { "(" (counts.sentence()) ")" } };
            let table = rows::table(&sorted, taken);
            add(Some(super::rows_of(anchor)), "rows-of", summary, (Rank::Rows, "rows", "every row"), table);
        }
        if !section.controls.is_empty() {
            let red = section.controls.iter().filter(|control| control.turned_red).count();
            let summary =
                html! { "Negative controls " span.of { "(" (red) " of " (section.controls.len()) " turned red)" } };
            let table = controls_table(&section.controls);
            add(None, "aside", summary, (Rank::Controls, "controls", "negative controls"), table);
        }
        if !section.runs.is_empty() {
            let summary = html! { "Costs " span.of { "(" (section.runs.len()) " runs)" } };
            add(None, "aside", summary, (Rank::Costs, "costs", "costs"), costs_table(&section.runs));
        }
        for (heading, text) in headed(&section.derivation) {
            let text = html! { div.prose { (prose::render(text)) } };
            let names = (Rank::Derivations, &*super::slug(heading), &*heading.to_lowercase());
            add(None, "aside", html! { (heading) }, names, text);
        }
        Ok(Self { section, anchor, figures, details })
    }

    /// Returns all parts that can be moved out of the page.
    pub(crate) fn parts(&mut self) -> impl Iterator<Item = &mut Part> {
        self.figures.iter_mut().chain(self.details.iter_mut().map(|details| &mut details.part))
    }

    /// Returns true if the table of all results is in the page.
    pub(crate) fn has_rows(&self) -> bool {
        self.details.iter().any(|details| details.part.rank == Rank::Rows && !details.part.is_moved)
    }
}

impl Render for CaseSection<'_> {
    fn render(&self) -> Markup {
        let Self { section, anchor, figures, details } = self;
        let failures: Vec<_> = section.failures(line::verdict_in_section, line::control_in_section).collect();
        // The search also looks through this text.
        let words = format!("{} {} {}", section.name, section.title, section.claim);
        html! {
            section.case id=(anchor) data-case=(section.name) data-words=(words) {
                p.kicker { (section.name) }
                h2 { (section.title) }
                p.claim { (section.claim) }
                @if !failures.is_empty() {
                    ul.failing aria-label="What fails in this case" { @for (_, line) in failures { li { (line) } } }
                }
                @if let Some(error) = &section.omitted { p.note { "The figures are omitted: " (error) } }
                (figures::render(figures))
                @for Details { id, class, summary, part } in details {
                    details id=[id.as_ref()] class=(class) { summary { (summary) } (part) }
                }
                @if !section.weak.is_empty() {
                    details.aside { summary { "Limitations" } div.prose { (prose::render(&section.weak)) } }
                }
            }
        }
    }
}

/// Returns the parts of a derivation with their headings. The part before the first heading (`## …`) is "Derivation".
fn headed(derivation: &str) -> impl Iterator<Item = (&str, &str)> {
    const HEADING: &str = "\n## ";
    let (first, rest) = derivation.split_once(HEADING).unwrap_or((derivation, ""));
    let parts = rest.split(HEADING).filter(|part| !part.is_empty());
    let parts = parts.map(|part| part.split_once('\n').unwrap_or((part, "")));
    Some(("Derivation", first)).filter(|(_, text)| !text.trim().is_empty()).into_iter().chain(parts)
}

fn controls_table(controls: &[ControlResult]) -> Markup {
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

fn costs_table(runs: &[RunCost]) -> Markup {
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
