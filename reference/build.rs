//! Publishes the folder of this crate to dependent crates, and generates the list of file formats from the files in
//! `src/read/formats`. A new format therefore needs only a new file.

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
    let name = |file: &PathBuf| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let modules: String =
        files.iter().map(|file| format!("#[path = {file:?}]\npub(crate) mod {};\n", name(file))).collect();
    let names: String = files.iter().map(|file| format!("    &{}::FORMAT,\n", name(file))).collect();
    let about = "/// Every format, in the order of their names.";
    Ok(format!("{modules}{about}\npub(crate) static FORMATS: &[&Format] = &[\n{names}];\n"))
}
