//! Stored results of external solvers. They belong to the present adapters and claims, and to the tables of `peers/README.md`.
//!
//! `UPDATE_README=1 cargo test --release --test it peers` writes the tables again. New results come from `grainbench
//! run --solver PATH --update-stored`.

use crate::common::{entries, expect_file, root, table, with_generated};
use grainbench::cases::registry;
use grainbench::peers::{KEPT, kept};
use grainbench::reference::outside::ExternalProgram;
use grainbench::reports::Headline;
use grainbench::reports::judged::{ExternalResults, cases};
use grainbench::reports::study::point::Diagram;
use grainbench::reports::study::{Study, cost};
use grainbench::reports::{Provenance, number};
use std::path::PathBuf;

/// Each adapter in `peers/` has stored results of its present files.
#[test]
fn every_adapter_was_judged_as_it_stands() {
    let folders = entries(root("peers")).into_iter().filter(|path| path.join("SOLVER.toml").is_file());
    let mut named: Vec<PathBuf> = KEPT.iter().map(|(name, _)| root("peers").join(name)).collect();
    named.sort_unstable();
    assert_eq!(folders.collect::<Vec<_>>(), named);
    for ((folder, _), judged) in KEPT.iter().zip(kept().unwrap()) {
        let path = root("peers").join(folder);
        let program = ExternalProgram::read(&path.join("SOLVER.toml")).unwrap();
        let found = program.fingerprint().unwrap();
        assert_eq!(judged.adapter, found, "{folder} has changed since: run it with --update-stored");
        assert_eq!(judged.program, program.manifest().name);
        assert!(!judged.provenance.commit.contains("changes"), "{folder} was judged by a tree that nobody has");
    }
}

/// Each passing result has a negative control that turned red. Each result of a registry case matches a current
/// solver-independent claim in quantity, resolution and tolerance.
#[test]
fn kept_rows_are_earned_and_are_those_of_today() {
    for judged in kept().unwrap() {
        let name = &judged.program;
        for found in judged.rows.iter().filter(|found| found.result.outcome.word() == "pass") {
            let row = &found.result;
            assert_eq!(found.control_red, Some(true), "{name}: {}/{} · {}", row.case, row.variant, row.quantity);
        }
        for case in cases(std::slice::from_ref(&judged)) {
            let Some(of_registry) = registry::by_name(case) else { continue };
            let claims = (of_registry.claims)();
            for row in judged.rows.iter().map(|row| &row.result).filter(|row| row.case == case) {
                let is_it = claims.iter().any(|claim| {
                    let is_one = claim.quantity == row.quantity && claim.resolution() == row.resolution;
                    is_one && claim.scope.is_open() && claim.tolerance.allowed(&[]) == row.allowed
                });
                assert!(is_it, "{name}: {case} has no row `{}` any more: run it with --update-stored", row.quantity);
            }
        }
    }
}

fn programs_table(judged: &[ExternalResults]) -> String {
    let row = |results: &ExternalResults| {
        let count = results.count(None);
        let (pass, red, amber) = (count.pass(), count.red(), count.amber());
        let Headline { controls, controls_red, .. } = count;
        let rows = results.rows.len();
        let (version, day, commit) = (&results.version, results.provenance.day(), &results.provenance.commit);
        format!("{version} | {rows} | {pass} | {red} | {amber} | {controls_red} of {controls} | {day}, {commit}")
    };
    table("program | rows | pass | red | amber | controls red | judged", judged.iter().map(row)).trim_end().to_owned()
}

/// Returns a table cell: largest |error|/allowed, number of passed claims, and number of all claims including amber
/// ones. If no claim passed or failed, the cell is a dash.
fn cell(count: Headline, worst: Option<f64>) -> String {
    if count.conclusive() == 0 {
        return "–".to_owned();
    }
    let (pass, red, asked) = (count.pass(), count.red(), count.rows());
    let red = if red > 0 { format!(", **{red} red**") } else { String::new() };
    worst.map_or_else(String::new, |worst| format!("{} · ", number::significant(worst, 2)))
        + &format!("{pass}/{asked}{red}")
}

fn cases_table(judged: &[ExternalResults]) -> String {
    let names: Vec<&str> = judged.iter().map(|results| results.program.as_str()).collect();
    let row = |case: &str| {
        let cells = judged.iter().map(|results| cell(results.count(Some(case)), results.worst(case)));
        format!("`{case}` | {}", cells.collect::<Vec<_>>().join(" | "))
    };
    table(&format!("case | {}", names.join(" | ")), cases(judged).into_iter().map(row)).trim_end().to_owned()
}

#[test]
fn tables_are_generated() {
    let judged = kept().unwrap();
    let readme = std::fs::read_to_string(root("peers/README.md")).unwrap();
    let readme = with_generated(&readme, "programs", &programs_table(&judged));
    let readme = with_generated(&readme, "cases", &cases_table(&judged));
    let study: Study = serde_json::from_str(&std::fs::read_to_string(root("peers/cost.json")).unwrap()).unwrap();
    expect_file("peers/README.md", &with_generated(&readme, "costs", &costs_table(&study)));
}

/// Returns a table with the time of the cheapest setting of each solver with an error of at most 1 %, and the ratio of
/// this time to the time of the cheapest solver. If a solver does not reach 1 %, the cell shows its smallest error.
fn costs_table(study: &Study) -> String {
    const TARGET: f64 = 0.01;
    let lines = cost::lines(&study.diagrams);
    let row = |diagram: &Diagram| {
        let cheapest = |line: &str| cost::cheapest(diagram, line, TARGET).and_then(|point| point.wall_seconds);
        let best = lines.iter().filter_map(|line| cheapest(line)).fold(f64::INFINITY, f64::min);
        let nearest = |line: &str| {
            let points = diagram.points.iter().filter(|point| point.solver == line);
            points.filter_map(|point| point.error).reduce(f64::min)
        };
        let cell = |line: &&str| match (cheapest(line), nearest(line)) {
            (Some(time), _) if time <= best => format!("**{}**", number::seconds(time)),
            (Some(time), _) => format!("{} (× {})", number::seconds(time), number::significant(time / best, 2)),
            (None, _) if cost::is_hidden(diagram, line, TARGET) => "less than its start varies by".to_owned(),
            (None, Some(error)) => format!("at best {}", number::fraction(error)),
            (None, None) => "–".to_owned(),
        };
        let cells: Vec<String> = lines.iter().map(cell).collect();
        let Diagram { case, variant, quantity, .. } = diagram;
        format!("`{case}/{variant}`, {quantity} | {}", cells.join(" | "))
    };
    let costs = table(&format!("at 1 % | {}", lines.join(" | ")), study.diagrams.iter().map(row));
    let Provenance { machine, date, commit, .. } = &study.provenance;
    format!("{costs}\n{machine}, {}, commit {commit}.", date.split(' ').next().unwrap_or_default())
}
