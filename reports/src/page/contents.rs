//! Table of contents that stays visible while the page scrolls. Each case shows its number of red or amber results.

use maud::{Markup, html};

use super::questions;
use crate::headline::Headline;
use crate::report::Report;

pub(crate) fn render(report: &Report, anchors: &[String]) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            details open {
                summary { "Contents" }
                ul {
                    li { a href="#summary" { "Summary" } }
                    @for (id, heading, _) in questions::stored(&report.measured) { li { a href={ "#" (id) } { (heading) } } }
                    @for (section, anchor) in report.sections.iter().zip(anchors) {
                        @let counts = Headline::of_section(section);
                        @let wrong = counts.red();
                        li {
                            a href={ "#" (anchor) } data-case=(section.name) {
                                @if wrong > 0 { span.n.fail { "✗ " (wrong) } }
                                @else if counts.amber() > 0 {
                                    span.n.amber title={ (counts.amber()) " amber results" } { "▲ " (counts.amber()) }
                                }
                                (section.name)
                            }
                        }
                    }
                    @if !report.judged.is_empty() { li { a href="#peers" { "External solvers" } } }
                    li { a href="#provenance" { "Provenance" } }
                }
            }
            button #theme type="button" hidden { "Dark or light" }
        }
    }
}
