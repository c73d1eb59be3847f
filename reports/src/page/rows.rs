//! Table of all results of a case. The first column is the outcome.

use std::collections::BTreeSet;

use grainbench_harness::verdict::{Outcome, Verdict};
use maud::{Markup, html};

use super::{sign, unique};
use crate::headline::used_tolerance;
use crate::line;
use crate::number;
use crate::table::{Column, head};

/// Returns the anchor of a result, from a hash of its key. It is therefore the same in every report.
pub(crate) fn address(verdict: &Verdict) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in verdict.key() {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    format!("row-{}", &hasher.finalize().to_hex()[..8])
}

/// Returns the red results, then the amber results, then the green ones. Failed results come before all other red results.
/// Otherwise, the order of the claims is kept.
pub(crate) fn sorted(verdicts: &[Verdict]) -> Vec<&Verdict> {
    let mut rows: Vec<&Verdict> = verdicts.iter().collect();
    rows.sort_by_key(|verdict| std::cmp::Reverse((verdict.outcome.severity(), verdict.outcome == Outcome::Fail)));
    rows
}

/// Returns the table of results. `taken` contains the anchors that the page already uses.
pub(crate) fn table(rows: &[&Verdict], taken: &mut BTreeSet<String>) -> Markup {
    let columns = ["Verdict", "Quantity", "Solver"].map(Column::text).into_iter();
    let columns = columns.chain(["Value, expected", "Error, allowed"].map(Column::number));
    let columns: Vec<Column> = columns.chain([Column::text("Evidence and source")]).collect();
    html! {
        table.rows.sorts.verdicts {
            colgroup { @for _ in &columns { col; } }
            (head(&columns))
            tbody { @for verdict in rows { (row(verdict, &unique(&address(verdict), taken))) } }
        }
    }
}

fn row(verdict: &Verdict, id: &str) -> Markup {
    let (symbol, class) = sign(verdict.outcome);
    let used = verdict.error.map(|_| used_tolerance(verdict)).filter(|used| used.is_finite());
    html! {
        tr data-s=(verdict.solver) data-o=(verdict.outcome.word()) data-unjudged[!verdict.outcome.is_judged()] id=(id)
            class=(class) {
            td {
                span class={ "mark " (class) } { (symbol) " " (verdict.outcome.word()) }
                @if let Some(detail) = &verdict.detail { span.fine { (detail) } }
            }
            th scope="row" { (verdict.quantity) @if !verdict.variant.is_empty() { span.fine { (verdict.variant) } } }
            td { (verdict.solver) span.fine { (verdict.resolution) } }
            td.n data-v=[verdict.value.map(|value| format!("{value:.5e}"))] {
                (verdict.value.map_or_else(|| "—".to_owned(), |value| number::with_unit(value, &verdict.unit)))
                span.fine { (line::expected_word(verdict.evidence)) " " (line::expected(verdict.expected, &verdict.unit)) }
            }
            td.n data-v=[used.map(|used| format!("{used:.4e}"))] {
                (number::error(verdict.error))
                @if let (Some(scale), Some(_)) = (line::scale_note(verdict), verdict.error) { " " (scale) }
                span.fine {
                    "allowed " (number::fraction(verdict.allowed)) ", " (verdict.tolerance.word())
                    @if let Some(used) = verdict.closeness() {
                        ", " (number::significant(used, 2)) (if used > 1.0 { " times it" } else { " of it used" })
                    }
                }
            }
            td {
                (verdict.evidence.word()) ": " (verdict.source)
                @if !verdict.because.is_empty() { span.fine { "allowed: " (verdict.because) } }
            }
        }
    }
}
