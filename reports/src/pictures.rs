//! Pages that contain figures of records, without results of claims.

use crate::page::{figures, shell, slug, unique};
use crate::store::{SaveError, figure_files};
use grainbench_harness::figure::Figure;
use grainbench_solver::record::{Provenance, Record};
use grainbench_store::StagedDir;
use maud::html;
use std::collections::BTreeSet;
use std::path::Path;

/// Writes `index.html` and `figures/NAME.svg` to `dir`, and each film also as `figures/NAME.png`. If an error occurs,
/// no file is written.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_pictures(dir: &Path, records: &[&Record], figures: &[Figure]) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir)?;
    let title = records.first().map_or("pictures", |record| record.provenance.scene.as_str());
    let leads: Vec<String> = records.iter().map(|record| words(&record.provenance)).collect();
    write_page(&mut out, title, &leads, figures)?;
    Ok(out.commit_beside()?)
}

/// Adds `index.html` with a title, paragraphs and figures, and the files of the figures.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub(crate) fn write_page(
    out: &mut StagedDir,
    title: &str,
    leads: &[String],
    figures: &[Figure],
) -> Result<(), SaveError> {
    let mut drawn = Vec::new();
    for (name, figure) in named_figures(figures) {
        for (path, bytes) in figure_files(figure, &name)? {
            out.write(path, bytes)?;
        }
        drawn.push(figures::part(figure, &name, &name)?);
    }
    let body = html! {
        main.alone {
            header {
                p.kicker { "grainbench" }
                h1 { (title) }
                @for lead in leads { p.lead { (lead) } }
            }
            div.figures { @for figure in &drawn { (figure) } }
        }
    };
    out.write("index.html", shell(&format!("grainbench · {title}"), &body))?;
    Ok(())
}

/// Returns figures with the names of their files.
#[must_use]
pub fn named_figures(figures: &[Figure]) -> Vec<(String, &Figure)> {
    let mut names = BTreeSet::new();
    figures.iter().map(|figure| (unique(&slug(&figure.name), &mut names), figure)).collect()
}

fn words(from: &Provenance) -> String {
    let effects = if from.effects.is_empty() { "contact springs only".to_owned() } else { from.effects.join(", ") };
    format!("{}, {}: {effects}", from.solver, from.resolution)
}
