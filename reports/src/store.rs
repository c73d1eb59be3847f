//! Output directory of a report. All its files are written together. The report can be read back to write them again.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::path::Path;

use grainbench_harness::figure::{Drawing, Figure, Graph};
use rayon::prelude::*;
use thiserror::Error;

use crate::badge::badge;
use crate::junit::junit_xml;
use crate::report::Report;
use crate::results::{points_table, results_json, rows_table};
use crate::table::{Cell, Column, Table};
use crate::{page, plot, row};
use grainbench_store::artifact::read_json;
use grainbench_store::{ReadError, StagedDir, WriteError};

/// File from which all files of a report can be written again.
pub const REPORT_FILE: &str = "report.json";

/// Error when a report cannot be written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Draw(#[from] plot::DrawError),
    /// A value cannot be written in a file format, a figure cannot be converted, or no font of a style is installed.
    #[error("{0}")]
    Other(String),
}

impl SaveError {
    /// Returns a function that makes the error of an encoder from its message.
    pub(crate) fn encode<E: Display>(file: &'static str) -> impl FnOnce(E) -> Self {
        move |error| Self::Other(format!("cannot encode {file}: {error}"))
    }
}

/// Writes the files of a report to `dir`. If an error occurs, no file is written.
///
/// The files are `index.html`, `results.json`, `report.json`, `rows.csv`, `points.csv`, `junit.xml`, `badge.svg` and
/// `figures/CASE-NAME.svg`. If `parquet` is true, the results are also written as `rows.parquet`. The data of graphs are
/// added as `.csv` and films as `.png`. Parts that would make the page too large become separate pages.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_report(dir: impl AsRef<Path>, report: &Report, parquet: bool) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    out.write("results.json", results_json(report).map_err(SaveError::encode("results.json"))?)?;
    out.write_with("points.csv", |file| points_table(report).csv(file))?;
    out.write_with("rows.csv", |file| rows_table(report).csv(file))?;
    out.write("junit.xml", junit_xml(report).map_err(SaveError::encode("junit.xml"))?)?;
    out.write("badge.svg", badge(report))?;
    let figures = named_figures(report);
    let drawn = || figures.par_iter().map(|(name, figure)| figure_files(figure, name)).collect::<Result<Vec<_>, _>>();
    let stored = || serde_json::to_string(report).map_err(SaveError::encode(REPORT_FILE));
    let (stored, (page, drawn)) = rayon::join(stored, || rayon::join(|| page::render(report), drawn));
    out.write(REPORT_FILE, stored? + "\n")?;
    let page = page?;
    out.write("index.html", page.html)?;
    for (path, text) in page.beside {
        out.write(path, text)?;
    }
    for (path, bytes) in drawn?.into_iter().flatten() {
        out.write(path, bytes)?;
    }
    if parquet {
        out.write_with("rows.parquet", |file| rows_table(report).parquet(file))?;
    }
    Ok(out.commit()?)
}

/// Returns the figures of a report with the names of their files.
#[must_use]
pub fn named_figures(report: &Report) -> Vec<(String, &Figure)> {
    let mut taken = BTreeSet::new();
    let named = |section| page::figure_names(section, &mut taken).into_iter().zip(&section.figures);
    report.sections.iter().flat_map(named).collect()
}

/// Returns the path and the content of each file of a figure: the picture as SVG, the data of a graph as CSV, and a film
/// as an animated PNG.
///
/// # Errors
/// When the figure cannot be drawn.
pub(crate) fn figure_files(figure: &Figure, name: &str) -> Result<Vec<(String, Vec<u8>)>, SaveError> {
    let mut files = vec![(format!("figures/{name}.svg"), plot::draw(figure)?.into_bytes())];
    if let Drawing::Graph(graph) = &figure.drawing {
        let mut data = Vec::new();
        graph_table(graph).csv(&mut data).map_err(SaveError::encode("the data of a figure"))?;
        files.push((format!("figures/{name}.csv"), data));
    }
    if let Some(film) = plot::film(figure)? {
        files.push((format!("figures/{name}.png"), film));
    }
    Ok(files)
}

/// Returns the data of a graph with one row per point. Values that are not finite are empty cells.
fn graph_table(graph: &Graph) -> Table<'_> {
    let columns = [Column::text("curve"), Column::number(&graph.x.label), Column::number(&graph.y.label)];
    let mut name = "";
    let rows = graph.curves.iter().flat_map(move |curve| {
        // Points without a label belong to the previous labelled curve.
        if !curve.label.is_empty() {
            name = &curve.label;
        }
        curve.points.iter().map(move |(x, y)| row![name, Cell::finite(Some(*x)), Cell::finite(Some(*y))])
    });
    Table::new("points", columns, rows)
}

impl Report {
    /// Reads the report that [`write_report`] wrote to `dir`.
    ///
    /// # Errors
    /// When the file is missing or damaged. The message names the position in the file.
    pub fn load(dir: impl AsRef<Path>) -> Result<Self, ReadError> {
        read_json(&dir.as_ref().join(REPORT_FILE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use std::fs;

    #[test]
    fn redraws_the_same_page_from_the_directory_alone() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        let report = sample::report();
        write_report(&out, &report, false).unwrap();
        let first = fs::read_to_string(out.join("index.html")).unwrap();
        let loaded = Report::load(&out).unwrap();
        write_report(&out, &loaded, false).unwrap();
        assert_eq!(fs::read_to_string(out.join("index.html")).unwrap(), first);
        let names = "results.json rows.csv points.csv junit.xml figures/backspin-convergence.svg \
                     figures/nine-discs-forces.svg";
        for name in names.split(' ') {
            assert!(out.join(name).is_file(), "{name}");
        }
    }

    #[test]
    fn a_damaged_report_is_an_error_that_names_the_place() {
        let dir = tempfile::tempdir().unwrap();
        let message = Report::load(dir.path()).unwrap_err().to_string();
        assert!(message.contains("report.json: expected a readable file, found "), "{message}");

        write_report(dir.path(), &sample::report(), false).unwrap();
        let path = dir.path().join(REPORT_FILE);
        let text = fs::read_to_string(&path).unwrap();
        let message_of = |text: &str| {
            fs::write(&path, text).unwrap();
            Report::load(dir.path()).unwrap_err().to_string()
        };
        let with_steps = |steps: &str| message_of(&text.replacen("\"steps\":25000", &format!("\"steps\":{steps}"), 1));
        let message = with_steps("\"many\"");
        assert!(message.contains("report.json, line "), "{message}");
        assert!(message.contains("at `sections[0].runs[0].steps`"), "{message}");
        assert!(message.contains("invalid type: string \"many\", expected u64"), "{message}");

        // Terminal control characters are escaped.
        let message = with_steps("\"ma\u{7f}ny\"");
        assert!(message.contains("string \"ma\\u{7f}ny\""), "{message:?}");

        let message = message_of(&text[..text.len() / 2]);
        assert!(message.contains("the end of the file"), "{message}");
    }
}
