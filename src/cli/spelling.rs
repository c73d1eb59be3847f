//! Old spellings of options and commands. They are accepted until the next version, and a note is printed.

use super::exit;
use std::ffi::OsString;

/// Old and present spelling of each renamed option.
const RENAMED: [(&str, &str); 11] = [
    ("--again", "--retry-failed"),
    ("--allow-missing", "--partial"),
    ("--anew", "--no-cache"),
    ("--as-kept", "--expect-stored"),
    ("--chunk", "--shard"),
    ("--chunks", "--shards"),
    ("--dt", "--time-step"),
    ("--fresh", "--no-cache"),
    ("--keep", "--update-stored"),
    ("--rerun-failed", "--retry-failed"),
    ("--rungs", "--levels"),
];

/// Returns the arguments in their present spelling, and prints a note for each old spelling. Arguments after `--` are
/// unchanged, because they belong to another program.
pub(super) fn present(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut is_ours = true;
    let current = |argument: OsString| {
        is_ours &= argument != "--";
        let present = argument.to_str().filter(|_| is_ours).and_then(renamed);
        present.map_or(argument, OsString::from)
    };
    arguments.map(current).collect()
}

/// Returns the present spelling of an argument; none if its spelling is not old. The value may follow after `=`.
fn renamed(argument: &str) -> Option<String> {
    let (option, value) = argument.split_at(argument.find('=').unwrap_or(argument.len()));
    let (old, new) = RENAMED.iter().find(|(old, _)| *old == option)?;
    say(old, new);
    Some(format!("{new}{value}"))
}

/// Prints the note for the old spelling of a command.
pub(super) fn say_command(old: &str, new: &str) {
    say(old, &format!("grainbench {new}"));
}

fn say(old: &str, new: &str) {
    exit::say("note", &format!("`{old}` is now `{new}`; the next version will not accept the old spelling"));
}
