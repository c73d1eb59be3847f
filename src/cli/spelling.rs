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
    command(arguments.map(current).collect())
}

/// Commands with a plan. In the old command `plan`, other words name the file of a sweep.
const PLANNED: [&str; 3] = ["run", "cost", "stability"];

/// Returns a command line without the old commands `plan`, `work`, `status` and `collect`.
fn command(mut words: Vec<OsString>) -> Vec<OsString> {
    let old = words.get(1).and_then(|word| word.to_str()).unwrap_or_default().to_owned();
    match old.as_str() {
        "plan" => {
            say_command("plan", "run|cost|stability|effects … --plan DIR` or `simulate SWEEP.toml --plan DIR");
            let has_name = |word: &OsString| PLANNED.iter().any(|name| word == name);
            let at = words.iter().position(has_name);
            words[1] = at.map_or_else(|| "simulate".into(), |at| words.remove(at));
            let out = words.iter_mut().find(|word| *word == "--out" || word.as_encoded_bytes().starts_with(b"--out="));
            match out {
                Some(out) => *out = out.to_string_lossy().replacen("--out", "--plan", 1).into(),
                None => words.push("--plan=grainbench-plan".into()),
            }
        }
        "work" => {
            say_command("work", "run --resume DIR");
            words.splice(1..2, ["run".into(), "--resume".into()]);
        }
        "status" => {
            say_command("status", "report DIR --progress");
            words.splice(1..2, ["report".into(), "--progress".into()]);
        }
        "collect" => {
            say_command("collect", "report DIR");
            words[1] = "report".into();
        }
        _ => {}
    }
    words
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
