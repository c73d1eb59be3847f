//! README shows what the code says: its tables are generated, its pictures are drawn, its scene runs.
//!
//! `UPDATE_README=1 cargo test --release --test readme` writes them anew.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{expect_file, root, with_generated};
use grainbench::cases::registry::{self, CASES, read_grains};
use grainbench::cases::runner;
use grainbench::dem::convention::Convention;
use grainbench::harness::case::PLAIN;
use grainbench::harness::course::of_case;
use grainbench::mpm::solver::Mpm;
use grainbench::reports::plot;
use grainbench::scene::solver::{Resolution, Solver};
use grainbench::scene::source::SceneSource;
use grainbench::studies::race::Race;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

fn settings_table() -> String {
    let mut table = "| solver | setting |\n|---|---|\n".to_owned();
    for mpm in Mpm::ALL {
        writeln!(table, "| `{}` | {} |", mpm.name, mpm.setting.words().join("; ")).unwrap();
    }
    table
}

fn cases_table() -> String {
    let mut table = "| case | what it is | gates | evidence | solvers |\n|---|---|---|---|---|\n".to_owned();
    for case in CASES {
        let claims = (case.claims)();
        let list = |words: BTreeSet<String>| words.into_iter().collect::<Vec<_>>().join(", ");
        let evidence = list(claims.iter().map(|claim| claim.evidence().word().to_owned()).collect());
        let solvers =
            list(claims.iter().flat_map(|claim| claim.runs.iter().map(|run| format!("`{}`", run.solver))).collect());
        writeln!(table, "| `{}` | {} | {} | {evidence} | {solvers} |", case.name, case.title, claims.len()).unwrap();
    }
    table
}

fn conventions_table() -> String {
    let mut table = "| solver | options |\n|---|---|\n".to_owned();
    for convention in Convention::ALL {
        writeln!(table, "| `{}` | {} |", convention.name, convention.words().join("; ")).unwrap();
    }
    table
}

/// What the race printed that is kept: `grainbench race` on a quiet machine leaves another `race.json`.
fn race_table() -> String {
    let kept = std::fs::read_to_string(root("benches/race/race.json")).unwrap();
    serde_json::from_str::<Race>(&kept).unwrap().table().trim_end().to_owned()
}

#[test]
fn tables_are_generated() {
    let readme = std::fs::read_to_string(root("README.md")).unwrap();
    let readme = with_generated(&readme, "cases", &cases_table());
    let readme = with_generated(&readme, "settings", &settings_table());
    let readme = with_generated(&readme, "race", &race_table());
    expect_file("README.md", &with_generated(&readme, "conventions", &conventions_table()));
}

#[test]
fn pictures_are_drawn() {
    for (case, figure) in
        [("nine-discs", "forces-distortion"), ("incline-disc", "compliance"), ("incline-disc", "elastic")]
    {
        let case = registry::by_name(case).unwrap();
        let figures = of_case(case, &runner(case), &(case.claims)()).unwrap();
        let figure = figures.iter().find(|candidate| candidate.name == figure).unwrap();
        let path = format!("reports/readme/{}-{}.svg", case.name, figure.name);
        expect_file(&path, &plot::draw(figure).unwrap());
    }
}

#[test]
fn the_scene_runs() {
    let readme = std::fs::read_to_string(root("README.md")).unwrap();
    let start = readme.find("<!-- scene -->\n```toml\n").unwrap() + "<!-- scene -->\n```toml\n".len();
    let text = &readme[start..start + readme[start..].find("```").unwrap()];
    let source = SceneSource::from_text("README.md", Path::new(""), text);
    for variant in [PLAIN, "icy"] {
        let source = if variant == PLAIN { source.clone() } else { source.clone().variant(variant) };
        let scene = source.scene(&read_grains).unwrap();
        let record = grainbench::dem::solver::Dem::new(Convention::DEFAULT)
            .run(&scene, &Resolution::CriticalFraction(0.1), &mut ())
            .unwrap();
        // Rolls at (2/3) g sin θ; on ice it slides at g (sin θ − μ cos θ). Both to the compliance of the contact.
        let (sine, cosine) = (20_f64.to_radians().sin(), 20_f64.to_radians().cos());
        let expected = if variant == PLAIN { 9.81 * sine / 3.0 } else { 0.5 * 9.81 * (sine - 0.05 * cosine) };
        let x = record.series.column("disc.x").unwrap().last().copied().unwrap();
        assert!((x / expected - 1.0).abs() < 5e-3, "{variant}: {x} m, expected {expected} m");
    }
}
