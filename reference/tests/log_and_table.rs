//! Tests with intact and damaged logs and CSV tables.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::fmt::Write as _;

use common::data;
use grainbench_reference::{parse_log, parse_table, read_log};

#[test]
fn reads_two_runs_of_lammps() {
    let log = read_log(&data("lammps-two-runs.log")).unwrap();
    assert_eq!((log.units.as_deref(), log.time_step), (Some("si"), Some(0.015_254_853_881_062_817)));
    let rows: Vec<usize> = log.runs.iter().map(|run| run.thermo.rows()).collect();
    assert_eq!(rows, [4, 3]);
    let (first, second) = (&log.runs[0], &log.runs[1]);
    assert_eq!((first.end.unwrap().steps, first.end.unwrap().atoms, first.end.unwrap().processes), (3, 9, 1));
    let step = second.thermo.column("Step").unwrap();
    assert_eq!(second.thermo.values(step).collect::<Vec<f64>>(), [3.0, 4.0, 5.0]);
    assert!(second.thermo.column("KinEng").is_some());
}

#[test]
fn reads_a_log_of_liggghts() {
    let log = read_log(&data("liggghts.log")).unwrap();
    assert_eq!((log.runs.len(), log.units.as_deref()), (1, Some("si")));
    let thermo = &log.runs[0].thermo;
    assert_eq!((thermo.rows(), thermo.column("Atoms")), (4, Some(3)));
    assert_eq!(log.runs[0].end.unwrap().steps, 3);
}

/// The log has the alignment of a 2025 release, a warning between rows, a printed NaN, and no end.
#[test]
fn reads_another_alignment_and_a_log_that_breaks_off() {
    let text = "LAMMPS (22 Jul 2025)\nPer MPI rank memory allocation (min/avg/max) = 5 | 5 | 5 Mbytes\n\
                \x20  Step          Time          \
                KinEng    \n         0   0              0            \nWARNING: Fix moved\n\
                \x20      100   0.01           -nan         \n";
    let log = parse_log(text.as_bytes(), "log").unwrap();
    let thermo = &log.runs[0].thermo;
    assert_eq!((thermo.rows(), log.runs[0].end), (2, None));
    assert!(thermo.values(2).last().unwrap().is_nan());
}

#[test]
fn reads_tables_of_any_separator() {
    for text in ["# made by hand\nt, x\n0,1.5\n\n0.25, 2\n", "t;x\n0;1.5\n0.25;2\n", "\"t\"\tx\n0\t1.5\n0.25\t2"] {
        let table = parse_table(text.as_bytes(), "csv").unwrap();
        let columns: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(columns, ["t", "x"]);
        assert_eq!(table.values(0).collect::<Vec<f64>>(), [0.0, 0.25]);
        assert_eq!(table.values(1).collect::<Vec<f64>>(), [1.5, 2.0]);
    }
}

#[test]
fn names_the_place_of_every_fault() {
    let mut messages = String::new();
    let mut say = |name: &str, error: String| writeln!(messages, "{name:<22} {error}").unwrap();
    for (name, text) in [
        ("empty", ""),
        ("no run", "units si\n"),
        ("several lines a step", "Per MPI rank memory allocation\n------------ Step 0 ----- CPU = 0 (sec) -----\n"),
        ("a number too few", "Step Time\n0 0\n1\n"),
        ("a number too many", "Step Time\n0 0 0\n"),
        ("no number", "Step Time\n0 0.1.2\n"),
        ("an odd end", "Step Time\n0 0\nLoop time of x\n"),
    ] {
        say(name, parse_log(text.as_bytes(), "log").unwrap_err().to_string());
    }
    for (name, text) in [
        ("empty table", ""),
        ("no names", "0,1\n"),
        ("a name twice", "t,t\n0,1\n"),
        ("no row", "t,x\n"),
        ("a field too few", "t,x\n0,1\n2\n"),
        ("a field too many", "t,x\n0,1,2\n"),
        ("an empty field", "t,x\n0,\n"),
        ("NaN", "t,x\n0,NaN\n"),
        ("zero byte", "t,x\n0,\0\n"),
    ] {
        say(name, parse_table(text.as_bytes(), "csv").unwrap_err().to_string());
    }
    insta::assert_snapshot!(messages);
}
