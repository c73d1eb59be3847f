//! Report for GitHub Actions: a Markdown summary, and one annotation for each red result.

use std::fmt::Write;

use crate::headline::Headline;
use crate::line;
use crate::report::{Report, Section};
use crate::row;
use crate::table::{Column, Table, escaped};
use crate::terminal::failing_lines;

/// Largest number of results in a summary. GitHub limits a job summary to 1 MB.
const MOST: usize = 100;

/// Returns a Markdown summary: the counts, the red results, and a table with one row per case.
#[must_use]
pub fn summary(report: &Report) -> String {
    let mut text = format!("## grainbench: {}\n\n", Headline::of_report(report).sentence());
    let failing = failing_lines(report);
    for line in failing.iter().take(MOST) {
        let _ = writeln!(text, "- {}", escaped(line));
    }
    if failing.len() > MOST {
        let _ = writeln!(text, "- and {} more", failing.len() - MOST);
    }
    let row = |section: &Section| {
        let counts = Headline::of_section(section);
        let controls = format!("{}/{}", counts.controls_red, counts.controls);
        row![&section.name, counts.passed(), counts.red(), counts.amber(), controls]
    };
    let columns = ["case", "passed", "red", "amber", "controls red"].map(Column::text);
    text.push('\n');
    text.push_str(&Table::new("", columns, report.sections.iter().map(row)).markdown());
    let provenance = &report.provenance;
    let _ = write!(text, "\n{} {}, {}\n", provenance.version, provenance.commit, escaped(&provenance.machine));
    text
}

/// Returns one workflow command for each red result, each unmet negative control, and each other reason for red.
#[must_use]
pub fn annotations(report: &Report) -> Vec<String> {
    let error = |title: &str, message: &str| format!("::error title={}::{}", property(title), data(message));
    let reasons = report.red_because.iter().map(|reason| error("grainbench", reason));
    let failures = report.sections.iter().flat_map(|section| section.failures(line::verdict, line::control));
    reasons.chain(failures.map(|(quantity, line)| error(quantity, &line))).collect()
}

/// Returns the message of a workflow command with its line breaks escaped.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// Returns a property of a workflow command. `,` and `:` are escaped, because they would end the property.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn reads_well() {
        insta::assert_snapshot!(summary(&sample::report()));
        insta::assert_snapshot!(annotations(&sample::report()).join("\n"));
    }

    /// The text of a quantity comes from the author of a case. It must not start a workflow command.
    #[test]
    fn names_are_no_commands_and_no_markup() {
        let mut report = sample::report();
        report.sections[0].verdicts[0].quantity = "a\n::stop-commands::x, 5 % | <img>".to_owned();
        report.sections[0].verdicts[0].outcome = grainbench_harness::verdict::Outcome::Fail;
        assert!(annotations(&report).iter().all(|line| line.lines().count() == 1));
        assert!(annotations(&report)[0].starts_with("::error title=a%0A%3A%3Astop-commands%3A%3Ax%2C 5 %25 | <img>::"));
        assert!(summary(&report).contains("\\| \\<img\\>"));
    }
}
