//! Provenance of a report: version, machine and date, and its citation.

use maud::{Markup, html};

use crate::number;
use crate::report::Provenance;

pub(crate) fn render(provenance: &Provenance) -> Markup {
    let options = if provenance.options.is_empty() { "none".to_owned() } else { provenance.options.join(", ") };
    let rows = [
        ("Version", provenance.version.clone()),
        ("Commit", provenance.commit.clone()),
        ("Date", provenance.date.clone()),
        ("Machine", provenance.machine.clone()),
        ("Compiler", provenance.rustc.clone()),
        ("Options", options),
        ("Wall time of the run", number::seconds(provenance.wall_seconds)),
    ];
    html! {
        section.provenance id="provenance" {
            h2 { "Provenance" }
            dl {
                @for (name, value) in rows { div { dt { (name) } dd { (value) } } }
            }
            details.aside {
                summary { "Cite this result" }
                @for text in citation(provenance) { div.cite { pre { (text) } } }
            }
        }
    }
}

/// Title and author of the program, as in `CITATION.cff`.
pub const TITLE: &str = "grainbench, a validation harness for granular simulation";
/// Author of the program, as in `CITATION.cff`.
pub const AUTHOR: &str = "The authors of grainbench";

/// Returns the citation of a result as text and as BibTeX, with the version and the commit that made it.
fn citation(provenance: &Provenance) -> [String; 2] {
    let Provenance { version, commit, machine, .. } = provenance;
    let day = provenance.day();
    let year = day.split('-').next().unwrap_or_default();
    let text = format!("{AUTHOR}: {TITLE}, version {version}, commit {commit}. Results of {day} on {machine}.");
    let bibtex = format!(
        "@software{{grainbench,\n  author  = {{{{{AUTHOR}}}}},\n  title   = {{{TITLE}}},\n\
         \x20 version = {{{version}, commit {commit}}},\n\
         \x20 year    = {{{year}}},\n  note    = {{Results of {day}}}\n}}"
    );
    [text, bibtex]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_citation_names_version_and_commit() {
        let report = crate::sample::report();
        let Provenance { version, commit, .. } = &report.provenance;
        for text in citation(&report.provenance) {
            assert!(text.contains(TITLE) && text.contains(version) && text.contains(commit), "{text}");
        }
        let [_, bibtex] = citation(&report.provenance);
        assert!(bibtex.starts_with("@software{grainbench,") && bibtex.contains("author  = {{The authors"), "{bibtex}");
        assert_eq!(bibtex.matches('{').count(), bibtex.matches('}').count());
    }
}
