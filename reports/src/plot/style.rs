//! Style of figures for a publication: width, size and family of the letters, and colours.

use super::graph::{self, Form};
use super::palette::COLOURS;
use super::{DrawError, FONTS, WIDTH, draw, markup};
use grainbench_harness::figure::{Drawing, Figure};
use serde::Deserialize;

/// Size of the labels of a graph (drawing units).
const LETTERS: f64 = 14.0;

/// Length of a point (mm).
const POINT: f64 = 25.4 / 72.0;

/// Smallest width of a graph with legible labels (drawing units).
const NARROWEST: f64 = 300.0;

/// Style of figures, as in a style file. Absent keys keep the style of the page.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureStyle {
    /// Width of a figure (mm).
    pub width: Option<f64>,
    /// Size of the labels of graphs (pt). It needs a width.
    pub font_size: Option<f64>,
    /// Families of the letters, such as `Times New Roman, serif`.
    pub font: Option<String>,
    /// Colours of the curves in their order, as `#rrggbb`. Further curves keep their colours.
    pub colors: Vec<String>,
}

impl FigureStyle {
    /// Returns the first wrong value: its key, the expected value and the found value. None if all values are valid.
    #[must_use]
    pub fn wrong(&self) -> Option<(&'static str, &'static str, String)> {
        let is_size = |size: f64, most: f64| size.is_finite() && size > 0.0 && size <= most;
        let is_color = |color: &String| {
            color.len() == 7 && color.starts_with('#') && color[1..].chars().all(|digit| digit.is_ascii_hexdigit())
        };
        let is_font = |font: &String| {
            !font.is_empty() && font.chars().all(|letter| letter.is_alphanumeric() || " ,'-".contains(letter))
        };
        if let Some(width) = self.width.filter(|width| !is_size(*width, 2000.0)) {
            return Some(("width", "a width in mm, at most 2000", width.to_string()));
        }
        if let Some(size) = self.font_size.filter(|size| !is_size(*size, 100.0) || self.width.is_none()) {
            let found = if self.width.is_none() { format!("{size} without `width`") } else { size.to_string() };
            return Some(("font_size", "a size in pt, at most 100, and a width", found));
        }
        if let Some(form) = self.form().filter(|form| form.width < NARROWEST) {
            let found = format!("{:.2} of the width", LETTERS / form.width);
            return Some(("font_size", "letters of at most a twentieth of the width", found));
        }
        if let Some(font) = self.font.as_ref().filter(|font| !is_font(font)) {
            return Some(("font", "names of font families", format!("`{font}`")));
        }
        if let Some(color) = self.colors.iter().find(|color| !is_color(color)) {
            return Some(("colors", "colours as `#rrggbb`", format!("`{color}`")));
        }
        let is_too_many = self.colors.len() > COLOURS.len();
        is_too_many.then(|| ("colors", "at most six colours", self.colors.len().to_string()))
    }

    /// Returns the form of a graph whose letters have the requested size when the graph has the requested width.
    fn form(&self) -> Option<Form> {
        let width = self.width? / (self.font_size? * POINT) * LETTERS;
        Some(Form { width, height: width * Form::FIGURE.height / WIDTH, legend: true })
    }

    /// Draws a figure in this style as a complete SVG document.
    ///
    /// # Errors
    /// When a field has no panel, or when its frames differ in size or number.
    pub fn draw(&self, figure: &Figure) -> Result<String, DrawError> {
        let mut svg = match (&figure.drawing, self.form()) {
            (Drawing::Graph(graph), Some(form)) => markup(&graph::draw_as(&figure.title, graph, form)),
            _ => draw(figure)?,
        };
        if let Some(width) = self.width {
            // Some readers do not derive the height from the width and the view box.
            let sizes = svg.split("viewBox=\"0 0 ").nth(1).and_then(|rest| rest.split('"').next()?.split_once(' '));
            let ratio = sizes.and_then(|(wide, high)| Some(high.parse::<f64>().ok()? / wide.parse::<f64>().ok()?));
            let height = ratio.map_or(String::new(), |ratio| format!(" height=\"{:.2}mm\"", width * ratio));
            svg = svg.replacen("width=\"100%\"", &format!("width=\"{width}mm\"{height}"), 1);
        }
        if let Some(font) = &self.font {
            svg = svg.replace(FONTS, font);
        }
        // A colour of the style can be another colour of the page, so all are replaced at once.
        let marked = (0..self.colors.len()).fold(svg, |svg, at| svg.replace(COLOURS[at], &format!("\u{0}{at}\u{0}")));
        let colors = self.colors.iter().enumerate();
        Ok(colors.fold(marked, |svg, (at, color)| svg.replace(&format!("\u{0}{at}\u{0}"), color)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    fn graph() -> Figure {
        let report = sample::report();
        let figures = report.sections.into_iter().flat_map(|section| section.figures);
        figures.into_iter().find(|figure| matches!(figure.drawing, Drawing::Graph(_))).unwrap()
    }

    #[test]
    fn a_style_changes_width_letters_and_colours() {
        let figure = graph();
        let plain = draw(&figure).unwrap();
        assert_eq!(FigureStyle::default().draw(&figure).unwrap(), plain, "an empty style changes nothing");
        // The first two colours are exchanged.
        let colors = vec![COLOURS[1].to_owned(), COLOURS[0].to_owned()];
        let style =
            FigureStyle { width: Some(86.0), font_size: Some(8.0), font: Some("Times, serif".to_owned()), colors };
        assert_eq!(style.wrong(), None);
        let svg = style.draw(&figure).unwrap();
        let shape = svg.split("viewBox=\"0 0 ").nth(1).unwrap().split('"').next().unwrap();
        let (wide, high) = shape.split_once(' ').unwrap();
        let height = 86.0 * high.parse::<f64>().unwrap() / wide.parse::<f64>().unwrap();
        assert!(svg.contains(&format!("width=\"86mm\" height=\"{height:.2}mm\"")), "{svg}");
        assert!(svg.contains("width=\"86mm\"") && svg.contains("font-family=\"Times, serif\""), "{svg}");
        // 86 mm are 243.8 pt, so letters of 14 units have 8 pt if the drawing is 14 · 243.8 / 8 = 426.6 units wide.
        assert!(svg.contains("viewBox=\"0 0 426.6"), "{svg}");
        let count = |svg: &str, color: usize| svg.matches(COLOURS[color]).count();
        assert!(count(&plain, 0) > 0 && count(&svg, 1) > 0, "{svg}");
        assert!(!svg.contains('\u{0}'));
    }

    #[test]
    fn wrong_styles_are_refused() {
        let right = FigureStyle { width: Some(86.0), font_size: Some(8.0), ..FigureStyle::default() };
        let key = |style: FigureStyle| style.wrong().map(|(key, ..)| key);
        assert_eq!(key(right.clone()), None);
        for width in [0.0, -1.0, f64::NAN, 1e9] {
            assert_eq!(key(FigureStyle { width: Some(width), font_size: None, ..right.clone() }), Some("width"));
        }
        assert_eq!(key(FigureStyle { width: None, ..right.clone() }), Some("font_size"));
        assert_eq!(key(FigureStyle { font_size: Some(20.0), ..right.clone() }), Some("font_size"));
        assert_eq!(key(FigureStyle { font: Some("a\" onload=\"b".to_owned()), ..right.clone() }), Some("font"));
        assert_eq!(key(FigureStyle { colors: vec!["red".to_owned()], ..right.clone() }), Some("colors"));
        assert_eq!(key(FigureStyle { colors: vec!["#000000".to_owned(); 7], ..right }), Some("colors"));
    }
}
