//! Cases without Rust code: a folder with `scene.toml` and `claims.toml`, in the registry or of a user.
//!
//! A claim in a file has the same parts as a claim in Rust: quantity, expected value and its source, tolerance and its
//! reason, negative control. Expected values are arithmetic over the numbers of the scene.

mod claims_file;
mod expression;
mod numbers;
mod read;
mod row;

pub use claims_file::{Formula, SampleReduction};
pub use expression::Expression;
pub use numbers::Numbers;
pub use read::RecordExpression;

use crate::registry::HOME;
use claims_file::{ClaimEntry, ClaimsFile};
use grainbench_harness::course::no_more;
use grainbench_harness::prelude::*;
use grainbench_harness::subject::from_claims;
use grainbench_scene::source::named_files;
use grainbench_scene::text::written;
use grainbench_scene::toml_error::TomlError;
use row::Reader;
use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the scene file.
const SCENE: &str = "scene.toml";
/// Name of the file with the claims.
pub const CLAIMS: &str = "claims.toml";
/// Name of the optional file with the derivation of the expected values.
const DERIVATION: &str = "derivation.md";

/// Error in the folder of a case: file, place in it, expected and found text.
#[derive(Debug, thiserror::Error)]
#[error("{}: {what}", file.display())]
pub struct CaseFolderError {
    file: PathBuf,
    what: String,
}

/// Returns the message of an error in a key of a claim.
fn wrong(key: &str, expected: impl Display, found: impl Display) -> String {
    format!("{key}: expected {expected}, found {found}")
}

/// Leaks a text to obtain a static lifetime. The leak is small, because a command reads few cases.
fn kept(text: String) -> &'static str {
    text.leak()
}

/// Reads the case in a folder.
///
/// # Errors
/// The message names the file, the claim and the key, and gives the expected and the found text.
pub fn read(folder: &Path) -> Result<&'static Case, CaseFolderError> {
    let file = folder.join(CLAIMS);
    let no_case = |what: String| CaseFolderError { file: file.clone(), what };
    let text = text_of(&file)?;
    let claims: ClaimsFile = toml::from_str(&text).map_err(|error| {
        let TomlError { line, expected, found, .. } = TomlError::new(&text, &error);
        no_case(format!("line {line}: expected {expected}, found {found}"))
    })?;
    let words = [&claims.title, &claims.claim, &claims.weakness];
    if claims.title.trim().is_empty() || words.iter().any(|text| text.chars().any(char::is_control)) {
        return Err(no_case("expected a title, and texts without control characters".to_owned()));
    }
    if claims.claims.is_empty() {
        return Err(no_case("expected at least one `[[claims]]`, found none".to_owned()));
    }
    let source = SceneSource::read(&folder.join(SCENE)).map_err(|error| no_case(error.to_string()))?;
    let rows = rows(&claims.claims, &Reader { folder, source: &source, plots: true }).map_err(no_case)?;
    let whole = fs::canonicalize(folder).map_err(|error| no_case(error.to_string()))?;
    let is_plain = |name: &&std::ffi::OsStr| !name.to_string_lossy().chars().any(char::is_control);
    let (Some(name), Some(parent)) = (whole.file_name().filter(is_plain), whole.parent()) else {
        return Err(no_case("expected a folder with a plain name".to_owned()));
    };
    let derivation = folder.join(DERIVATION);
    let derivation = if derivation.exists() { text_of(&derivation)? } else { String::new() };
    let parent = parent.to_owned();
    let folder = Box::leak(Box::new(move || parent.clone()));
    let home = Home { folder, read_grains: HOME.read_grains, made: None };
    Ok(Box::leak(Box::new(Case {
        name: kept(name.to_string_lossy().into_owned()),
        title: kept(claims.title),
        physics: claims.physics,
        claim: kept(claims.claim),
        scene: kept(source.text().to_owned()),
        derivation: kept(derivation),
        weakness: kept(claims.weakness),
        claims: Box::leak(Box::new(move || rows.clone())),
        home: Box::leak(Box::new(home)),
        ..EMPTY
    })))
}

/// Default values for a case in the registry whose claims are in a file. The case replaces the texts and the claims.
pub(crate) const EMPTY: Case = Case {
    name: "",
    title: "",
    physics: Physics::Own,
    claim: "",
    scene: "",
    derivation: "",
    weakness: "",
    levels: &[],
    default_level: fraction("dt=.1", 0.1),
    claims: &Vec::new,
    figures: no_more,
    targets: from_claims,
    home: &HOME,
};

/// Returns the claims of a case in the registry from the text of its file. An invalid file gives one failing claim.
pub(crate) fn claims(case: &Case, text: &str) -> Vec<Claim> {
    let (folder, source) = (case.directory(), case.source());
    let claims = toml::from_str(text).map_err(|error| error.message().replace('\n', " "));
    let read = claims
        .and_then(|file: ClaimsFile| rows(&file.claims, &Reader { folder: &folder, source: &source, plots: false }));
    read.unwrap_or_else(|reason| vec![unreadable(format!("{}: {reason}", folder.join(CLAIMS).display()))])
}

/// Returns a claim that needs no run and always fails with this reason.
fn unreadable(reason: String) -> Claim {
    claim("claims that can be read", "1")
        .holds("the file of claims is valid", move |_| Err(MissingData(format!("claims that can be read: {reason}"))))
        .within(exactly("nothing is measured"))
        .refuses(Control::scene("none", |_| ()))
}

/// Converts the claims of a file. An error names the claim and the key, and gives the expected and the found text.
fn rows(claims: &[ClaimEntry], reader: &Reader<'_>) -> Result<Vec<Claim>, String> {
    let mut rows = Vec::new();
    for (place, claimed) in claims.iter().enumerate() {
        let entry = format!("claim {} ({})", place + 1, claimed.quantity);
        rows.extend(reader.claims(claimed).map_err(|what| format!("{entry}: {what}"))?);
    }
    Ok(rows)
}

/// Returns the files on which the results of a case folder depend: scene, claims, and the files named in these two.
///
/// # Errors
/// When the scene file or the claims file is invalid or cannot be read.
pub fn files(folder: &Path) -> Result<Vec<PathBuf>, CaseFolderError> {
    let (scene, claims) = (folder.join(SCENE), folder.join(CLAIMS));
    let no_case = |file: &Path, what: String| CaseFolderError { file: file.to_owned(), what };
    let source = SceneSource::read(&scene).map_err(|error| no_case(&scene, error.to_string()))?;
    let named = source.files().map_err(|error| no_case(&scene, error.to_string()))?;
    let table: toml::Table = toml::from_str(&text_of(&claims)?).map_err(|error| no_case(&claims, error.to_string()))?;
    let of_claims = named_files(folder, &table);
    let mut files: Vec<PathBuf> = named.into_iter().chain(of_claims).collect();
    files.sort();
    files.dedup();
    Ok([scene, claims].into_iter().chain(files).collect())
}

/// Reads a text file of the case folder.
fn text_of(file: &Path) -> Result<String, CaseFolderError> {
    let case_error = |(expected, found)| CaseFolderError {
        file: file.to_owned(),
        what: format!("expected {expected}, found {found}"),
    };
    written(file).map_err(case_error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::CASES;
    use crate::solvers::runner;
    use grainbench_harness::verdict::Outcome;

    /// If the claims file of a case cannot be read, the case has one result, which fails.
    #[test]
    fn claims_that_cannot_be_read_are_red() {
        let case = CASES[0];
        for text in ["[[claims]]\nno-such-key = 1\n", "= 1"] {
            let claims = claims(case, text);
            let rows: Vec<_> = claims.iter().map(|claim| runner(case).judge(claim)).collect();
            assert_eq!(rows.iter().map(|row| row.outcome).collect::<Vec<_>>(), [Outcome::Fail], "{text}");
            let message = rows[0].detail.clone().unwrap_or_default();
            assert!(message.contains("claims.toml: "), "{message}");
        }
    }
}
