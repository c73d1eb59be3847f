//! The ledger of effects, tabulated.

use super::Study;
use crate::number;
use crate::page::scrolling;
use grainbench_harness::study::ledger::{Entry, Shift, Worth};
use maud::{Markup, html};

/// The section of the page.
pub(crate) fn render(study: &Study) -> Markup {
    let count = |worth: Worth| study.ledger.iter().filter(|entry| entry.worth == worth).count();
    html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What each effect is worth" }
            p.lead {
                "What every scene calls for and which key turned it on. Each effect that is on is switched off: \
                 what that changes in \
                 every gated quantity, and in the cost. Each effect that is off is compiled in with a value \
                   that does nothing, and \
                 must change no bit."
            }
            p {
                (count(Worth::Needed)) " needed, " (count(Worth::NotWorthSimulating)) " not worth simulating where they are on, "
                (count(Worth::Inert)) " inert, " (count(Worth::NotInert)) " not inert."
            }
            (table(&study.ledger))
        }
    }
}

const fn class(worth: Worth) -> &'static str {
    match worth {
        Worth::Needed | Worth::Inert => "pass",
        Worth::NotWorthSimulating | Worth::Untold => "amber",
        Worth::NotInert => "fail",
    }
}

/// The quantity that moves farthest in units of what its gate allows.
fn farthest(entry: &Entry) -> Option<&Shift> {
    entry.shifts.iter().max_by(|a, b| moved(a).total_cmp(&moved(b)))
}

/// Change of the error in units of what is allowed; infinite where the run broke.
fn moved(shift: &Shift) -> f64 {
    match (shift.with, shift.without) {
        (Some(with), Some(without)) => (without - with).abs() / shift.allowed.max(f64::MIN_POSITIVE),
        _ => f64::INFINITY,
    }
}

fn table(ledger: &[Entry]) -> Markup {
    let ratio = |value: Option<f64>| value.map_or("—".to_owned(), |value| number::significant(value, 3));
    let table = html! {
        table.rows {
            thead {
                tr {
                    th scope="col" { "Scene" }
                    th scope="col" { "Effect" }
                    th scope="col" { "Turned on by" }
                    th scope="col" { "Worth" }
                    th scope="col" { "What changes most without it" }
                    th.n scope="col" { "Gates red" }
                    th.n scope="col" { "Counts, with / without" }
                    th.n scope="col" { "CPU time, with / without" }
                }
            }
            tbody {
                @for entry in ledger {
                    tr class=(class(entry.worth)) {
                        th scope="row" { (entry.case) "/" (entry.variant) }
                        td { (entry.effect) }
                        td { @if entry.on { (entry.key) } @else { "off; tried with " (entry.tried.join(", ")) } }
                        td.verdict { span.mark class=(class(entry.worth)) { (entry.worth.word()) } }
                        td.wide {
                            @if let Some(shift) = farthest(entry) {
                                (shift.quantity) ", " (shift.solver) ": " (number::error(shift.with)) " → "
                                (number::error(shift.without))
                                " (allowed " (number::fraction(shift.allowed)) ")"
                            }
                        }
                        td.n {
                            @if entry.on { (entry.shifts.iter().filter(|shift| shift.red).count()) " of " (entry.shifts.len()) }
                            @else { "—" }
                        }
                        td.n { (ratio(entry.counts)) }
                        td.n { (ratio(entry.time)) }
                    }
                }
            }
        }
    };
    scrolling("The ledger", &table)
}
