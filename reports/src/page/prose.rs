//! Markdown texts of the cases as HTML. Raw HTML is shown as text, and images are replaced by their text.

use maud::{Markup, PreEscaped};
use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

use crate::plot::text;

/// Renders Markdown with tables. Its headings have lower levels than the headings of the page.
pub(crate) fn render(markdown: &str) -> Markup {
    let events = Parser::new_ext(markdown, Options::ENABLE_TABLES).map(tame);
    let mut text = String::new();
    html::push_html(&mut text, events);
    PreEscaped(text)
}

/// Renders a caption: text between backticks is code, and symbols have subscripts. All other Markdown stays text,
/// because captions contain formulas.
pub(crate) fn inline(caption: &str) -> Markup {
    maud::html! {
        @for (at, part) in caption.split('`').enumerate() {
            @if at % 2 == 1 { code { (part) } } @else { (text::html(part)) }
        }
    }
}

fn tame(event: Event<'_>) -> Event<'_> {
    match event {
        Event::Html(raw) | Event::InlineHtml(raw) => Event::Text(raw),
        Event::Start(Tag::Image { .. }) => Event::Start(Tag::Emphasis),
        Event::End(TagEnd::Image) => Event::End(TagEnd::Emphasis),
        Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
            Event::Start(Tag::Link { link_type, dest_url: harmless(dest_url), title, id })
        }
        Event::Start(Tag::Heading { level, classes, attrs, .. }) => {
            Event::Start(Tag::Heading { level: lower(level), id: None, classes, attrs })
        }
        Event::End(TagEnd::Heading(level)) => Event::End(TagEnd::Heading(lower(level))),
        other => other,
    }
}

/// Returns the address of a link to a web page or to a place in this page; otherwise the address of the summary.
fn harmless(address: CowStr<'_>) -> CowStr<'_> {
    let known = ["https://", "http://", "#"];
    if known.iter().any(|start| address.starts_with(start)) { address } else { CowStr::Borrowed("#summary") }
}

const fn lower(level: HeadingLevel) -> HeadingLevel {
    match level {
        HeadingLevel::H1 | HeadingLevel::H2 => HeadingLevel::H4,
        HeadingLevel::H3 => HeadingLevel::H5,
        _ => HeadingLevel::H6,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_have_code_and_subscripts() {
        let text = inline("`mpm` at 2*k_n < E*").into_string();
        assert_eq!(text, "<code>mpm</code> at 2*k<sub>n</sub> &lt; E*");
    }

    #[test]
    fn keeps_formulas_and_tames_the_rest() {
        let text = render("# Slip\n\n`t* = 2v₀/7μg` <b onload=\"x\">\n\n    a < b\n\n[x](javascript:y) ![z](q)");
        assert_eq!(
            text.into_string(),
            "<h4>Slip</h4>\n<p><code>t* = 2v₀/7μg</code> &lt;b onload=\"x\"&gt;</p>\n\
             <pre><code>a &lt; b\n</code></pre>\n<p><a href=\"#summary\">x</a> <em>z</em></p>\n"
        );
    }
}
