//! Figures for a publication: drawn again in a style, and converted to PDF or PNG.

use grainbench_harness::figure::Figure;
use grainbench_reports::plot::style::FigureStyle;
use grainbench_reports::store::SaveError;
use grainbench_store::StagedDir;
use krilla::geom::Size;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use rayon::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Family, Query};
use resvg::usvg::{ImageHrefResolver, Options, Tree};
use std::borrow::Borrow;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Length of a drawing unit in a PDF document (pt). SVG has 96 units in an inch, PDF has 72.
const POINTS: f32 = 72.0 / 96.0;

/// Size of a drawing unit in a PNG picture (pixels), for 300 pixels in an inch.
const PIXELS: f32 = 300.0 / 96.0;

/// Largest number of pixels of a PNG picture. A figure of the page has about 4 million.
const MOST_PIXELS: u64 = 100_000_000;

/// Format of a figure: ending of the file names, and function that converts a drawing.
pub type FigureFormat = (&'static str, fn(&Tree) -> Result<Vec<u8>, String>);

/// All formats: scalable pictures with letters that can be selected, and pictures with 300 pixels in an inch.
pub const FORMATS: [FigureFormat; 2] = [("pdf", pdf), ("png", png)];

/// Draws figures again in a style, as `dir/figures/NAME.svg`. All other files stay.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_figures<F: Borrow<Figure>>(
    dir: &Path,
    figures: &[(String, F)],
    style: &FigureStyle,
) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir)?;
    for (name, figure) in figures {
        out.write(format!("figures/{name}.svg"), style.draw(figure.borrow())?)?;
    }
    out.commit_beside()?;
    Ok(())
}

/// Converts each `dir/figures/NAME.svg` to `NAME.pdf` or `NAME.png`. A film is already a PNG picture, so its file stays.
/// `families` are the font families of a style, which must be installed; without them, the letters are those of DejaVu Sans
/// on every machine.
///
/// # Errors
/// When no font family is installed, or when a file cannot be read, converted or written.
pub fn convert_figures<'a>(
    dir: &Path,
    names: impl Iterator<Item = &'a str>,
    (ending, draw): FigureFormat,
    families: Option<&str>,
) -> Result<(), SaveError> {
    let paths = names.map(|name| dir.join("figures").join(format!("{name}.svg")));
    let paths: Vec<PathBuf> = paths.filter(|path| ending != "png" || !is_film(path)).collect();
    let options = options(families)?;
    let converted: Vec<(PathBuf, Vec<u8>)> = paths
        .par_iter()
        .map(|path| {
            let svg = fs::read_to_string(path).map_err(|error| wrong(path, &error.to_string()))?;
            let bytes = convert(&svg, draw, &options).map_err(|reason| wrong(path, &reason))?;
            let name = path.file_name().unwrap_or_default();
            Ok((Path::new("figures").join(name).with_extension(ending), bytes))
        })
        .collect::<Result<_, SaveError>>()?;
    let mut out = StagedDir::new(dir)?;
    for (name, bytes) in &converted {
        out.write(name, bytes)?;
    }
    out.commit_beside()?;
    Ok(())
}

/// Returns true if the PNG picture beside an SVG file is animated: the chunk `acTL` precedes the image data.
fn is_film(svg: &Path) -> bool {
    let mut start = Vec::new();
    let file = fs::File::open(svg.with_extension("png"));
    file.is_ok_and(|file| file.take(1000).read_to_end(&mut start).is_ok())
        && start.windows(4).any(|name| name == b"acTL")
}

fn wrong(path: &Path, reason: &str) -> SaveError {
    SaveError::Other(format!("{}: {reason}", path.display()))
}

/// Returns the options for reading SVG, with the fonts.
fn options(families: Option<&str>) -> Result<Options<'static>, SaveError> {
    let mut fonts = Database::new();
    for font in [dejavu::sans::regular(), dejavu::sans::bold(), dejavu::sans::oblique(), dejavu::sans_mono::regular()] {
        fonts.load_font_data(font.to_vec());
    }
    if let Some(families) = families {
        fonts.load_system_fonts();
        let names = families.split(',').map(|name| name.trim().trim_matches('\''));
        let is_there =
            |name: &str| fonts.query(&Query { families: &[Family::Name(name)], ..Query::default() }).is_some();
        if !names.clone().any(is_there) {
            let found = format!("found none of `{families}`");
            let expected = "expected the name of an installed family for PDF and PNG";
            return Err(SaveError::Other(format!("font: {expected}, {found}")));
        }
    }
    for set in [Database::set_sans_serif_family, Database::set_serif_family] {
        set(&mut fonts, "DejaVu Sans");
    }
    fonts.set_monospace_family("DejaVu Sans Mono");
    // A figure contains its pictures, and reads no other file.
    let resolver = ImageHrefResolver { resolve_string: Box::new(|_, _| None), ..ImageHrefResolver::default() };
    let font_family = "DejaVu Sans".to_owned();
    Ok(Options { fontdb: Arc::new(fonts), font_family, image_href_resolver: resolver, ..Options::default() })
}

/// Converts an SVG document by a function for its drawing.
fn convert(svg: &str, draw: fn(&Tree) -> Result<Vec<u8>, String>, options: &Options<'_>) -> Result<Vec<u8>, String> {
    // A dot is a line of length zero with round ends. The SVG library omits lines of length zero.
    let dots = svg.replace("h0\"", "h.01\"").replace("h0M", "h.01M");
    draw(&Tree::from_str(&dots, options).map_err(|error| error.to_string())?)
}

fn pdf(tree: &Tree) -> Result<Vec<u8>, String> {
    let [width, height] = [tree.size().width() * POINTS, tree.size().height() * POINTS];
    let size = Size::from_wh(width, height).ok_or("the figure has no area")?;
    let page = PageSettings::from_wh(width, height).ok_or("the figure has no area")?;
    let mut document = krilla::Document::new();
    let mut page = document.start_page_with(page);
    let mut surface = page.surface();
    surface.draw_svg(tree, size, SvgSettings::default()).ok_or("the figure cannot be drawn")?;
    surface.finish();
    page.finish();
    document.finish().map_err(|error| format!("{error:?}"))
}

fn png(tree: &Tree) -> Result<Vec<u8>, String> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|length| (length * PIXELS).ceil() as u32);
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!("expected at most {MOST_PIXELS} pixels, found {width} × {height}"));
    }
    let mut picture = Pixmap::new(width, height).ok_or_else(|| format!("{width} × {height} pixels are too many"))?;
    resvg::render(tree, Transform::from_scale(PIXELS, PIXELS), &mut picture.as_mut());
    picture.encode_png().map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A red bar, a blue dot and a letter.
    const BAR: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 96 48" width="100%">
        <rect width="96" height="48" fill="#fff"/><rect x="48" width="48" height="24" fill="#f00"/>
        <path d="M72 36h0" stroke="#00f" stroke-width="6" stroke-linecap="round"/>
        <text x="4" y="40" font-size="20" font-family="Arial, sans-serif">Ω</text></svg>"##;

    #[test]
    fn a_picture_has_300_pixels_in_an_inch() {
        let png = convert(BAR, png, &options(None).unwrap()).unwrap();
        let picture = Pixmap::decode_png(&png).unwrap();
        assert_eq!((picture.width(), picture.height()), (300, 150));
        let color = |x, y| picture.pixel(x, y).map(|pixel| (pixel.red(), pixel.green(), pixel.blue()));
        assert_eq!(color(225, 30), Some((255, 0, 0)));
        assert_eq!(color(75, 30), Some((255, 255, 255)));
        assert_eq!(color(225, 112), Some((0, 0, 255)), "the dot");
        let is_dark = |x, y| picture.pixel(x, y).is_some_and(|pixel| pixel.red() < 64);
        let dark = (0..75).flat_map(|x| (75..150).map(move |y| (x, y))).filter(|(x, y)| is_dark(*x, *y)).count();
        assert!(dark > 100, "{dark} pixels of the letter");
    }

    #[test]
    fn a_document_has_the_size_of_the_figure_and_its_font() {
        let pdf = convert(BAR, pdf, &options(None).unwrap()).unwrap();
        let text = String::from_utf8_lossy(&pdf).replace(' ', "");
        assert!(text.starts_with("%PDF-") && text.contains("+DejaVuSans"), "{text}");
        let size = text.split("/MediaBox[").nth(1).and_then(|rest| rest.split(']').next());
        assert_eq!(size, Some("007236"), "0 0 72 36: {text}");
    }

    #[test]
    fn wrong_figures_and_fonts_are_errors() {
        let options = options(None).unwrap();
        for svg in ["", "<svg", "{}", r#"<svg xmlns="http://www.w3.org/2000/svg" width="0" height="1"/>"#] {
            assert!(convert(svg, pdf, &options).is_err(), "{svg}");
        }
        let large = r#"<svg xmlns="http://www.w3.org/2000/svg" width="1e5" height="1e5"/>"#;
        assert!(convert(large, png, &options).is_err_and(|reason| reason.contains("pixels")));
        let missing = super::options(Some("'No Such Family', serif")).err().map(|error| error.to_string());
        assert_eq!(
            missing.as_deref(),
            Some(
                "font: expected the name of an installed family for PDF and PNG, found none of `'No Such Family', serif`"
            )
        );
        let dir = tempfile::tempdir().unwrap();
        let missing = convert_figures(dir.path(), ["a"].into_iter(), FORMATS[0], None).unwrap_err().to_string();
        assert!(missing.contains("a.svg"), "{missing}");
    }
}
