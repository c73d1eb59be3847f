//! Provenance of a run: program, date and machine.

use super::cores::cores;
use chrono::Utc;
use grainbench::lanes::Processor;
use grainbench::reports::{Provenance, number};
use std::fs;

/// Returns the date in UTC, for example 2026-01-31.
pub(crate) fn today() -> String {
    Utc::now().format("%Y-%m-%d").to_string()
}

/// Returns the date and time in UTC, for example 2026-01-31 12:00:00 UTC.
pub(crate) fn now() -> String {
    Utc::now().format("%Y-%m-%d %H:%M:%S UTC").to_string()
}

/// Returns the provenance of a run of `wall_seconds` (s). `options` are the options of the run in words.
pub(crate) fn provenance(options: Vec<String>, wall_seconds: f64) -> Provenance {
    Provenance {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("GRAINBENCH_COMMIT").to_owned(),
        date: now(),
        machine: machine(),
        rustc: env!("GRAINBENCH_RUSTC").to_owned(),
        options,
        wall_seconds,
    }
}

/// Returns a description of the processor, its cores, the operating system, and the vector instructions of our solvers.
fn machine() -> String {
    let (cores, loops) = (number::counted(cores(), "core"), Processor::new().name());
    format!("{}, {cores}, {}, loops compiled for {loops}", processor(), system())
}

/// Returns the value on the first line of a system file that starts with `key`. The value follows `separator`.
fn setting(file: &str, key: &str, separator: char) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    let (_, value) = line.split_once(separator)?;
    Some(value.trim().trim_matches('"').to_owned())
}

fn processor() -> String {
    setting("/proc/cpuinfo", "model name", ':').unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

fn system() -> String {
    setting("/etc/os-release", "PRETTY_NAME=", '=').unwrap_or_else(|| std::env::consts::OS.to_owned())
}
