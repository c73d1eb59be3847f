//! Outcomes in the report of an earlier run.

use super::exit::Fault;
use grainbench::harness::claim::Claim;
use grainbench::harness::verdict::{ControlResult, Verdict};
use grainbench::reports::{Report, line, number};
use grainbench::store::artifact::read_json;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Results and controls of an earlier report, read from `results.json`.
#[derive(Deserialize)]
pub(crate) struct EarlierReport {
    #[serde(default)]
    provenance: Options,
    verdicts: Vec<Verdict>,
    controls: Vec<ControlResult>,
}

/// Options of the earlier run, in words.
#[derive(Default, Deserialize)]
struct Options {
    #[serde(default)]
    options: Vec<String>,
}

impl EarlierReport {
    /// Reads an earlier report. `path` is its directory or its `results.json`, and `place` is the option that contains the path.
    pub(crate) fn read(place: &str, path: &Path) -> Result<Self, Fault> {
        let file = if path.is_dir() { path.join("results.json") } else { path.to_owned() };
        read_json(&file).map_err(|error| Fault::input(format!("{place}: {error}")))
    }

    /// Returns the cases that an interrupted run named. The list is empty for a run that was not interrupted, and for a
    /// run without named cases.
    pub(crate) fn cases(&self) -> Vec<String> {
        let options = if self.is_interrupted() { &self.provenance.options[..] } else { &[] };
        let is_case = |words: &&String| !words.starts_with("--") && !words.starts_with("interrupted:");
        options.iter().take_while(is_case).cloned().collect()
    }

    fn is_interrupted(&self) -> bool {
        self.provenance.options.iter().any(|words| words.starts_with("interrupted:"))
    }

    /// Returns true if a result of the claim with this solver was red, if its control did not fail, or if an interrupted
    /// run omitted the claim or its control.
    pub(crate) fn is_open(&self, case: &str, solver: &str, claim: &Claim, with_controls: bool) -> bool {
        let variant = claim.runs.first().map_or("", |run| run.variant);
        let sought = [case, variant, solver, claim.quantity.as_str()];
        let resolution = claim.resolution();
        let mut rows =
            self.verdicts.iter().filter(|row| row.key() == [case, variant, solver, &resolution, &claim.quantity]);
        let is_its = |control: &&ControlResult| {
            [&control.case, &control.variant, &control.solver, &control.quantity].map(String::as_str) == sought
        };
        let mut controls = self.controls.iter().filter(is_its);
        let is_omitted = rows.clone().next().is_none() || with_controls && controls.clone().next().is_none();
        self.is_interrupted() && is_omitted
            || rows.any(|row| row.outcome.is_red())
            || controls.any(|control| !control.turned_red)
    }

    /// Returns the differences between a report and the earlier one, one line per result or control. Lines of red
    /// results come first.
    ///
    /// If `is_whole` is false, earlier results of cases that are not in the report are ignored.
    pub(crate) fn changes(&self, report: &Report, is_whole: bool) -> Vec<String> {
        let rows = || report.verdicts();
        let before: BTreeMap<[&str; 5], &Verdict> = self.verdicts.iter().map(|row| (row.key(), row)).collect();
        let now: BTreeMap<[&str; 5], &Verdict> = rows().map(|row| (row.key(), row)).collect();
        let (mut red, mut other, mut moved) = (Vec::new(), Vec::new(), 0_usize);
        for row in rows() {
            let Some(was) = before.get(&row.key()) else {
                other.push(format!("new, is {}: {}", row.outcome.word(), line::verdict(row)));
                continue;
            };
            let is_same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
            if !is_same(was.allowed, row.allowed) {
                let [was, is] = [was.allowed, row.allowed].map(number::value);
                other.push(format!("tolerance was {was}, is {is}: {}", line::verdict(row)));
            }
            if (was.expected, was.scale) != (row.expected, row.scale) && row.value.is_some() && was.value.is_some() {
                other.push(format!("another expected value or scale: {}", line::verdict(row)));
            }
            if was.outcome == row.outcome {
                moved += usize::from(was.value != row.value);
                continue;
            }
            let words = format!("was {}, is {}: {}", was.outcome.word(), row.outcome.word(), line::verdict(row));
            if row.outcome.is_red() { red.push(words) } else { other.push(words) }
        }
        let is_asked = |row: &&Verdict| is_whole || report.sections.iter().any(|section| section.name == row.case);
        for row in self.verdicts.iter().filter(is_asked).filter(|row| !now.contains_key(&row.key())) {
            other.push(format!("not judged now, was {}: {}", row.outcome.word(), line::verdict(row)));
        }
        for section in &report.sections {
            for control in section.controls.iter().filter(|control| !control.turned_red) {
                let same = |was: &&ControlResult| {
                    (&was.case, &was.variant, &was.solver, &was.quantity)
                        == (&control.case, &control.variant, &control.solver, &control.quantity)
                };
                if self.controls.iter().find(same).is_some_and(|was| was.turned_red) {
                    red.push(format!("was red, stayed green: {}", line::control(control)));
                }
            }
        }
        red.extend(other);
        if moved > 0 {
            let total = number::count(now.len() as u64);
            red.push(format!("{moved} of {total} results have the same outcome and another value"));
        }
        red
    }
}
