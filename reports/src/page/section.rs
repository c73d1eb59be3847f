//! Section of one case: claim, failures and figures. Closed details contain all results, controls, costs, derivation
//! and limitations.

use std::collections::BTreeSet;

use maud::{Markup, PreEscaped, html};

use super::budget::{Part, Piece, Rank};
use super::{figures, prose, rows, tables};
use crate::headline::Headline;
use crate::line;
use crate::plot::DrawError;
use crate::report::Section;

/// Returns the pieces of a case. `names` contains the file names of its figures, and `taken` the anchors that the page
/// already uses.
pub(crate) fn pieces(
    section: &Section,
    anchor: &str,
    names: &[String],
    taken: &mut BTreeSet<String>,
) -> Result<Vec<Piece>, DrawError> {
    let mut pieces = vec![Piece::Fixed(open(section, anchor))];
    pieces.extend(figures::pieces(section, anchor, names, taken)?);
    let sorted = rows::sorted(&section.verdicts);
    if !sorted.is_empty() {
        let counts = Headline::of_section(section);
        let id = super::rows_of(anchor);
        let summary = html! { "Rows " span.of { "(" (counts.sentence()) ")" } };
        let path = format!("tables/{anchor}-rows.html");
        let title = format!("{}: every row", section.name);
        let table = rows::table(&sorted, taken).into_string();
        folded(&mut pieces, Some(&id), "rows-of", &summary, Part::text(Rank::Rows, &title, path, table));
    }
    if !section.controls.is_empty() {
        let red = section.controls.iter().filter(|control| control.turned_red).count();
        let summary =
            html! { "Negative controls " span.of { "(" (red) " of " (section.controls.len()) " turned red)" } };
        let table = tables::controls(&section.controls).into_string();
        let title = format!("{}: negative controls", section.name);
        folded(
            &mut pieces,
            None,
            "aside",
            &summary,
            Part::text(Rank::Controls, &title, format!("tables/{anchor}-controls.html"), table),
        );
    }
    if !section.runs.is_empty() {
        let summary = html! { "Costs " span.of { "(" (section.runs.len()) " runs)" } };
        let title = format!("{}: costs", section.name);
        let table = tables::costs(&section.runs).into_string();
        folded(
            &mut pieces,
            None,
            "aside",
            &summary,
            Part::text(Rank::Costs, &title, format!("tables/{anchor}-costs.html"), table),
        );
    }
    for (heading, text) in headed(&section.derivation) {
        let text = html! { div.prose { (prose::render(text)) } }.into_string();
        let title = format!("{}: {}", section.name, heading.to_lowercase());
        let part =
            Part::text(Rank::Derivations, &title, format!("tables/{anchor}-{}.html", super::slug(heading)), text);
        folded(&mut pieces, None, "aside", &html! { (heading) }, part);
    }
    if !section.weak.is_empty() {
        let text = html! {
            details.aside { summary { "Limitations" } div.prose { (prose::render(&section.weak)) } }
        };
        pieces.push(Piece::Fixed(text.into_string()));
    }
    pieces.push(Piece::Fixed("</section>".to_owned()));
    Ok(pieces)
}

/// Returns the parts of a derivation with their headings. The part before the first heading (`## …`) is "Derivation".
fn headed(derivation: &str) -> impl Iterator<Item = (&str, &str)> {
    const HEADING: &str = "\n## ";
    let (first, rest) = derivation.split_once(HEADING).unwrap_or((derivation, ""));
    let parts = rest.split(HEADING).filter(|part| !part.is_empty());
    let parts = parts.map(|part| part.split_once('\n').unwrap_or((part, "")));
    Some(("Derivation", first)).filter(|(_, text)| !text.trim().is_empty()).into_iter().chain(parts)
}

/// Adds a part within closed details.
fn folded(pieces: &mut Vec<Piece>, id: Option<&str>, class: &str, summary: &Markup, part: Part) {
    let open = html! { details id=[id] class=(class) { summary { (summary) } (PreEscaped("\u{0}")) } }.into_string();
    let (before, after) = open.split_once('\u{0}').unwrap_or((&open, ""));
    pieces.push(Piece::Fixed(before.to_owned()));
    pieces.push(Piece::Part(part));
    pieces.push(Piece::Fixed(after.to_owned()));
}

/// Returns the opening tag and the beginning of the section.
fn open(section: &Section, anchor: &str) -> String {
    let failing = section.verdicts.iter().filter(|row| row.outcome.is_red());
    let green_controls = section.controls.iter().filter(|control| !control.turned_red);
    let fails = failing.clone().count() + green_controls.clone().count();
    // The search also looks through this text.
    let words = format!("{} {} {}", section.name, section.title, section.claim);
    let tag = html! { section.case id=(anchor) data-case=(section.name) data-words=(words) {} }.into_string();
    let head = html! {
        p.kicker { (section.name) }
        h2 { (section.title) }
        p.claim { (section.claim) }
        @if fails > 0 {
            ul.failing aria-label="What fails in this case" {
                @for verdict in failing { li { (line::verdict_in_section(verdict)) } }
                @for control in green_controls { li { (line::control_in_section(control)) } }
            }
        }
    };
    tag.trim_end_matches("</section>").to_owned() + &head.into_string()
}
