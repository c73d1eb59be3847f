//! Notes for provenance which commit, which compiler and which sources of solvers the program is built from.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What the solvers of a kind are made of; of other people's programs that is what we hand them.
const SOURCES: [(&str, &[&str]); 4] = [
    ("DEM", &["solvers/dem/src", "solvers/scene/src", "solvers/lanes/src"]),
    ("MPM", &["solvers/mpm/src", "solvers/scene/src", "solvers/lanes/src"]),
    ("RIGID", &["solvers/rigid/src", "solvers/scene/src"]),
    ("PROGRAMS", &["reference/src/deck"]),
];

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    println!("cargo::rustc-env=GRAINBENCH_RUSTC={}", words(&rustc, &["--version"]).unwrap_or_else(unknown));
    println!("cargo::rustc-env=GRAINBENCH_COMMIT={}", commit(&root).unwrap_or_else(unknown));
    println!("cargo::rustc-env=GRAINBENCH_BUILD={}", build(Path::new(&root), &rustc));
    for (name, folders) in SOURCES {
        println!("cargo::rustc-env=GRAINBENCH_SOURCES_{name}={}", fingerprint(Path::new(&root), folders));
    }
    // Whatever can make the tree differ from its commit, and the commit itself.
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

/// Hash of what solvers are built with: compiler, its options, and the versions of all crates.
fn build(root: &Path, rustc: &str) -> String {
    let read = |file: &str| fs::read_to_string(root.join(file)).unwrap_or_default();
    let set = |name: &str| env::var(name).unwrap_or_default();
    let options = ["TARGET", "PROFILE", "OPT_LEVEL", "CARGO_CFG_TARGET_FEATURE", "CARGO_ENCODED_RUSTFLAGS"].map(set);
    let all = [words(rustc, &["-vV"]).unwrap_or_default(), read("Cargo.lock"), read("Cargo.toml"), options.join(" ")];
    blake3::hash(all.join("\n").as_bytes()).to_hex().to_string()
}

/// Hash of all files in some folders except tests, by their paths and texts; comments of Rust sources do not count. A package
/// has none of them: its version and the checksums in its lock identify its sources.
fn fingerprint(root: &Path, folders: &[&str]) -> String {
    if folders.iter().any(|folder| !root.join(folder).is_dir()) {
        return format!("package {}", env::var("CARGO_PKG_VERSION").unwrap_or_default());
    }
    let mut files: Vec<PathBuf> = Vec::new();
    let mut open: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if !path.ends_with("tests.rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    let mut hasher = blake3::Hasher::new();
    for file in files {
        let name = file.strip_prefix(root).unwrap_or(&file).to_string_lossy().into_owned();
        for part in [name.into_bytes(), code(&file)] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(&part);
        }
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

/// The text of a file; of a Rust source the lines of code without their indentation.
fn code(file: &Path) -> Vec<u8> {
    let bytes = fs::read(file).unwrap_or_default();
    match (file.extension(), str::from_utf8(&bytes)) {
        (Some(end), Ok(text)) if end == "rs" => {
            let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
            lines.collect::<Vec<_>>().join("\n").into_bytes()
        }
        _ => bytes,
    }
}

/// The folders of the workspace's crates but this one, from the line that lists them.
fn members(manifest: &str) -> impl Iterator<Item = &str> {
    let line = manifest.lines().find(|line| line.starts_with("members = ")).unwrap_or_default();
    line.split('"').skip(1).step_by(2).filter(|member| *member != ".")
}

/// The commit, marked when the tree has changes; nothing when the sources are no repository of their own.
fn commit(root: &str) -> Option<String> {
    let top = words("git", &["-C", root, "rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(root).ok()? {
        return None;
    }
    let commit = words("git", &["-C", root, "rev-parse", "--short", "HEAD"])?;
    // Without the locks git leaves its index alone, and two builds at once do not disturb each other.
    let changes = words("git", &["--no-optional-locks", "-C", root, "status", "--porcelain"])?;
    Some(if changes.is_empty() { commit } else { commit + "+changes" })
}

/// What a program prints, when it is there and succeeds.
fn words(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

fn unknown() -> String {
    "unknown".to_owned()
}
