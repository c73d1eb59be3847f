//! Generated parts of the README and of the guide: the tables of `guide/src/tables.md` and the figures. The feature matrix of the
//! README is written by hand and checked against the claims. The slope of the guide is checked against its exact solution.
//!
//! `UPDATE_README=1 cargo test --release --test it readme` writes the generated parts again.

use crate::common::{expect_file, root, table, with_generated};
use grainbench::cases::registry::{self, CASES, read_grains};
use grainbench::cases::runner;
use grainbench::dem::convention::Convention;
use grainbench::harness::case::{Case, PLAIN};
use grainbench::harness::claim::Claim;
use grainbench::harness::course::of_case;
use grainbench::harness::evidence::Evidence;
use grainbench::mpm::solver::Mpm;
use grainbench::reports::plot;
use grainbench::scene::source::SceneSource;
use grainbench::solver::Solver;
use grainbench::solver::resolution::Resolution;
use grainbench::studies::race::ThroughputBenchmark;
use std::collections::BTreeSet;
use std::path::Path;

fn settings_table() -> String {
    table("solver | setting", Mpm::ALL.iter().map(|mpm| format!("`{}` | {}", mpm.name, mpm.setting.words().join("; "))))
}

fn cases_table() -> String {
    let row = |case: &&Case| {
        let claims = (case.claims)();
        let list = |words: BTreeSet<String>| words.into_iter().collect::<Vec<_>>().join(", ");
        let evidence = list(claims.iter().map(|claim| claim.evidence().word().to_owned()).collect());
        let solvers =
            list(claims.iter().flat_map(|claim| claim.runs.iter().map(|run| format!("`{}`", run.solver))).collect());
        format!("`{}` | {} | {} | {evidence} | {solvers}", case.name, case.title, claims.len())
    };
    table("case | title | claims | evidence | solvers", CASES.iter().map(row))
}

fn conventions_table() -> String {
    let row = |convention: Convention| format!("`{}` | {}", convention.name, convention.words().join("; "));
    table("solver | options", Convention::ALL.into_iter().map(row))
}

/// Returns the table of the stored throughput benchmark. `grainbench race` on an idle machine makes a new `race.json`.
fn race_table() -> String {
    let kept = std::fs::read_to_string(root("benches/race/race.json")).unwrap();
    serde_json::from_str::<ThroughputBenchmark>(&kept).unwrap().markdown().trim_end().to_owned()
}

#[test]
fn tables_are_generated() {
    const CHAPTER: &str = "guide/src/tables.md";
    let mut chapter = std::fs::read_to_string(root(CHAPTER)).unwrap();
    for (mark, table) in [
        ("cases", cases_table()),
        ("conventions", conventions_table()),
        ("settings", settings_table()),
        ("race", race_table()),
    ] {
        chapter = with_generated(&chapter, mark, &table);
    }
    expect_file(CHAPTER, &chapter);
}

/// The page explains the name of each convention and each method that a claim uses.
#[test]
fn the_page_explains_names_of_solvers() {
    let claims = CASES.iter().flat_map(|case| (case.claims)());
    let names: BTreeSet<String> = claims.flat_map(|claim| claim.runs).map(|run| run.solver.to_owned()).collect();
    let named: Vec<&String> = names.iter().filter(|name| name.contains(':')).collect();
    let unexplained: Vec<_> = named.iter().filter(|name| grainbench::reports::page::meaning(name).is_none()).collect();
    assert!(named.len() >= 8 && unexplained.is_empty(), "{unexplained:?}");
}

/// Returns the wrong cells of the feature matrix as `case: evidence`. A cell is wrong if its case has no claim with the
/// evidence of the column. An empty matrix is an error too.
fn wrong_cells(readme: &str) -> Vec<String> {
    const COLUMNS: [&[Evidence]; 5] = [
        &[Evidence::Analytic],
        &[Evidence::Experiment],
        &[Evidence::OtherCode],
        &[Evidence::Paper, Evidence::Prototype],
        &[Evidence::Convergence],
    ];
    let rows = readme.lines().skip_while(|line| !line.starts_with("| physics |")).skip(2);
    let rows: Vec<&str> = rows.take_while(|line| line.starts_with('|')).collect();
    assert!(rows.len() > 5, "the feature matrix has {} rows", rows.len());
    let mut wrong = Vec::new();
    for row in rows {
        for (cell, column) in row.split('|').skip(2).zip(COLUMNS) {
            for name in cell.split('`').skip(1).step_by(2) {
                let case = CASES.iter().find(|case| case.name == name);
                let has = |claim: &Claim| column.contains(&claim.evidence());
                if !case.is_some_and(|case| (case.claims)().iter().any(has)) {
                    wrong.push(format!("{name}: {}", column[0].word()));
                }
            }
        }
    }
    wrong
}

#[test]
fn the_feature_matrix_names_cases_with_that_evidence() {
    let readme = std::fs::read_to_string(root("README.md")).unwrap();
    assert_eq!(wrong_cells(&readme), Vec::<String>::new());
    let planted = readme.replace("| – | `collision`", "| `collision` | `collision`");
    assert_eq!(wrong_cells(&planted), ["collision: experiment"], "a wrong cell is found");
}

#[test]
fn pictures_are_drawn() {
    for (case, figure) in
        [("nine-discs", "forces-distortion"), ("incline-disc", "compliance"), ("incline-disc", "elastic")]
    {
        let case = registry::by_name(case).unwrap();
        let figures = of_case(case, &runner(case), &(case.claims)()).unwrap();
        let figure = figures.iter().find(|candidate| candidate.name == figure).unwrap();
        let path = format!("guide/src/{}-{}.svg", case.name, figure.name);
        expect_file(&path, &plot::draw(figure).unwrap());
    }
}

#[test]
fn the_disc_on_the_slope_rolls_or_slips() {
    let path = "guide/scenes/slope.toml";
    let source = SceneSource::from_text(path, Path::new(""), &std::fs::read_to_string(root(path)).unwrap());
    for variant in [PLAIN, "icy"] {
        let source = if variant == PLAIN { source.clone() } else { source.clone().variant(variant) };
        let scene = source.scene(&read_grains).unwrap();
        let record = grainbench::dem::solver::Dem::new(Convention::DEFAULT)
            .run(&scene, &Resolution::CriticalFraction(0.1), &mut ())
            .unwrap();
        // A rolling disc has a = (2/3) g sin θ, and a disc that slides on ice has a = g (sin θ − μ cos θ). The
        // compliance of the contact causes a small difference.
        let (sine, cosine) = (20_f64.to_radians().sin(), 20_f64.to_radians().cos());
        let expected = if variant == PLAIN { 9.81 * sine / 3.0 } else { 0.5 * 9.81 * (sine - 0.05 * cosine) };
        let x = record.series.column("disc.x").unwrap().last().copied().unwrap();
        assert!((x / expected - 1.0).abs() < 5e-3, "{variant}: {x} m, expected {expected} m");
    }
}
