//! Rules for the whole repository.

use crate::common::{Directory, entries, root, temporary};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::harness::case::{PLAIN, Physics};
use grainbench::harness::evidence::Evidence;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// Returns the relative path and the text of all text files of the repository. Build products, programs installed
/// beside their adapters, and hidden folders except `.ci` are left out.
fn texts() -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![root("")];
    while let Some(folder) = open.pop() {
        for path in entries(folder) {
            let shown = path.strip_prefix(root("")).unwrap().display().to_string();
            let hidden = shown.starts_with('.') && !shown.starts_with(".ci") && !shown.starts_with(".gitignore");
            let is_installed = shown.starts_with("peers/") && shown.ends_with("/venv");
            if hidden || is_installed || shown == "target" || shown == "grainbench-out" {
                continue;
            }
            if path.is_dir() {
                open.push(path);
            } else if let Ok(text) = fs::read_to_string(&path) {
                found.push((shown, text));
            }
        }
    }
    found.sort();
    assert!(found.len() > 50, "{}", found.len());
    found
}

fn rust() -> Vec<(String, String)> {
    texts().into_iter().filter(|(name, _)| name.ends_with(".rs")).collect()
}

/// Returns code without comments and without everything after `#[cfg(test)]`. A string that contains `//` is truncated,
/// which does not affect these tests.
fn code(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.trim() != "#[cfg(test)]");
    lines.map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n").collect()
}

/// Returns true if `word` occurs in `text` as a whole name.
fn has_word(text: &str, word: &str) -> bool {
    let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].chars().next_back().is_some_and(is_name)
            && !text[at + word.len()..].chars().next().is_some_and(is_name)
    })
}

#[test]
fn crates_depend_in_one_direction() {
    // Allowed dependencies of each crate. A new crate needs an entry here.
    let allowed = [
        ("solvers/lanes", ""),
        ("solvers/scene", ""),
        ("solvers/solver", "scene"),
        ("solvers/dem", "scene solver lanes"),
        ("solvers/mpm", "scene solver lanes"),
        ("solvers/rigid", "scene solver"),
        ("harness", "scene solver"),
        ("reference", "scene solver store"),
        ("fields", "scene solver harness"),
        ("cases", "scene solver harness dem mpm rigid reference fields store"),
        ("store", "scene"),
        ("reports", "scene solver harness fields store"),
        ("studies", "lanes scene solver harness reports store"),
        ("jobs", "scene solver harness cases reports studies store"),
        (".", "lanes scene solver harness dem mpm rigid reference fields cases reports store studies jobs"),
    ];
    // Additional dependencies of tests: tests of the solvers use the harness, and tests of the studies use one solver.
    let tested: &[(&str, &str)] =
        &[("solvers/dem", "harness"), ("solvers/mpm", "harness"), ("solvers/rigid", "harness"), ("studies", "dem")];
    let manifest: toml::Table = root("").read("Cargo.toml").parse().unwrap();
    let members = manifest["workspace"]["members"].as_array().unwrap();
    assert_eq!(Some(members), manifest["workspace"]["default-members"].as_array(), "`cargo test` runs all crates");
    for member in members {
        let member = member.as_str().unwrap();
        let (_, known) = allowed.iter().find(|(name, _)| *name == member).unwrap_or_else(|| panic!("{member} is new"));
        let manifest: toml::Table = root(member).read("Cargo.toml").parse().unwrap();
        for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let names = manifest.get(section).and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::keys);
            for name in names.filter_map(|name| name.strip_prefix("grainbench-")) {
                let is_tested = section == "dev-dependencies" && tested.contains(&(member, name));
                let is_known = known.split(' ').any(|known| known == name);
                assert!(is_known || is_tested, "{member} must not depend on {name}");
            }
        }
    }
}

#[test]
fn nothing_unsafe_unfinished_or_left_from_debugging() {
    // The words are split, so that this file does not contain them.
    let banned = [
        concat!("un", "safe"),
        concat!("todo", "!("),
        concat!("unimplemented", "!("),
        concat!("dbg", "!("),
        concat!("#[ig", "nore"),
    ];
    for (name, text) in rust() {
        for word in banned {
            let text: String = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
            let found =
                if word.ends_with('(') || word.starts_with('#') { text.contains(word) } else { has_word(&text, word) };
            assert!(!found, "{name} has `{word}`");
        }
    }
}

/// Loops over particles and contacts use no hash map, string or trait object. The test `allocations` counts their allocations.
#[test]
fn no_hash_map_string_or_trait_object_in_hot_loops() {
    let of_dem = "neighbours cells walls grains geometry motion forces laws pairs touching";
    let of_mpm = "points/runs points/share";
    let of_lanes = "number plain avx2 avx512 logarithm";
    let mut files: Vec<PathBuf> = Vec::new();
    for (solver, names, folders) in [
        ("dem", of_dem, &["contact"][..]),
        ("mpm", of_mpm, &["contact", "grid", "material", "surface", "transfer"]),
        ("lanes", of_lanes, &[]),
    ] {
        let source = root("solvers").join(solver).join("src");
        files.extend(names.split(' ').map(|name| source.join(name).with_extension("rs")));
        files.extend(folders.iter().flat_map(|folder| entries(source.join(folder))));
    }
    assert!(files.len() > 35, "{}", files.len());
    for path in &files {
        let code = code(&fs::read_to_string(path).unwrap());
        for word in ["HashMap", "HashSet", "BTreeMap", "BTreeSet", "String", "format", "to_string", "to_owned", "dyn"] {
            assert!(!has_word(&code, word), "{} has `{word}`", path.display());
        }
    }
}

/// Functions of a system library may differ in the last bit between processors, because the library selects a version
/// by the features of the processor. The solvers use logarithms and other functions that are written in Rust.
#[test]
fn solvers_compute_the_same_bits_on_every_processor() {
    let of_the_system = ".ln() .log2() .log10() .ln_1p() .exp() .exp2() .exp_m1() .sin() .cos() .tan() .sin_cos() .asin() \
        .acos() .atan() .atan2( .sinh() .cosh() .tanh() .powf( .cbrt() .hypot(";
    for (name, text) in rust().into_iter().filter(|(name, _)| name.starts_with("solvers/") && name.contains("/src/")) {
        let code = code(&text);
        let shipped = code.split("#[cfg(test)]").next().unwrap_or_default();
        let found = of_the_system.split(' ').find(|call| shipped.contains(call));
        assert!(found.is_none() || name.ends_with("/tests.rs"), "{name}: {found:?}: expected it from `libm`");
    }
}

#[test]
fn every_case_folder_is_whole() {
    let mut folders = BTreeSet::new();
    for path in entries(root("cases")) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !path.is_dir() || name == "src" || name == "tests" || name == "benches" {
            continue;
        }
        assert!(path.join("scene.toml").is_file(), "cases/{name} has no scene.toml, so it is in no registry");
        // Two cases may share a derivation; one case then includes the file of the other case.
        let code = fs::read_to_string(path.join("case.rs")).unwrap_or_default();
        assert!(!code.is_empty() || path.join("claims.toml").is_file(), "cases/{name} has no claims");
        let derived = path.join("derivation.md").is_file() || code.contains("derivation.md\")");
        assert!(derived, "cases/{name} has no derivation");
        folders.insert(name);
    }
    assert_eq!(CASES.iter().map(|case| case.name.to_owned()).collect::<BTreeSet<_>>(), folders);
}

#[test]
fn every_case_and_claim_states_its_content_and_reason() {
    CASES.par_iter().for_each(|case| {
        let words = [case.title, case.claim, case.derivation, case.weakness];
        assert_ne!(case.physics, Physics::Own, "{}: a field of physics", case.name);
        assert!(words.iter().all(|text| !text.trim().is_empty()), "{}: title, claim, derivation, weakness", case.name);
        // Claims in a file state their resolutions. If the file is invalid, its claims are missing.
        let of_file = fs::read_to_string(case.directory().join("claims.toml"));
        match of_file {
            Ok(text) => assert!(text.matches("[[claims]]").count() <= (case.claims)().len(), "{}", case.name),
            Err(_) => assert!(!case.levels.is_empty(), "{} has no level", case.name),
        }
        let mut variants = case.variants().unwrap();
        for variant in &variants {
            case.variant(variant).unwrap_or_else(|error| panic!("{error}"));
        }
        variants.push(PLAIN.to_owned());
        let claims = (case.claims)();
        assert!(!claims.is_empty(), "{} has no claim", case.name);
        for claim in claims {
            let place = format!("{} · {}", case.name, claim.quantity);
            let (source, because) = (claim.source.words(), &claim.tolerance.because);
            let words = [claim.quantity.as_str(), claim.unit, &source, because, claim.control.name];
            assert!(words.iter().all(|text| !text.trim().is_empty()), "{place}: an empty text in {words:?}");
            let allowed = claim.tolerance.allowed(&[]);
            assert!(allowed.is_finite() && allowed >= 0.0, "{place}: allowed {allowed}");
            assert!(!claim.runs.is_empty(), "{place} reads no run");
            if let Some(work) = claim.source.work() {
                let folder = root("reference").join(work.id);
                assert!(folder.join("provenance.toml").is_file(), "{place}: {} has no provenance", work.id);
            }
            // Expected values of an external program come from a stored or live run, never from a number in the code.
            let has_program = claim.runs.iter().any(|run| solvers::is_program(run.solver));
            assert!(claim.evidence() != Evidence::OtherCode || has_program, "{place}: no program ran it");
            for run in &claim.runs {
                assert!(variants.iter().any(|variant| variant == run.variant), "{place}: no variant {}", run.variant);
            }
        }
    });
}

/// Returns the formatting errors of some files. `cargo fmt` does not find files in generated lists.
fn badly_formatted(files: &[PathBuf]) -> Option<String> {
    let settings = root("rustfmt.toml");
    let mut command = std::process::Command::new("rustfmt");
    command.args(["--check", "--edition", "2024", "--config-path"]).arg(settings).args(files);
    let Ok(output) = command.output() else {
        assert!(std::env::var_os("CI").is_none(), "rustfmt is not installed: nothing was looked at");
        return None;
    };
    Some(String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr))
}

#[test]
fn every_rust_file_of_the_tree_is_formatted() {
    let files: Vec<PathBuf> = rust().into_iter().map(|(name, _)| root(&name)).collect();
    if let Some(found) = badly_formatted(&files) {
        assert!(found.is_empty(), "{found}");
    }
}

#[test]
fn a_badly_formatted_file_is_seen() {
    let folder = temporary();
    let file = folder.join("case.rs");
    fs::write(&file, "fn  claims( )  { }\n").unwrap();
    if let Some(found) = badly_formatted(&[file]) {
        assert!(found.contains("fn claims() {}"), "{found}");
    }
}

/// rustfmt does not shorten comments and long strings, so this test limits the length of all lines.
#[test]
fn lines_are_short_enough_to_read() {
    const MOST: usize = 130;
    for (name, text) in rust() {
        let long = text.lines().position(|line| line.chars().count() > MOST);
        assert!(long.is_none(), "{name}:{} has more than {MOST} characters", long.unwrap_or_default() + 1);
    }
}

#[test]
fn files_are_short_enough_to_read() {
    for (name, text) in texts() {
        let is_lock = name.ends_with("-lock.json");
        let is_ours =
            [".rs", ".md", ".toml"].iter().any(|end| name.ends_with(end)) || name.starts_with(".ci") && !is_lock;
        let lines = text.lines().count();
        assert!(!is_ours || lines <= 700, "{name} has {lines} lines");
    }
}

#[test]
fn no_path_of_one_machine() {
    let folders = [["/wo", "rk/"].concat(), ["/ro", "ot/"].concat(), ["/ho", "me/"].concat(), ["/Us", "ers/"].concat()];
    for (name, text) in texts() {
        for folder in &folders {
            if let Some(line) = text.lines().position(|line| line.contains(folder.as_str())) {
                panic!("{name}:{} has {folder}", line + 1);
            }
        }
    }
}

#[test]
fn the_readme_has_the_two_commands() {
    let Ok(text) = fs::read_to_string(root("README.md")) else { return };
    for command in ["cargo run --release", "cargo test --release"] {
        assert!(text.contains(command), "README.md says nothing of `{command}`");
    }
}

/// Our own texts contain no banned phrase. Data, stored results and third-party texts are left out. The adapters in `peers` are
/// left out too, because stored results contain their hashes. In the sources of the solvers, only comments are searched.
#[test]
fn no_banned_phrases() {
    const BANNED: [&str; 11] = [
        "so many",
        "whoever",
        "anew",
        "of ours",
        "of theirs",
        "is told",
        "are told",
        "told in short",
        "hangs on",
        "in the place of",
        "has it that",
    ];
    let is_own = |name: &str| {
        let folders: Vec<&str> = name.split('/').collect();
        let is_stored = folders.contains(&"kept") || folders.contains(&"data") || folders[0] == "shared";
        let is_of_others = ["reference/lammps/", "reference/liggghts/", "reference/literature/"];
        let is_hashed = folders[0] == "peers" && !name.ends_with(".md");
        let is_list = name == "tests/it/tidy.rs";
        let is_text =
            [".rs", ".toml", ".md", ".py", ".html", ".css", ".js", ".snap"].iter().any(|end| name.ends_with(end));
        is_text && !is_stored && !is_hashed && !is_list && !is_of_others.iter().any(|start| name.starts_with(start))
    };
    let mut found = Vec::new();
    for (name, text) in texts().into_iter().filter(|(name, _)| is_own(name)) {
        let is_solver = name.starts_with("solvers/") && name.contains("/src/");
        // A phrase may continue on the next line, after the mark of a comment or of a continued string.
        let mut joined = String::new();
        for line in text.lines() {
            let line = if is_solver { line.split_once("//").map_or("", |(_, comment)| comment) } else { line };
            joined += line.trim().trim_start_matches(['/', '!', '#']).trim_start().trim_end_matches('\\').trim_end();
            joined.push(' ');
        }
        // The old spelling of an option.
        let joined = joined.to_lowercase().replace("--anew", "");
        found
            .extend(BANNED.iter().filter(|phrase| has_word(&joined, phrase)).map(|phrase| format!("{name}: {phrase}")));
    }
    assert!(found.is_empty(), "{found:#?}");
}
