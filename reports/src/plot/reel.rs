//! Reduction of fields to a size that is suitable for a page. Pictures get fewer pixels. Films are stored as
//! differences between frames, which a script in the page unpacks.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use grainbench_harness::figure::{Field, Panel, Shades};
use grainbench_harness::raster::{HIGH, LOW, RIM, Raster, VOID};

use super::field::{self, Frames};

/// Largest size of a picture in a page (bytes).
const PICTURE: usize = 60_000;
/// Largest size of a film in a page (bytes).
const FILM: usize = 45_000;
/// Smallest number of frames to which a film is reduced.
const FRAMES: usize = 16;
/// Smallest width to which a panel is reduced (pixels).
const ACROSS: u32 = 60;

/// Reduces pixels and frames of a field until it is small enough for a page, or cannot be reduced further. Returns the field
/// and, for a film, its packed form.
///
/// # Errors
/// When the frames differ in size or number.
pub(crate) fn light(field: &Field) -> io::Result<(Field, Option<String>)> {
    let mut field = field.clone();
    let is_film = field.times.len() > 1;
    loop {
        // Fast compression makes a film larger by a few tens of percent. It detects films that are much too large
        // in less time than slow compression.
        let far_too_heavy = is_film && reel(&field, Compression::fast())?.len() > 2 * FILM;
        let is_narrow = |field: &Field| field.panels[0].frames[0].width < 2 * ACROSS;
        if !far_too_heavy || is_narrow(&field) {
            let reel = if is_film { Some(reel(&field, Compression::default())?) } else { None };
            let stills = || Ok::<usize, io::Error>(field::stills(&field)?.iter().map(Vec::len).sum());
            let weight = reel.as_ref().map_or_else(stills, |reel| Ok(reel.len()))?;
            if weight <= if is_film { FILM } else { PICTURE } || is_narrow(&field) {
                return Ok((field, reel));
            }
        }
        field = lighter(&field);
    }
}

/// Halves the number of frames if the film has many frames, otherwise the number of pixels along each side.
fn lighter(field: &Field) -> Field {
    if field.times.len() >= 2 * FRAMES { every_other(field) } else { halved(field) }
}

/// Returns a film as text: `width height frames palette levels`. The palette is base64, and the levels are the base64
/// code of a zlib stream. After the first frame, the stream contains differences from the previous frame.
///
/// # Errors
/// When the frames differ in size or number.
fn reel(field: &Field, compression: Compression) -> io::Result<String> {
    let Frames { width, height, levels } = field::frames(field)?;
    let mut packed = ZlibEncoder::new(Vec::new(), compression);
    let zero = vec![0; levels.first().map_or(0, Vec::len)];
    for (now, then) in levels.iter().zip(std::iter::once(&zero).chain(&levels)) {
        let differences: Vec<u8> = now.iter().zip(then).map(|(now, then)| now.wrapping_sub(*then)).collect();
        packed.write_all(&differences)?;
    }
    let palette = STANDARD.encode(field::palette(field.shades));
    Ok(format!("{width} {height} {} {palette} {}", levels.len(), STANDARD.encode(packed.finish()?)))
}

/// Removes every second frame, but not the last one.
fn every_other(field: &Field) -> Field {
    let odd = field.times.len() % 2;
    let keep = |at: &usize| at % 2 != odd;
    let pick = |panel: &Panel| Panel {
        frames: panel.frames.iter().enumerate().filter(|(at, _)| keep(at)).map(|(_, frame)| frame.clone()).collect(),
        ..panel.clone()
    };
    let times = field.times.iter().enumerate().filter(|(at, _)| keep(at)).map(|(_, time)| *time).collect();
    Field { panels: field.panels.iter().map(pick).collect(), times, ..field.clone() }
}

/// Halves the number of pixels along each side.
fn halved(field: &Field) -> Field {
    let half = |panel: &Panel| Panel {
        frames: panel.frames.iter().map(|frame| halved_raster(frame, field.shades)).collect(),
        ..panel.clone()
    };
    Field { panels: field.panels.iter().map(half).collect(), pixel: 2.0 * field.pixel, ..field.clone() }
}

/// Replaces each square of four pixels by one pixel. The pixel is a rim if at least two of the four are rims, or if one is a
/// rim and none has a value. Otherwise it has the mean of the values, or is empty if there are none.
fn halved_raster(raster: &Raster, shades: Shades) -> Raster {
    let (width, height) = (raster.width.div_ceil(2), raster.height.div_ceil(2));
    let at =
        |x: u32, y: u32| raster.levels[(y.min(raster.height - 1) * raster.width + x.min(raster.width - 1)) as usize];
    let level = |x: u32, y: u32| {
        let four = [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
        let values = || four.into_iter().filter(|level| (LOW..=HIGH).contains(level)).map(u32::from);
        match (four.into_iter().filter(|level| *level == RIM).count(), values().count() as u32) {
            (2.., _) | (1, 0) => RIM,
            (_, 0) => VOID,
            // Levels of lit bodies cannot be averaged, because they combine a colour and a brightness.
            _ if shades == Shades::Lit => values().next().unwrap_or(0) as u8,
            (_, count) => (values().sum::<u32>() / count) as u8,
        }
    };
    let levels = (0..height).flat_map(|y| (0..width).map(move |x| level(x, y))).collect();
    Raster { width, height, levels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn noise(width: u32, frames: usize) -> Field {
        let mut state = 1_u32;
        let mut dice = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let mut raster = |_| Raster { width, height: width, levels: (0..width * width).map(|_| dice()).collect() };
        let panel = Panel { title: String::new(), frames: (0..frames).map(&mut raster).collect(), own: None };
        Field {
            label: "noise".to_owned(),
            unit: "1".to_owned(),
            range: (0.0, 1.0),
            shades: Shades::Amount,
            pixel: 1.0,
            length: "m".to_owned(),
            panels: vec![panel],
            clock: "t (s)".to_owned(),
            times: (0..frames).map(|frame| frame as f64).collect(),
        }
    }

    #[test]
    fn what_is_heavy_is_made_light_and_keeps_its_end() {
        for (width, frames) in [(800, 1), (400, 60)] {
            let field = noise(width, frames);
            let (light, packed) = light(&field).unwrap();
            assert_eq!(packed, (frames > 1).then(|| reel(&light, Compression::default()).unwrap()));
            assert!(light.panels[0].frames[0].width < width && light.times.last() == field.times.last());
            let size = f64::from(light.panels[0].frames[0].width) * light.pixel;
            assert!((size - f64::from(width)).abs() < 0.05 * f64::from(width), "{size}");
        }
        let small = noise(40, 1);
        assert_eq!(light(&small).unwrap(), (small, None));
    }

    #[test]
    fn a_reel_unpacks_to_its_frames() {
        let field = noise(20, 3);
        let text = reel(&field, Compression::default()).unwrap();
        let parts: Vec<&str> = text.split(' ').collect();
        let Frames { width, height, levels } = field::frames(&field).unwrap();
        assert_eq!(parts[..3], [width.to_string(), height.to_string(), "3".to_owned()]);
        let mut found = Vec::new();
        ZlibDecoder::new(STANDARD.decode(parts[4]).unwrap().as_slice()).read_to_end(&mut found).unwrap();
        let size = levels[0].len();
        for at in size..found.len() {
            found[at] = found[at].wrapping_add(found[at - size]);
        }
        assert_eq!(found, levels.concat());
    }
}
