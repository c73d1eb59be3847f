//! Publishes the folder of this crate to dependent crates, and generates the list of file formats from the files in
//! `src/read/formats`. A new format therefore needs only a new file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let formats = root.join("src/read/formats");
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("formats.rs"), list(&formats)?)?;
    println!("cargo::metadata=folder={}", root.display());
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", formats.display());
    Ok(())
}

/// Returns Rust code that declares each file in a folder as a module and lists their formats.
fn list(folder: &Path) -> Result<String, Failure> {
    let mut files = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    files.retain(|path| path.extension().is_some_and(|end| end == "rs"));
    files.sort();
    let (mut code, mut names) = (String::new(), String::new());
    for file in &files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        writeln!(code, "#[path = {file:?}]\npub(crate) mod {name};")?;
        writeln!(names, "    &{name}::FORMAT,")?;
    }
    writeln!(
        code,
        "/// Every format, in the order of their names.\npub(crate) static FORMATS: &[&Format] = &[\n{names}];"
    )?;
    Ok(code)
}
