//! Lists the case folders, so that adding a case touches one folder and nothing else.

use std::fmt::Write as _;
use std::{env, fs, path::Path};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = env::var("CARGO_MANIFEST_DIR")?;
    let mut names = Vec::new();
    for entry in fs::read_dir(&root)? {
        let path = entry?.path();
        if path.join("scene.toml").is_file()
            && let Some(name) = path.file_name().and_then(|name| name.to_str())
        {
            names.push(name.to_owned());
        }
    }
    names.sort();
    let mut code = String::new();
    for name in &names {
        let module = name.replace('-', "_");
        let file = Path::new(&root).join(name).join("case.rs");
        writeln!(code, "#[path = {file:?}]\nmod {module};")?;
    }
    writeln!(code, "/// Every case, in the order of their names.\npub static CASES: &[&crate::case::Case] = &[")?;
    for name in &names {
        writeln!(code, "    &{}::CASE,", name.replace('-', "_"))?;
    }
    writeln!(code, "];")?;
    with_costs(&root, &names, &mut code)?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("registry.rs"), code)?;
    println!("cargo::rerun-if-changed={root}");
    Ok(())
}

/// Cases that say themselves what accuracy is measured by have a `cost.rs`.
fn with_costs(root: &str, names: &[String], code: &mut String) -> std::fmt::Result {
    let has_one = |name: &&String| Path::new(root).join(name).join("cost.rs").is_file();
    let own: Vec<&String> = names.iter().filter(has_one).collect();
    for name in &own {
        let file = Path::new(root).join(name).join("cost.rs");
        writeln!(code, "#[path = {file:?}]\nmod {}_cost;", name.replace('-', "_"))?;
    }
    writeln!(code, "/// What accuracy is measured by, of cases that say it themselves.")?;
    writeln!(code, "pub(crate) static COSTS: &[crate::subject::Own] = &[")?;
    for name in &own {
        writeln!(code, "    ({name:?}, {}_cost::subjects),", name.replace('-', "_"))?;
    }
    writeln!(code, "];")
}
