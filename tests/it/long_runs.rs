//! Warning before the first step of a run that takes hours.

use crate::common::{Directory, temporary_with};
use std::io::{BufRead, BufReader};
use std::process::Stdio;

/// Returns a scene of a falling disc. In steel, a wave crosses a cell of 1.25 mm in 0.2 µs.
fn scene(young_modulus: f64, duration: f64) -> String {
    include_str!("../scenes/falling-disc.toml")
        .replace("young_modulus = 2.1e11", &format!("young_modulus = {young_modulus:e}"))
        .replace("duration = 20.0", &format!("duration = {duration:.1}"))
}

/// Starts a run, ends it after its first line on the standard error, and returns this line.
fn first_line(young_modulus: f64, duration: f64, cells: &str) -> String {
    let directory = temporary_with("disc.toml", scene(young_modulus, duration));
    let mut run = directory.program(format!("simulate disc.toml --solver mpm --cells {cells} --out out"));
    let mut run = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(run.stderr.take().unwrap()).read_line(&mut line).unwrap();
    run.kill().unwrap();
    run.wait().unwrap();
    line
}

/// 20 s with time steps of 0.4 h/c. Here h = R/8 = 1.25 mm, c = √(M/ρ) = 6020 m/s in steel, and M = 1.346 E at ν = 0.3.
/// These are 2.4e8 steps of 1804 points, or twelve hours at ten million particle-steps per second.
#[test]
fn steel_in_mpm_is_warned_of() {
    let line = first_line(2.1e11, 20.0, "8");
    assert!(line.starts_with("warning: this takes about 12 h, "), "{line}");
    for part in [" steps of 8.305e-8 s for ", "Softer moduli or larger cells (--cells)", "--checkpoint FILE"] {
        assert!(line.contains(part), "{part}: {line}");
    }
}

/// One second in rubber with cells of half a radius is a short run, so there is no warning.
#[test]
fn rubber_is_not() {
    let line = first_line(2.1e7, 1.0, "2");
    assert!(line.is_empty(), "{line}");
}
