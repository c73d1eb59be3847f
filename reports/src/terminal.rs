//! Summary of a report as plain text for the terminal.

use grainbench_harness::verdict::Verdict;

use crate::headline::{self, Headline};
use crate::line;
use crate::number;
use crate::report::{Report, Section};
use crate::row;
use crate::table::{Column, Row, Table};

/// Returns one row per case, the counts, and all failures. There are no colour codes, because the text is also written
/// to files.
#[must_use]
pub fn summary_table(report: &Report) -> String {
    let (counts, all) = (Headline::of_report(report), report);
    let report = &*report.view();
    let columns = ["case", "solvers", "passed", "amber", "worst, of allowed", "controls red"].map(Column::text);
    let mut text = Table::new("", columns, report.sections.iter().map(row)).text();
    text.push_str(&format!("\n{}\n", counts.sentence()));
    let failing = failing_lines(all);
    if !failing.is_empty() {
        text.push('\n');
        for line in failing {
            text.push_str(&line);
            text.push('\n');
        }
    }
    text
}

/// Returns true if a result is red: it fails, its run crashed, or its reference was made from another scene.
#[must_use]
pub fn is_red(verdict: &Verdict) -> bool {
    verdict.outcome.is_red()
}

/// Returns one line for each red result, for each negative control that did not fail as required, and for each further
/// reason why the run is red.
#[must_use]
pub fn failing_lines(report: &Report) -> Vec<String> {
    let mut lines: Vec<String> = report.red_because.iter().map(|reason| format!("✗ {reason}")).collect();
    for section in &report.sections {
        for verdict in &section.verdicts {
            if is_red(verdict) {
                lines.push(format!("✗ {}", line::verdict(verdict)));
            }
        }
        for control in &section.controls {
            if !control.turned_red {
                lines.push(format!("✗ {}", line::control(control)));
            }
        }
    }
    lines
}

fn row(section: &Section) -> Row {
    let counts = Headline::of_section(section);
    let worst = headline::worst(section).map_or_else(
        || "—".to_owned(),
        |verdict| {
            let used = headline::used_tolerance(verdict);
            // A result outside its tolerance does not read as 1.
            let shown =
                if (1.0..1.05).contains(&used) && used > 1.0 { "> 1".to_owned() } else { number::significant(used, 2) };
            format!("{shown} {}", verdict.quantity)
        },
    );
    row![
        &section.name,
        headline::solvers(section).join(", "),
        format!("{}/{}", counts.pass, counts.rows()),
        counts.amber().to_string(),
        worst,
        format!("{}/{}", counts.controls_red, counts.controls),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn reads_well() {
        insta::assert_snapshot!(summary_table(&sample::report()));
    }
}
