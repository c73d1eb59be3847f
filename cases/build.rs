//! Generates the registry of cases from the case folders, so that a new case needs changes only in its own folder. Also
//! generates a module for each reference folder with a `provenance.toml`. Such a folder contains a work (publication or
//! prototype) that gives expected values.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Source folders of each kind of solver, or of the code that writes the decks of LAMMPS and LIGGGHTS.
const SOURCES: [(&str, &[&str]); 4] = [
    ("DEM", &["solvers/dem/src", "solvers/scene/src", "solvers/solver/src", "solvers/lanes/src"]),
    ("MPM", &["solvers/mpm/src", "solvers/scene/src", "solvers/solver/src", "solvers/lanes/src"]),
    ("RIGID", &["solvers/rigid/src", "solvers/scene/src", "solvers/solver/src"]),
    ("PROGRAMS", &["reference/src/deck"]),
];

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("registry.rs"), registry(&root)?)?;
    // The build script of the crate `reference` sets this variable. In a checkout, the folder is beside this crate; in
    // a package, it is not.
    let references = PathBuf::from(env::var("DEP_GRAINBENCH_REFERENCE_FOLDER")?);
    println!("cargo::rustc-env=GRAINBENCH_REFERENCES={}", references.display());
    fs::write(out.join("sources.rs"), sources(&references)?)?;
    fs::write(out.join("estimates.rs"), estimates(&references.join(ESTIMATES))?)?;
    println!("cargo::rerun-if-changed={}", root.display());
    for kind in KINDS.into_iter().chain([ESTIMATES]) {
        println!("cargo::rerun-if-changed={}", references.join(kind).display());
    }
    let workspace = root.parent().unwrap_or(&root);
    for (name, folders) in SOURCES {
        println!("cargo::rustc-env=GRAINBENCH_SOURCES_{name}={}", fingerprint(workspace, folders));
        for folder in folders.iter().map(|folder| workspace.join(folder)).filter(|folder| folder.is_dir()) {
            println!("cargo::rerun-if-changed={}", folder.display());
        }
    }
    Ok(())
}

/// Returns a hash of the paths and texts of all files in these folders, except files named `tests.rs`. Comment lines
/// and test modules of Rust sources do not change the hash. A package does not contain these folders. The result is
/// then the package version, because checksums in the lock file identify the sources.
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

/// Returns the text of a file. A Rust source is reduced to its lines of code, without indentation and without its test
/// module. A line that begins with a brace ends the module.
fn code(file: &Path) -> Vec<u8> {
    let bytes = fs::read(file).unwrap_or_default();
    match (file.extension(), str::from_utf8(&bytes)) {
        (Some(end), Ok(text)) if end == "rs" => {
            let (mut lines, mut is_test, mut before) = (Vec::new(), false, "");
            for line in text.lines() {
                is_test |= before == "#[cfg(test)]" && line.starts_with("mod ") && line.ends_with('{');
                if !is_test && !line.trim().is_empty() && !line.trim().starts_with("//") {
                    lines.push(line.trim());
                }
                is_test &= line != "}";
                before = line;
            }
            lines.join("\n").into_bytes()
        }
        _ => bytes,
    }
}

/// Returns the sorted names of the subfolders that contain a file.
fn folders_with(folder: &Path, file: &str) -> Result<Vec<String>, Failure> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.join(file).is_file()
            && let Some(name) = path.file_name().and_then(|name| name.to_str())
        {
            names.push(name.to_owned());
        }
    }
    names.sort();
    Ok(names)
}

/// Returns the code of the case modules and of the registry.
fn registry(root: &Path) -> Result<String, Failure> {
    let [mut code, mut heads, mut cases] = [const { String::new() }; 3];
    for name in folders_with(root, "scene.toml")? {
        let (folder, module) = (root.join(&name), name.replace('-', "_"));
        if let Some(head) = head(&folder, &name, "case.toml")? {
            writeln!(heads, "pub(crate) const {}: Case = Case {{ {head}..EMPTY }};", module.to_uppercase())?;
        }
        match of_claims(&folder, &name)? {
            Some(case) => writeln!(code, "mod {module} {{\n{case}}}")?,
            None => writeln!(code, "#[path = {:?}]\nmod {module};", folder.join("case.rs"))?,
        }
        writeln!(cases, "    &{module}::CASE,")?;
    }
    Ok(format!(
        "{code}/// Cases with the texts of their `case.toml` and without claims.\npub(crate) mod heads {{\n\
         use crate::{{Case, folder::EMPTY}};\n{heads}}}\n\
         /// All cases, in the order of their names.\npub static CASES: &[&crate::Case] = &[\n{cases}];\n"
    ))
}

/// Reads a TOML file.
fn table_of(file: &Path) -> Result<toml::Table, Failure> {
    let table = fs::read_to_string(file)?.parse();
    Ok(table.map_err(|error: toml::de::Error| format!("{}: {error}", file.display()))?)
}

/// Returns a text of a table that is not blank.
fn text<'t>(table: &'t toml::Table, key: &str) -> Result<&'t str, Failure> {
    let text = table.get(key).and_then(toml::Value::as_str).filter(|text| !text.trim().is_empty());
    Ok(text.ok_or_else(|| format!("expected a text `{key}`"))?)
}

/// Returns scene, derivation and the fields in a file of a case folder, as Rust code; `None` without this file.
fn head(folder: &Path, name: &str, file: &str) -> Result<Option<String>, Failure> {
    let file = folder.join(file);
    if !file.is_file() {
        return Ok(None);
    }
    let table = table_of(&file)?;
    let text = |key: &str| text(&table, key).map_err(|error| format!("{}: {error}", file.display()));
    let [title, claim, physics] = [text("title")?, text("claim")?, text("physics")?];
    let physics = physics[..1].to_uppercase() + &physics[1..];
    let mut code = format!(
        "name: {name:?}, title: {title:?}, claim: {claim:?},\nphysics: grainbench_harness::case::Physics::{physics},\n"
    );
    // Cases may share their limitations, which are then in Rust.
    if table.contains_key("weakness") {
        writeln!(code, "weakness: {:?},", text("weakness")?)?;
    }
    for (key, file) in [("scene", "scene.toml"), ("derivation", "derivation.md")] {
        let path = folder.join(file);
        if path.is_file() {
            writeln!(code, "{key}: include_str!({path:?}),")?;
        }
    }
    Ok(Some(code))
}

/// Returns the Rust code of a case whose claims are in `claims.toml`; `None` if the folder has no such file.
fn of_claims(folder: &Path, name: &str) -> Result<Option<String>, Failure> {
    let claims = folder.join("claims.toml");
    Ok(head(folder, name, "claims.toml")?.map(|head| {
        format!(
            "static CLAIMS: std::sync::OnceLock<Vec<grainbench_harness::claim::Claim>> = std::sync::OnceLock::new();\n\
             pub(crate) static CASE: crate::Case = crate::Case {{\n{head}\
             claims: &|| CLAIMS.get_or_init(|| crate::folder::claims(&CASE, include_str!({claims:?}))).clone(),\n\
             ..crate::folder::EMPTY }};\n"
        )
    }))
}

/// Subfolder of the reference folder that contains estimated uncertainties.
const ESTIMATES: &str = "uncertainty";

/// Returns the code of a list with the name and the text of each file of estimates.
fn estimates(folder: &Path) -> Result<String, Failure> {
    let mut files = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    files.sort();
    let name = |file: &PathBuf| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let lines: String = files.iter().map(|file| format!("    ({:?}, include_str!({file:?})),\n", name(file))).collect();
    Ok(format!("static ESTIMATES: &[(&str, &str)] = &[\n{lines}];\n"))
}

/// Subfolders of the reference folder that contain works.
const KINDS: [&str; 2] = ["literature", "prototype"];

/// Returns the code of one module for each kind of work. It has a module for each work with its values.
fn sources(references: &Path) -> Result<String, Failure> {
    let (mut code, mut all) = (String::new(), String::new());
    for kind in KINDS {
        writeln!(code, "/// Works of this kind.\npub mod {kind} {{")?;
        for name in folders_with(&references.join(kind), "provenance.toml")? {
            let path = references.join(kind).join(&name).join("provenance.toml");
            work(&mut code, kind, &name, &table_of(&path)?).map_err(|error| format!("{}: {error}", path.display()))?;
            write!(all, "&{kind}::{}::WORK, ", name.replace('-', "_"))?;
        }
        writeln!(code, "}}")?;
    }
    writeln!(code, "/// All works.\npub const WORKS: &[&grainbench_harness::source::Work] = &[{all}];")?;
    Ok(code)
}

/// Adds the module of a work. Values whose keys end in `_0`, `_1` and so on are also a list without this number.
fn work(code: &mut String, kind: &str, name: &str, table: &toml::Table) -> Result<(), Failure> {
    let number = |table: &toml::Table, key: &str| {
        table.get(key).and_then(|value| value.as_float().or(value.as_integer().map(|whole| whole as f64)))
    };
    let cited = text(table, "cited")?;
    let variant = match (kind, table.get("experiment").and_then(toml::Value::as_bool)) {
        ("literature", Some(true)) => "Experiment",
        ("literature", _) => "Literature",
        _ => "Prototype",
    };
    writeln!(code, "/// {cited}\npub mod {} {{", name.replace('-', "_"))?;
    let source = "grainbench_harness::source";
    writeln!(code, "/// The work.\npub static WORK: {source}::Work =")?;
    writeln!(code, "{source}::Work {{ kind: {source}::Kind::{variant}, id: \"{kind}/{name}\", cited: {cited:?} }};")?;
    let mut keys = Vec::new();
    for value in table.get("value").and_then(toml::Value::as_array).into_iter().flatten() {
        let value = value.as_table().ok_or("expected tables `[[value]]`")?;
        let (key, what) = (text(value, "key")?, text(value, "what")?);
        let uncertainty = number(value, "uncertainty").unwrap_or(0.0);
        let value = number(value, "value").ok_or(format!("expected a number `value` of {key}"))?;
        keys.push(key.to_uppercase());
        writeln!(code, "/// {what}\npub const {}: {source}::CitedNumber = {source}::CitedNumber", key.to_uppercase())?;
        writeln!(code, "{{ work: &WORK, what: {what:?}, value: {value:?}, uncertainty: {uncertainty:?} }};")?;
    }
    for name in keys.iter().filter_map(|key| key.strip_suffix("_0")) {
        let list: Vec<String> = (0..).map(|at| format!("{name}_{at}")).take_while(|key| keys.contains(key)).collect();
        writeln!(code, "/// List of values.\npub const {name}: &[{source}::CitedNumber] = &[{}];", list.join(", "))?;
    }
    writeln!(code, "}}")?;
    Ok(())
}
