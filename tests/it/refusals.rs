//! Errors in the user's input. The tables in `tests/refusals` are run through the command line.
//!
//! An entry edits a base file, writes it as `file` and runs `command`. The command must end with the given exit code
//! and message. It must print nothing on the standard output, and must neither create nor change a file. In a message,
//! `[DIR]` is the directory, `[ROOT]` the repository, `[cases]` and `[solvers]` are the names of the registries, and
//! `[..]` is any text. `UPDATE_REFUSALS=1` writes the messages of the program to the tables.
//!
//! An entry with one edit is a row `[text, message]` in the list of `[rows]` with the name of the edit, for `replace` a
//! row `[text, replacement, message]`. Any other entry is a `[[refusal]]`.

use crate::common::{Directory, entries, files, root, temporary};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::Path;

/// Table of entries that share one directory.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Table {
    /// Values for entries without a value of their own: `base`, `file`, `command`, `alone`.
    common: Entry,
    /// Further files in the directory, by name.
    files: BTreeMap<String, Entry>,
    /// Commands that must succeed before the entries are run.
    prepare: Vec<String>,
    /// Files that are made from the output of these commands, by name.
    prepared: BTreeMap<String, Entry>,
    /// Entries with one edit, by the name of the edit.
    rows: BTreeMap<String, Vec<Vec<String>>>,
    refusal: Vec<Entry>,
}

/// Place of an entry in its file: the name of its list of rows, or none for a `[[refusal]]`, and its index.
type Place = (Option<String>, usize);

impl Table {
    /// Returns all entries with their places.
    fn entries(&self) -> Vec<(Place, Entry)> {
        let rows = self.rows.iter().flat_map(|(edit, rows)| rows.iter().enumerate().map(move |row| (edit, row)));
        let read = |(edit, (at, row)): (&String, (usize, &Vec<String>))| {
            let value: toml::Value = match &row[..] {
                [text, _] => text.clone().into(),
                [from, to, _] => vec![vec![from.clone(), to.clone()]].into(),
                _ => panic!("{edit} {at}: expected two or three texts, found {row:?}"),
            };
            let message = row[row.len() - 1].clone().into();
            let entry = toml::Table::from_iter([(edit.clone(), value), ("message".to_owned(), message)]).try_into();
            ((Some(edit.clone()), at), entry.unwrap_or_else(|error| panic!("{edit} {at}: {error}")))
        };
        let whole = self.refusal.iter().enumerate().map(|(at, entry)| ((None, at), entry.clone()));
        rows.map(read).chain(whole).collect()
    }
}

/// A file, given by a base and edits, and a command that must reject it. The edits are applied in the order of these fields.
#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Entry {
    /// Name of the entry in failures, if the edit does not identify it.
    name: Option<String>,
    /// Base file: a file in the directory, in `tests/scenes`, or in the repository.
    base: Option<String>,
    /// Whole text of the file, instead of a base.
    text: Option<String>,
    /// Texts with their replacements. Only the first occurrence of each text is replaced.
    replace: Vec<[String; 2]>,
    /// Texts with their replacements. All occurrences are replaced.
    replace_all: Vec<[String; 2]>,
    prepend: Option<String>,
    append: Option<String>,
    /// Fraction of the bytes that is kept, from the start.
    keep: Option<f64>,
    /// Number of bytes that are removed at the end.
    cut: usize,
    /// Position and new value of changed bytes. A negative position counts from the end.
    bytes: Vec<(i64, u8)>,
    append_bytes: Vec<u8>,
    /// Name of the edited file.
    file: Option<String>,
    /// Command line of the program. `[ROOT]` is the repository.
    command: Option<String>,
    /// Further words for the command line.
    with: Option<String>,
    /// True to hide LAMMPS and LIGGGHTS from the program.
    alone: Option<bool>,
    /// Expected exit code; 2 if absent.
    code: Option<i32>,
    /// Expected text on the standard error.
    message: String,
}

impl Entry {
    fn or(mut self, common: &Self) -> Self {
        if self.text.is_none() {
            self.base = self.base.or_else(|| common.base.clone());
        }
        self.file = self.file.or_else(|| common.file.clone());
        self.command = self.command.or_else(|| common.command.clone());
        self.alone = self.alone.or(common.alone);
        self
    }

    /// Returns the name of the entry, or the first line of the text that distinguishes it.
    fn shown(&self) -> &str {
        let edit = self.replace.first().or(self.replace_all.first()).map(|[_, to]| to);
        let all = [
            self.name.as_ref(),
            edit,
            self.append.as_ref(),
            self.with.as_ref(),
            self.command.as_ref(),
            self.text.as_ref(),
        ];
        all.into_iter().flatten().flat_map(|text| text.lines()).find(|line| !line.is_empty()).unwrap_or_default()
    }

    /// Returns the content of the edited file. An edit without effect is an error.
    fn contents(&self, directory: &Path) -> Result<Vec<u8>, String> {
        let mut bytes = match (&self.base, &self.text) {
            (Some(base), _) => {
                let places = [directory.join(base), root("tests/scenes").join(base), root(base)];
                let place = places.iter().find(|place| place.is_file()).ok_or_else(|| format!("no base {base}"))?;
                unpacked(fs::read(place).map_err(|error| error.to_string())?)
            }
            (None, text) => text.clone().unwrap_or_default().into_bytes(),
        };
        let texts =
            self.replace.iter().map(|pair| (pair, 1)).chain(self.replace_all.iter().map(|pair| (pair, usize::MAX)));
        for ([from, to], count) in texts {
            let text = String::from_utf8(bytes).map_err(|_| "the base is no text".to_owned())?;
            if !text.contains(from) || from == to {
                return Err(format!("the edit does not apply: the base has no {from:?}, or it stays"));
            }
            bytes = text.replacen(from, to, count).into_bytes();
        }
        bytes.splice(0..0, self.prepend.iter().flat_map(|text| text.bytes()));
        bytes.extend(self.append.iter().flat_map(|text| text.bytes()));
        if let Some(part) = self.keep {
            bytes.truncate((bytes.len() as f64 * part) as usize);
        }
        let rest = bytes.len().checked_sub(self.cut).ok_or("the edit does not apply: the base is too short")?;
        bytes.truncate(rest);
        for &(place, value) in &self.bytes {
            let at = if place < 0 { bytes.len() as i64 + place } else { place };
            let byte = usize::try_from(at).ok().and_then(|at| bytes.get_mut(at)).filter(|byte| **byte != value);
            *byte
                .ok_or_else(|| format!("the edit does not apply: byte {place} is {value} or outside of the base"))? =
                value;
        }
        bytes.extend(&self.append_bytes);
        Ok(bytes)
    }
}

fn unpacked(bytes: Vec<u8>) -> Vec<u8> {
    let mut whole = Vec::new();
    match flate2::read::GzDecoder::new(&bytes[..]).read_to_end(&mut whole) {
        Ok(_) => whole,
        Err(_) => bytes,
    }
}

/// Returns a message with placeholders for paths and for the names of the registries, and without spaces at the ends of lines.
pub(crate) fn settled(message: &str, directory: &Path) -> String {
    let lines = |names: Vec<String>| names.iter().map(|name| format!("  {name}\n")).collect::<String>();
    let cases = lines(CASES.iter().map(|case| case.name.to_owned()).collect());
    let message = message.replace(&cases, "  [cases]\n").replace(&lines(solvers::names()), "  [solvers]\n");
    let message =
        message.replace(&directory.display().to_string(), "[DIR]").replace(env!("CARGO_MANIFEST_DIR"), "[ROOT]");
    message.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

/// Returns true if a message equals the expected message, in which `[..]` means any text.
fn is_as(found: &str, expected: &str) -> bool {
    let Some((start, rest)) = expected.split_once("[..]") else { return found == expected };
    found.strip_prefix(start).is_some_and(|found| {
        found.char_indices().map(|(at, _)| at).chain([found.len()]).any(|at| is_as(&found[at..], rest))
    })
}

/// Returns all files of a directory with their contents.
fn contents(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    files(directory)
        .into_iter()
        .map(|name| (name.clone(), fs::read(directory.join(name)).unwrap_or_default()))
        .collect()
}

/// Writes a file and creates its folders. A name that ends with `/` is a folder.
fn write(directory: &Path, name: &str, bytes: &[u8]) {
    if name.ends_with('/') {
        fs::create_dir_all(directory.join(name)).unwrap();
    } else {
        directory.write(name, bytes);
    }
}

/// Runs all entries of a table. Returns the place, the failure and the actual message of each failed entry.
fn failures(table: &Table) -> Vec<(Place, String, Option<String>)> {
    let path = temporary();
    let prepare = |files: &BTreeMap<String, Entry>| {
        files.iter().for_each(|(name, file)| {
            write(&path, name, &file.contents(&path).unwrap_or_else(|error| panic!("{error}")))
        });
    };
    prepare(&table.files);
    for line in &table.prepare {
        path.ok(line);
    }
    prepare(&table.prepared);
    let check = |entry: Entry| -> Result<(), (String, Option<String>)> {
        let entry = entry.or(&table.common);
        let bytes = entry.contents(&path).map_err(|error| (error, None))?;
        let file = entry.file.filter(|_| entry.base.is_some() || entry.text.is_some());
        let earlier = file.as_ref().and_then(|file| fs::read(path.join(file)).ok());
        file.iter().for_each(|file| write(&path, file, &bytes));
        let before = contents(&path);
        let line = [entry.command.unwrap_or_default(), entry.with.unwrap_or_default()].join(" ");
        let answer = if entry.alone == Some(true) { path.run_alone(line) } else { path.run(line) };
        let after = contents(&path);
        match (file, earlier) {
            (Some(file), Some(bytes)) => write(&path, &file, &bytes),
            (Some(file), None) => fs::remove_file(path.join(file)).unwrap(),
            _ => {}
        }
        let expected = (Some(entry.code.unwrap_or(2)), "");
        if (answer.code, answer.out.as_str()) != expected {
            return Err((
                format!("expected {expected:?}, found {:?}: {}", (answer.code, answer.out), answer.err),
                None,
            ));
        }
        if before != after {
            let left: Vec<&String> = after.keys().filter(|name| before.get(*name) != after.get(*name)).collect();
            return Err((format!("files were left, changed or removed: {left:?}"), None));
        }
        let (found, expected) = (settled(&answer.err, &path), entry.message.trim_end());
        if is_as(&found, expected) {
            Ok(())
        } else {
            Err((format!("expected {expected}\n    found {found}"), Some(found)))
        }
    };
    let failure = |(place, entry): (Place, Entry)| {
        let name = entry.shown().to_owned();
        check(entry).err().map(|(failure, found)| (place, format!("{name}: {failure}"), found))
    };
    table.entries().into_iter().filter_map(failure).collect()
}

#[test]
fn every_refusal_is_as_in_its_table() {
    let tables = entries(root("tests/refusals"));
    let run = |file: &std::path::PathBuf| -> (usize, Vec<String>) {
        let text = fs::read_to_string(file).unwrap();
        let table: Table = toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let failed = failures(&table);
        if std::env::var_os("UPDATE_REFUSALS").is_some() {
            let mut table: toml_edit::DocumentMut = text.parse().unwrap();
            for ((list, at), found) in failed.iter().filter_map(|(place, _, found)| Some((place, found.as_ref()?))) {
                let message = match list {
                    Some(list) => {
                        let row = &mut table["rows"][list][*at];
                        let last = row.as_array().unwrap().len() - 1;
                        &mut row[last]
                    }
                    None => &mut table["refusal"][*at]["message"],
                };
                let layout = message.as_value().unwrap().decor().clone();
                *message = toml_edit::value(found);
                *message.as_value_mut().unwrap().decor_mut() = layout;
            }
            fs::write(file, table.to_string()).unwrap();
        }
        let name = file.file_name().unwrap().to_string_lossy();
        let shown = failed.into_iter().map(|((list, at), failure, _)| {
            format!("{name}, {} {}, {failure}", list.as_deref().unwrap_or("refusal"), at + 1)
        });
        (table.entries().len(), shown.collect())
    };
    let results: Vec<_> = tables.par_iter().map(run).collect();
    let count: usize = results.iter().map(|(count, _)| count).sum();
    let failed: Vec<String> = results.into_iter().flat_map(|(_, failed)| failed).collect();
    assert!(failed.is_empty(), "{} of {count} refusals:\n{}", failed.len(), failed.join("\n"));
    assert!(count > MANY, "{count}");
}

/// Control: an entry with a wrong message, exit code or file, or with an edit that has no effect, fails.
#[test]
fn a_wrong_entry_of_a_table_is_found() {
    let table: Table = toml::from_str(
        r#"
common = { base = "two-discs.toml", file = "scene.toml", command = "simulate scene.toml --solver dem --out out" }
[files]
"kept.toml" = { base = "two-discs.toml", replace = [["Two", "2"]] }
[rows]
replace = [
    ["dimension = 2", "dimension = 4", "error: scene.toml:2: dimension: [..]found 4[..]"],
    ["dimension = 2", "dimension = 4", "error: scene.toml: dimension: expected 2 or 3, found 5"],
    ["dimension = 7", "dimension = 4", "error: scene.toml:2: dimension: [..]found 4[..]"],
]
[[refusal]]
replace = [["dimension = 2", "dimension = 4"]]
code = 1
message = "error: scene.toml:2: dimension: [..]found 4[..]"
[[refusal]]
name = "a scene without an error"
message = ""
"#,
    )
    .unwrap();
    let found = failures(&table);
    let said = [
        (Some("replace"), 1, "found error: scene.toml"),
        (Some("replace"), 2, "the edit does not apply"),
        (None, 0, "expected (Some(1)"),
        (None, 1, "expected (Some(2)"),
    ];
    assert_eq!(found.len(), said.len(), "{found:?}");
    for (((list, at), failure, _), (in_list, entry, words)) in found.iter().zip(said) {
        assert!(list.as_deref() == in_list && *at == entry && failure.contains(words), "{list:?} {at}: {failure}");
    }
}

/// Smallest number of entries. With fewer entries, a table is missing.
const MANY: usize = 500;
