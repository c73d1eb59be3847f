//! The report as one page that needs nothing else: no script, no network, no font.

mod peers;
mod prose;
pub(crate) mod provenance;
mod section;
mod style;
mod summary;

use std::collections::BTreeSet;

use grainbench_harness::verdict::Outcome;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::headline::Headline;
use crate::plot::{DrawError, markup};
use crate::report::Report;

/// Renders the whole page.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn render(report: &Report) -> Result<String, DrawError> {
    let mut taken = BTreeSet::from(["summary", "peers", "provenance"].map(str::to_owned));
    let anchors: Vec<String> = report.sections.iter().map(|section| unique(&slug(&section.name), &mut taken)).collect();
    let counts = Headline::of_report(report);
    let mut sections = Vec::new();
    for (section, anchor) in report.sections.iter().zip(&anchors) {
        sections.push(section::render(section, anchor, &mut taken)?);
    }
    let body = html! {
        main {
            (summary::render(report, &anchors))
            @for section in &sections { (section) }
            (peers::render(report))
            (provenance::render(&report.provenance))
        }
    };
    Ok(shell(&format!("grainbench · {}", counts.sentence()), &body))
}

/// A whole page about a body.
pub(crate) fn shell(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(style::CSS)) }
            }
            body { (body) }
        }
    };
    markup(&page.into_string())
}

/// A name reduced to lower-case letters, digits and `-`, for anchors and file names.
#[must_use]
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for letter in name.chars() {
        if letter.is_ascii_alphanumeric() {
            slug.push(letter.to_ascii_lowercase());
        } else if !slug.is_empty() && !slug.ends_with('-') {
            slug.push('-');
        }
    }
    let slug = slug.trim_end_matches('-');
    if slug.is_empty() { "unnamed" } else { slug }.to_owned()
}

/// `stem`, or `stem-2` and so on when that is taken.
pub(crate) fn unique(stem: &str, taken: &mut BTreeSet<String>) -> String {
    let mut name = stem.to_owned();
    let mut next = 2;
    while !taken.insert(name.clone()) {
        name = format!("{stem}-{next}");
        next += 1;
    }
    name
}

/// Symbol and class of an outcome: the meaning never hangs on colour alone.
pub(crate) const fn sign(outcome: Outcome) -> (&'static str, &'static str) {
    match outcome {
        Outcome::Pass => ("✓", "pass"),
        Outcome::Fail | Outcome::Broken => ("✗", "fail"),
        Outcome::Known | Outcome::Stale | Outcome::NoReference | Outcome::Unsupported | Outcome::NotAvailable => {
            ("▲", "amber")
        }
    }
}

/// A table that scrolls inside its own box where the screen is narrower than it, also by keyboard.
pub(crate) fn scrolling(label: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(label) tabindex="0" { (table) } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn refers_to_nothing_outside() {
        let page = render(&sample::report()).unwrap();
        let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for outside in ["http://", "https://", "src=", "@import", "url(", "<script", "<link"] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn hostile_text_stays_text() {
        let page = render(&sample::hostile()).unwrap();
        assert!(!page.contains("<script"), "a text field was not escaped");
        assert!(!page.contains("<img"), "an image got in");
        assert!(!page.contains("</title></svg></style>"), "an attribute or a heading broke out");
        assert!(!page.to_lowercase().contains("href=\"javascript"));
        assert!(page.contains("&lt;script&gt;"));
    }

    #[test]
    fn anchors_are_unique_and_links_lead_somewhere() {
        let mut report = sample::report();
        let again = report.sections.clone();
        report.sections.extend(again);
        let page = render(&report).unwrap();
        let values = |attribute: &str| -> Vec<String> {
            page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect()
        };
        let ids = values(" id=\"");
        assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());
        for target in values("href=\"#") {
            assert!(ids.contains(&target), "{target}");
        }
        assert!(ids.contains(&"backspin".to_owned()) && ids.contains(&"backspin-2".to_owned()));
    }

    #[test]
    fn slugs_are_plain() {
        assert_eq!(slug("Nine discs: κ=1/2"), "nine-discs-1-2");
        assert_eq!(slug("<>"), "unnamed");
    }
}
