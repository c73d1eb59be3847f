//! Report as `junit.xml`, a format that continuous-integration services display.

use grainbench_harness::verdict::{ControlResult, Outcome, Severity, Verdict};
use quick_junit::{NonSuccessKind, SerializeError, TestCase, TestCaseStatus, TestSuite};

use crate::line;
use crate::report::Report;

/// Returns a document with one test suite per case, and one test per result and per negative control. Amber results
/// count as skipped, with their reason, and never as passed. Each further reason why the run is red is an error.
///
/// # Errors
/// When a value has no XML form. This does not occur in reports of this project.
pub fn junit_xml(report: &Report) -> Result<String, SerializeError> {
    let mut document = quick_junit::Report::new("grainbench");
    for section in &report.sections {
        let verdict = |row: &Verdict| (name(&row.variant, &row.solver, &row.resolution, &row.quantity), status(row));
        let control = |control: &ControlResult| {
            let claim = name(&control.variant, &control.solver, "", &control.quantity);
            let status = if control.turned_red {
                TestCaseStatus::success()
            } else {
                non_success(NonSuccessKind::Failure, line::control(control))
            };
            (format!("negative control · {claim} · {}", control.wrong_physics), status)
        };
        let tests = section.verdicts.iter().map(verdict).chain(section.controls.iter().map(control));
        document.add_test_suite(suite(&section.name, tests));
    }
    if !report.red_because.is_empty() {
        let reason = |reason: &String| (reason.clone(), non_success(NonSuccessKind::Error, reason.as_str()));
        document.add_test_suite(suite("grainbench", report.red_because.iter().map(reason)));
    }
    document.to_string()
}

/// Returns a suite of tests, each with its name and status.
fn suite(name: &str, tests: impl Iterator<Item = (String, TestCaseStatus)>) -> TestSuite {
    let mut suite = TestSuite::new(name);
    suite.add_test_cases(tests.map(|(test, status)| {
        let mut test = TestCase::new(test, status);
        test.set_classname(name);
        test
    }));
    suite
}

fn non_success(kind: NonSuccessKind, message: impl AsRef<str>) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_message(message);
    status
}

fn name(variant: &str, solver: &str, resolution: &str, quantity: &str) -> String {
    let solver = format!("{solver} {resolution}");
    [variant, solver.trim_end(), quantity].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" · ")
}

fn status(verdict: &Verdict) -> TestCaseStatus {
    let mut status = match verdict.outcome.severity() {
        Severity::Green => return TestCaseStatus::success(),
        Severity::Red if verdict.outcome == Outcome::Fail => TestCaseStatus::non_success(NonSuccessKind::Failure),
        Severity::Red => TestCaseStatus::non_success(NonSuccessKind::Error),
        Severity::Amber => TestCaseStatus::skipped(),
    };
    let message = match (&verdict.outcome, &verdict.detail) {
        (outcome, _) if outcome.is_red() => line::verdict(verdict),
        (outcome, Some(detail)) => format!("{}: {detail}", outcome.word()),
        (outcome, None) => outcome.word().to_owned(),
    };
    status.set_message(message);
    status.set_type(verdict.outcome.word());
    status
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn only_right_rows_pass() {
        let text = junit_xml(&sample::report()).unwrap();
        assert!(text.contains("failures=\"2\" errors=\"1\""), "{text}");
        assert!(text.contains("skipped=\"3\""), "{text}");
        assert!(text.contains("negative control"));
        assert!(text.contains("not-available: "));
    }

    #[test]
    fn an_interrupted_run_is_an_error() {
        let mut report = sample::report();
        report.red_because.push("interrupted: 3 checks left out".to_owned());
        let text = junit_xml(&report).unwrap();
        assert!(text.contains("failures=\"2\" errors=\"2\""), "{text}");
        assert!(text.contains("message=\"interrupted: 3 checks left out\""), "{text}");
    }
}
