//! Helpers that run the program as a separate process.

// Each test program uses only some of these helpers.
#![allow(dead_code)]

use grainbench::cases::solvers;
use grainbench::scene::resolve::no_data_file;
use grainbench::scene::scene::Scene;
use grainbench::scene::source::SceneSource;
use grainbench::solver::kept_record;
use grainbench::solver::record::{Cost, Record};
use grainbench::solver::resolution::Resolution;
use serde_json::Value;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// Environment that hides LAMMPS and LIGGGHTS from the program.
pub(crate) const ABSENT: [(&str, &str); 2] =
    [("GRAINBENCH_LAMMPS", "nowhere/lmp"), ("GRAINBENCH_LIGGGHTS", "nowhere/liggghts")];

pub(crate) struct Answer {
    /// Exit code; `None` if the process was killed.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

impl Answer {
    /// Runs a command.
    pub(crate) fn of(command: &mut Command) -> Self {
        let output = command.output().expect("the program starts");
        let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }

    /// Returns the answer of a command that must have succeeded.
    pub(crate) fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{}{}", self.out, self.err);
        self
    }

    /// Returns the standard output of a command that must have succeeded without a message.
    pub(crate) fn quiet(self) -> String {
        assert_eq!((self.code, self.err.as_str()), (Some(0), ""), "{}", self.out);
        self.out
    }

    /// Returns the exit code and the results of a report that was printed as JSON.
    pub(crate) fn judged(&self) -> (Option<i32>, Vec<Value>) {
        (self.code, self.rows())
    }

    /// Checks that the program rejected its input with a message.
    pub(crate) fn refused(&self, message: &str) {
        let Self { code, out, err } = self;
        assert!(*code == Some(2) && err.contains(message), "{message}: {code:?} {out}{err}");
    }

    /// Returns the standard output as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {}{}", self.out, self.err))
    }

    /// Returns the results of a report that was printed as JSON.
    pub(crate) fn rows(&self) -> Vec<Value> {
        self.json()["verdicts"].as_array().unwrap().clone()
    }
}

/// Temporary directory, removed at the end of a test.
pub(crate) struct Folder(TempDir);

impl std::ops::Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        self.0.path()
    }
}

impl AsRef<Path> for Folder {
    fn as_ref(&self) -> &Path {
        self
    }
}

/// Returns an empty temporary directory.
pub(crate) fn temporary() -> Folder {
    Folder(tempfile::tempdir().expect("a temporary directory"))
}

/// Returns a temporary directory with one file.
pub(crate) fn temporary_with(name: &str, content: impl AsRef<[u8]>) -> Folder {
    let folder = temporary();
    folder.write(name, content);
    folder
}

/// Directory in which a test writes files and runs the program.
pub(crate) trait Directory: AsRef<Path> {
    /// Writes a file and creates its folders.
    fn write(&self, name: impl AsRef<Path>, content: impl AsRef<[u8]>) {
        let path = self.as_ref().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }

    /// Writes a script for the shell that can be run as a program.
    #[cfg(unix)]
    fn script(&self, name: &str, text: &str) {
        self.write(name, format!("#!/bin/sh\n{text}\n"));
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(self.as_ref().join(name), mode).unwrap();
    }

    /// Copies the files of a folder of the repository, without a program that was built there.
    fn copy(&self, from: &str, to: &str) {
        let to = self.as_ref().join(to);
        std::fs::create_dir_all(&to).unwrap();
        for path in entries(root(from)).into_iter().filter(|path| path.is_file() && !path.ends_with("one_grain")) {
            std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
        }
    }

    /// Replaces a text in a file, which must contain it. Only its first occurrence is replaced.
    fn edit(&self, name: impl AsRef<Path>, from: &str, to: &str) {
        let text = self.read(&name);
        assert!(text.contains(from), "{}: {from}", name.as_ref().display());
        self.write(name, text.replacen(from, to, 1));
    }

    /// Returns the text of a file.
    fn read(&self, name: impl AsRef<Path>) -> String {
        let path = self.as_ref().join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// Returns the content of a JSON file.
    fn json(&self, name: impl AsRef<Path>) -> Value {
        serde_json::from_str(&self.read(&name)).unwrap_or_else(|error| panic!("{}: {error}", name.as_ref().display()))
    }

    /// Returns the program with a command line, with quotes as in a shell. Messages contain paths relative to this directory. The
    /// program does not use its cache, so that each test does its own runs.
    fn program(&self, line: impl AsRef<str>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grainbench"));
        command
            .args(words(line.as_ref()))
            .env("GRAINBENCH_CACHE", "off")
            .current_dir(self.as_ref())
            .stdin(Stdio::null());
        command
    }

    /// Starts the program with a command line and without output.
    fn start(&self, line: impl AsRef<str>) -> Child {
        self.program(line).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    /// Runs the program with a command line.
    fn run(&self, line: impl AsRef<str>) -> Answer {
        Answer::of(&mut self.program(line))
    }

    /// Runs the program with a command line that must succeed.
    fn ok(&self, line: impl AsRef<str>) -> Answer {
        self.run(line).ok()
    }

    /// Runs the program with a command line, with LAMMPS and LIGGGHTS hidden from it.
    fn run_alone(&self, line: impl AsRef<str>) -> Answer {
        Answer::of(self.program(line).envs(ABSENT))
    }
}

impl Directory for Path {}

/// Splits a command line into words, with quotes as in a shell. `[ROOT]` is the repository.
pub(crate) fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for letter in line.replace("[ROOT]", env!("CARGO_MANIFEST_DIR")).chars() {
        match (letter, quote) {
            ('\'' | '"', None) => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (letter, Some(open)) if letter == open => quote = None,
            (' ' | '\n', None) => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

/// Returns true if a program is installed. In CI, a missing program is an error.
pub(crate) fn is_here(program: &str) -> bool {
    let found = Command::new("sh").args(["-c", "command -v \"$0\"", program]).stdout(Stdio::null()).status();
    let is_here = found.is_ok_and(|status| status.success());
    assert!(is_here || std::env::var_os("CI").is_none(), "{program} is not here");
    is_here
}

/// Interrupts a process, as Ctrl-C does. Returns its exit code and its messages.
pub(crate) fn interrupted(child: Child) -> (Option<i32>, String) {
    // The process may already have ended.
    Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status().unwrap();
    let ended = child.wait_with_output().unwrap();
    (ended.status.code(), String::from_utf8(ended.stderr).unwrap())
}

/// Returns a text without its run times.
pub(crate) fn untimed(text: &str) -> String {
    let mut parts = text.split("\"wall_seconds\":");
    let first = parts.next().unwrap_or_default().to_owned();
    let is_number = |letter: char| letter.is_ascii_digit() || "+-.e".contains(letter);
    parts.fold(first, |all, part| all + part.trim_start_matches(is_number))
}

/// Returns the scene of a text. Its meshes are in a directory.
pub(crate) fn scene_in(directory: &Path, text: &str) -> Result<Scene, String> {
    let source = SceneSource::from_text("scene", directory, text);
    source.scene(&no_data_file).map_err(|error| error.to_string())
}

/// Returns the scene of a text that names no other file.
pub(crate) fn scene(text: &str) -> Scene {
    scene_in(Path::new(""), text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Returns the record of a run that must succeed.
pub(crate) fn simulated(solver: &str, scene: &Scene, resolution: &Resolution) -> Record {
    let solver = solvers::by_name(solver).unwrap();
    solver.run(scene, resolution, &mut ()).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a record as bytes, without its run time. Comparing printed numbers would take longer than most runs.
pub(crate) fn bits(record: Record) -> Vec<u8> {
    let untimed = Record { cost: Cost { wall_seconds: 0.0, ..record.cost }, ..record };
    kept_record::body("", &untimed).expect("a record can be kept")
}

/// Returns the largest resident memory of a run (kB), as the operating system reports it.
#[cfg(target_os = "linux")]
pub(crate) fn peak_memory(path: &Path, line: &str) -> u64 {
    let mut child = path.program(line).stdout(Stdio::null()).spawn().unwrap();
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        peak = line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(peak);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success(), "{line}");
    peak
}

/// Returns the relative paths of all files below a directory, sorted. An empty directory is listed with `/` at its end.
pub(crate) fn files(directory: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![directory.to_path_buf()];
    while let Some(path) = open.pop() {
        let shown = path.strip_prefix(directory).expect("below the directory").display().to_string();
        if path.is_dir() {
            let inner = entries(&path);
            if inner.is_empty() && path != directory {
                found.push(shown + "/");
            }
            open.extend(inner);
        } else {
            found.push(shown);
        }
    }
    found.sort();
    found
}

/// Returns the paths of all entries of a directory, sorted.
pub(crate) fn entries(directory: impl AsRef<Path>) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(directory).expect("readable");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Returns the number of results with an outcome.
pub(crate) fn count(rows: &[Value], verdict: &str) -> usize {
    rows.iter().filter(|row| row["verdict"] == verdict).count()
}

/// Returns the path of a stored output of another program.
pub(crate) fn data(name: &str) -> String {
    root("tests/data/check").join(name).display().to_string()
}

/// Returns the text of a stored output of another program.
pub(crate) fn unpacked(name: &str) -> String {
    let mut whole = String::new();
    let file = std::fs::File::open(data(name)).unwrap();
    flate2::read::GzDecoder::new(file).read_to_string(&mut whole).unwrap();
    whole
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

/// Returns a table in Markdown. The cells of its head and of each row are separated by `|`.
pub(crate) fn table(head: &str, rows: impl IntoIterator<Item = String>) -> String {
    let line = "---|".repeat(head.split('|').count());
    rows.into_iter().fold(format!("| {head} |\n|{line}\n"), |table, row| table + &format!("| {row} |\n"))
}

/// Returns a text in which the part between two marks is replaced.
pub(crate) fn with_generated(readme: &str, mark: &str, table: &str) -> String {
    let open = format!("<!-- generated: {mark} -->\n");
    let start = readme.find(&open).unwrap() + open.len();
    let end = start + readme[start..].find("<!-- end -->").unwrap();
    format!("{}\n{table}\n{}", &readme[..start], &readme[end..])
}
