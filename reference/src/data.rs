//! Directory of stored runs and initial states. A source tree contains these data. Packages from a registry, wheels and
//! archives of the program do not, because the data are large.

use crate::read::read_error::{one_line, quoted};
use grainbench_store::machine::user_directory;
use std::env;
use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use zip::ZipArchive;

/// Environment variable with the directory of the data, in place of the usual directories.
const VARIABLE: &str = "GRAINBENCH_DATA";
/// Folders in the directory of the data.
const PARTS: [&str; 2] = ["cases", "reference/lammps"];
/// Maximum size of the unpacked data (B).
const MOST: u64 = 1 << 30;

/// Returns the folder of the data of a crate, `cases` or `reference`. `built` is the folder of its sources, which
/// contains small files only if the directory of the data is missing.
#[must_use]
pub fn folder(name: &str, built: &str) -> PathBuf {
    match (named(), root()) {
        (_, Some(root)) => root.join(name),
        (Some(named), None) => named.join(name),
        (None, None) => PathBuf::from(built),
    }
}

/// Returns the folder with literature values, prototypes, stored runs and estimated uncertainties.
#[must_use]
pub fn reference() -> PathBuf {
    folder("reference", env!("CARGO_MANIFEST_DIR"))
}

/// Returns the reason for missing data, with the command that installs them; `None` if the data are there.
#[must_use]
pub fn missing() -> Option<String> {
    let reason = || match named() {
        Some(named) => {
            format!("{VARIABLE}: expected a directory with {}, found {}", PARTS.join(" and "), shown(&named))
        }
        None => format!(
            "the data of version {} are not installed; `grainbench reference fetch URL` installs them",
            env!("CARGO_PKG_VERSION")
        ),
    };
    root().is_none().then(reason)
}

/// Returns the default directory of the installed data, for this user and this version.
#[must_use]
pub fn installed() -> Option<PathBuf> {
    let directory = user_directory("Library/Application Support", "XDG_DATA_HOME", ".local/share");
    directory.map(|directory| directory.join(env!("CARGO_PKG_VERSION")))
}

/// Calls `take` with the name and the content of each file of a ZIP archive of the data, and returns their number.
///
/// # Errors
/// If the archive is damaged, is no archive of the data, or has names outside its folders. An error of `take`.
pub fn unpack(archive: &Path, mut take: impl FnMut(&str, &[u8]) -> io::Result<()>) -> io::Result<usize> {
    let wrong = |expected: &str, found: String| {
        io::Error::other(format!("{}: expected {expected}, found {found}", shown(archive)))
    };
    let opened = File::open(archive).map_err(|error| wrong("a readable file", error.to_string()))?;
    let damaged = |error: zip::result::ZipError| wrong("a complete ZIP archive", quoted(&error.to_string()));
    let mut entries = ZipArchive::new(opened).map_err(damaged)?;
    for part in PARTS {
        if !names(&mut entries).map_err(damaged)?.iter().any(|name| name.starts_with(&format!("{part}/"))) {
            return Err(wrong(&format!("an archive with a folder `{part}`"), "none".to_owned()));
        }
    }
    let (mut count, mut left) = (0, MOST);
    for place in 0..entries.len() {
        let entry = entries.by_index(place).map_err(damaged)?;
        if entry.is_dir() {
            continue;
        }
        let name = entry.name().map_err(damaged)?.into_owned();
        let is_inside = name.split('/').all(|part| !matches!(part, "" | "." | "..")) && !name.contains(['\\', ':']);
        if !is_inside {
            return Err(wrong("paths inside the archive", quoted(&name)));
        }
        let mut bytes = Vec::new();
        entry.take(left + 1).read_to_end(&mut bytes)?;
        left = left.checked_sub(bytes.len() as u64).ok_or_else(|| wrong("at most 1 GiB", "more".to_owned()))?;
        take(&name, &bytes)?;
        count += 1;
    }
    Ok(count)
}

/// Returns the names of all entries of an archive.
fn names(entries: &mut ZipArchive<impl Read + Seek>) -> Result<Vec<String>, zip::result::ZipError> {
    (0..entries.len()).map(|place| Ok(entries.by_index(place)?.name()?.into_owned())).collect()
}

/// Returns the directory that the user has set.
fn named() -> Option<PathBuf> {
    env::var_os(VARIABLE).filter(|path| !path.is_empty()).map(PathBuf::from)
}

/// Returns the directory of the data: the one that the user has set, the source tree, `share/grainbench` beside the
/// folder of the program, or the directory of installed data. `None` if it does not contain the data.
fn root() -> Option<&'static Path> {
    static ROOT: OnceLock<Option<PathBuf>> = OnceLock::new();
    let find = || {
        let has_data = |root: &PathBuf| PARTS.iter().all(|part| root.join(part).is_dir());
        if let Some(named) = named() {
            return Some(named).filter(has_data);
        }
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_owned);
        let program = env::current_exe().ok();
        let beside = program.and_then(|program| Some(program.parent()?.parent()?.join("share/grainbench")));
        [source, beside, installed()].into_iter().flatten().find(has_data)
    };
    ROOT.get_or_init(find).as_deref()
}

/// Returns a path on one line for error messages.
fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;
    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    const SOUND: [&str; 2] = ["cases/silo-wide/start.state", "reference/lammps/backspin/series.csv.gz"];

    fn archive(folder: &Path, names: &[&str]) -> PathBuf {
        let path = folder.join("data.zip");
        let mut writer = ZipWriter::new(fs::File::create(&path).unwrap());
        for name in names {
            writer.start_file(*name, SimpleFileOptions::default()).unwrap();
            writer.write_all(name.as_bytes()).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    #[test]
    fn files_of_the_data_are_unpacked() {
        let folder = tempfile::tempdir().unwrap();
        let mut found = Vec::new();
        let count = unpack(&archive(folder.path(), &SOUND), |name, bytes| {
            assert_eq!(name.as_bytes(), bytes);
            found.push(name.to_owned());
            Ok(())
        });
        assert_eq!((count.unwrap(), found), (2, SOUND.map(str::to_owned).to_vec()));
    }

    #[test]
    fn other_archives_are_refused_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |names: &[&str]| {
            let path = archive(folder.path(), names);
            let mut taken = 0;
            let count = |_: &str, _: &[u8]| {
                taken += 1;
                Ok(())
            };
            let error = unpack(&path, count).unwrap_err().to_string();
            (error.replace(&*path.to_string_lossy(), "FILE"), taken)
        };
        let none = "FILE: expected an archive with a folder `reference/lammps`, found none".to_owned();
        assert_eq!(refused(&SOUND[..1]), (none, 0));
        for name in ["../elsewhere", "/absolute", "cases/../../elsewhere", "cases\\elsewhere", "C:/elsewhere"] {
            let (error, taken) = refused(&[name, SOUND[0], SOUND[1]]);
            assert!(error.starts_with("FILE: expected paths inside the archive, found"), "{name}: {error}");
            assert_eq!(taken, 0);
        }
        let path = archive(folder.path(), &SOUND);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let error = unpack(&path, |_, _| Ok(())).unwrap_err().to_string();
        assert!(error.contains("expected a complete ZIP archive"), "{error}");
        let error = unpack(&folder.path().join("none.zip"), |_, _| Ok(())).unwrap_err().to_string();
        assert!(error.contains("expected a readable file"), "{error}");
    }
}
