//! Stored results of an external solver, with its version, the hash of its adapter, date and machine.

use grainbench_harness::verdict::{ControlResult, Verdict};
use serde::{Deserialize, Serialize};

use crate::distinct;
use crate::headline::{self, Headline};
use crate::section::{Provenance, Section};

/// Results of an external solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExternalResults {
    /// Name of the solver in its manifest.
    pub program: String,
    /// Version that the solver reports.
    pub version: String,
    /// Hash of the manifest and of all files in the directory of the manifest.
    pub adapter: String,
    /// Version of grainbench, date and machine.
    pub provenance: Provenance,
    /// Results in the order of the registry.
    pub rows: Vec<ExternalResult>,
}

/// A result of an external solver, with the outcome of its negative control.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExternalResult {
    /// Result of the claim.
    #[serde(flatten)]
    pub result: Verdict,
    /// True if the negative control failed as required; absent if the control was not run.
    pub control_red: Option<bool>,
}

/// Relative difference of two errors up to which the difference counts as rounding.
const ROUNDING: f64 = 1e-6;

impl ExternalResults {
    /// Returns the results of all cases, which contain only this solver. `names` are program, version and adapter.
    #[must_use]
    pub fn new(names: [String; 3], provenance: &Provenance, sections: &[Section]) -> Self {
        let controls = || sections.iter().flat_map(|section| &section.controls);
        let row = |row: &Verdict| {
            let is_of = |control: &&ControlResult| {
                (&control.case, &control.variant, &control.quantity) == (&row.case, &row.variant, &row.quantity)
            };
            ExternalResult {
                result: row.clone(),
                control_red: controls().find(is_of).map(|control| control.turned_red),
            }
        };
        let rows = sections.iter().flat_map(|section| &section.verdicts).map(row).collect();
        let [program, version, adapter] = names;
        Self { program, version, adapter, provenance: provenance.clone(), rows }
    }

    /// Returns the differences between the stored results and present ones of the same solver, one line each: other outcomes
    /// or controls, results that are not stored, and errors that changed by more than the tolerance.
    #[must_use]
    pub fn otherwise(&self, sections: &[Section]) -> Vec<String> {
        let now = Self::new([const { String::new() }; 3], &self.provenance, sections);
        let words = |row: &ExternalResult| {
            let control =
                row.control_red.map_or("", |red| if red { ", its control red" } else { ", its control not red" });
            format!("{}{control}", row.result.outcome.word())
        };
        let key = |row: &Verdict| [&row.case, &row.variant, &row.resolution, &row.quantity].map(String::clone);
        let line = |found: &ExternalResult| {
            let row = &found.result;
            let kept = self.rows.iter().find(|kept| key(&kept.result) == key(row));
            let words_kept = kept.map_or_else(|| "no such row".to_owned(), words);
            let found = words(found);
            let place = || format!("{}/{} · {}", row.case, row.variant, row.quantity);
            if words_kept != found {
                return Some(format!("{}: {found}; kept: {words_kept}", place()));
            }
            let errors = kept.and_then(|kept| kept.result.error).zip(row.error);
            let (was, is) = errors.filter(|(was, is)| (was - is).abs() > row.allowed.max(was.abs() * ROUNDING))?;
            Some(format!("{}: {found}, error {is:e}; kept: error {was:e}, allowed {:e}", place(), row.allowed))
        };
        now.rows.iter().filter_map(line).collect()
    }

    fn of_case(&self, case: Option<&str>) -> impl Iterator<Item = &ExternalResult> {
        self.rows.iter().filter(move |row| case.is_none_or(|case| case == row.result.case))
    }

    /// Counts the results of one case, or all results.
    #[must_use]
    pub fn count(&self, case: Option<&str>) -> Headline {
        let controls = || self.of_case(case).filter_map(|row| row.control_red);
        let (all, red) = (controls().count(), controls().filter(|is_red| *is_red).count());
        let mut results = Headline::from_results(self.of_case(case).map(|row| &row.result), []);
        (results.controls, results.controls_red) = (all, red);
        results
    }

    /// Returns the largest |error|/allowed of the judged results of one case.
    #[must_use]
    pub fn worst(&self, case: &str) -> Option<f64> {
        headline::worst(self.of_case(Some(case)).map(|row| &row.result)).map(headline::used_tolerance)
    }
}

/// Returns the cases with results of any external solver, in order of appearance.
#[must_use]
pub fn cases(judged: &[ExternalResults]) -> Vec<&str> {
    distinct(judged.iter().flat_map(|results| &results.rows).map(|row| row.result.case.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use grainbench_harness::verdict::Outcome;
    use grainbench_store::artifact::parse_json;
    use std::path::Path;

    #[test]
    fn rows_stand_with_their_controls_and_are_read_back() {
        let report = sample::report();
        let names = ["other", "other 1.0", "hash"].map(str::to_owned);
        let judged = ExternalResults::new(names, &report.provenance, &report.sections);
        let read = |text: &str| parse_json::<ExternalResults>(Path::new("judged.json"), text.as_bytes());
        let text = serde_json::to_string(&judged).unwrap();
        assert_eq!(read(&text).unwrap(), judged);
        let counts = crate::Headline::of_report(&report);
        let count = judged.count(None);
        assert_eq!((count.pass(), count.red()), (counts.pass(), counts.red()));
        assert_eq!(count.rows(), judged.rows.len());
        assert!(count.controls > 0 && count.controls_red <= count.controls);
        assert_eq!(judged.count(Some("no-such-case")), Headline::default());
        assert!(read(&text.replace("\"program\"", "\"programme\"")).is_err());
        // Files of earlier versions lack some keys of a result.
        let mut stored = serde_json::to_value(&judged).unwrap();
        for row in stored["rows"].as_array_mut().unwrap() {
            let row = row.as_object_mut().unwrap();
            for key in ["solver", "scale", "tolerance", "because", "evidence", "source", "severity"] {
                assert!(row.remove(key).is_some(), "{key}");
            }
        }
        let earlier = read(&stored.to_string()).unwrap();
        // Without its evidence, a result counts as a regression.
        let totals = |count: Headline| (count.pass(), count.red(), count.amber(), count.controls, count.controls_red);
        assert_eq!(totals(earlier.count(None)), totals(count));
        stored["rows"][0].as_object_mut().unwrap().remove("quantity");
        assert!(read(&stored.to_string()).is_err());
    }

    #[test]
    fn what_ends_otherwise_is_told() {
        let mut report = sample::report();
        // The sample report has results of several solvers; an external solver has one result per quantity.
        report.sections.truncate(1);
        report.sections[0].verdicts.truncate(1);
        let kept = ExternalResults::new(["other", "", ""].map(str::to_owned), &report.provenance, &report.sections);
        assert_eq!(kept.otherwise(&report.sections), Vec::<String>::new());
        report.sections[0].verdicts[0].outcome = Outcome::Stale;
        let [line] = &kept.otherwise(&report.sections)[..] else { panic!("one row ends otherwise") };
        assert!(line.contains(": stale") && line.contains("; kept: pass"), "{line}");
        report.sections[0].verdicts[0].quantity = "another".to_owned();
        assert!(kept.otherwise(&report.sections)[0].ends_with("kept: no such row"));
    }
}
