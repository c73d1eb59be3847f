//! Output directory of a report. All its files are written together. The report can be read back to write them again.

use std::io;
use std::path::{Path, PathBuf};

use grainbench_harness::figure::{Drawing, Figure, Graph};
use rayon::prelude::*;
use thiserror::Error;

use crate::badge::badge;
use crate::junit::junit_xml;
use crate::page;
use crate::plot;
use crate::report::Report;
use crate::results::{points_csv, results_json};
use crate::row;
use crate::rows::{ROWS_PARQUET, rows_csv, rows_parquet};
use crate::table::{Cell, Column, Table};
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
    /// A value cannot be written in a file format.
    #[error("cannot encode {file}: {reason}")]
    Encode {
        /// Name of the file.
        file: &'static str,
        /// Message of the encoder.
        reason: String,
    },
    /// A figure cannot be converted.
    #[error("{}: {reason}", path.display())]
    Convert {
        /// Path of the figure, or of the directory of figures.
        path: PathBuf,
        /// Reason why the figure cannot be converted.
        reason: String,
    },
    /// No font family of a style is installed.
    #[error("font: expected the name of an installed family for PDF and PNG, found none of `{families}`")]
    NoFont {
        /// Font families of the style.
        families: String,
    },
}

/// Writes the files of a report to `dir`. If an error occurs, no file is written.
///
/// The files are `index.html`, `results.json`, `report.json`, `rows.csv`, `points.csv`, `junit.xml`, `badge.svg` and
/// `figures/CASE-NAME.svg`. The data of graphs are added as `.csv` and films as `.png`. Parts that would make the page
/// too large become separate pages.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_report(dir: impl AsRef<Path>, report: &Report) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    add_report(&mut out, report)?;
    out.commit()?;
    Ok(())
}

/// Writes the files of a report to `dir`, and the results also as Parquet.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_report_and_parquet(dir: impl AsRef<Path>, report: &Report) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir.as_ref())?;
    add_report(&mut out, report)?;
    let rows =
        rows_parquet(report).map_err(|error| SaveError::Encode { file: ROWS_PARQUET, reason: error.to_string() })?;
    out.write(ROWS_PARQUET, rows)?;
    out.commit()?;
    Ok(())
}

/// Returns the figures of a report with the names of their files.
#[must_use]
pub fn named_figures(report: &Report) -> Vec<(String, &Figure)> {
    let figures = report.sections.iter().flat_map(|section| &section.figures);
    page::figure_names(report).into_iter().flatten().zip(figures).collect()
}

/// Adds all files of a report to a staged directory.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
fn add_report(out: &mut StagedDir, report: &Report) -> Result<(), SaveError> {
    let encode = |file: &'static str| move |reason: String| SaveError::Encode { file, reason };
    let results = results_json(report).map_err(|error| encode("results.json")(error.to_string()))?;
    out.write("results.json", results)?;
    let points = points_csv(report).map_err(|error| encode("points.csv")(error.to_string()))?;
    out.write("points.csv", points)?;
    let rows = rows_csv(report).map_err(|error| encode("rows.csv")(error.to_string()))?;
    out.write("rows.csv", rows)?;
    let junit = junit_xml(report).map_err(|error| encode("junit.xml")(error.to_string()))?;
    out.write("junit.xml", junit)?;
    out.write("badge.svg", badge(report))?;
    let figures = named_figures(report);
    let drawn = || figures.par_iter().map(|(name, figure)| figure_files(figure, name)).collect::<Result<Vec<_>, _>>();
    let stored = || serde_json::to_string(report).map_err(|error| encode(REPORT_FILE)(error.to_string()));
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
    Ok(())
}

/// Adds the files of a figure: the picture as SVG, the data of a graph as CSV, and a film as an animated PNG.
///
/// # Errors
/// When a file cannot be written or the figure cannot be drawn.
pub(crate) fn add_figure(out: &mut StagedDir, figure: &Figure, name: &str) -> Result<(), SaveError> {
    for (path, bytes) in figure_files(figure, name)? {
        out.write(path, bytes)?;
    }
    Ok(())
}

/// Returns the path and the content of each file of a figure.
fn figure_files(figure: &Figure, name: &str) -> Result<Vec<(String, Vec<u8>)>, SaveError> {
    let mut files = vec![(format!("figures/{name}.svg"), plot::draw(figure)?.into_bytes())];
    if let Drawing::Graph(graph) = &figure.drawing {
        let data = graph_csv(graph)
            .map_err(|error| SaveError::Encode { file: "the data of a figure", reason: error.to_string() })?;
        files.push((format!("figures/{name}.csv"), data));
    }
    if let Some(film) = plot::film(figure)? {
        files.push((format!("figures/{name}.png"), film));
    }
    Ok(files)
}

/// Returns the data of a graph as CSV, one line per point. Values that are not finite are empty cells.
fn graph_csv(graph: &Graph) -> io::Result<Vec<u8>> {
    let columns = [Column::text("curve"), Column::number(&graph.x.label), Column::number(&graph.y.label)];
    let mut name = "";
    let rows = graph.curves.iter().flat_map(|curve| {
        // Points without a label belong to the previous labelled curve.
        if !curve.label.is_empty() {
            name = &curve.label;
        }
        curve.points.iter().map(move |(x, y)| row![name, Cell::finite(Some(*x)), Cell::finite(Some(*y))])
    });
    Table::new("points", columns, rows).csv_bytes()
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
        write_report(&out, &report).unwrap();
        let first = fs::read_to_string(out.join("index.html")).unwrap();
        let loaded = Report::load(&out).unwrap();
        write_report(&out, &loaded).unwrap();
        assert_eq!(fs::read_to_string(out.join("index.html")).unwrap(), first);
        for name in [
            "results.json",
            "rows.csv",
            "points.csv",
            "junit.xml",
            "figures/backspin-convergence.svg",
            "figures/nine-discs-forces.svg",
        ] {
            assert!(out.join(name).is_file(), "{name}");
        }
        // With this variable, a copy of the report is written, so that it can be opened in a browser.
        if let Ok(copy) = std::env::var("GRAINBENCH_REPORT_DIR") {
            write_report(copy, &report).unwrap();
        }
    }

    #[test]
    fn a_damaged_report_is_an_error_that_names_the_place() {
        let dir = tempfile::tempdir().unwrap();
        let message = Report::load(dir.path()).unwrap_err().to_string();
        assert!(message.contains("report.json: expected a readable file, found "), "{message}");

        write_report(dir.path(), &sample::report()).unwrap();
        let path = dir.path().join(REPORT_FILE);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replacen("\"steps\":25000", "\"steps\":\"many\"", 1)).unwrap();
        let message = Report::load(dir.path()).unwrap_err().to_string();
        assert!(message.contains("report.json, line "), "{message}");
        assert!(message.contains("at `sections[0].runs[0].steps`"), "{message}");
        assert!(message.contains("invalid type: string \"many\", expected u64"), "{message}");

        // Terminal control characters are escaped.
        fs::write(&path, text.replacen("\"steps\":25000", "\"steps\":\"ma\u{7f}ny\"", 1)).unwrap();
        let message = Report::load(dir.path()).unwrap_err().to_string();
        assert!(message.contains("string \"ma\\u{7f}ny\""), "{message:?}");

        fs::write(&path, &text[..text.len() / 2]).unwrap();
        let message = Report::load(dir.path()).unwrap_err().to_string();
        assert!(message.contains("the end of the file"), "{message}");
    }
}
