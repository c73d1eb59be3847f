//! Provenance of a report: version, machine and date.

use maud::{Markup, html};

use crate::number;
use crate::report::Provenance;

/// Renders the provenance at the end of the page.
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
        }
    }
}
