//! Records for provenance the commit and the compiler that the program is built from.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    println!("cargo::rustc-env=GRAINBENCH_RUSTC={}", words(&rustc, &["--version"]).unwrap_or_else(unknown));
    println!("cargo::rustc-env=GRAINBENCH_COMMIT={}", commit(&root).unwrap_or_else(unknown));
    println!("cargo::rustc-env=GRAINBENCH_BUILD={}", build(Path::new(&root), &rustc));
    // Inputs that can make the tree differ from its commit, and the commit itself.
    let manifest = fs::read_to_string(Path::new(&root).join("Cargo.toml")).unwrap_or_default();
    for part in ["build.rs", "Cargo.toml", "Cargo.lock", "src"].into_iter().chain(members(&manifest)) {
        println!("cargo::rerun-if-changed={part}");
    }
    if let Some(git) = words("git", &["-C", &root, "rev-parse", "--absolute-git-dir"]) {
        for part in ["HEAD", "logs/HEAD"].map(|part| Path::new(&git).join(part)).iter().filter(|part| part.exists()) {
            println!("cargo::rerun-if-changed={}", part.display());
        }
    }
}

/// Computes the hash of everything that a build of the solvers depends on: compiler, its options, and versions of all
/// crates.
fn build(root: &Path, rustc: &str) -> String {
    let read = |file: &str| fs::read_to_string(root.join(file)).unwrap_or_default();
    let set = |name: &str| env::var(name).unwrap_or_default();
    let options = ["TARGET", "PROFILE", "OPT_LEVEL", "CARGO_CFG_TARGET_FEATURE", "CARGO_ENCODED_RUSTFLAGS"].map(set);
    let all = [words(rustc, &["-vV"]).unwrap_or_default(), read("Cargo.lock"), read("Cargo.toml"), options.join(" ")];
    blake3::hash(all.join("\n").as_bytes()).to_hex().to_string()
}

/// Returns the folders of the workspace's other crates, from the line that lists them.
fn members(manifest: &str) -> impl Iterator<Item = &str> {
    let line = manifest.lines().find(|line| line.starts_with("members = ")).unwrap_or_default();
    line.split('"').skip(1).step_by(2).filter(|member| *member != ".")
}

/// Returns the commit, with `+changes` if the tree has changes; `None` if the sources are not the root of a repository.
fn commit(root: &str) -> Option<String> {
    let top = words("git", &["-C", root, "rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(root).ok()? {
        return None;
    }
    let commit = words("git", &["-C", root, "rev-parse", "--short", "HEAD"])?;
    // Without optional locks, git does not write its index, and two simultaneous builds do not disturb each other.
    let changes = words("git", &["--no-optional-locks", "-C", root, "status", "--porcelain"])?;
    Some(if changes.is_empty() { commit } else { commit + "+changes" })
}

/// Returns the output of a program; `None` if the program is missing or fails.
fn words(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

fn unknown() -> String {
    "unknown".to_owned()
}
