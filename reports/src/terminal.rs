//! Summary of a report as plain text for the terminal.

use std::collections::BTreeMap;

use grainbench_harness::verdict::Severity;

use crate::headline::{self, Headline};
use crate::line;
use crate::number;
use crate::report::{Report, Section};
use crate::table::{Column, Columns};

/// Largest number of reasons for amber results.
const REASONS: usize = 6;

/// Returns one row per case, the counts, all failures, the reasons of amber results, and a sentence. The table is at most
/// `width` characters wide, if possible; longer cells are cut and end with `…`. There are no colour codes, because the text is
/// also written to files.
#[must_use]
pub fn summary_table_within(report: &Report, width: usize) -> String {
    let (counts, all) = (Headline::of_report(report), report);
    let report = &*report.view();
    let controls = |counts: Headline| format!("{}/{}", counts.controls_red, counts.controls);
    let columns = Columns::<&Section>::new(Column::text("case").shrinks_to(12), |section| &section.name)
        .and(Column::text("solvers").shrinks_to(8), |section| headline::solvers(section).join(", "))
        .and(Column::text("passed"), |section| Headline::of_section(section).passed())
        .and(Column::text("amber"), |section| Headline::of_section(section).amber().to_string())
        .and(Column::text("worst, of allowed").shrinks_to(16), worst)
        .and(Column::text("controls red"), |section| controls(Headline::of_section(section)));
    let mut text = columns.table("", &report.sections, |_| "").text_within(width);
    text.push_str(&format!("\n{}\n", counts.sentence()));
    for lines in [failing_lines(all), amber_lines(all), conclusion(all).into_iter().collect()] {
        if !lines.is_empty() {
            text.push('\n');
        }
        lines.iter().for_each(|line| text.push_str(&format!("{line}\n")));
    }
    text
}

/// Returns one line for each reason of amber results, with the number of results and their solvers. The most frequent
/// reasons come first, and a last line counts the others.
fn amber_lines(report: &Report) -> Vec<String> {
    let mut groups: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for row in report.verdicts().filter(|row| row.outcome.severity() == Severity::Amber) {
        let reason = row.detail.as_deref().unwrap_or("no reason is stated");
        groups.entry((row.outcome.word(), reason)).or_default().push(&row.solver);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, solvers)| std::cmp::Reverse(solvers.len()));
    let rest = groups.split_off(groups.len().min(REASONS));
    let line = |((outcome, reason), mut solvers): ((&str, &str), Vec<&str>)| {
        let count = solvers.len();
        solvers.sort_unstable();
        solvers.dedup();
        format!("▲ {count} {outcome} ({}): {reason}", solvers.join(", "))
    };
    let mut lines: Vec<String> = groups.into_iter().map(line).collect();
    if !rest.is_empty() {
        let results: usize = rest.iter().map(|(_, solvers)| solvers.len()).sum();
        lines.push(format!("▲ {results} more, for {} other reasons: the page lists them", rest.len()));
    }
    lines
}

/// Returns the outcome of a report in words, with the mark of its colour; none if there is no result.
fn conclusion(report: &Report) -> Option<String> {
    let counts = Headline::of_report(report);
    let (red, amber, judged) = (counts.red(), counts.amber(), counts.conclusive());
    let missed = counts.controls - counts.controls_red;
    let are = |count: usize| if count == 1 { "is" } else { "are" };
    let (mark, mut text) = match judged {
        _ if counts.rows() == 0 => return None,
        0 => ("▲", "No result is conclusive.".to_owned()),
        _ if red > 0 => ("✗", format!("{red} of {judged} conclusive results {} red.", are(red))),
        1 => ("✓", "The only conclusive result is within its tolerance.".to_owned()),
        _ => ("✓", format!("All {judged} conclusive results are within their tolerances.")),
    };
    if amber > 0 {
        text += &format!(" {amber} {} amber: inconclusive, or a documented error.", are(amber));
    }
    text += &match counts.controls {
        0 => String::new(),
        _ if missed > 0 => format!(" {missed} of {} negative controls did not fail as they must.", counts.controls),
        1 => " The negative control failed, as it must.".to_owned(),
        all => format!(" All {all} negative controls failed, as they must."),
    };
    Some(format!("{} {text}", if report.passes() { mark } else { "✗" }))
}

/// Returns one line for each red result, for each negative control that did not fail as required, and for each further
/// reason why the run is red.
#[must_use]
pub fn failing_lines(report: &Report) -> Vec<String> {
    let failures = report.sections.iter().flat_map(|section| section.failures(line::verdict, line::control));
    let lines = report.red_because.iter().cloned().chain(failures.map(|(_, line)| line));
    lines.map(|line| format!("✗ {line}")).collect()
}

/// Returns the largest |error|/allowed of a case, with its quantity.
fn worst(section: &Section) -> Option<String> {
    let verdict = headline::worst(&section.verdicts)?;
    let used = headline::used_tolerance(verdict);
    // A result outside its tolerance does not read as 1.
    let shown = if (1.0..1.05).contains(&used) && used > 1.0 { "> 1".to_owned() } else { number::significant(used, 2) };
    Some(format!("{shown} {}", verdict.quantity))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use grainbench_harness::verdict::{Outcome, Verdict};

    /// A section without any judged result does not read as a failure.
    #[test]
    fn a_section_without_judgement_says_so() {
        let passed = |outcomes: &[Outcome]| {
            let row =
                |outcome: &Outcome| Verdict { outcome: *outcome, ..sample::verdict("a", "lammps", "x", 1.0, 1.0, 0.1) };
            let section =
                Section { name: "a".to_owned(), verdicts: outcomes.iter().map(row).collect(), ..Section::default() };
            Headline::of_section(&section).passed()
        };
        assert_eq!(passed(&[Outcome::NotAvailable, Outcome::NoReference]), "not judged");
        assert_eq!(passed(&[Outcome::NotAvailable, Outcome::Fail]), "0/1");
    }

    #[test]
    fn reads_well() {
        insta::assert_snapshot!(summary_table_within(&sample::report(), usize::MAX));
    }

    /// No line of the table is wider than the terminal, and a wide terminal cuts nothing.
    #[test]
    fn a_table_fits_the_terminal() {
        let report = sample::report();
        let table = |width| summary_table_within(&report, width).split("\n\n").next().unwrap().to_owned();
        let widest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap();
        for width in [80, 70] {
            assert!(widest(&table(width)) <= width && table(width).contains('…'), "{}", table(width));
        }
        assert!(widest(&table(500)) > 80 && !table(500).contains('…'));
    }

    /// Results with the same reason share a line, and a result without judgement is no failure.
    #[test]
    fn amber_results_have_their_reasons() {
        let mut report = sample::report();
        for row in report.sections.iter_mut().flat_map(|section| &mut section.verdicts) {
            (row.outcome, row.detail) = (Outcome::NotAvailable, Some("it is not installed".to_owned()));
            row.solver = "lammps".to_owned();
        }
        assert_eq!(amber_lines(&report), ["▲ 9 not-available (lammps): it is not installed"]);
        assert!(conclusion(&report).unwrap().contains("No result is conclusive. 9 are amber"));
        assert!(!summary_table_within(&report, usize::MAX).contains("0/"), "an amber result reads as a failure");
        for (at, row) in report.sections.iter_mut().flat_map(|section| &mut section.verdicts).enumerate() {
            row.detail = Some(format!("reason {at}"));
        }
        let lines = amber_lines(&report);
        assert_eq!(
            (lines.len(), lines.last().unwrap().as_str()),
            (7, "▲ 3 more, for 3 other reasons: the page lists them")
        );
    }
}
