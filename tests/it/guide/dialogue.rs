//! `console` blocks of the guide: commands and their output.

use crate::common::{Directory, Folder, temporary};
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Placeholder for text that varies.
const ANY: &str = "…";

/// A command, with the output that the guide shows for it.
pub(crate) struct Step {
    pub(crate) line: usize,
    command: String,
    shown: Vec<String>,
    exit: i32,
}

/// A `console` block, with the programs that it needs.
pub(crate) struct Block {
    pub(crate) needs: Vec<String>,
    pub(crate) steps: Vec<Step>,
}

/// Returns the `console` blocks of a text.
pub(crate) fn blocks(text: &str) -> Result<Vec<Block>, String> {
    let mut found = Vec::new();
    let mut needs = Vec::new();
    let mut open: Option<Block> = None;
    for (at, line) in text.lines().enumerate() {
        let Some(block) = &mut open else {
            if let Some(rest) = line.strip_prefix("<!-- needs ") {
                let names = rest.strip_suffix(" -->").ok_or_else(|| format!("line {}: ` -->` is not there", at + 1))?;
                needs = names.split(' ').map(str::to_owned).collect();
            } else if line == "```console" {
                open = Some(Block { needs: std::mem::take(&mut needs), steps: Vec::new() });
            } else if !line.is_empty() {
                needs.clear();
            }
            continue;
        };
        if line == "```" {
            found.extend(open.take());
        } else if let Some(command) = line.strip_prefix("$ ") {
            block.steps.push(Step { line: at + 1, command: command.to_owned(), shown: Vec::new(), exit: 0 });
        } else {
            let step = block.steps.last_mut().ok_or_else(|| format!("line {}: an answer to no command", at + 1))?;
            if let Some(code) = line.strip_prefix("# exit ") {
                step.exit = code.parse().map_err(|_| format!("line {}: `{code}` is no exit code", at + 1))?;
            } else {
                step.shown.push(plain(line));
            }
        }
    }
    if open.is_some() { Err("a block does not end".to_owned()) } else { Ok(found) }
}

/// Returns a line in which non-breaking spaces are replaced by ordinary spaces.
fn plain(line: &str) -> String {
    line.trim_end().replace(['\u{a0}', '\u{2009}', '\u{202f}'], " ")
}

/// Returns true if an output line matches a shown line, which may contain [`ANY`].
pub(crate) fn hold(shown: &str, line: &str) -> bool {
    let mut parts = shown.split(ANY);
    let Some(mut rest) = line.strip_prefix(parts.next().unwrap_or_default()) else { return false };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else { return rest.is_empty() };
    for part in parts {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

/// Returns true if the output contains the shown lines in their order. They must be consecutive, except across a line `…`.
fn is_part(shown: &[String], answer: &[String]) -> bool {
    let mut from = 0;
    for run in shown.split(|line| line == ANY).filter(|run| !run.is_empty()) {
        let fits = |window: &[String]| run.iter().zip(window).all(|(shown, line)| hold(shown, line));
        match answer[from..].windows(run.len()).position(fits) {
            Some(at) => from += at + run.len(),
            None => return false,
        }
    }
    true
}

/// Copy of the files that a reader of the guide has: guide and examples, with the program on the path.
pub(crate) struct Place {
    folder: Folder,
}

impl Place {
    pub(crate) fn new() -> Self {
        let folder = temporary();
        let parts =
            "guide/scenes guide/claims examples/cpp examples/python examples/case examples/sweep cases/drum-mixing";
        for part in parts.split(' ') {
            folder.copy(part, part);
        }
        let programs = folder.join("bin");
        fs::create_dir(&programs).unwrap();
        std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_grainbench"), programs.join("grainbench")).unwrap();
        Self { folder }
    }

    /// Runs a command. Returns an error that shows the difference if the output is not as shown.
    pub(crate) fn run(&self, step: &Step) -> Result<(), String> {
        let mut path = vec![self.folder.join("bin")];
        path.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).collect::<Vec<PathBuf>>());
        let output = Command::new("sh")
            .args(["-c", &format!("exec 2>&1\n{}", step.command)])
            .env("PATH", std::env::join_paths(path).unwrap())
            .env("GRAINBENCH_CACHE", "off")
            .env_remove("GITHUB_ACTIONS")
            .env_remove("GITHUB_STEP_SUMMARY")
            .current_dir(self.folder.join("guide/scenes"))
            .stdin(Stdio::null())
            .output()
            .map_err(|error| error.to_string())?;
        let answer = String::from_utf8_lossy(&output.stdout);
        let lines: Vec<String> = answer.lines().map(plain).collect();
        let code = output.status.code();
        if code != Some(step.exit) {
            return Err(format!("`{}` ended with {code:?}, not {}:\n{answer}", step.command, step.exit));
        }
        if is_part(&step.shown, &lines) {
            return Ok(());
        }
        Err(format!("`{}` answered\n{answer}and not, in this order,\n{}", step.command, step.shown.join("\n")))
    }
}
