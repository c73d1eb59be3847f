//! Fields as pixel images, with panels, a colour bar and a scale bar. The drawing of a film shows its last frame and a
//! time axis.

use std::io;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use grainbench_harness::figure::{Field, Shades};
use grainbench_harness::raster::{COLOURS, HIGH, LIGHTS, LOW, RIM, Raster, VOID, lit};
use maud::{Markup, html};

use super::scale::Scale;
use super::{WIDTH, apart, document, fine as px, text_width};
use crate::number;

const MARGIN: f64 = 10.0;
const TOP: f64 = 48.0;
/// Height above each row of panels, for their titles (drawing units).
const HEAD: f64 = 24.0;
const GAP: f64 = 14.0;
/// Width to the right of the panels, for the colour bar (drawing units).
const BAR: f64 = 124.0;
/// Largest height of the panels if there is a single row (drawing units).
const TALLEST: f64 = 560.0;
/// Largest mean height of a row of panels if there are several rows (drawing units).
const TALLEST_ROW: f64 = 300.0;
const FOOT: f64 = 46.0;
/// Height below panels that have their own scales (drawing units).
const BARS: f64 = 72.0;
/// Height below a film, for its time axis (drawing units).
const CLOCK: f64 = 50.0;
/// Largest distance between the panels of a film (pixels of the film). The height of the time bar equals the actual distance.
const SEAM: usize = 8;
/// Ratio of the width of all panels of a film to their distance, which is therefore small for coarse pixels.
const SEAMS: usize = 64;
/// Duration of each frame except the last, in units of 0.1 s.
const PACE: u16 = 1;
/// Duration of the last frame, in units of 0.1 s.
const REST: u16 = 12;

/// Draws a field as a complete SVG document.
///
/// # Errors
/// When the field has no panel, or when frames differ in size or number.
pub(crate) fn draw(title: &str, field: &Field) -> io::Result<String> {
    let size = check(field)?;
    let is_film = field.times.len() > 1;
    let count = field.panels.len();
    let across = if is_film { count } else { per_row(count, size) };
    let rows = count.div_ceil(across);
    let head = if field.panels.iter().any(|panel| !panel.title.is_empty()) { HEAD } else { 0.0 };
    let each_its_own = field.panels.iter().any(|panel| panel.own.is_some());
    let room = WIDTH - 2.0 * MARGIN - if each_its_own { 0.0 } else { BAR };
    // The distance between the panels of a film is scaled with the image.
    let seam = seam(size, count) as f64;
    let widest = if is_film {
        room / (f64::from(size.0) * across as f64 + seam * (across - 1) as f64) * f64::from(size.0)
    } else {
        (room - GAP * (across - 1) as f64) / across as f64
    };
    let scale =
        (widest / f64::from(size.0)).min(TALLEST.max(TALLEST_ROW * rows as f64) / rows as f64 / f64::from(size.1));
    let panel = (f64::from(size.0) * scale, f64::from(size.1) * scale);
    let gap = if is_film { seam * scale } else { GAP };
    let row = head + panel.1 + if rows > 1 { GAP } else { 0.0 };
    let corner = |at: usize| (MARGIN + (panel.0 + gap) * (at % across) as f64, TOP + row * (at / across) as f64 + head);
    let bottom = TOP + row * rows as f64;
    let full = panel.0 * across as f64 + gap * (across - 1) as f64;
    let images = if is_film {
        let strip = 2.0 * seam * scale;
        vec![(corner(0), (full, panel.1 + strip), still(field)?)]
    } else {
        stills(field)?.into_iter().enumerate().map(|(at, still)| (corner(at), panel, still)).collect()
    };
    let foot = bottom + if is_film { 2.0 * seam * scale } else { 0.0 };
    let bars = foot + if is_film { CLOCK } else { 0.0 };
    let height = bars + if each_its_own { BARS } else { 0.0 } + FOOT;
    let body = html! {
        @for (at, panel_of) in field.panels.iter().enumerate() {
            @let (x, y) = corner(at);
            @let size = (15.0 * panel.0 / text_width(&panel_of.title, 15.0)).min(15.0);
            text x=(px(x)) y=(px(y - 8.0)) font-size=(px(size)) fill="#222" { (panel_of.title) }
        }
        @for ((x, y), (width, height), image) in &images {
            image x=(px(*x)) y=(px(*y)) width=(px(*width)) height=(px(*height)) preserveAspectRatio="none"
                href=(format!("data:image/png;base64,{}", STANDARD.encode(image))) {}
        }
        @for at in 0..count {
            @let (x, y) = corner(at);
            rect x=(px(x)) y=(px(y)) width=(px(panel.0)) height=(px(panel.1)) fill="none" stroke="#777" stroke-width=".8" {}
        }
        @if is_film { (clock(field, full, foot)) }
        // A field whose lengths have no unit has no scale bar.
        @if field.pixel > 0.0 { (scale_bar(field.pixel / scale, &field.length, panel.0, height - FOOT + 24.0)) }
        @if each_its_own {
            @for (at, panel_of) in field.panels.iter().enumerate() {
                @if let Some((range, unit)) = &panel_of.own {
                    (level_bar(field.shades, *range, unit, [corner(at).0, bars + 14.0], panel.0 - 16.0))
                }
            }
        } @else {
            (colour_bar(field, MARGIN + full + 30.0, TOP + head, (panel.1 * rows as f64).clamp(120.0, 320.0)))
        }
    };
    Ok(document(title, [WIDTH, height], &body))
}

/// Returns the distance between the panels of a film (pixels of the film).
fn seam((width, _): (u32, u32), count: usize) -> usize {
    (width as usize * count / SEAMS).clamp(1, SEAM)
}

/// Frames of a film. The panels are side by side, and a bar below them shows the time.
pub(crate) struct Frames {
    /// Width of a frame (pixels).
    pub(crate) width: u32,
    /// Height of a frame (pixels).
    pub(crate) height: u32,
    /// Levels of each frame, row by row from the top.
    pub(crate) levels: Vec<Vec<u8>>,
}

/// Combines the panels of a field into the frames of a film.
pub(crate) fn frames(field: &Field) -> io::Result<Frames> {
    let (width, height) = check(field)?;
    let (wide, high) = (width as usize, height as usize);
    let seam = seam((width, height), field.panels.len());
    let full = wide * field.panels.len() + seam * (field.panels.len() - 1);
    // On black, the level of the rim would be too dark for the bar.
    let ink = if field.shades == Shades::Glow { HIGH } else { RIM };
    let levels_of = |frame: usize| {
        let mut levels = vec![VOID; full * (high + 2 * seam)];
        for (at, panel) in field.panels.iter().enumerate() {
            let left = at * (wide + seam);
            for (row, line) in panel.frames[frame].levels.chunks(wide).enumerate() {
                levels[row * full + left..row * full + left + wide].copy_from_slice(line);
            }
        }
        let done = (position(&field.times, frame) * full as f64).round() as usize;
        for row in high + seam..high + 2 * seam {
            levels[row * full..row * full + done.min(full)].fill(ink);
        }
        levels
    };
    let levels = (0..field.times.len()).map(levels_of).collect();
    Ok(Frames { width: full as u32, height: height + 2 * seam as u32, levels })
}

/// Returns the film of a field as an animated PNG.
///
/// # Errors
/// When the field has no panel, or when frames differ in size or number.
pub(crate) fn film(field: &Field) -> io::Result<Vec<u8>> {
    let Frames { width, height, levels } = frames(field)?;
    png(field.shades, (width, height), &levels)
}

/// Returns the last frame of a film as a PNG. It is shown in print, and until the film starts.
fn still(field: &Field) -> io::Result<Vec<u8>> {
    let Frames { width, height, levels } = frames(field)?;
    png(field.shades, (width, height), &levels[levels.len() - 1..])
}

/// Returns each panel of a picture as a PNG.
pub(crate) fn stills(field: &Field) -> io::Result<Vec<Vec<u8>>> {
    let size = check(field)?;
    field.panels.iter().map(|panel| png(field.shades, size, std::slice::from_ref(&panel.frames[0].levels))).collect()
}

/// Returns the colours of all levels: red, green and blue of each level from 0 to 255.
pub(crate) fn palette(shades: Shades) -> Vec<u8> {
    (0..=u8::MAX).flat_map(|level| colour(shades, level)).collect()
}

/// Returns the position of a frame on the time axis, from 0 to 1.
fn position(times: &[f64], frame: usize) -> f64 {
    let (first, last) = (times[0], times[times.len() - 1]);
    if last > first { ((times[frame] - first) / (last - first)).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the width and the height of the frames. Returns an error if frames differ in size or number.
fn check(field: &Field) -> io::Result<(u32, u32)> {
    let wrong = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what.to_owned());
    let first = field.panels.first().and_then(|panel| panel.frames.first()).ok_or_else(|| wrong("no panel"))?;
    let size = (first.width, first.height);
    let is_size = |raster: &Raster| {
        (raster.width, raster.height) == size && raster.levels.len() == size.0 as usize * size.1 as usize
    };
    if size.0 == 0 || !field.panels.iter().flat_map(|panel| &panel.frames).all(is_size) {
        return Err(wrong("frames of different sizes"));
    }
    if field.times.is_empty() || field.panels.iter().any(|panel| panel.frames.len() != field.times.len()) {
        return Err(wrong("the numbers of frames and times differ"));
    }
    Ok(size)
}

/// Returns the number of panels per row: one for wide panels, otherwise up to three.
const fn per_row(count: usize, (width, height): (u32, u32)) -> usize {
    if width > 2 * height {
        1
    } else if count > 3 {
        count.div_ceil(count.div_ceil(3))
    } else {
        count
    }
}

/// Encodes levels as a PNG with the colours of their colour map. Several frames make an animated PNG.
fn png(shades: Shades, (width, height): (u32, u32), frames: &[Vec<u8>]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    // PNG filters do not help, because neighbouring pixels need not have similar palette indices.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_palette(palette(shades));
    if frames.len() > 1 {
        encoder.set_animated(frames.len() as u32, 0)?;
        encoder.set_frame_delay(PACE, 10)?;
    }
    let mut writer = encoder.write_header()?;
    for (at, frame) in frames.iter().enumerate() {
        if frames.len() > 1 {
            writer.set_frame_delay(if at + 1 == frames.len() { REST } else { PACE }, 10)?;
        }
        writer.write_image_data(frame)?;
    }
    writer.finish()?;
    Ok(bytes)
}

/// Returns the colour of a level. The colour maps are readable without colour vision, and their brightness changes
/// evenly. They are cividis (Nuñez, Anderton and Renslow 2018), magma, viridis and ColorBrewer's PuOr, all from the
/// `colorous` crate, and grey for fringes.
fn colour(shades: Shades, level: u8) -> [u8; 3] {
    let part = f64::from(level.saturating_sub(LOW)) / f64::from(HIGH - LOW);
    let (value, light) = (level.saturating_sub(LOW) / LIGHTS, level.saturating_sub(LOW) % LIGHTS);
    let hue = f64::from(value.min(COLOURS - 1)) / f64::from(COLOURS - 1);
    let lit = |channel: u8| (f64::from(channel) * f64::from(light) / f64::from(LIGHTS - 1)).round() as u8;
    match (level, shades) {
        (VOID, Shades::Glow) => [0x30, 0x30, 0x38],
        (VOID, _) => [0xff; 3],
        (RIM, Shades::Glow) => [0x58, 0x58, 0x60],
        (RIM, Shades::Fringes) => [0x00, 0x72, 0xb2],
        (RIM, _) => [0x22; 3],
        (_, Shades::Amount) => colorous::CIVIDIS.eval_continuous(part).as_array(),
        (_, Shades::Glow) => colorous::MAGMA.eval_continuous(part).as_array(),
        (_, Shades::Signed) => colorous::PURPLE_ORANGE.eval_continuous(part).as_array(),
        (_, Shades::Lit) => colorous::VIRIDIS.eval_continuous(hue).as_array().map(lit),
        (_, Shades::Fringes) => [(255.0 * part).round() as u8; 3],
    }
}

/// Returns the level at a fraction of the range of values, for a colour bar.
fn level_of(shades: Shades, part: f64) -> u8 {
    if shades == Shades::Lit { lit(part, 1.0) } else { LOW + (f64::from(HIGH - LOW) * part) as u8 }
}

/// Draws a vertical colour bar with values.
fn colour_bar(field: &Field, x: f64, y: f64, height: f64) -> Markup {
    const STEPS: u8 = 64;
    let (low, high) = field.range;
    let (factor, unit) = with_prefix(low.abs().max(high.abs()), &field.unit);
    let scale = Scale::fit([low / factor, high / factor].into_iter(), false, 0.0, 6);
    let step = height / f64::from(STEPS);
    let label = if unit == "1" { field.label.clone() } else { format!("{} ({unit})", field.label) };
    html! {
        g font-size="14" fill="#222" {
            @for at in 0..STEPS {
                @let [red, green, blue] = colour(field.shades, level_of(field.shades, (f64::from(at) + 0.5) / f64::from(STEPS)));
                rect x=(px(x)) y=(px(y + height - step * f64::from(at + 1))) width="16" height=(px(step + 0.8))
                    fill=(format!("#{red:02x}{green:02x}{blue:02x}")) {}
            }
            rect x=(px(x)) y=(px(y)) width="16" height=(px(height)) fill="none" stroke="#777" stroke-width=".8" {}
            @for tick in scale.ticks() {
                @let at = y + height * (1.0 - scale.position(tick.value));
                line x1=(px(x + 16.0)) y1=(px(at)) x2=(px(x + 21.0)) y2=(px(at)) stroke="#222" {}
                text x=(px(x + 25.0)) y=(px(at + 5.0)) { (tick.label.unwrap_or_default()) }
            }
            text transform=(format!("translate({} {}) rotate(-90)", px(x - 6.0), px(y + 0.5 * height))) text-anchor="middle" {
                (label)
            }
        }
    }
}

/// Draws a horizontal colour bar with values, for a panel with its own scale.
fn level_bar(shades: Shades, (low, high): (f64, f64), unit: &str, [x, y]: [f64; 2], width: f64) -> Markup {
    const STEPS: u8 = 48;
    let (factor, unit) = with_prefix(low.abs().max(high.abs()), unit);
    let scale = Scale::fit([low / factor, high / factor].into_iter(), false, 0.0, 3);
    // The first label starts at the left end of the bar, not before it.
    let labels = apart(scale.ticks().into_iter().map(|tick| {
        let label = tick.label.unwrap_or_default();
        let length = text_width(&label, 13.0);
        ((x + width * scale.position(tick.value)).max(x + 0.5 * length), length, label)
    }));
    let step = width / f64::from(STEPS);
    html! {
        g font-size="13" fill="#222" {
            @for at in 0..STEPS {
                @let [red, green, blue] = colour(shades, level_of(shades, (f64::from(at) + 0.5) / f64::from(STEPS)));
                rect x=(px(x + step * f64::from(at))) y=(px(y)) width=(px(step + 0.8)) height="12"
                    fill=(format!("#{red:02x}{green:02x}{blue:02x}")) {}
            }
            rect x=(px(x)) y=(px(y)) width=(px(width)) height="12" fill="none" stroke="#777" stroke-width=".8" {}
            @for tick in scale.ticks() {
                @let at = px(x + width * scale.position(tick.value));
                line x1=(at) y1=(px(y + 12.0)) x2=(at) y2=(px(y + 17.0)) stroke="#222" {}
            }
            @for (at, label) in labels { text x=(px(at)) y=(px(y + 30.0)) text-anchor="middle" { (label) } }
            @if unit != "1" { text x=(px(x + 0.5 * width)) y=(px(y + 46.0)) text-anchor="middle" { (unit) } }
        }
    }
}

/// Draws a scale bar with a round length. `unit` is the length per drawing unit, and `name` is the unit of length.
fn scale_bar(unit: f64, name: &str, room: f64, y: f64) -> Markup {
    let longest = 0.4 * room * unit;
    let decade = 10_f64.powf(longest.log10().floor());
    let length =
        [5.0, 2.0, 1.0].into_iter().map(|round| round * decade).find(|round| *round <= longest).unwrap_or(decade);
    let drawn = length / unit;
    let (factor, name) = with_prefix(length, name);
    html! {
        rect x=(px(MARGIN)) y=(px(y - 3.0)) width=(px(drawn)) height="4" fill="#222" {}
        text x=(px(MARGIN + drawn + 8.0)) y=(px(y + 4.0)) font-size="14" fill="#222" {
            (number::with_unit(length / factor, &name))
        }
    }
}

/// Draws the time axis of a film below the bar that shows the time.
fn clock(field: &Field, width: f64, y: f64) -> Markup {
    let (first, last) = (field.times[0], field.times[field.times.len() - 1]);
    let scale = Scale::fit([first, last].into_iter(), false, 0.0, 8);
    html! {
        g font-size="14" fill="#222" {
            line x1=(px(MARGIN)) y1=(px(y)) x2=(px(MARGIN + width)) y2=(px(y)) stroke="#222" {}
            @for tick in scale.ticks() {
                @let at = MARGIN + width * scale.position(tick.value);
                line x1=(px(at)) y1=(px(y)) x2=(px(at)) y2=(px(y + 5.0)) stroke="#222" {}
                @let label = tick.label.unwrap_or_default();
                @let anchor = if at < MARGIN + 0.5 * text_width(&label, 14.0) { "start" } else { "middle" };
                text x=(px(at)) y=(px(y + 20.0)) text-anchor=(anchor) { (label) }
            }
            text x=(px(MARGIN + 0.5 * width)) y=(px(y + 40.0)) text-anchor="middle" { (field.clock) }
        }
    }
}

/// Returns a factor and the unit with its SI prefix. Units without prefixes have the factor 1.
fn with_prefix(value: f64, unit: &str) -> (f64, String) {
    let prefixes: &[(f64, &str)] = match unit {
        "Pa" => &[(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, "")],
        "m" => &[(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")],
        _ => &[],
    };
    let fits = prefixes.iter().find(|(factor, _)| value >= *factor * (1.0 - 1e-9)).or(prefixes.last());
    fits.map_or_else(|| (1.0, unit.to_owned()), |(factor, prefix)| (*factor, format!("{prefix}{unit}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_harness::figure::Panel;

    fn field(frames: usize, panels: usize) -> Field {
        let raster = |level: u8| Raster { width: 40, height: 30, levels: vec![level; 1200] };
        let panel = |at: usize| Panel {
            title: format!("panel <{at}>"),
            frames: (0..frames).map(|frame| raster(1 + (frame + 100 * at) as u8)).collect(),
            own: None,
        };
        Field {
            label: "σ₁ − σ₂".to_owned(),
            unit: "Pa".to_owned(),
            range: (0.0, 2.5e6),
            shades: Shades::Glow,
            pixel: 1e-5,
            length: "m".to_owned(),
            panels: (0..panels).map(panel).collect(),
            clock: "time t (s)".to_owned(),
            times: (0..frames).map(|frame| frame as f64).collect(),
        }
    }

    #[test]
    fn pictures_have_a_scale_and_units() {
        let svg = draw("stress <&>", &field(1, 2)).unwrap_or_default();
        assert_eq!(svg.matches("data:image/png;base64,").count(), 2);
        assert!(
            svg.contains("σ₁ − σ₂ (MPa)") && svg.contains("100\u{202f}µm") && svg.contains("panel &lt;1&gt;"),
            "{svg}"
        );
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn a_film_plays_all_panels_in_step_and_forever() {
        let field = field(3, 2);
        let bytes = film(&field).unwrap_or_default();
        let mut reader =
            png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap_or_else(|error| unreachable!("{error}"));
        let control = reader.info().animation_control.map(|control| (control.num_frames, control.num_plays));
        assert_eq!(control, Some((3, 0)));
        assert_eq!(reader.info().size(), (81, 32));
        let mut pixels = vec![0; reader.output_buffer_size().unwrap_or(0)];
        for frame in 0..3 {
            assert!(reader.next_frame(&mut pixels).is_ok());
            assert_eq!((pixels[0], pixels[40], pixels[80]), (1 + frame, VOID, 101 + frame));
            // The length of the time bar is 0, one half and 1 of the width of the film.
            let run = pixels[31 * 81..32 * 81].iter().filter(|&&level| level == HIGH).count();
            assert_eq!(run, [0, 41, 81][usize::from(frame)]);
        }
        let svg = draw("film", &field).unwrap_or_default();
        assert!(svg.matches("data:image/png;base64,").count() == 1 && svg.contains("time t (s)"));
        assert_eq!([(16, 1), (80, 2), (400, 4)].map(|(width, count)| seam((width, 9), count)), [1, 2, 8]);
    }

    #[test]
    fn the_panels_of_a_film_stay_within_the_drawing() {
        let mut field = field(2, 4);
        for panel in &mut field.panels {
            panel.own = Some(((0.0, 1.0), "1".to_owned()));
        }
        let svg = draw("film", &field).unwrap_or_default();
        let after =
            |name: &str, text: &str| text.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse::<f64>().ok();
        let rects = svg.split("<rect").skip(1).filter_map(|rect| rect.split('>').next());
        let ends: Vec<f64> = rects.filter_map(|rect| Some(after("x", rect)? + after("width", rect)?)).collect();
        assert!(ends.len() > 4 && ends.iter().all(|end| *end <= WIDTH - MARGIN + 0.01), "{ends:?}");
    }

    #[test]
    fn frames_that_do_not_fit_are_refused() {
        for break_it in [
            |field: &mut Field| field.panels.clear(),
            |field: &mut Field| field.times.push(9.0),
            |field: &mut Field| field.panels[1].frames[0].width = 20,
            |field: &mut Field| field.panels[0].frames[1].levels.truncate(7),
        ] {
            let mut field = field(2, 2);
            break_it(&mut field);
            assert!(draw("broken", &field).is_err() && film(&field).is_err());
        }
    }
}
