//! Helpers that run the program as a separate process.

// Each test program uses only some of these helpers.
#![allow(dead_code)]

use grainbench::solver::kept_record;
use grainbench::solver::record::{Cost, Record};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub(crate) struct Answer {
    /// Exit code; `None` if the process was killed.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

/// Returns a record as bytes, without its run time. Comparing printed numbers would take longer than most runs.
pub(crate) fn bits(record: Record) -> Vec<u8> {
    let untimed = Record { cost: Cost { wall_seconds: 0.0, ..record.cost }, ..record };
    kept_record::body("", &untimed).expect("a record can be kept")
}

/// Returns a command that runs the program without its cache, so that each test does its own runs.
pub(crate) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grainbench"));
    command.env("GRAINBENCH_CACHE", "off");
    command
}

/// Runs the program in a directory, so that messages contain relative paths.
pub(crate) fn grainbench(directory: &Path, arguments: &[&str]) -> Answer {
    grainbench_in(directory, arguments, &[])
}

/// Runs the program in a directory, with LAMMPS and LIGGGHTS hidden from it.
pub(crate) fn grainbench_alone(directory: &Path, arguments: &[&str]) -> Answer {
    let absent = [("GRAINBENCH_LAMMPS", "nowhere/lmp"), ("GRAINBENCH_LIGGGHTS", "nowhere/liggghts")];
    grainbench_in(directory, arguments, &absent)
}

fn grainbench_in(directory: &Path, arguments: &[&str], environment: &[(&str, &str)]) -> Answer {
    let output = program()
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(directory)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    Answer { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}

/// Returns the largest resident memory of a run (kB), as the operating system reports it.
#[cfg(target_os = "linux")]
pub(crate) fn peak_memory(path: &Path, arguments: &[&str]) -> u64 {
    let mut child = program().args(arguments).current_dir(path).stdout(Stdio::null()).spawn().unwrap();
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        peak = line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(peak);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success(), "{arguments:?}");
    peak
}

/// Returns the relative paths of all files below a directory, sorted. An empty directory is listed with `/` at its end.
pub(crate) fn files(directory: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![directory.to_path_buf()];
    while let Some(path) = open.pop() {
        let shown = path.strip_prefix(directory).expect("below the directory").display().to_string();
        if path.is_dir() {
            let entries: Vec<_> =
                std::fs::read_dir(&path).expect("readable").map(|entry| entry.unwrap().path()).collect();
            if entries.is_empty() && path != directory {
                found.push(shown + "/");
            }
            open.extend(entries);
        } else {
            found.push(shown);
        }
    }
    found.sort();
    found
}

/// Returns the path of a file in the repository.
pub(crate) fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Checks that a file has the expected contents. If `UPDATE_README` is set, writes the file first.
pub(crate) fn expect_file(path: &str, wanted: &str) {
    let path = root(path);
    if std::env::var_os("UPDATE_README").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, wanted).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == wanted, "{} is out of date: UPDATE_README=1 cargo test --test it writes it", path.display());
}

/// Returns a text in which the part between two marks is replaced.
pub(crate) fn with_generated(readme: &str, mark: &str, table: &str) -> String {
    let open = format!("<!-- generated: {mark} -->\n");
    let start = readme.find(&open).unwrap() + open.len();
    let end = start + readme[start..].find("<!-- end -->").unwrap();
    format!("{}\n{table}\n{}", &readme[..start], &readme[end..])
}
