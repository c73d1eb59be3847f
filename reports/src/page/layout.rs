//! Frame of every page, and the names and signs that all pages share.

use crate::class;
use crate::plot::{graph, markup};
use grainbench_harness::figure::{Drawing, Figure};
use grainbench_harness::verdict::{Outcome, Severity};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::collections::BTreeSet;

pub(super) const CSS: &str = include_str!("style.css");
/// Optional script of the page for search, filters and films.
pub(super) const SCRIPT: &str = include_str!("page.js");

/// Returns the anchor of the table with all results of a case.
pub(crate) fn rows_of(anchor: &str) -> String {
    format!("{anchor}-rows")
}

/// Returns a complete HTML page with the given body.
pub(crate) fn shell(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                // Without an icon link, a browser would request an icon from the server.
                link rel="icon" href="data:,";
                title { (title) }
                style { (PreEscaped(CSS)) }
            }
            body { (body) script { (PreEscaped(SCRIPT)) } }
        }
    };
    markup(&page.into_string())
}

/// Returns a name reduced to lower-case letters, digits and `-`, for anchors and file names.
pub(crate) fn slug(name: &str) -> String {
    let parts = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    let slug = parts.collect::<Vec<_>>().join("-").to_ascii_lowercase();
    if slug.is_empty() { "unnamed".to_owned() } else { slug }
}

/// Returns `stem`, or `stem-2`, `stem-3` and so on if the name is already used.
pub(crate) fn unique(stem: &str, taken: &mut BTreeSet<String>) -> String {
    let mut names = std::iter::once(stem.to_owned()).chain((2..).map(|next| format!("{stem}-{next}")));
    names.find(|name| taken.insert(name.clone())).unwrap_or_default()
}

/// Returns the symbol and the CSS class of an outcome. The symbols differ also without colour.
pub(crate) const fn sign(outcome: Outcome) -> (&'static str, &'static str) {
    let symbol = match outcome.severity() {
        Severity::Green => "✓",
        Severity::Red => "✗",
        Severity::Amber => "▲",
    };
    (symbol, class(outcome.severity()))
}

pub(crate) fn captioned(figure: &Figure) -> Markup {
    html! {
        figure {
            @if let Drawing::Graph(graph) = &figure.drawing {
                div class="plot graph" { (PreEscaped(markup(&graph::draw(&figure.title, graph)))) }
            }
            figcaption { (figure.caption) }
        }
    }
}
