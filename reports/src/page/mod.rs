//! Report as one page. It needs no network, no external font and, for reading, no script. If it would be too large,
//! parts are moved to files beside it.

pub(crate) mod budget;
mod cards;
pub(crate) mod figures;
mod layout;
mod matrix;
mod overview;
mod peers;
mod prose;
pub(crate) mod provenance;
mod questions;
mod rows;
mod section;
pub(crate) mod summary;

pub use cards::meaning;
use layout::{CSS, SCRIPT};
pub(crate) use layout::{captioned, rows_of, shell, sign, slug, unique};
pub use provenance::{AUTHOR, TITLE};

use std::collections::BTreeSet;

use maud::{Render, html};

use self::section::CaseSection;
use crate::headline::Headline;
use crate::plot::DrawError;
use crate::report::{Report, Section};

/// Allowance for the HTML tags around the content of the page (bytes).
const FRAME: usize = 2_000;

/// A page, and the files beside it with the parts that were moved out of it.
pub struct Page {
    /// HTML of the page.
    pub html: String,
    /// Paths and texts of the files to which the page links.
    pub beside: Vec<(String, String)>,
}

/// Renders the page of a report.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn render(report: &Report) -> Result<Page, DrawError> {
    let counts = Headline::of_report(report);
    let report = &*report.view();
    let mut taken = BTreeSet::from(
        ["summary", "peers", "provenance", "tools", "matrix", "solvers", "costs", "stability", "effects"]
            .map(str::to_owned),
    );
    let anchors: Vec<String> = report.sections.iter().map(|section| unique(&slug(&section.name), &mut taken)).collect();
    taken.extend(anchors.iter().map(|anchor| rows_of(anchor)));
    let (mut sections, mut names) = (Vec::new(), BTreeSet::new());
    for (section, anchor) in report.sections.iter().zip(&anchors) {
        sections.push(CaseSection::new(section, anchor, &figure_names(section, &mut names), &mut taken)?);
    }
    let contents = overview::contents(report, &anchors);
    let studies = questions::sections(&report.measured);
    let foot = html! { (studies) (peers::render(report)) (provenance::render(&report.provenance)) };
    // The first screen is largest if the page contains all results.
    let head = |has_rows: &dyn Fn(&str) -> bool| overview::render(report, counts, &anchors, has_rows);
    let texts = [&contents, &foot, &head(&|_| true)].map(|part| part.0.len());
    let fixed = FRAME + CSS.len() + SCRIPT.len() + texts.iter().sum::<usize>();
    let whole: usize = sections.iter().map(|section| section.render().0.len()).sum();
    let mut parts: Vec<&mut budget::Part> = sections.iter_mut().flat_map(CaseSection::parts).collect();
    let own = whole - parts.iter().map(|part| part.whole.0.len()).sum::<usize>();
    let beside = budget::fit(&mut parts, fixed + own, budget::PAGE);
    let has_rows = |case: &str| {
        report.sections.iter().zip(&sections).any(|(section, shown)| section.name == case && shown.has_rows())
    };
    let body = html! {
        a.skip href="#summary" { "To the summary" }
        div.frame {
            (contents)
            main { (head(&has_rows)) @for section in &sections { (section) } (foot) }
        }
    };
    Ok(Page { html: shell(&format!("grainbench · {}", counts.sentence()), &body), beside })
}

/// Returns the file names of the figures of a section. `taken` contains the names of all sections so far.
pub(crate) fn figure_names(section: &Section, taken: &mut BTreeSet<String>) -> Vec<String> {
    let stems = section.figures.iter().map(|figure| slug(&format!("{}-{}", section.name, figure.name)));
    stems.map(|stem| unique(&stem, taken)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    fn html(report: &Report) -> String {
        render(report).unwrap().html
    }

    /// A browser ignores a second attribute with the same name.
    #[test]
    fn refers_to_nothing_outside_and_no_tag_has_two_classes() {
        let page = html(&sample::report());
        for tag in page.split('<').filter_map(|rest| rest.split('>').next()) {
            assert!(tag.matches(" class=").count() <= 1, "{tag}");
        }
        let page = page.replace("http://www.w3.org/2000/svg", "").replace(SCRIPT, "");
        for outside in ["http://", "https://", "src=", "@import", "url(", "<link rel=\"style"] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert_eq!(page.matches("<script").count(), 1);
    }

    #[test]
    fn hostile_text_stays_text() {
        let page = html(&sample::hostile());
        assert_eq!(page.matches("<script").count(), 1, "a text field was not escaped");
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
        let page = html(&report);
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

    /// If the report has too many cases, parts are moved out of the page, and no result is lost.
    #[test]
    fn a_page_stays_light_however_much_there_is() {
        let mut report = sample::report();
        let mut section = report.sections[0].clone();
        let rows = section.verdicts.clone();
        section.verdicts = rows.iter().cycle().take(60 * rows.len()).cloned().collect();
        let whole: usize = report.sections.iter().map(|section| section.verdicts.len()).sum();
        report.sections.extend(std::iter::repeat_n(section.clone(), 40));
        let page = render(&report).unwrap();
        assert!(page.html.len() <= budget::PAGE, "{}", page.html.len());
        let row = "<tr data-s=";
        let there = page.html.matches(row).count()
            + page.beside.iter().map(|(_, text)| text.matches(row).count()).sum::<usize>();
        assert_eq!(there, whole + 40 * section.verdicts.len());
        for (path, _) in &page.beside {
            assert!(page.html.contains(&format!("href=\"{path}\"")), "{path} is not linked");
        }
    }

    #[test]
    fn slugs_are_plain() {
        assert_eq!(slug("Nine discs: κ=1/2"), "nine-discs-1-2");
        assert_eq!(slug("<>"), "unnamed");
    }
}
