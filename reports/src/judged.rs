//! What is kept of a program that was judged: every row with its control, by which version and adapter, when and where.

use grainbench_harness::expect::Expected;
use grainbench_harness::verdict::{Control, Outcome, Severity, Verdict};
use serde::{Deserialize, Serialize};

use crate::report::{Provenance, Report};

/// A program's rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Judged {
    /// Name of the program in its manifest.
    pub program: String,
    /// What it says of its version.
    pub version: String,
    /// Hash of its manifest and of the files beside it.
    pub adapter: String,
    /// By what, when and where it was judged.
    pub provenance: Provenance,
    /// The rows, in the order of the registry.
    pub rows: Vec<Row>,
}

/// A row of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Case.
    pub case: String,
    /// Variant of its scene.
    pub variant: String,
    /// Resolution.
    pub resolution: String,
    /// What was measured, in words.
    pub quantity: String,
    /// Unit of `value` and `expected`.
    pub unit: String,
    /// What was measured; absent where nothing was.
    pub value: Option<f64>,
    /// What it should be.
    pub expected: Option<Expected>,
    /// Signed error, in units of the row's scale.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// How the row ended.
    pub verdict: Outcome,
    /// Reason for an outcome other than pass or fail.
    pub detail: Option<String>,
    /// Whether its negative control turned red; absent where none was tried.
    pub control_red: Option<bool>,
}

/// Relative rounding of errors that are read back.
const ROUNDING: f64 = 1e-6;

/// The rows of a program in a case, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// Rows within the allowed error.
    pub pass: usize,
    /// Rows outside it, and runs that broke.
    pub red: usize,
    /// Rows that say nothing of the quantity.
    pub amber: usize,
    /// Controls.
    pub controls: usize,
    /// Controls that turned red, as they must.
    pub controls_red: usize,
    /// Largest error over what is allowed, of rows that pass or fail.
    pub worst: Option<f64>,
}

impl Judged {
    /// Of the report of a run of a program alone.
    #[must_use]
    pub fn of(program: String, version: String, adapter: String, report: &Report) -> Self {
        let controls = || report.sections.iter().flat_map(|section| &section.controls);
        let row = |row: &Verdict| {
            let is_of = |control: &&Control| {
                (&control.case, &control.variant, &control.quantity) == (&row.case, &row.variant, &row.quantity)
            };
            Row {
                case: row.case.clone(),
                variant: row.variant.clone(),
                resolution: row.resolution.clone(),
                quantity: row.quantity.clone(),
                unit: row.unit.clone(),
                value: row.value,
                expected: row.expected,
                error: row.error,
                allowed: row.allowed,
                verdict: row.outcome,
                detail: row.detail.clone(),
                control_red: controls().find(is_of).map(|control| control.turned_red),
            }
        };
        let rows = report.sections.iter().flat_map(|section| &section.verdicts).map(row).collect();
        Self { program, version, adapter, provenance: report.provenance.clone(), rows }
    }

    /// Differences of another run of the program, a line each: verdicts, controls, rows that are not kept, and errors that
    /// moved by more than the tolerance.
    #[must_use]
    pub fn otherwise(&self, report: &Report) -> Vec<String> {
        let now = Self::of(self.program.clone(), String::new(), String::new(), report);
        let words = |row: &Row| {
            let control = match row.control_red {
                Some(true) => ", its control red",
                Some(false) => ", its control not red",
                None => "",
            };
            format!("{}{control}", row.verdict.word())
        };
        let line = |row: &Row| {
            let kept = self.rows.iter().find(|kept| {
                (&kept.case, &kept.variant, &kept.resolution, &kept.quantity)
                    == (&row.case, &row.variant, &row.resolution, &row.quantity)
            });
            let words_kept = kept.map_or_else(|| "no such row".to_owned(), words);
            let found = words(row);
            let place = || format!("{}/{} · {}", row.case, row.variant, row.quantity);
            if words_kept != found {
                return Some(format!("{}: {found}; kept: {words_kept}", place()));
            }
            let errors = kept.and_then(|kept| kept.error).zip(row.error);
            let (was, is) = errors.filter(|(was, is)| (was - is).abs() > row.allowed.max(was.abs() * ROUNDING))?;
            Some(format!("{}: {found}, error {is:e}; kept: error {was:e}, allowed {:e}", place(), row.allowed))
        };
        now.rows.iter().filter_map(line).collect()
    }

    /// As it is kept.
    ///
    /// # Errors
    /// When something has no JSON form, which no report that was made by this project has.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|text| text + "\n")
    }

    /// Reads what was kept.
    ///
    /// # Errors
    /// When it is not what was written.
    pub fn read(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// Its rows, all of them or those of a case, counted.
    #[must_use]
    pub fn count(&self, case: Option<&str>) -> Count {
        let mut count = Count::default();
        for row in self.rows.iter().filter(|row| case.is_none_or(|case| case == row.case)) {
            match row.verdict.severity() {
                Severity::Green => count.pass += 1,
                Severity::Red => count.red += 1,
                Severity::Amber => count.amber += 1,
            }
            count.controls += usize::from(row.control_red.is_some());
            count.controls_red += usize::from(row.control_red == Some(true));
            if let (Outcome::Pass | Outcome::Fail, Some(error)) = (row.verdict, row.error) {
                // What is to be exact and is uses nothing up.
                let of_allowed = if error == 0.0 { 0.0 } else { error.abs() / row.allowed };
                count.worst = Some(count.worst.map_or(of_allowed, |worst: f64| worst.max(of_allowed)));
            }
        }
        count
    }

    /// The day on which it was judged.
    #[must_use]
    pub fn day(&self) -> &str {
        self.provenance.date.split(' ').next().unwrap_or_default()
    }
}

/// The cases that any of some programs was asked of, in the order in which they come.
#[must_use]
pub fn cases(judged: &[Judged]) -> Vec<&str> {
    let mut cases = Vec::new();
    for row in judged.iter().flat_map(|of| &of.rows) {
        if !cases.contains(&row.case.as_str()) {
            cases.push(&row.case);
        }
    }
    cases
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn rows_stand_with_their_controls_and_are_read_back() {
        let report = sample::report();
        let judged = Judged::of("other".to_owned(), "other 1.0".to_owned(), "hash".to_owned(), &report);
        assert_eq!(Judged::read(&judged.text().unwrap()).unwrap(), judged);
        let counts = crate::Headline::of_report(&report);
        let count = judged.count(None);
        assert_eq!((count.pass, count.red), (counts.pass, counts.red()));
        assert_eq!(count.pass + count.red + count.amber, judged.rows.len());
        assert!(count.controls > 0 && count.controls_red <= count.controls);
        assert_eq!(judged.count(Some("no-such-case")), Count::default());
        assert!(Judged::read(&judged.text().unwrap().replace("\"program\"", "\"programme\"")).is_err());
    }

    #[test]
    fn what_ends_otherwise_is_told() {
        let mut report = sample::report();
        // A program has one row of a quantity.
        report.sections.truncate(1);
        report.sections[0].verdicts.truncate(1);
        let kept = Judged::of("other".to_owned(), String::new(), String::new(), &report);
        assert_eq!(kept.otherwise(&report), Vec::<String>::new());
        report.sections[0].verdicts[0].outcome = Outcome::Stale;
        let [line] = &kept.otherwise(&report)[..] else { panic!("one row ends otherwise") };
        assert!(line.contains(": stale") && line.contains("; kept: pass"), "{line}");
        report.sections[0].verdicts[0].quantity = "another".to_owned();
        assert!(kept.otherwise(&report)[0].ends_with("kept: no such row"));
    }
}
