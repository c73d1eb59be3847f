//! Logs of LAMMPS and LIGGGHTS: what they print while they run.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::read::line_reader::{Line, LineReader};
use crate::read::numbers::{NotFinite, NumberColumn, RowForm};
use crate::read::read_error::{ReadError, quoted};
use crate::read::table::Table;

/// One `run` of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LoggedRun {
    /// What was printed, by the names that the program gives the columns: `Step`, `Time`, `KinEng`, … Releases order
    /// and align them differently.
    pub thermo: Table,
    /// Time step of the run, where the log repeats the command `timestep` with a number before it.
    pub time_step: Option<f64>,
    /// How it ended; none where the log breaks off.
    pub end: Option<LoopTime>,
}

impl LoggedRun {
    /// Returns the first step that was printed.
    #[must_use]
    pub fn first_step(&self) -> Option<u64> {
        let first = self.thermo.values(self.thermo.column("Step")?).next()?;
        (first >= 0.0).then_some(first as u64)
    }
}

/// The line `Loop time of … on … procs for … steps with … atoms`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopTime {
    /// Wall-clock time of the loop (s).
    pub seconds: f64,
    /// Processes.
    pub processes: u64,
    /// Steps taken.
    pub steps: u64,
    /// Atoms in the end.
    pub atoms: u64,
}

/// A log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// The line by which the program names its version, where the log begins with it.
    pub version: Option<String>,
    /// The name of the unit system, where the log repeats the command that sets it.
    pub units: Option<String>,
    /// The time step, where the log repeats a command `timestep` with a number; that of the last one.
    pub time_step: Option<f64>,
    /// Its runs, in order.
    pub runs: Vec<LoggedRun>,
}

/// Reads the log at `path`, plain, gzip or zstd; see [`parse_log`].
///
/// # Errors
/// The file cannot be read, or is not such a log.
pub fn read_log(path: &Path) -> Result<Log, ReadError> {
    let name = path.to_string_lossy();
    let file = File::open(path).map_err(|error| ReadError::opening(&name, error))?;
    parse_log(BufReader::new(file), &name)
}

/// Reads a log with `thermo_style one` or `custom`; `name` is what errors call it. NaN is kept: it is what the program
/// printed. Warnings between the rows are passed over. The last run may be broken off.
///
/// # Errors
/// The input cannot be read, prints thermodynamic output in several lines a step, has a row that is not one number for
/// each column, or has no run at all.
pub fn parse_log(reader: impl BufRead, name: &str) -> Result<Log, ReadError> {
    let mut lines = LineReader::new(reader, name)?;
    let mut log = Log::default();
    let mut expected = Expected::Text;
    while let Some(line) = lines.next_line()? {
        let words = || line.text.split_whitespace();
        if line.number == 1 && ["LAMMPS (", "LIGGGHTS ("].iter().any(|name| line.text.starts_with(name)) {
            log.version = Some(line.text.trim().to_owned());
        }
        if let Expected::Rows(columns, values) = &mut expected {
            match words().next() {
                Some("Loop") => {
                    let end = Some(loop_time(line)?);
                    let thermo = Table::new(std::mem::take(columns), std::mem::take(values));
                    log.runs.push(LoggedRun { thermo, time_step: log.time_step, end });
                    expected = Expected::Text;
                }
                // A blank line, a warning.
                None => {}
                Some(word) if word.starts_with(char::is_alphabetic) && word.parse::<f64>().is_err() => {}
                Some(_) => ROW.read(line.raw(), columns, values)?,
            }
            continue;
        }
        if expected == Expected::Names || words().next() == Some("Step") {
            if let Some(columns) = columns_of(line) {
                expected = Expected::Rows(columns, Vec::new());
                continue;
            }
            if line.text.starts_with("---") {
                let found = format!("{}, of another `thermo_style`", quoted(line.text));
                return Err(line.error("the names of columns, as `thermo_style one` and `custom` print them", found));
            }
        }
        let mut words = words();
        expected = match (words.next(), words.next(), words.next()) {
            // LAMMPS says it of each process, older releases and LIGGGHTS of the processor.
            (Some("Per"), Some("MPI"), Some("rank")) | (Some("Memory"), Some("usage"), Some("per")) => Expected::Names,
            (Some("units"), Some(units), None) => {
                log.units = Some(units.to_owned());
                Expected::Text
            }
            (Some("timestep"), Some(step), None) => {
                log.time_step =
                    step.parse().ok().filter(|step: &f64| step.is_finite() && *step > 0.0).or(log.time_step);
                Expected::Text
            }
            _ => Expected::Text,
        };
    }
    if let Expected::Rows(columns, values) = expected {
        log.runs.push(LoggedRun { thermo: Table::new(columns, values), time_step: log.time_step, end: None });
    }
    if log.runs.is_empty() {
        let found = if lines.number() == 0 { "an empty file" } else { "none" };
        return Err(lines.error_at_end("a run: a line of names such as `Step Time KinEng`, and rows", found));
    }
    Ok(log)
}

/// A row of a log.
const ROW: RowForm = RowForm { separator: None, not_finite: NotFinite::Kept };

/// What the next line of a log may be.
#[derive(PartialEq)]
enum Expected {
    /// Anything.
    Text,
    /// The names of the columns.
    Names,
    /// Rows of these columns.
    Rows(Vec<NumberColumn>, Vec<f64>),
}

/// The columns, if the line names some: words, none a number, none twice, `Step` among them.
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
