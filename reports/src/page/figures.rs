//! Figures of a case. The first ones are visible, and all others are in a closed section. Films have a pause button.

use std::collections::BTreeSet;

use grainbench_harness::figure::{Drawing, Figure};
use maud::{Markup, PreEscaped, html};
use rayon::prelude::*;

use super::budget::{Part, Rank};
use super::{prose, slug, unique};
use crate::plot::{self, DrawError};
use crate::report::Section;

/// Size above which a figure is moved out of the page before films (bytes).
const HEAVY: usize = 30_000;
/// Number of figures of a case that are visible without opening a section.
const SEEN: usize = 2;

/// Returns the CSS class of a drawing. On a narrow screen, graphs scroll, because their text would become too small,
/// and all other drawings shrink. Images of fields keep their colours on a dark page.
const fn class(drawing: &Drawing) -> &'static str {
    match drawing {
        Drawing::Graph(_) => "plot graph",
        Drawing::Forces(_) | Drawing::Lines(_) => "plot",
        Drawing::Field(_) => "plot field",
    }
}

/// Returns the figures of a section. `names` contains the file names of the figures.
pub(crate) fn parts(
    section: &Section,
    anchor: &str,
    names: &[String],
    taken: &mut BTreeSet<String>,
) -> Result<Vec<Part>, DrawError> {
    let ids: Vec<String> =
        section.figures.iter().map(|figure| unique(&format!("{anchor}-{}", slug(&figure.name)), taken)).collect();
    let named = section.figures.par_iter().zip(names).zip(&ids);
    let mut parts: Vec<Part> = named.map(|((figure, name), id)| part(figure, name, id)).collect::<Result<_, _>>()?;
    for part in parts.iter_mut().skip(SEEN).filter(|part| part.rank == Rank::Figures) {
        part.rank = Rank::ClosedFigures;
    }
    Ok(parts)
}

/// Renders the figures of a section, the first ones visible and the others in a closed section.
pub(crate) fn render(parts: &[Part]) -> Markup {
    let (seen, closed) = parts.split_at(parts.len().min(SEEN));
    html! {
        @if !seen.is_empty() { div class="figures aside" { @for part in seen { (part) } } }
        @if !closed.is_empty() {
            details.aside {
                summary { (closed.len()) " more figure" @if closed.len() > 1 { "s" } }
                div.figures { @for part in closed { (part) } }
            }
        }
    }
}

/// Returns a figure as a part of the page, with the link that replaces it if the page becomes too large.
pub(crate) fn part(figure: &Figure, name: &str, id: &str) -> Result<Part, DrawError> {
    let (still, reel) = plot::draw_small(figure)?;
    let still = html! { div class=(class(&figure.drawing)) { (PreEscaped(still)) } };
    let shown = html! {
        @if let Some(reel) = &reel {
            div.film data-title=(figure.title) data-film=(reel) { (still) button type="button" hidden { "Pause" } }
        } @else { (still) }
    };
    let whole = framed(figure, name, id, &shown);
    // A moved film is replaced by its last frame. Any other moved figure is replaced by an image loaded from its file.
    let lighter = html! {
        @if reel.is_some() { (still) } @else {
            div class=(class(&figure.drawing)) {
                img loading="lazy" width="860" height="520" src={ "figures/" (name) ".svg" } alt=(figure.title);
            }
        }
    };
    let link = framed(figure, name, id, &lighter);
    let rank = match reel {
        Some(_) => Rank::Films,
        None if whole.0.len() > HEAVY => Rank::HeavyFigures,
        None => Rank::Figures,
    };
    Ok(Part::figure(rank, whole, link))
}

/// Returns a figure with its caption and links to its files.
fn framed(figure: &Figure, name: &str, id: &str, shown: &Markup) -> Markup {
    html! {
        figure id=(id) {
            (shown)
            figcaption {
                (prose::inline(&figure.caption))
                span.act {
                    " "
                    @match &figure.drawing {
                        Drawing::Graph(_) => { a href={ "figures/" (name) ".csv" } { "data (CSV)" } }
                        Drawing::Field(field) if field.times.len() > 1 => { a href={ "figures/" (name) ".png" } { "film" } }
                        _ => { a href={ "figures/" (name) ".svg" } { "picture" } }
                    }
                }
            }
        }
    }
}
