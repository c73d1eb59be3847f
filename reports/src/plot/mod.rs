//! Figures as SVG text. They need no external font or library.

pub mod field;
pub mod forces;
pub mod graph;
pub mod lines;
pub mod palette;
mod reel;
pub mod scale;
pub(crate) mod text;

use grainbench_harness::figure::{Drawing, Figure};
use grainbench_scene::text::tamed;
use thiserror::Error;

/// Width of every figure (drawing units). Pages scale the figures.
pub(crate) const WIDTH: f64 = 860.0;

/// Fonts that are available on desktops and phones.
pub(crate) const FONTS: &str =
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif";

/// Error when a figure cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw figure `{figure}`: {reason}")]
pub struct DrawError {
    /// Name of the figure.
    pub figure: String,
    /// Reason why the figure cannot be drawn.
    pub reason: String,
}

/// Draws a figure as a complete SVG document.
///
/// # Errors
/// When a field has no panel, or when its frames differ in size or number.
pub fn draw(figure: &Figure) -> Result<String, DrawError> {
    let svg = match &figure.drawing {
        Drawing::Graph(graph) => graph::draw(&figure.title, graph),
        Drawing::Forces(plot) => forces::draw(&figure.title, plot),
        Drawing::Lines(plot) => lines::draw(&figure.title, plot),
        Drawing::Field(field) => field::draw(&figure.title, field)
            .map_err(|reason| DrawError { figure: figure.name.clone(), reason: reason.to_string() })?,
    };
    Ok(markup(&svg))
}

/// Draws a figure as SVG for a page. A field with many pixels is reduced. A film is also returned in packed form for
/// the script of the page.
///
/// # Errors
/// When a field has no panel, or when its frames differ in size or number.
pub fn draw_small(figure: &Figure) -> Result<(String, Option<String>), DrawError> {
    let Drawing::Field(field) = &figure.drawing else { return Ok((draw(figure)?, None)) };
    let wrong = |reason: std::io::Error| DrawError { figure: figure.name.clone(), reason: reason.to_string() };
    let (light, reel) = reel::light(field).map_err(wrong)?;
    Ok((markup(&field::draw(&figure.title, &light).map_err(wrong)?), reel))
}

/// Returns an SVG document without characters that XML does not allow.
pub(crate) fn markup(document: &str) -> String {
    tamed(document, |character| matches!(character, '\n' | '\t'))
}

/// Returns the film of a figure as an animated PNG; none if the figure is not a film.
///
/// # Errors
/// When the field has no panel, or when its frames differ in size or number.
pub fn film(figure: &Figure) -> Result<Option<Vec<u8>>, DrawError> {
    match &figure.drawing {
        Drawing::Field(field) if field.times.len() > 1 => field::film(field)
            .map(Some)
            .map_err(|reason| DrawError { figure: figure.name.clone(), reason: reason.to_string() }),
        _ => Ok(None),
    }
}

/// Returns the approximate width of a text (drawing units) at a font size. Font metrics are unknown, so average widths of
/// letters are used.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let letters: f64 = text
        .chars()
        .map(|letter| match letter {
            '⁰'..='⁹' | '⁻' | '¹' | '²' | '³' => 0.42,
            'i' | 'j' | 'l' | 't' | 'f' | '.' | ',' | ' ' | '(' | ')' => 0.36,
            'm' | 'w' | 'M' | 'W' => 0.9,
            _ => 0.6,
        })
        .sum();
    letters * size
}

/// Breaks a text at spaces into lines of at most `width`. A longer word has a line of its own.
pub(crate) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        if let Some(line) = lines.last_mut() {
            if line.is_empty() {
                line.push_str(word);
                continue;
            }
            let longer = format!("{line} {word}");
            if text_width(&longer, size) <= width {
                *line = longer;
                continue;
            }
        }
        lines.push(word.to_owned());
    }
    lines
}
