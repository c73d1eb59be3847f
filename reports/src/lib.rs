//! Figures, pages and result files from records and results. No solver is needed.

pub mod badge;
pub mod elements;
pub mod export;
pub mod github;
pub mod headline;
pub mod judged;
pub mod junit;
pub mod line;
pub mod measured;
pub mod number;
pub mod page;
pub mod parts;
pub mod pictures;
pub mod plot;
pub mod record_figures;
pub mod report;
pub mod results;
mod section;
mod solid_figures;
pub mod store;
pub mod study;
pub mod sweep;
pub mod table;
pub mod terminal;
pub mod trend;

#[cfg(test)]
mod sample;

pub use export::record_json::each_snapshot;
use grainbench_harness::verdict::Severity;
pub use headline::Headline;
pub use parts::SnapshotStore;
pub use pictures::write_pictures;
pub use report::{Provenance, Report, RunCost, Section};
pub use store::{SaveError, write_report};
pub use terminal::summary_table_within;

/// Returns the CSS class of a colour.
pub(crate) const fn class(severity: Severity) -> &'static str {
    match severity {
        Severity::Green => "pass",
        Severity::Red => "fail",
        Severity::Amber => "amber",
    }
}

/// Returns the values in the order of their first occurrence, each once.
pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}

/// Returns the value below which the fraction `part` of the values lies; none for an empty list. Sorts the values.
pub(crate) fn quantile(values: &mut [f64], part: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(((values.len() as f64 * part) as usize).min(values.len().saturating_sub(1))).copied()
}
