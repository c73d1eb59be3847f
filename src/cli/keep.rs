//! Stored results. `run --update-stored` stores the results of an external solver next to its manifest, and `--expect-stored`
//! compares with them. `cost`, `stability` and `effects` with `--update-stored` store a study in the source tree.

use super::exit::{Fault, refuse};
use super::select::CaseSelection;
use grainbench::reference::outside::{ExternalProgram, STORED};
use grainbench::reports::Report;
use grainbench::reports::judged::ExternalResults;
use grainbench::reports::study::{Study, kept_text};
use grainbench::store::artifact::read_json;
use grainbench::store::write_file;

/// Version of a program that does not report its version.
const UNKNOWN: &str = "unknown";

/// Returns the selected external solver. Returns an error if there is none or more than one.
pub(crate) fn program(selected: &[CaseSelection]) -> Result<&ExternalProgram, Fault> {
    let mut programs = selected.iter().map(|selection| selection.external.as_deref());
    let Some(Some(program)) = programs.next() else {
        refuse!("--update-stored: expected the manifest of one program, found a built-in solver");
    };
    let is_it =
        |other: Option<&ExternalProgram>| other.is_some_and(|other| other.manifest().name == program.manifest().name);
    if programs.all(is_it) {
        Ok(program)
    } else {
        Err(Fault::input("--update-stored: expected one program, found several"))
    }
}

/// Reads the stored results of an external solver from the directory of its manifest.
pub(crate) fn read(program: &ExternalProgram) -> Result<ExternalResults, Fault> {
    read_json(&program.folder().join(STORED))
        .map_err(|found| Fault::input(format_args!("--expect-stored: {found} (`--update-stored` writes the file)")))
}

/// Returns the differences between a report and the stored results of an external solver, in words: of name, version and
/// results.
pub(crate) fn differences(program: &ExternalProgram, kept: &ExternalResults, report: &Report) -> Vec<String> {
    let version = program.version().unwrap_or_else(|| UNKNOWN.to_owned());
    let pairs = [("name", &program.manifest().name, &kept.program), ("version", &version, &kept.version)];
    let other = pairs.into_iter().filter(|(_, is, was)| is != was);
    let other = other.map(|(what, is, was)| format!("{what} {is}; kept: {was}"));
    other.chain(kept.otherwise(&report.sections)).collect()
}

/// Stores a study in the source tree, for the first screen of the report.
pub(crate) fn keep_study(name: &str, study: &Study) -> Result<(), Fault> {
    let text = kept_text(study)?;
    Ok(write_file(grainbench::studies::kept::place(name), text)?)
}

/// Stores the results of an external solver in the directory of its manifest.
pub(crate) fn keep(program: &ExternalProgram, report: &Report) -> Result<(), Fault> {
    let adapter = program.fingerprint()?;
    let name = program.manifest().name.clone();
    let version = program.version().unwrap_or_else(|| UNKNOWN.to_owned());
    let results = ExternalResults::new([name, version, adapter], &report.provenance, &report.sections);
    let text = serde_json::to_string_pretty(&results)? + "\n";
    Ok(write_file(program.folder().join(STORED), text)?)
}
