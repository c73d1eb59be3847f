//! Limits for the size and the cyclic dependencies of each crate. A commit that raises a limit states the reason.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Folder, largest number of lines in its Rust files, and largest number of files with a cyclic dependency. `harness`
/// has a cycle, because a case has a function that draws figures with a runner, and a runner runs a case.
const BUDGETS: [(&str, usize, usize); 16] = [
    ("solvers/scene", 9_685, 0),
    ("solvers/solver", 3_350, 0),
    ("solvers/lanes", 1_355, 0),
    ("solvers/dem", 8_325, 0),
    ("solvers/mpm", 10_775, 0),
    ("solvers/rigid", 1_465, 0),
    ("harness", 7_590, 5),
    ("store", 1_920, 0),
    ("reference", 13_975, 0),
    ("cases", 18_690, 0),
    ("fields", 3_185, 0),
    ("reports", 13_980, 0),
    ("studies", 6_220, 0),
    ("jobs", 2_685, 0),
    ("src", 10_805, 0),
    ("tests", 10_290, 0),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the path and the text of all Rust files of a folder.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

#[test]
fn crates_stay_within_their_budgets() {
    let (mut over, mut far_below) = (Vec::new(), Vec::new());
    for (folder, most_lines, most_files) in BUDGETS {
        let lines: usize = files(&root().join(folder)).iter().map(|(_, text)| text.lines().count()).sum();
        let circular = if folder == "tests" { BTreeSet::new() } else { in_circles(&modules(folder)) };
        if lines > most_lines || circular.len() > most_files {
            over.push(format!("{folder}: {lines} lines, files in circles: {circular:?}"));
        }
        // A limit far above the number of lines would let a crate grow without notice.
        if lines + lines / 40 < most_lines {
            far_below.push(format!("{folder}: {lines} lines, budget {most_lines}"));
        }
    }
    assert!(over.is_empty(), "over the budget: {over:#?}");
    assert!(far_below.is_empty(), "lower the budget: {far_below:#?}");
}

#[test]
fn circles_are_found() {
    let graph = |files: &[(&str, &str)]| -> BTreeMap<String, String> {
        files.iter().map(|(name, text)| ((*name).to_owned(), code(text))).collect()
    };
    let circle = graph(&[("", "mod a; mod b;"), ("a", "use crate::b::B;"), ("b", "use super::a::{A, other::C};")]);
    assert_eq!(in_circles(&circle), ["a", "b"].map(str::to_owned).into());
    let straight = graph(&[("", "mod a;"), ("a", "use crate::b::B;"), ("b", "fn f() {} // crate::a")]);
    assert_eq!(in_circles(&straight), BTreeSet::new());
    // A name that a module re-exports from one of its files belongs to this file.
    let folder =
        graph(&[("x", "pub use x::y::Y;\nuse self::z::Z;"), ("x::y", "struct Y;"), ("x::z", "use crate::x::Y;")]);
    let folder: BTreeMap<_, _> = folder.into_iter().map(|(name, text)| (name, text.replace("x::y", "y"))).collect();
    assert_eq!(in_circles(&folder), BTreeSet::new());
}

/// Returns the code of all modules of a crate, by path, such as `contact::chain`.
fn modules(folder: &str) -> BTreeMap<String, String> {
    let source = if folder == "src" { root().join("src") } else { root().join(folder).join("src") };
    let name = |path: &Path| -> String {
        let inner = path.strip_prefix(&source).unwrap().with_extension("");
        let parts: Vec<String> = inner.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        parts.join("::").trim_end_matches("::mod").replace("lib", if parts == ["lib"] { "" } else { "lib" })
    };
    files(&source).into_iter().map(|(path, text)| (name(&path), code(&text))).collect()
}

/// Returns code without comments and without the text after `#[cfg(test)]`.
fn code(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.trim() != "#[cfg(test)]");
    lines.map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n").collect()
}

/// Returns the modules that are part of a cyclic dependency.
fn in_circles(modules: &BTreeMap<String, String>) -> BTreeSet<String> {
    let taken: BTreeMap<String, String> =
        modules.iter().flat_map(|(name, text)| taken_names(modules, name, text)).collect();
    let uses = |name: &String| -> BTreeSet<String> {
        let found = paths(&modules[name]).into_iter().filter_map(|path| target(modules, &taken, name, &path));
        found.filter(|other| other != name && !other.is_empty()).collect()
    };
    let graph: BTreeMap<&String, BTreeSet<String>> = modules.keys().map(|name| (name, uses(name))).collect();
    let reaches_itself = |start: &&String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![(*start).clone()]);
        while let Some(name) = open.pop() {
            for next in graph.get(&name).into_iter().flatten() {
                if next == *start {
                    return true;
                }
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        false
    };
    modules.keys().filter(reaches_itself).cloned().collect()
}

/// Returns the names that a module re-exports with `pub use`, and the modules to which they belong.
fn taken_names(modules: &BTreeMap<String, String>, name: &str, text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for statement in text.split(';').filter_map(|part| part.trim_start().split_once("use ")) {
        if !statement.0.trim_end().ends_with("pub") && !statement.0.trim_end().ends_with(')') {
            continue;
        }
        for path in expand(statement.1.trim()) {
            let Some((module, item)) = path.rsplit_once("::") else { continue };
            let inner = module.trim_start_matches("self::").trim_start_matches("crate::");
            let whole = [name, inner].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("::");
            for of in [whole, inner.to_owned()] {
                if modules.contains_key(&of) {
                    found.push((format!("{name}::{item}"), of));
                    break;
                }
            }
        }
    }
    found
}

/// Returns the module to which a path in a module refers; none if it is in another crate.
fn target(
    modules: &BTreeMap<String, String>,
    taken: &BTreeMap<String, String>,
    name: &str,
    path: &str,
) -> Option<String> {
    let mut parts: Vec<&str> = path.split("::").map(str::trim).collect();
    let mut base: Vec<&str> = if name.is_empty() { Vec::new() } else { name.split("::").collect() };
    match parts.first().copied() {
        Some("crate") => {
            base.clear();
            parts.remove(0);
        }
        Some("self") => drop(parts.remove(0)),
        _ => {
            while parts.first() == Some(&"super") {
                parts.remove(0);
                base.pop();
            }
        }
    }
    let whole: Vec<&str> = base.into_iter().chain(parts).collect();
    for length in (1..=whole.len()).rev() {
        let start = whole[..length].join("::");
        if let Some(of) = taken.get(&start) {
            return Some(of.clone());
        }
        if modules.contains_key(&start) {
            return Some(start);
        }
    }
    None
}

/// Returns all paths in the code that begin with `crate`, `self` or `super`.
fn paths(text: &str) -> Vec<String> {
    let is_of_path = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    let mut found = Vec::new();
    for start in ["crate::", "self::", "super::"] {
        for (at, _) in text.match_indices(start) {
            if text[..at].chars().next_back().is_some_and(is_of_path) {
                continue;
            }
            let end = text[at..].find(|letter: char| !is_of_path(letter)).map_or(text.len(), |end| at + end);
            let group = text[end..].strip_prefix('{').filter(|_| text[at..end].ends_with("::"));
            let inner = group.map_or(0, |group| closing(group) + 2);
            found.extend(expand(&text[at..end + inner]));
        }
    }
    found
}

/// Returns the position of the bracket that closes a group. The group is given without its opening bracket.
fn closing(group: &str) -> usize {
    let mut depth = 1;
    for (at, letter) in group.char_indices() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        if depth == 0 {
            return at;
        }
    }
    group.len()
}

/// Returns all paths of a `use` statement that may contain nested groups.
fn expand(path: &str) -> Vec<String> {
    let Some((start, group)) = path.split_once('{') else {
        return vec![path.split_whitespace().next().unwrap_or_default().trim_end_matches("::self").to_owned()];
    };
    let group = &group[..closing(group)];
    let (mut parts, mut depth, mut from) = (Vec::new(), 0, 0);
    for (at, letter) in group.char_indices() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        if letter == ',' && depth == 0 {
            parts.push(&group[from..at]);
            from = at + 1;
        }
    }
    parts.push(&group[from..]);
    let parts = parts.into_iter().map(str::trim).filter(|part| !part.is_empty());
    parts.flat_map(|part| expand(&format!("{start}{part}"))).collect()
}
