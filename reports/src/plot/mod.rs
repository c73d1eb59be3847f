//! Figures as SVG text. They need no external font or library.

mod field;
mod forces;
pub(crate) mod graph;
mod lines;
pub(crate) mod palette;
mod reel;
pub(crate) mod scale;
pub mod style;
pub(crate) mod text;

use grainbench_harness::figure::{Drawing, Figure};
use grainbench_scene::text::tamed;
use maud::{Markup, html};
use thiserror::Error;

use crate::number::{self, THIN};

/// Width of every figure (drawing units). Pages scale the figures.
pub(crate) const WIDTH: f64 = 860.0;

/// Smallest distance between two labels of an axis (drawing units).
const GAP: f64 = 6.0;

/// Fonts that are available on desktops and phones.
pub(crate) const FONTS: &str =
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif";

/// Error when a figure cannot be drawn.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct DrawError(String);

fn wrong(figure: &Figure) -> impl Fn(std::io::Error) -> DrawError {
    |reason| DrawError(format!("cannot draw figure `{}`: {reason}", figure.name))
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
        Drawing::Field(field) => field::draw(&figure.title, field).map_err(wrong(figure))?,
    };
    Ok(markup(&svg))
}

/// Draws a figure as SVG for a page. A field with many pixels is reduced. A film is also returned in packed form for
/// the script of the page.
///
/// # Errors
/// When a field has no panel, or when its frames differ in size or number.
pub(crate) fn draw_small(figure: &Figure) -> Result<(String, Option<String>), DrawError> {
    let Drawing::Field(field) = &figure.drawing else { return Ok((draw(figure)?, None)) };
    let (light, reel) = reel::light(field).map_err(wrong(figure))?;
    Ok((markup(&field::draw(&figure.title, &light).map_err(wrong(figure))?), reel))
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
        Drawing::Field(field) if field.times.len() > 1 => field::film(field).map(Some).map_err(wrong(figure)),
        _ => Ok(None),
    }
}

/// Transformation from a plane to drawing units, with y upwards.
struct View {
    /// Drawing units per unit of each coordinate.
    scale: [f64; 2],
    left: f64,
    bottom: f64,
    /// Point of the plane at the lower left corner.
    low: [f64; 2],
}

impl View {
    fn at(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = [0, 1].map(|axis| (point[axis] - self.low[axis]) * self.scale[axis]);
        [self.left + x, self.bottom - y]
    }
}

/// Returns the approximate width of a text (drawing units) at a font size. Font metrics are unknown, so widths of the
/// letters of DejaVu Sans are used, the widest of [`FONTS`].
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let width = |letter: char| match letter {
        '⁰'..='⁹' | '¹' | '²' | '³' | '₀'..='₉' => 0.42,
        'i' | 'j' | 'l' | 't' | 'f' | '.' | ',' | ' ' | '(' | ')' | ':' | THIN => 0.36,
        '0'..='9' => 0.64,
        '×' | '−' | '=' | '+' => 0.84,
        'm' | 'w' | 'M' | 'W' => 0.9,
        _ => 0.6,
    };
    text.chars().map(width).sum::<f64>() * size
}

/// Returns a drawing as a complete SVG document. A title that is wider than the drawing has smaller letters.
pub(crate) fn document(title: &str, [width, height]: [f64; 2], body: &Markup) -> String {
    // Bold letters are about a tenth wider than others.
    let size = (17.0 * (width - 20.0) / (1.1 * text_width(title, 17.0))).min(17.0);
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (width) " " (px(height)) } width="100%" role="img"
            aria-label=(title) font-family=(FONTS) {
            title { (title) }
            rect width=(width) height=(px(height)) fill="#fff" {}
            text x="10" y="29" font-size=(px(size)) font-weight="bold" fill="#222" { (text::svg(title)) }
            (body)
        }
    };
    svg.into_string()
}

/// Returns a length in drawing units with at most one decimal.
pub(crate) fn px(length: f64) -> String {
    let text = format!("{length:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Returns a length in drawing units with at most two decimals, for small parts.
pub(crate) fn fine(length: f64) -> String {
    format!("{length:.2}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the labels of an axis that do not overlap. Each label has a position and a length along the axis.
pub(crate) fn apart<T>(labels: impl Iterator<Item = (f64, f64, T)>) -> Vec<(f64, T)> {
    let mut before: Option<(f64, f64)> = None;
    let mut is_free = |at: f64, length: f64| {
        let is_free = before.is_none_or(|(other, reach)| (at - other).abs() > 0.5 * (length + reach) + GAP);
        before = if is_free { Some((at, length)) } else { before };
        is_free
    };
    labels.filter(|(at, length, _)| is_free(*at, *length)).map(|(at, _, label)| (at, label)).collect()
}

/// Returns the note that states the number of parts of a drawing without finite coordinates.
pub(crate) fn missing(count: usize, part: &str) -> Option<String> {
    (count > 0).then(|| format!("({} without a finite place not shown)", number::counted(count, part)))
}

/// Breaks a text at spaces into lines of at most `width`. A longer word has a line of its own.
pub(crate) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    // A narrow space joins a number and its unit, so a text is not broken there.
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => *line = format!("{line} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    if lines.is_empty() { vec![String::new()] } else { lines }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_have_room() {
        // Widths in DejaVu Sans.
        for (text, width) in [("−2×10⁻³", 4.73), ("5×10⁻⁴", 3.67), ("0.125", 2.86)] {
            assert!((text_width(text, 1.0) - width).abs() < 0.1 * width, "{text}: {}", text_width(text, 1.0));
        }
        assert_eq!(wrap("bias 0.55\u{202f}%, spread", 14.0, 80.0), ["bias", "0.55\u{202f}%,", "spread"]);
        let is_large = |title: &str| document(title, [WIDTH; 2], &html! {}).contains("font-size=\"17\"");
        assert!(is_large("Energy") && !is_large(&"long ".repeat(30)));
        let labels = [(0.0, 20.0, "a"), (15.0, 20.0, "b"), (30.0, 20.0, "c")];
        assert_eq!(apart(labels.into_iter()), [(0.0, "a"), (30.0, "c")]);
    }
}
