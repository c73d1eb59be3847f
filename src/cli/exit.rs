//! Exit codes, messages and output on the terminal.

use super::terminal;
use grainbench::jobs;
use grainbench::reference::ReadError;
use grainbench::scene::error::did_you_mean;
use grainbench::scene::text::{shortened, tamed};
use grainbench::store::written_files;
use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Result of a command.
pub(crate) type Outcome = Result<ExitCode, Fault>;

/// Error of a command.
#[derive(Debug)]
pub(crate) enum Fault {
    /// Bad input or usage: exit code 2.
    Input(String),
    /// Bad input with an unknown name: message, and the known names, which are printed one per line. Exit code 2.
    Unknown(String, Vec<String>),
    /// Failure during a run, such as a crash of our solver or a full disk; exit code 1.
    Broken(String),
}

/// Exit code if a result is red, a control does not fail, or a run fails.
pub(crate) const RED: ExitCode = ExitCode::FAILURE;

/// Returns the exit code of a command with red or without red results.
pub(crate) const fn exit_code(is_red: bool) -> ExitCode {
    if is_red { RED } else { ExitCode::SUCCESS }
}

/// Largest number of known names that fit on one line.
const MOST_ON_A_LINE: usize = 6;

/// Exit code for bad input or usage; it is also the exit code of clap.
const BAD_INPUT: u8 = 2;

/// Returns from a function with an error for bad input. The arguments are those of `format!`.
macro_rules! refuse {
    ($($message:tt)*) => {
        return Err($crate::cli::exit::Fault::input(format_args!($($message)*)))
    };
}
pub(crate) use refuse;

impl Fault {
    /// Returns an error for bad input or usage.
    pub(crate) fn input(message: impl Display) -> Self {
        Self::Input(message.to_string())
    }

    /// Returns the error of output that cannot be read. For a truncated file, it names the option that uses the complete frames.
    pub(crate) fn reading(error: ReadError) -> Self {
        let hint = if error.is_cut() { " (--partial uses the complete frames before it)" } else { "" };
        Self::input(format!("{error}{hint}"))
    }

    /// Returns the error of an unknown word, with the known words.
    pub(crate) fn unknown<'a>(what: &str, word: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Self {
        let mut names: Vec<&str> = known.clone().into_iter().collect();
        let mut seen = BTreeSet::new();
        names.retain(|name| seen.insert(*name));
        let help = did_you_mean(word, known).map(|help| format!(" ({help})")).unwrap_or_default();
        if names.len() > MOST_ON_A_LINE {
            let message = format!("expected {what}, found `{word}`{help}; choices:");
            return Self::Unknown(message, names.into_iter().map(str::to_owned).collect());
        }
        Self::Input(format!("expected {what}, one of {}; found `{word}`{help}", names.join(", ")))
    }

    /// Prints the error on the standard error and returns the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let (message, names, code) = match self {
            Self::Input(message) => (message, &[][..], ExitCode::from(BAD_INPUT)),
            Self::Unknown(message, names) => (message, &names[..], ExitCode::from(BAD_INPUT)),
            Self::Broken(message) => (message, &[][..], RED),
        };
        say("error", message);
        for name in names {
            let _ = writeln!(io::stderr(), "  {}", tamed(&shortened(name), |_| false));
        }
        code
    }
}

impl Display for Fault {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input(message) | Self::Broken(message) => formatter.write_str(message),
            Self::Unknown(message, names) => write!(formatter, "{message} {}", names.join(", ")),
        }
    }
}

impl<E: Error + 'static> From<E> for Fault {
    /// A full disk and a failure of the batch system are failures during the run. All other errors count as bad input.
    fn from(error: E) -> Self {
        let first: &(dyn Error + 'static) = &error;
        let is_full = |cause: &(dyn Error + 'static)| {
            cause.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == ErrorKind::StorageFull)
        };
        let is_of_batch = matches!(first.downcast_ref::<jobs::Fault>(), Some(jobs::Fault::Batch(_)));
        if is_of_batch || std::iter::successors(Some(first), |&cause| cause.source()).any(is_full) {
            return Self::Broken(error.to_string());
        }
        Self::input(error)
    }
}

/// Prints a message on one line of the standard error. A closed standard error is ignored.
pub(crate) fn say(kind: &str, message: &str) {
    let one_line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = format!("{kind}: {}", tamed(&shortened(&one_line), |_| false));
    let _ = writeln!(io::stderr(), "{}", terminal::message(line));
}

/// Prints text on the standard output, and returns the exit code for success. If the reader closes the pipe early, as
/// `head` does, this is not an error.
pub(crate) fn print(text: &str) -> Outcome {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints text for a reader on the standard output. On a terminal, it has colours and fits the width.
pub(crate) fn print_text(text: &str) -> Outcome {
    let Some(shown) = terminal::shown(text) else { return print(text) };
    let mut out = io::stdout().lock();
    done(out.write_all(shown.as_bytes()).and_then(|()| out.flush()))
}

/// Prints the output of a function in blocks, so that large output needs little memory.
pub(crate) fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome {
    let mut out = TamedOutput { out: io::stdout().lock(), piece: Vec::new() };
    done(write(&mut out).and_then(|()| out.flush()))
}

/// Returns the exit code for success, or the error of the standard output. A closed pipe is no error.
fn done(written: io::Result<()>) -> Outcome {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Fault::input(format!("cannot write the standard output: {error}")))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Standard output that replaces all control characters except line feeds and tabs.
struct TamedOutput {
    out: io::StdoutLock<'static>,
    piece: Vec<u8>,
}

impl TamedOutput {
    /// Prints the complete characters of the buffered block.
    fn write_piece(&mut self) -> io::Result<()> {
        let end = match std::str::from_utf8(&self.piece) {
            Err(error) if error.error_len().is_none() => error.valid_up_to(),
            _ => self.piece.len(),
        };
        let text = String::from_utf8_lossy(&self.piece[..end]);
        self.out.write_all(tamed(&text, |character| matches!(character, '\n' | '\t')).as_bytes())?;
        self.piece.drain(..end);
        Ok(())
    }
}

impl Write for TamedOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        /// Size of a block (bytes).
        const PIECE: usize = 1 << 16;
        let bytes = &bytes[..bytes.len().min(PIECE)];
        self.piece.extend_from_slice(bytes);
        if self.piece.len() >= PIECE {
            self.write_piece()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_piece()?;
        self.out.flush()
    }
}

pub(crate) fn print_json(value: &impl serde::Serialize) -> Outcome {
    let text = serde_json::to_string_pretty(value)?;
    print(&(text + "\n"))
}

/// Returns an error if an output directory cannot be written. The directory may contain other files of the user.
fn check_folder(out: &Path) -> Result<(), Fault> {
    // The temporary directory is removed immediately, so that an interrupted run leaves nothing beside the output directory.
    grainbench::store::StagedDir::new(out).map(drop).map_err(|error| Fault::input(format!("--out: {error}")))
}

/// Kind of output of a command: words for a message, and files of which a directory with this output has at least one.
#[derive(PartialEq, Eq)]
pub(crate) struct OutputKind(&'static str, &'static [&'static str]);

pub(crate) const RECORD: OutputKind = OutputKind("a record of `simulate`", &["record.json", "broken.json"]);
pub(crate) const DECK: OutputKind = OutputKind("a deck", &["in.lammps", "in.liggghts"]);
pub(crate) const FIELDS: OutputKind = OutputKind("continuum fields", &["summary.json"]);
pub(crate) const THROUGHPUT: OutputKind = OutputKind("a throughput benchmark", &["race.json"]);
pub(crate) const MANUAL: OutputKind = OutputKind("manual pages", &["grainbench.1"]);
// Records and fields may have a page too, so reports are the last kind.
pub(crate) const REPORT: OutputKind = OutputKind("a report", &["index.html"]);

/// Checks the output directory of a report before any computation, as [`check_output`].
pub(crate) fn check_writable(out: &Path) -> Result<(), Fault> {
    check_output(out, &REPORT, REPORT.1)
}

/// Checks an output directory before any computation. The directory must be writable. It must not contain a
/// manifest or one of the named files of another program, or output of another kind, which would be removed.
pub(crate) fn check_output(out: &Path, kind: &OutputKind, names: &[&str]) -> Result<(), Fault> {
    check_folder(out)?;
    grainbench::store::refuse_other_programs(out, names).map_err(|error| Fault::input(format!("--out: {error}")))?;
    let files = written_files(out);
    let is_there =
        |OutputKind(_, names): &&OutputKind| names.iter().any(|name| files.iter().any(|file| file == Path::new(name)));
    let found = [&RECORD, &DECK, &FIELDS, &THROUGHPUT, &MANUAL, &REPORT].into_iter().find(is_there);
    if let Some(other) = found.filter(|other| *other != kind) {
        refuse!("--out: {}: expected a new directory or one with {}, found {}", out.display(), kind.0, other.0);
    }
    Ok(())
}

/// Checks that an output directory does not contain an input of the command. The output could replace or remove the input.
pub(crate) fn refuse_inputs<'a>(out: &Path, inputs: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), Fault> {
    let Ok(folder) = out.canonicalize() else { return Ok(()) };
    let is_inside = |input: &&PathBuf| {
        let path = input.canonicalize().unwrap_or_default();
        let name = path.strip_prefix(&folder);
        name.is_ok_and(|name| name.components().count() < 2 || written_files(&folder).iter().any(|file| file == name))
    };
    if let Some(input) = inputs.into_iter().find(is_inside) {
        refuse!("--out: {}: expected a directory without input, found the input {}", out.display(), input.display());
    }
    Ok(())
}
