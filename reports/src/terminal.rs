//! Summary of a report as plain text for the terminal.

use grainbench_harness::verdict::Verdict;

use crate::headline::{self, Headline};
use crate::line;
use crate::number;
use crate::report::{Report, Section};

/// Returns one row per case, the counts, and all failures. There are no colour codes, because the text is also written
/// to files.
#[must_use]
pub fn summary_table(report: &Report) -> String {
    let (counts, all) = (Headline::of_report(report), report);
    let report = &*report.view();
    let head = ["case", "solvers", "passed", "amber", "worst, of allowed", "controls red"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(report.sections.iter().map(row));
    let widths = [0, 1, 2, 3, 4, 5].map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let mut text = String::new();
    for (index, row) in rows.iter().enumerate() {
        push_line(&mut text, row, &widths);
        if index == 0 {
            let rule = widths.map(|width| "─".repeat(width));
            push_line(&mut text, &rule, &widths);
        }
    }
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

fn row(section: &Section) -> [String; 6] {
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
    [
        section.name.clone(),
        headline::solvers(section).join(", "),
        counts.passed(),
        counts.amber().to_string(),
        worst,
        format!("{}/{}", counts.controls_red, counts.controls),
    ]
}

fn push_line(text: &mut String, cells: &[String; 6], widths: &[usize; 6]) {
    let padded: Vec<String> = cells.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
    text.push_str(padded.join("  ").trim_end());
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use grainbench_harness::verdict::Outcome;

    /// A section without any judged result does not read as a failure.
    #[test]
    fn a_section_without_judgement_says_so() {
        let passed = |outcomes: &[Outcome]| {
            let row =
                |outcome: &Outcome| Verdict { outcome: *outcome, ..sample::verdict("a", "lammps", "x", 1.0, 1.0, 0.1) };
            let section =
                Section { name: "a".to_owned(), verdicts: outcomes.iter().map(row).collect(), ..Section::default() };
            super::row(&section)[2].clone()
        };
        assert_eq!(passed(&[Outcome::NotAvailable, Outcome::NoReference]), "not judged");
        assert_eq!(passed(&[Outcome::NotAvailable, Outcome::Fail]), "0/2");
        assert_eq!(passed(&[]), "0/0");
    }

    #[test]
    fn reads_well() {
        insta::assert_snapshot!(summary_table(&sample::report()));
    }
}
