//! Exit codes, messages, and what is printed.

use grainbench::scene::error::{SceneError, did_you_mean};
use grainbench::scene::text::tamed;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

/// What a command ends with.
pub(crate) type Outcome = Result<ExitCode, Fault>;

/// Why a command could not do what it was asked for.
#[derive(Debug)]
pub(crate) enum Fault {
    /// Bad input or usage: exit code 2.
    Input(String),
    /// The same, with the names that are known, which are told one a line.
    Unknown(String, Vec<String>),
    /// A solver of ours broke: exit code 1.
    Broken(String),
}

/// Exit code of a run with a row that fails, a control that stayed green, or a solver that broke.
pub(crate) const RED: u8 = 1;

/// More names than these are told one a line.
const MOST_ON_A_LINE: usize = 6;

/// Exit code of bad input or usage, the same that clap has for its own.
const BAD_INPUT: u8 = 2;

impl Fault {
    /// Bad input or usage.
    pub(crate) fn input(message: impl Display) -> Self {
        Self::Input(message.to_string())
    }

    /// Something that could not be written. A full disk is no fault of the input.
    pub(crate) fn writing(error: impl std::error::Error + 'static) -> Self {
        let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&error);
        while let Some(inner) = cause {
            if inner.downcast_ref::<io::Error>().is_some_and(|io| io.kind() == ErrorKind::StorageFull) {
                return Self::Broken(error.to_string());
            }
            cause = inner.source();
        }
        Self::input(error)
    }

    /// A word that is none of those known.
    pub(crate) fn unknown<'a>(what: &str, word: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Self {
        let mut names: Vec<&str> = known.clone().into_iter().collect();
        let mut seen = BTreeSet::new();
        names.retain(|name| seen.insert(*name));
        let help = did_you_mean(word, known).map(|help| format!(" ({help})")).unwrap_or_default();
        if names.len() > MOST_ON_A_LINE {
            let message = format!("expected {what}, found `{word}`{help}; there are:");
            return Self::Unknown(message, names.into_iter().map(str::to_owned).collect());
        }
        Self::Input(format!("expected {what}, one of {}; found `{word}`{help}", names.join(", ")))
    }

    /// Says it on the standard error and gives the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let (message, names, code) = match self {
            Self::Input(message) => (message, &[][..], BAD_INPUT),
            Self::Unknown(message, names) => (message, &names[..], BAD_INPUT),
            Self::Broken(message) => (message, &[][..], RED),
        };
        say("error", message);
        for name in names {
            let _ = writeln!(io::stderr(), "  {}", tamed(name, |_| false));
        }
        ExitCode::from(code)
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

impl From<SceneError> for Fault {
    fn from(error: SceneError) -> Self {
        Self::input(error)
    }
}

/// A line on the standard error. Nobody is left to tell when that is closed.
pub(crate) fn say(kind: &str, message: &str) {
    let one_line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    let _ = writeln!(io::stderr(), "{kind}: {}", tamed(&one_line, |_| false));
}

/// Prints text on the standard output. A reader who has seen enough, as `head` has, is no error.
pub(crate) fn print(text: &str) -> Result<(), Fault> {
    let mut out = io::stdout().lock();
    match out.write_all(tamed(text, |character| matches!(character, '\n' | '\t')).as_bytes()).and_then(|()| out.flush())
    {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Fault::input(format!("cannot write the standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON.
pub(crate) fn print_json(value: &impl serde::Serialize) -> Result<(), Fault> {
    let text = serde_json::to_string_pretty(value).map_err(Fault::input)?;
    print(&(text + "\n"))
}

/// Refuses an output directory for files beside those of the user that cannot be written.
pub(crate) fn check_folder(out: &Path) -> Result<(), Fault> {
    // Made and dropped at once, so that a run that is interrupted leaves nothing beside the directory either.
    grainbench::reports::StagedDir::new(out).map(drop).map_err(|error| Fault::input(format!("--out: {error}")))
}

/// Refuses an output directory that cannot be written, or has a page or a manifest of another program, before anything is
/// computed for it.
pub(crate) fn check_writable(out: &Path) -> Result<(), Fault> {
    check_folder(out)?;
    grainbench::reports::refuse_other_programs(out).map_err(|error| Fault::input(format!("--out: {error}")))
}
