//! Files of `init`, the command `judge`, and colours.

use crate::common::{Answer, Directory, files, is_here, temporary};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Cases that a solver for one grain can run.
const CASES: [&str; 2] = ["incline-disc/30deg-mu.5", "backspin/sphere"];

/// Each written solver passes, and fails after its friction is changed.
#[test]
fn a_written_solver_runs_at_once() {
    let languages = [
        ("python", "python3", "one_grain.py", "law[\"friction\"] *", "0.9 * law[\"friction\"] *"),
        ("cpp", "c++", "one_grain.cpp", "most = mu *", "most = 0.9 * mu *"),
        ("rust", "rustc", "one_grain.rs", "friction_coefficient * push", "0.9 * friction_coefficient * push"),
    ];
    for (language, _, source, right, wrong) in languages.into_iter().filter(|(_, compiler, ..)| is_here(compiler)) {
        let path = temporary();
        let made = path.run(format!("init solver mine --language {language}"));
        assert_eq!(made.quiet(), "grainbench judge mine/SOLVER.toml incline-disc backspin\n");
        let judge = || path.run(format!("judge mine/SOLVER.toml {} {} --no-controls --quiet", CASES[0], CASES[1]));
        let answer = judge();
        assert!(answer.code == Some(0) && answer.out.contains("9 pass, 0 fail"), "{}{}", answer.out, answer.err);
        // `make` compares times of files.
        let _ = fs::remove_file(path.join("mine/one_grain"));
        path.edit(format!("mine/{source}"), right, wrong);
        assert_eq!(judge().code, Some(1), "{language}: a wrong friction passes");
    }
}

/// A written case and a written scene run. Nothing is overwritten, and a refusal writes nothing.
#[test]
fn a_written_case_and_scene_run_at_once() {
    let path = temporary();
    let done = |arguments: &str| path.ok(arguments).out;
    assert_eq!(done("init case mine"), "grainbench run mine\n");
    assert!(done("run mine --quiet").starts_with("3 pass, 0 fail; negative controls: 3 of 3"));
    assert_eq!(done("init scene ball.toml"), "grainbench simulate ball.toml --solver dem\n");
    assert!(done("simulate ball.toml --solver dem --out ball").contains("A ball on a slope"));
    let before = files(&path);
    path.write("ball.toml", "mine");
    for (arguments, found) in [
        ("init case mine", "mine: expected a new or empty directory, found `"),
        ("init solver mine", "mine: expected a new or empty directory, found `"),
        ("init solver ball.toml", "ball.toml: "),
        ("init scene ball.toml", "ball.toml: expected the name of a new `.toml` file, found an existing file"),
        ("init scene ball", "ball: expected the name of a new `.toml` file, found another name"),
        ("init solver other --language cobol", "invalid value 'cobol'"),
    ] {
        path.run(arguments).refused(found);
    }
    assert_eq!(files(&path), before);
    assert_eq!(path.read("ball.toml"), "mine");
    fs::create_dir(path.join("empty")).unwrap();
    assert_eq!(done("init case empty"), "grainbench run empty\n", "an empty directory is not refused");
}

/// `judge NAME` gives the results of `run --solver NAME`.
#[test]
fn judge_and_run_give_the_same_results() {
    let directory = temporary();
    let results = |arguments: &str| -> Value { directory.run(arguments).json()["verdicts"].clone() };
    let by_run = results(&format!("run {} --solver dem:lammps --no-controls --json", CASES[1]));
    assert!(!by_run.as_array().unwrap().is_empty());
    assert_eq!(results(&format!("judge dem:lammps {} --no-controls --json", CASES[1])), by_run);
    assert_ne!(results(&format!("judge rigid {} --no-controls --json", CASES[1])), by_run);
}

/// A Python function needs `python3` and the package. A misspelled built-in solver is no function.
#[cfg(unix)]
#[test]
fn a_python_function_needs_python() {
    let path = temporary();
    let judge = |name: &str, script: Option<&str>| {
        script.into_iter().for_each(|script| path.script("bin/python3", script));
        Answer::of(path.program(format!("judge {name} {}", CASES[1])).env("PATH", path.join("bin")))
    };
    let absent = "error: sphere:sphere: expected the program `python3`, which runs the function; found none\n";
    let answer = judge("sphere:sphere", None);
    assert_eq!((answer.code, answer.err.as_str()), (Some(2), absent));
    judge("sphere.py:sphere", Some("echo \"No module named 'grainbench'\" >&2; exit 1"))
        .refused("pip install ./python");
    let other = judge("sphere.py:other", Some("echo 'found NoneType' >&2; exit 1"));
    other.refused("python3 reports: found NoneType");
    assert!(!other.err.contains("pip install"), "{}", other.err);
    judge("dem:lamps", Some("exit 1")).refused("did you mean `dem:lammps`?");
    path.run("judge sphere.py:sphere --plan plan").refused("--plan: expected a manifest");
}

/// Without arguments, the program prints its help and ends with 2. At most 18 commands are shown.
#[test]
fn without_arguments_there_is_help() {
    let directory = temporary();
    let answer = directory.run("");
    let help = directory.run("--help").out;
    assert_eq!((answer.code, answer.out.as_str()), (Some(2), ""));
    assert!(answer.err.contains("Judge solvers with the cases:") && help.contains("Judge solvers with the cases:"));
    let commands = help
        .lines()
        .filter(|line| line.starts_with("  ") && line.as_bytes().get(2).is_some_and(u8::is_ascii_lowercase));
    assert!((15..=18).contains(&commands.count()), "{help}");
    for old in ["plan", "work", "status", "collect"] {
        assert!(!help.contains(&format!("\n  {old} ")), "{old}");
    }
}

#[test]
fn colours_are_as_requested() {
    let directory = temporary();
    let is_colored = |color: &str, variables: &[(&str, &str)]| {
        let mut run = directory.program(format!("run {} --solver dem:lammps --no-controls {color}", CASES[1]));
        Answer::of(run.envs(variables.iter().copied())).out.contains("\u{1b}[32m✓\u{1b}[0m All ")
    };
    assert!(is_colored("--color always", &[]));
    assert!(is_colored("--color=always", &[("NO_COLOR", "1")]), "an option is stronger than the environment");
    for (color, variables) in [("", &[][..]), ("--color never", &[]), ("--color auto", &[("NO_COLOR", "1")])] {
        assert!(!is_colored(color, variables), "{color:?}: a pipe has colours");
    }
    directory.run("list --color red").refused("invalid value 'red'");
    let answer = directory.run("run sqash --color always");
    assert!(answer.err.starts_with("\u{1b}[31merror:\u{1b}[0m expected a case"));
}

/// The citation of a page is that of `CITATION.cff`.
#[test]
fn the_citation_is_that_of_the_file() {
    use grainbench::reports::page::{AUTHOR, TITLE};
    let file = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("CITATION.cff")).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    for line in [format!("title: {TITLE}"), format!("  - name: {AUTHOR}"), format!("version: {version}")] {
        assert!(file.lines().any(|found| found == line), "{line}");
    }
}

/// A style changes the figures of a stored report and nothing else. A wrong style changes nothing.
#[test]
fn figures_have_the_style_of_a_file() {
    let path = temporary();
    path.ok(format!("run {} --solver dem:lammps --no-controls --out out --quiet", CASES[1]));
    let out = path.join("out");
    let names = || files(&out).into_iter().filter(|name| name.starts_with("figures") && name.ends_with(".svg"));
    let figures = || -> Vec<String> { names().map(|name| out.read(name)).collect() };
    let (plain, page) = (figures(), path.read("out/index.html"));
    assert!(!plain.is_empty());
    for (style, message) in [
        ("width = -86", "style.toml: width: expected a width in mm, at most 2000, found -86"),
        (
            "font_size = 8",
            "style.toml: font_size: expected a size in pt, at most 100, and a width, found 8 without `width`",
        ),
        ("colours = []", "unknown field `colours`"),
        ("colors = [\"red\"]", "style.toml: colors: expected colours as `#rrggbb`, found `red`"),
    ] {
        path.write("style.toml", style);
        path.run("report out --style style.toml").refused(message);
        assert_eq!(figures(), plain);
    }
    let family = "font-family=\"No Such Family, serif\"";
    path.write("style.toml", "width = 86\nfont_size = 8\nfont = 'No Such Family, serif'\ncolors = ['#123456']");
    path.run("report out --style style.toml").quiet();
    for svg in figures() {
        assert!(svg.contains("width=\"86mm\"") && svg.contains(family) && !svg.contains("#0072b2"));
    }
    assert_eq!(path.read("out/index.html"), page, "the page keeps its figures");
    let report = "report out --style style.toml --figures pdf --figures png";
    path.run(report).refused("font: expected the name of an installed family");
    path.write("style.toml", "width = 86");
    path.run(report).quiet();
    for svg in names() {
        let read = |ending: &str| fs::read(out.join(&svg).with_extension(ending)).unwrap();
        assert!(read("pdf").starts_with(b"%PDF-"));
        // 86 mm with 300 pixels in an inch.
        assert_eq!(read("png")[16..20], 1016_u32.to_be_bytes());
    }
    // A directory without a report.
    assert_eq!(path.run("report . --style style.toml").code, Some(2));
}
