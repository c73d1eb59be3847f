//! Wrong values for each option of each command. Each gives an error before any run, and a snapshot contains the whole
//! message. The options are read from the help of the command, so that none is missing.

use crate::common::{Directory, files, temporary};
use crate::refusals::settled;
use std::path::Path;

/// Commands with their required arguments.
const COMMANDS: [&str; 23] = [
    "list",
    "run squash",
    "judge rigid squash",
    "init solver new",
    "simulate scene.toml --solver dem",
    "deck nine-discs/kappa-0 --for lammps",
    "check nine-discs/kappa-0 --dump table.csv",
    "fields table.csv --cell 1",
    "compare table.csv table.csv",
    "cost collision",
    "stability two-discs",
    "effects collision",
    "race nine-discs/kappa-1",
    "reference build",
    "reference verify",
    "reference keep squash",
    "reference uncertainty squash",
    "reference fetch no-such.zip",
    "conform dem",
    "scene collision",
    "report a-directory",
    "completions bash",
    "man",
];

/// Returns the name of a command without its arguments.
fn name(command: &str) -> String {
    let depth = if command.starts_with("reference") || command.starts_with("init") { 2 } else { 1 };
    command.split(' ').take(depth).collect::<Vec<_>>().join(" ")
}

/// An option as shown in the help: its long name and the name of its value.
struct HelpOption {
    name: String,
    value: Option<String>,
}

/// Returns the options that a help text lists.
fn options(help: &str) -> Vec<HelpOption> {
    let read = |line: &str| {
        let line = line.trim_start();
        let long = line
            .starts_with("--")
            .then_some(line)
            .or_else(|| line.split_once(", ").filter(|(short, _)| short.len() == 2)?.1.into());
        let long = long.filter(|long| long.starts_with("--"))?;
        let mut words = long.split_whitespace();
        let name = words.next()?.to_owned();
        let value = words
            .next()
            .and_then(|word| word.strip_prefix('<'))
            .map(|word| word.trim_end_matches(['.', '>']).to_owned());
        Some(HelpOption { name, value })
    };
    help.lines().filter_map(read).filter(|shown| !["--help", "--version"].contains(&shown.name.as_str())).collect()
}

/// Returns values that are invalid for an option. They depend on the name of the option or of its value.
fn wrong(option: &HelpOption) -> Vec<&'static str> {
    match (option.name.as_str(), option.value.as_deref()) {
        (_, None) => vec!["yes"],
        ("--low" | "--high", _) => vec!["1,2", "wrong"],
        ("--to", _) => vec!["wrong", "nan"],
        (_, Some("DIR")) => vec!["table.csv"],
        ("--checkpoint" | "--state", _) => vec!["no-directory/file"],
        (_, Some("FILE" | "DIR|results.json" | "OLD.json")) => vec!["missing", "empty"],
        (_, Some("N")) => vec!["-1", "1.5", "many"],
        _ => vec!["wrong", "-1"],
    }
}

/// Writes the files that the commands need: a scene, a table, an empty file and a directory.
fn prepare(directory: &Path) {
    let scene = include_str!("../scenes/one-disc.toml");
    for (name, text) in [("scene.toml", scene), ("table.csv", "step,id,x\n0,1,0\n"), ("empty", "")] {
        directory.write(name, text);
    }
    std::fs::create_dir(directory.join("a-directory")).unwrap();
}

/// Last lines of each error of the parser of options. The snapshot has `[help]` instead of them.
const HELP: &str = "\n\nFor more information, try '--help'.";

/// Returns a command without one of its options and the value of this option.
fn without(command: &str, option: &str) -> String {
    let mut words: Vec<&str> = command.split(' ').collect();
    if let Some(place) = words.iter().position(|word| *word == option) {
        words.drain(place..place + 2);
    }
    words.join(" ")
}

/// Returns the messages of a command for wrong values of each of its options, with the line of the command.
fn answers(command: &str) -> Vec<(String, String)> {
    let directory = temporary();
    prepare(&directory);
    let before = files(&directory);
    let help = directory.run_alone(name(command) + " --help");
    let mut messages = Vec::new();
    let mut ask = |word: &str| {
        let option = word.split('=').next().unwrap_or_default();
        let given = without(command, option) + " " + word;
        let answer = directory.run_alone(&given);
        assert_eq!((answer.code, answer.out.as_str()), (Some(2), ""), "{given}: {}", answer.err);
        assert_eq!(files(&directory), before, "{given}");
        messages.push((settled(&answer.err, &directory).trim_end().replace(HELP, " [help]"), given));
    };
    for option in options(&help.out) {
        for value in wrong(&option) {
            ask(&format!("{}={value}", option.name));
        }
        if option.value.is_some() {
            ask(&option.name);
        }
    }
    ask("--no-such-option");
    messages
}

/// The snapshot contains each message once, below the lines of all commands that print it.
#[test]
fn each_option_given_wrongly_is_refused_by_a_message_that_helps() {
    let mut messages: Vec<(String, String)> = Vec::new();
    for (message, given) in COMMANDS.into_iter().flat_map(answers) {
        let line = format!("$ grainbench {given}\n");
        match messages.iter_mut().find(|(known, _)| *known == message) {
            Some((_, lines)) => lines.push_str(&line),
            None => messages.push((message, line)),
        }
    }
    let shown = messages.into_iter().map(|(message, lines)| lines + &message);
    insta::assert_snapshot!(shown.collect::<Vec<_>>().join("\n"));
}

/// The list of commands in this test is the list of commands that the program shows.
#[test]
fn no_command_is_left_out() {
    let directory = temporary();
    for (place, line) in ["--help", "reference --help"].into_iter().enumerate() {
        let help = directory.run_alone(line).out;
        let listed = help.lines().skip_while(|line| !line.ends_with(':')).take_while(|line| *line != "Options:");
        let listed = listed.filter(|line| line.starts_with("  "));
        let names: Vec<&str> = listed.filter_map(|line| line.split_whitespace().next()).collect();
        assert!(names.len() > 4, "{help}");
        for name in names.into_iter().filter(|name| *name != "help") {
            assert!(COMMANDS.iter().any(|command| command.split(' ').nth(place) == Some(name)), "{name}");
        }
    }
}
