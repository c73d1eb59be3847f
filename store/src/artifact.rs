//! Stored files: reading and checking of their content, and a directory with one file for each key.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use grainbench_scene::text::tamed;
use grainbench_scene::toml_error::TomlError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use tempfile::TempDir;
use thiserror::Error;

use crate::scratch::{remove_leftovers, temporary_in};
use crate::write::WriteError;

/// Reason why a stored file cannot be used: it cannot be read, is truncated, or has another format, key or hash than expected.
#[derive(Debug, Error)]
#[error("{}{place}: {reason}", one_line(&path.to_string_lossy()))]
pub struct ReadError {
    path: PathBuf,
    /// Position in the file, such as `, line 3, column 4, at key`; empty for the file as a whole.
    place: String,
    /// Expected content and content found.
    reason: String,
}

impl ReadError {
    /// Returns the error of a file with other content than expected.
    pub fn other(path: &Path, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::at(path, String::new(), &expected.into(), &found.into())
    }

    /// Returns the error of other content than expected at a position in a file.
    fn at(path: &Path, place: String, expected: &str, found: &str) -> Self {
        let reason = format!("expected {}, found {}", one_line(expected), one_line(found));
        Self { path: path.to_owned(), place, reason }
    }

    /// Returns the error of a file that is absent or cannot be read.
    fn unreadable(path: &Path, error: &io::Error) -> Self {
        Self::other(path, "a readable file", error.to_string())
    }
}

/// Returns a text on one line, without control characters.
fn one_line(text: &str) -> String {
    tamed(text, |_| false)
}

fn read(path: &Path) -> Result<Vec<u8>, ReadError> {
    fs::read(path).map_err(|error| ReadError::unreadable(path, &error))
}

/// Reads a JSON file.
///
/// # Errors
/// When the file cannot be read or contains another value. The error names the position in the file.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, ReadError> {
    parse_json(path, &read(path)?)
}

/// Reads a value from the content of a JSON file.
///
/// # Errors
/// When the content is another value. The error names the position in the file.
pub fn parse_json<T: DeserializeOwned>(path: &Path, bytes: &[u8]) -> Result<T, ReadError> {
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let value =
        serde_path_to_error::deserialize(&mut json).map_err(|error| (error.path().to_string(), error.into_inner()));
    let value = value.and_then(|value| json.end().map(|()| value).map_err(|error| (".".to_owned(), error)));
    value.map_err(|(place, error)| {
        // The message of the parser ends with line and column, which the error states separately.
        let words = error.to_string();
        let words = words.rsplit_once(" at line ").map_or(&*words, |(words, _)| words);
        let reason = match words.strip_prefix("EOF while parsing ") {
            Some(_) if bytes.trim_ascii().is_empty() => "expected JSON, found an empty file".to_owned(),
            Some(what) => format!("expected the rest of {what}, found the end of the file"),
            None => one_line(words),
        };
        let place = format!(", line {}, column {}, at `{}`", error.line(), error.column(), one_line(&place));
        ReadError { path: path.to_owned(), place, reason }
    })
}

/// Reads a text file.
///
/// # Errors
/// When the file cannot be read or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, ReadError> {
    String::from_utf8(read(path)?).map_err(|_| ReadError::other(path, "UTF-8 text", "other bytes"))
}

/// Reads a TOML file.
///
/// # Errors
/// When the file cannot be read or contains other keys or values. The error names the line.
pub fn read_toml<T: DeserializeOwned>(path: &Path) -> Result<T, ReadError> {
    let text = read_text(path)?;
    toml::from_str(&text).map_err(|error| {
        let TomlError { line, expected, found, .. } = TomlError::new(&text, &error);
        ReadError::at(path, format!(":{line}"), &expected, &found)
    })
}

/// Returns the hashes of files by name, for the list in a provenance file.
#[must_use]
pub fn hashes(files: &[(String, Vec<u8>)]) -> BTreeMap<String, String> {
    files.iter().map(|(name, bytes)| (name.clone(), blake3::hash(bytes).to_hex().to_string())).collect()
}

/// Reads a file that `list`, the provenance file of its folder, lists with this hash.
///
/// # Errors
/// When the name is a path, because no file outside the folder may be read; when the file cannot be read; or when its hash
/// differs.
pub fn read_listed(list: &Path, name: &str, hash: &str) -> Result<Vec<u8>, ReadError> {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"._-".contains(&byte);
    if name.is_empty() || name.starts_with('.') || !name.bytes().all(is_plain) {
        let expected = "a plain name of letters, digits, `.`, `-` and `_`";
        return Err(ReadError::other(list, expected, format!("`{name}`")));
    }
    let path = list.with_file_name(name);
    let bytes = read(&path)?;
    let found = blake3::hash(&bytes).to_hex().to_string();
    if found == hash { Ok(bytes) } else { Err(ReadError::other(&path, format!("the file with BLAKE3 {hash}"), found)) }
}

/// File extension of JSON files.
pub const JSON: &str = "json";

/// Directory of files with one extension, one for each key. Each file is written completely or not at all.
#[derive(Debug)]
pub struct Directory {
    /// Path; `None` if nothing is stored.
    folder: Option<PathBuf>,
    /// File extension.
    ending: &'static str,
    /// True to ignore all stored files.
    is_fresh: bool,
    /// Directory for temporary files, created with the first written file.
    temporary: OnceLock<TempDir>,
    /// Number of files written.
    written: AtomicU64,
}

impl Directory {
    /// Opens a directory of files with the extension `ending`, and creates it if necessary. Existing files are ignored if
    /// `is_fresh` is true.
    ///
    /// # Errors
    /// When the directory cannot be created.
    pub fn open(folder: &Path, ending: &'static str, is_fresh: bool) -> Result<Self, WriteError> {
        let made = fs::create_dir_all(folder).and_then(|()| remove_leftovers(folder));
        made.map_err(|source| WriteError::new(folder, source))?;
        Ok(Self { folder: Some(folder.to_owned()), ending, is_fresh, ..Self::none() })
    }

    /// Returns a directory that stores nothing.
    #[must_use]
    pub const fn none() -> Self {
        Self { folder: None, ending: JSON, is_fresh: true, temporary: OnceLock::new(), written: AtomicU64::new(0) }
    }

    /// Returns the path of the directory; empty if nothing is stored.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.folder.as_deref().unwrap_or(Path::new(""))
    }

    /// Returns the path of the file of a key.
    fn path(&self, key: &str) -> PathBuf {
        self.folder().join(format!("{key}.{}", self.ending))
    }

    /// Reads the content of the file of a key.
    ///
    /// # Errors
    /// When the file is absent, is ignored, or cannot be read.
    pub fn read(&self, key: &str) -> Result<Vec<u8>, ReadError> {
        let path = self.path(key);
        if self.is_fresh {
            return Err(ReadError::unreadable(&path, &io::ErrorKind::NotFound.into()));
        }
        read(&path)
    }

    /// Reads the value of a key from a JSON file.
    ///
    /// # Errors
    /// When the file is absent, is ignored, or contains another value.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Result<T, ReadError> {
        parse_json(&self.path(key), &self.read(key)?)
    }

    /// Stores the value of a key as a JSON file. The file contains neither its key nor a checksum, so another program can
    /// read it.
    ///
    /// # Errors
    /// When the value cannot be written as JSON, or the disk rejects the write.
    pub fn put<T: Serialize>(&self, key: &str, value: &T) -> Result<(), WriteError> {
        let json = serde_json::to_vec(value).map_err(|error| WriteError::new(self.path(key), error.into()))?;
        self.write(key, &json)
    }

    /// Writes the content of the file of a key.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn write(&self, key: &str, bytes: &[u8]) -> Result<(), WriteError> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let path = self.path(key);
        let write = || -> io::Result<()> {
            let temporary = match self.temporary.get() {
                Some(temporary) => temporary,
                None => {
                    let made = temporary_in(folder)?;
                    self.temporary.get_or_init(|| made)
                }
            };
            // Two threads may store the same key.
            let number = self.written.fetch_add(1, Ordering::Relaxed);
            let staged = temporary.path().join(number.to_string());
            fs::write(&staged, bytes).and_then(|()| fs::rename(&staged, &path)).inspect_err(|_| {
                // An incomplete file would occupy space that other files need.
                let _ = fs::remove_file(&staged);
            })
        };
        write().map_err(|source| WriteError::new(&path, source))
    }

    /// Marks the file of a key as used now. If this fails, its last use stays the time of writing.
    pub fn touch(&self, key: &str) {
        let file = fs::File::options().append(true).open(self.path(key));
        let _ = file.and_then(|file| file.set_modified(SystemTime::now()));
    }

    /// Removes the least recently used files with the extension until the remaining ones do not exceed `most` bytes.
    pub fn make_room(&self, most: u64) {
        let file_entry = |entry: fs::DirEntry| {
            let is_of_kind = entry.path().extension().is_some_and(|ending| ending == self.ending);
            let about = entry.metadata().ok().filter(|_| is_of_kind)?;
            Some((about.modified().unwrap_or(SystemTime::UNIX_EPOCH), about.len(), entry.path()))
        };
        let entries = self.folder.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries.filter_map(file_entry).collect();
        files.sort();
        let mut all: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
        for (_, bytes, path) in files {
            if all <= most {
                break;
            }
            match fs::remove_file(path) {
                Ok(()) => all -= bytes,
                // Another process has removed the file.
                Err(error) if error.kind() == io::ErrorKind::NotFound => all -= bytes,
                Err(_) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn gives_back_whole_files_alone() {
        let folder = tempfile::tempdir().unwrap();
        let runs = Directory::open(folder.path(), JSON, false).unwrap();
        let get = |runs: &Directory| runs.get::<[u32; 2]>("a").map_err(|error| error.to_string());
        let path = folder.path().join("a.json");
        let wrong = |text: &str| get(&runs).unwrap_err().replace(&path.display().to_string(), "a.json") == text;
        assert!(wrong("a.json: expected a readable file, found No such file or directory (os error 2)"));
        runs.put("a", &[7, 8]).unwrap();
        assert_eq!(get(&runs), Ok([7, 8]));
        assert!(get(&Directory::open(folder.path(), JSON, true).unwrap()).is_err());
        for (text, reason) in [
            ("", "line 1, column 0, at `.`: expected JSON, found an empty file"),
            ("[7", "line 1, column 2, at `.`: expected the rest of a list, found the end of the file"),
            ("[7,8] 9", "line 1, column 7, at `.`: trailing characters"),
            ("[7, \"a\u{7f}\"]", "line 1, column 8, at `[1]`: invalid type: string \"a\\u{7f}\", expected u32"),
        ] {
            fs::write(&path, text).unwrap();
            assert!(wrong(&format!("a.json, {reason}")), "{:?}", get(&runs));
        }
        runs.put("a", &[1, 2]).unwrap();
        assert_eq!(get(&runs), Ok([1, 2]));
        drop(runs);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file is left");
        Directory::none().put("a", &[7, 8]).unwrap();
        assert!(get(&Directory::none()).is_err());
    }

    /// There are three files of 100 bytes and room for 250 bytes. The least recently used one is removed, and files of
    /// another extension are kept.
    #[test]
    fn the_longest_unused_makes_room() {
        let folder = tempfile::tempdir().unwrap();
        let runs = Directory::open(folder.path(), JSON, false).unwrap();
        for (age, name) in [(30, "a.json"), (40, "b.json"), (20, "c.json"), (99, "notes.txt")] {
            let path = folder.path().join(name);
            fs::write(&path, [0; 100]).unwrap();
            let then = SystemTime::now() - Duration::from_secs(age);
            fs::File::options().append(true).open(&path).unwrap().set_modified(then).unwrap();
        }
        runs.touch("b");
        runs.make_room(250);
        let mut left: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(left, ["b.json", "c.json", "notes.txt"]);
    }

    #[test]
    fn a_listed_file_has_its_hash_and_lies_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let list = folder.path().join("provenance.toml");
        let files = [("a.csv".to_owned(), b"1,2".to_vec())];
        let hash = &hashes(&files)["a.csv"];
        fs::write(folder.path().join("a.csv"), "1,2").unwrap();
        assert_eq!(read_listed(&list, "a.csv", hash).unwrap(), b"1,2");
        for text in ["", "1,", "1,3"] {
            fs::write(folder.path().join("a.csv"), text).unwrap();
            let message = read_listed(&list, "a.csv", hash).unwrap_err().to_string();
            assert!(message.contains(&format!("a.csv: expected the file with BLAKE3 {hash}, found ")), "{message}");
        }
        for name in ["", "../a.csv", ".a.csv", "b/a.csv", "b\n"] {
            let message = read_listed(&list, name, hash).unwrap_err().to_string();
            assert!(message.contains("provenance.toml: expected a plain name of letters"), "{message}");
        }
    }
}
