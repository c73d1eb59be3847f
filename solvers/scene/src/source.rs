//! Text of a scene file: reading, parsing, variants, overrides, and line numbers of keys.

use crate::error::{SceneError, did_you_mean};
use crate::toml_error::TomlError;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Text of a scene file, and its origin.
#[derive(Clone, Debug)]
pub struct SceneSource {
    /// Name of the file in error messages.
    pub name: String,
    /// Directory that paths in the file are relative to.
    pub directory: PathBuf,
    text: String,
    /// Parsed text. Copies with other variants and overrides share it, so the text is parsed only once.
    read: Arc<OnceLock<toml::Table>>,
    variant: Option<String>,
    overrides: Vec<(String, String)>,
}

impl SceneSource {
    /// Creates a scene source from text in memory.
    #[must_use]
    pub fn from_text(name: &str, directory: &Path, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            directory: directory.to_path_buf(),
            text: text.to_owned(),
            read: Arc::default(),
            variant: None,
            overrides: Vec::new(),
        }
    }

    /// Reads the text of a scene file.
    pub(crate) fn from_file(path: &Path) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let error = |expected: &str, found: String| SceneError::of_file(name.clone(), expected, found);
        let bytes = std::fs::read(path).map_err(|cause| error("a readable scene file", cause.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|cause| {
            let first = cause.utf8_error().valid_up_to();
            error("UTF-8 text", format!("other bytes after byte {first}"))
        })?;
        if let Some(at) = text.find('\0') {
            let place = format!("{name}:{}", line_of(&text, at));
            return Err(SceneError::of_file(place, "a text file", format!("a zero byte after byte {at}")));
        }
        let directory = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(Self::from_text(&name, &directory, &text))
    }

    /// Returns the text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Selects a variant of the scene.
    #[must_use]
    pub fn variant(mut self, name: &str) -> Self {
        self.variant = Some(name.to_owned());
        self
    }

    /// Overrides one key, given as a dotted path, with a TOML value. A value that is not TOML is used as a string. An
    /// empty value removes the key.
    #[must_use]
    pub fn set(mut self, key: &str, value: &str) -> Self {
        self.overrides.push((key.to_owned(), value.to_owned()));
        self
    }

    /// Returns the names of the variants, in the order of the file.
    ///
    /// # Errors
    /// When the text is not TOML.
    pub fn variants(&self) -> Result<Vec<String>, SceneError> {
        Ok(variant_names(self.parse()?))
    }

    /// Returns the table with its variant and overrides applied. Its keys and types are not checked.
    ///
    /// # Errors
    /// When the text is not TOML, the variant is unknown, or an override cannot be applied.
    pub fn table(&self) -> Result<toml::Table, SceneError> {
        self.laid_over(self.parse()?)
    }

    /// Returns the existing files that the scene names, such as meshes, states and data files of grains. Files named in
    /// variants and overrides are included.
    ///
    /// # Errors
    /// When the text is not TOML, the variant is unknown, or an override cannot be applied.
    pub fn files(&self) -> Result<Vec<PathBuf>, SceneError> {
        let mut files = named_files(&self.directory, self.parse()?);
        files.extend(named_files(&self.directory, &self.table()?));
        Ok(files)
    }

    pub(crate) fn laid_over(&self, text: &toml::Table) -> Result<toml::Table, SceneError> {
        let plain = text.iter().filter(|(key, _)| *key != "variants");
        let mut table: toml::Table = plain.map(|(key, value)| (key.clone(), value.clone())).collect();
        if let Some(variant) = &self.variant {
            let overlay = variant_tables(text).and_then(|tables| tables.get(variant));
            match overlay {
                Some(toml::Value::Table(overlay)) => merge(&mut table, overlay.clone()),
                Some(other) => {
                    let key = format!("variants.{variant}");
                    return Err(self.error(&key, "a table of overrides", other.type_str(), None));
                }
                None => {
                    let names = variant_names(text);
                    let help = did_you_mean(variant, names.iter().map(String::as_str));
                    let known = match &names[..] {
                        [] => "no variant, because this scene has none".to_owned(),
                        names => format!("one of the variants {}", names.join(", ")),
                    };
                    return Err(self.error("variants", &known, &format!("`{variant}`"), help));
                }
            }
        }
        table.remove("variants");
        for (key, value) in &self.overrides {
            self.lay_over(&mut table, key, value)?;
        }
        Ok(table)
    }

    /// Creates an error about a key of this scene.
    #[must_use]
    pub fn error(&self, key: &str, expected: &str, found: &str, help: Option<String>) -> SceneError {
        SceneError {
            place: self.place(key),
            key: key.to_owned(),
            expected: expected.to_owned(),
            found: found.to_owned(),
            help,
        }
    }

    pub(crate) fn parse(&self) -> Result<&toml::Table, SceneError> {
        if let Some(table) = self.read.get() {
            return Ok(table);
        }
        let table = self.text.parse::<toml::Table>().map_err(|error| {
            let TomlError { line, column, expected, found } = TomlError::new(&self.text, &error);
            SceneError::of_file(format!("{}:{line}:{column}", self.name), &expected, found)
        })?;
        Ok(self.read.get_or_init(|| table))
    }

    fn lay_over(&self, table: &mut toml::Table, key: &str, value: &str) -> Result<(), SceneError> {
        if value.is_empty() {
            return self.take_away(table, key);
        }
        let read = |value: &str| format!("value = {value}").parse::<toml::Table>().ok()?.remove("value");
        let parsed = read(value).or_else(|| read(&with_zeros(value)));
        let parsed = parsed.unwrap_or_else(|| toml::Value::String(value.to_owned()));
        let mut nested = parsed;
        for part in key.rsplit('.') {
            if part.is_empty() {
                return Err(self.error(key, "a dotted path of keys", &format!("`{key}`"), None));
            }
            nested = toml::Value::Table([(part.to_owned(), nested)].into_iter().collect());
        }
        if let toml::Value::Table(overlay) = nested {
            merge(table, overlay);
        }
        Ok(())
    }

    /// Removes an existing key, as `--set key=` requests.
    fn take_away(&self, table: &mut toml::Table, key: &str) -> Result<(), SceneError> {
        let (path, last) = key.rsplit_once('.').map_or((None, key), |(path, last)| (Some(path), last));
        let mut parts = path.into_iter().flat_map(|path| path.split('.'));
        let within = parts.try_fold(table, |table, part| table.get_mut(part)?.as_table_mut());
        match within.and_then(|table| table.remove(last)) {
            Some(_) => Ok(()),
            None => Err(self.error(key, "a key of the scene, because an empty value deletes it", "none", None)),
        }
    }

    /// Returns the origin of a key for error messages: the `--set` option, or the file and the line of the key or of
    /// its nearest existing parent.
    pub(crate) fn place(&self, key: &str) -> String {
        if let Some((set, value)) = self.overrides.iter().rev().find(|(set, _)| within(key, set)) {
            return format!("--set {set}={value}");
        }
        let variant = self.variant.as_ref().map(|variant| format!("variants.{variant}.{key}"));
        let exact = variant.and_then(|path| self.line(&path, true)).or_else(|| self.line(key, true));
        // If the key is not in the file, an override of a key below it may have created it.
        if let (None, Some((set, value))) = (exact, self.overrides.iter().rev().find(|(set, _)| within(set, key))) {
            return format!("--set {set}={value}");
        }
        let line = exact.or_else(|| self.line(key, false));
        line.map_or_else(|| self.name.clone(), |line| format!("{}:{line}", self.name))
    }

    /// Returns the line of a key. If `exact` is true, the whole path must exist. Otherwise, the result is the line of
    /// the deepest existing part of the path.
    fn line(&self, key: &str, exact: bool) -> Option<usize> {
        let document = toml_edit::Document::parse(self.text.as_str()).ok()?;
        let mut item: &dyn toml_edit::TableLike = document.as_table();
        let mut line = None;
        let parts: Vec<&str> = key.split('.').collect();
        for (depth, part) in parts.iter().enumerate() {
            let name = part.split('[').next().unwrap_or(part);
            let Some((found, value)) = item.get_key_value(name) else {
                return if exact { None } else { line };
            };
            let span = found.span().or_else(|| value.span());
            line = span.map(|span| line_of(&self.text, span.start)).or(line);
            match value.as_table_like() {
                Some(table) => item = table,
                None => return if exact && depth + 1 < parts.len() && !part.contains('[') { None } else { line },
            }
        }
        line
    }
}

/// Returns the existing files whose paths are string values in a table. The paths are relative to `directory`.
#[must_use]
pub fn named_files(directory: &Path, table: &toml::Table) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut open: Vec<&toml::Value> = table.values().collect();
    while let Some(value) = open.pop() {
        match value {
            toml::Value::String(name) => files.extend(Some(directory.join(name)).filter(|path| path.is_file())),
            toml::Value::Array(list) => open.extend(list),
            toml::Value::Table(table) => open.extend(table.values()),
            _ => {}
        }
    }
    files
}

/// Adds the zeros that TOML requires to numbers such as `.5`.
fn with_zeros(value: &str) -> String {
    let mut text = String::new();
    for (at, letter) in value.char_indices() {
        let begins =
            text.chars().next_back().is_none_or(|before| !before.is_alphanumeric() && !"._\"'".contains(before));
        if letter == '.' && begins && value[at + 1..].starts_with(|next: char| next.is_ascii_digit()) {
            text.push('0');
        }
        text.push(letter);
    }
    text
}

/// Returns the value at a dotted path; `None` if there is none.
pub(crate) fn value_at<'a>(table: &'a toml::Table, path: &str) -> Option<&'a toml::Value> {
    let mut parts = path.split(['.', '[']);
    let first = table.get(parts.next()?)?;
    parts.try_fold(first, |value, part| match part.strip_suffix(']') {
        Some(number) => value.get(number.parse::<usize>().ok()?),
        None => value.get(part),
    })
}

pub(crate) fn describe(value: &toml::Value) -> String {
    format!("{} `{}`", value.type_str(), shortened(value.to_string().trim()))
}

/// Returns the first line of a text, cut to 60 characters.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    let line = text.lines().next().unwrap_or_default();
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.to_owned(),
    }
}

/// Returns true if `key` is `set` or lies below it.
fn within(key: &str, set: &str) -> bool {
    key.strip_prefix(set).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

pub(crate) fn variant_names(table: &toml::Table) -> Vec<String> {
    variant_tables(table).map(|tables| tables.keys().cloned().collect()).unwrap_or_default()
}

fn variant_tables(table: &toml::Table) -> Option<&toml::Table> {
    table.get("variants").and_then(toml::Value::as_table)
}

/// Merges the table `overlay` into `base`. An empty string removes a key.
fn merge(base: &mut toml::Table, overlay: toml::Table) {
    for (key, value) in overlay {
        match (base.get_mut(&key), value) {
            (Some(toml::Value::Table(below)), toml::Value::Table(above)) => merge(below, above),
            (Some(_), toml::Value::String(text)) if text.is_empty() => {
                base.remove(&key);
            }
            (_, value) => {
                base.insert(key, value);
            }
        }
    }
}

fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes().iter().take(offset).filter(|byte| **byte == b'\n').count() + 1
}
