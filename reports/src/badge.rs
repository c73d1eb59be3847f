//! Badge for the README with the number of passed results. It is green if a result passes and nothing is red. Red counts
//! include failed results, negative controls that did not fail as required, and reasons such as an interrupted run.

use maud::html;

use crate::headline::Headline;
use crate::report::Report;

/// Average width of a letter in a badge (px).
const LETTER: usize = 7;

pub(crate) fn badge(report: &Report) -> String {
    let counts = Headline::of_report(report);
    let red = counts.red() + (counts.controls - counts.controls_red);
    let reason = report.red_because.first().and_then(|reason| reason.split(':').next());
    let words = if let Some(reason) = reason.filter(|_| red == 0) {
        reason.to_owned()
    } else if counts.rows() == 0 {
        "nothing judged".to_owned()
    } else if red > 0 {
        format!("{red} red of {}", counts.rows())
    } else {
        format!("{} of {} pass", counts.pass(), counts.rows())
    };
    let colour = match counts.pass() {
        _ if !report.passes() => "#b3261e",
        // Nothing failed, and the judged results are amber: grey.
        0 => "#666",
        _ => "#2e7d32",
    };
    let (name, left) = ("grainbench", "grainbench".len() * LETTER + 10);
    let right = words.len() * LETTER + 10;
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(left + right) height="20" role="img" aria-label={ (name) ": " (words) } {
            title { (name) ": " (words) }
            rect width=(left) height="20" fill="#444" {}
            rect x=(left) width=(right) height="20" fill=(colour) {}
            g fill="#fff" text-anchor="middle" font-family="Verdana, DejaVu Sans, sans-serif" font-size="11" {
                text x=(left / 2) y="14" { (name) }
                text x=(left + right / 2) y="14" { (words) }
            }
        }
    }
    .into_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn says_what_is_red() {
        let mut report = sample::report();
        assert!(badge(&report).contains("red of"), "{}", badge(&report));
        for section in &mut report.sections {
            section.verdicts.retain(|row| row.outcome == grainbench_harness::verdict::Outcome::Pass);
            section.controls.retain(|control| control.turned_red);
        }
        assert!(badge(&report).contains("pass") && badge(&report).contains("#2e7d32"), "{}", badge(&report));
        report.red_because.push("interrupted: 3 checks left out".to_owned());
        let red = badge(&report);
        assert!(red.contains("grainbench: interrupted<") && red.contains("#b3261e"), "{red}");
        report.red_because.clear();
        for row in report.sections.iter_mut().flat_map(|section| &mut section.verdicts) {
            row.outcome = grainbench_harness::verdict::Outcome::Unsupported;
        }
        assert!(badge(&report).contains("0 of") && !badge(&report).contains("#2e7d32"), "{}", badge(&report));
        report.sections.clear();
        assert!(badge(&report).contains("nothing judged") && badge(&report).contains("#b3261e"));
    }
}
