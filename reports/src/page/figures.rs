//! Figures of a case. The first ones are visible, and all others are in a closed section. Films have a pause button.

use std::collections::BTreeSet;

use grainbench_harness::figure::{Drawing, Figure};
use maud::{Markup, PreEscaped, html};
use rayon::prelude::*;

use super::budget::{Part, Piece, Rank};
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

/// Returns the figures of a section as pieces of the page. `names` contains the file names of the figures.
pub(crate) fn pieces(
    section: &Section,
    anchor: &str,
    names: &[String],
    taken: &mut BTreeSet<String>,
) -> Result<Vec<Piece>, DrawError> {
    let ids: Vec<String> =
        section.figures.iter().map(|figure| unique(&format!("{anchor}-{}", slug(&figure.name)), taken)).collect();
    let named = section.figures.par_iter().zip(names).zip(&ids);
    let parts: Vec<Part> = named.map(|((figure, name), id)| part(figure, name, id)).collect::<Result<_, _>>()?;
    let mut pieces = Vec::new();
    let count = section.figures.len();
    let fixed = |text: &str| Piece::Fixed(text.to_owned());
    for (at, mut part) in parts.into_iter().enumerate() {
        if at >= SEEN && part.rank == Rank::Figures {
            part.rank = Rank::ClosedFigures;
        }
        if at == 0 {
            pieces.push(fixed("<div class=\"figures aside\">"));
        }
        if at == SEEN {
            let more = count - SEEN;
            let head = format!(
                "</div><details class=\"aside\"><summary>{more} more figure{}</summary><div class=\"figures\">",
                if more == 1 { "" } else { "s" }
            );
            pieces.push(Piece::Fixed(head));
        }
        pieces.push(Piece::Part(part));
        if at + 1 == count {
            pieces.push(fixed(if count > SEEN { "</div></details>" } else { "</div>" }));
        }
    }
    Ok(pieces)
}

/// Returns a figure as a part of the page, with the link that replaces it if the page becomes too large.
pub(crate) fn part(figure: &Figure, name: &str, id: &str) -> Result<Part, DrawError> {
    let (still, reel) = plot::draw_small(figure)?;
    let still = PreEscaped(still);
    let shown = html! {
        @if let Some(reel) = &reel {
            div.film data-title=(figure.title) data-film=(reel) {
                div class=(class(&figure.drawing)) { (still) }
                button type="button" hidden { "Pause" }
            }
        } @else {
            div class=(class(&figure.drawing)) { (still) }
        }
    };
    let whole = framed(figure, name, id, &shown).into_string();
    // A moved film is replaced by its last frame. Any other moved figure is replaced by an image loaded from its file.
    let link = if reel.is_some() {
        framed(figure, name, id, &html! { div class=(class(&figure.drawing)) { (still) } })
    } else {
        let image = html! {
            div class=(class(&figure.drawing)) {
                img loading="lazy" width="860" height="520" src={ "figures/" (name) ".svg" } alt=(figure.title);
            }
        };
        framed(figure, name, id, &image)
    };
    let rank = match reel {
        Some(_) => Rank::Films,
        None if whole.len() > HEAVY => Rank::HeavyFigures,
        None => Rank::Figures,
    };
    Ok(Part { rank, whole, link: link.into_string(), file: None })
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
