//! Logs that LAMMPS and LIGGGHTS print during a run.

use std::io::BufRead;
use std::mem;

use crate::read::lines::{Line, Lines};
use crate::read::number_table::{NumberColumn, RowForm, Table};
use crate::read::read_error::{ReadError, quoted};

/// Output of one `run` command in a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LoggedRun {
    /// Printed columns, named as in the log: `Step`, `Time`, `KinEng`, … Their order and alignment depend on the
    /// release of the program.
    pub thermo: Table,
    /// Time step from the last `timestep` command before the run whose argument is a number; `None` if there is none.
    pub time_step: Option<f64>,
    /// Summary at the end of the run; `None` if the log is truncated.
    pub end: Option<LoopTime>,
}

/// Values of the line `Loop time of … on … procs for … steps with … atoms`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopTime {
    /// Wall-clock time of the loop (s).
    pub seconds: f64,
    /// Number of processes.
    pub processes: u64,
    /// Number of steps.
    pub steps: u64,
    /// Number of atoms at the end.
    pub atoms: u64,
}

/// Log of a program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// First line, if it names the program and its version; otherwise `None`.
    pub version: Option<String>,
    /// Name of the unit system; `None` if the log does not contain the command `units`.
    pub units: Option<String>,
    /// Time step from the last `timestep` command whose argument is a number; `None` if there is none.
    pub time_step: Option<f64>,
    /// Runs in the order of the log.
    pub runs: Vec<LoggedRun>,
}

impl Log {
    /// Returns the total loop time of all runs (s).
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.runs.iter().filter_map(|run| run.end).map(|end| end.seconds).sum()
    }
}

/// Reads a log with `thermo_style one` or `custom`, plain, gzip or zstd. `name` is the name of the log in error messages.
///
/// Printed NaN is kept. Blank lines and warnings between rows are skipped. The last run may be truncated.
///
/// # Errors
/// If the input cannot be read or contains no run, if a step has several lines of thermodynamic output, or if a row
/// does not have one number per column.
pub fn parse_log(reader: impl BufRead, name: &str) -> Result<Log, ReadError> {
    let mut lines = Lines::new(reader, name)?;
    let mut log = Log::default();
    // Rows of the current run, and true if a line of column names is expected next.
    let (mut rows, mut are_names_next) = (None::<Table>, false);
    while let Some(raw_line) = lines.next_line()? {
        let line = raw_line.text()?;
        let words = || line.text.split_whitespace();
        if line.number == 1 && ["LAMMPS (", "LIGGGHTS ("].iter().any(|name| line.text.starts_with(name)) {
            log.version = Some(line.text.trim().to_owned());
        }
        if let Some(thermo) = &mut rows {
            match words().next() {
                Some("Loop") => {
                    let end = Some(loop_time(line)?);
                    log.runs.push(LoggedRun { thermo: mem::take(thermo), time_step: log.time_step, end });
                    rows = None;
                }
                // Blank lines are skipped in this case, and warnings in the next one.
                None => {}
                Some(word) if word.starts_with(char::is_alphabetic) && word.parse::<f64>().is_err() => {}
                Some(_) => ROW.read(raw_line, thermo)?,
            }
            continue;
        }
        if mem::take(&mut are_names_next) || words().next() == Some("Step") {
            if let Some(columns) = columns_of(line) {
                rows = Some(Table::new(columns, Vec::new()));
                continue;
            }
            if line.text.starts_with("---") {
                let found = format!("{}, of another `thermo_style`", quoted(line.text));
                return Err(line.error("the names of columns, as `thermo_style one` and `custom` print them", found));
            }
        }
        let mut words = words();
        match (words.next(), words.next(), words.next()) {
            // LAMMPS prints the first form; LIGGGHTS and older releases of LAMMPS print the second.
            (Some("Per"), Some("MPI"), Some("rank")) | (Some("Memory"), Some("usage"), Some("per")) => {
                are_names_next = true;
            }
            (Some("units"), Some(units), None) => log.units = Some(units.to_owned()),
            (Some("timestep"), Some(step), None) => {
                let step = step.parse().ok().filter(|step: &f64| step.is_finite() && *step > 0.0);
                log.time_step = step.or(log.time_step);
            }
            _ => {}
        }
    }
    if let Some(thermo) = rows {
        log.runs.push(LoggedRun { thermo, time_step: log.time_step, end: None });
    }
    if log.runs.is_empty() {
        let found = if lines.number() == 0 { "an empty file" } else { "none" };
        return Err(lines.error("a run: a line of names such as `Step Time KinEng`, and rows", found));
    }
    Ok(log)
}

const ROW: RowForm = RowForm { separator: None, keeps_non_finite: true };

/// Returns the columns if a line consists of column names: distinct words that are not numbers, including `Step`.
fn columns_of(line: Line<'_>) -> Option<Vec<NumberColumn>> {
    let words: Vec<&str> = line.text.split_whitespace().collect();
    let named = words.contains(&"Step")
        && words.iter().enumerate().all(|(at, word)| word.parse::<f64>().is_err() && !words[..at].contains(word));
    named.then(|| words.into_iter().map(NumberColumn::new).collect())
}

fn loop_time(line: Line<'_>) -> Result<LoopTime, ReadError> {
    let words: Vec<&str> = line.text.split_whitespace().collect();
    let read = || match words[..] {
        ["Loop", "time", "of", seconds, "on", processes, _, "for", steps, "steps", "with", atoms, ..] => {
            Some(LoopTime {
                seconds: seconds.parse().ok()?,
                processes: processes.parse().ok()?,
                steps: steps.parse().ok()?,
                atoms: atoms.parse().ok()?,
            })
        }
        _ => None,
    };
    read().ok_or_else(|| line.error("`Loop time of SECONDS on N procs for N steps with N atoms`", quoted(line.text)))
}
