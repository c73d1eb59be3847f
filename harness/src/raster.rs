//! Raster pictures as levels from 0 to 255; reports map levels to colours. The pictures are small enough to be stored
//! with the results.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::io::{Read, Write};

/// Level of empty space.
pub const VOID: u8 = 0;
/// Level of the outline of a grain.
pub const RIM: u8 = 255;
/// Level of the lowest value. Values have levels from [`LOW`] to [`HIGH`].
pub const LOW: u8 = 1;
/// Level of the highest value.
pub const HIGH: u8 = 254;
/// Largest number of pixels of a picture.
const MOST_PIXELS: u64 = 1 << 24;

/// Levels of a picture, row by row from the top. They are serialised as the base64 code of a zlib stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Width (pixels).
    pub width: u32,
    /// Height (pixels).
    pub height: u32,
    /// Level of each pixel: [`VOID`], [`RIM`], or a value from [`LOW`] to [`HIGH`].
    pub levels: Vec<u8>,
}

/// Returns the level of a value. Values outside the range have the level of the nearest limit, and NaN has [`VOID`].
#[must_use]
pub fn level(value: f64, (low, high): (f64, f64)) -> u8 {
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    if part.is_nan() { VOID } else { LOW + (part * f64::from(HIGH - LOW)).round() as u8 }
}

/// Number of colours of [`lit`].
pub const COLOURS: u8 = 8;
/// Number of brightness levels of each colour of [`lit`].
pub const LIGHTS: u8 = 31;

/// Returns the level of a value from 0 to 1 at a light intensity from 0 to 1. NaN has [`VOID`].
#[must_use]
pub fn lit(value: f64, light: f64) -> u8 {
    let part = |fraction: f64, count: u8| {
        (fraction.clamp(0.0, 1.0) * f64::from(count)).floor().min(f64::from(count - 1)) as u8
    };
    if value.is_nan() || light.is_nan() { VOID } else { LOW + LIGHTS * part(value, COLOURS) + part(light, LIGHTS) }
}

#[derive(Serialize, Deserialize)]
struct StoredRaster {
    width: u32,
    height: u32,
    levels: String,
}

impl Serialize for Raster {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
        let levels = packed.write_all(&self.levels).and_then(|()| packed.finish());
        let levels = STANDARD.encode(levels.map_err(serde::ser::Error::custom)?);
        StoredRaster { width: self.width, height: self.height, levels }.serialize(to)
    }
}

impl<'de> Deserialize<'de> for Raster {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let StoredRaster { width, height, levels } = StoredRaster::deserialize(from)?;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > MOST_PIXELS {
            return Err(D::Error::custom(format!("expected 1 to {MOST_PIXELS} pixels, found {width} × {height}")));
        }
        let packed = STANDARD.decode(&levels).map_err(|error| D::Error::custom(format!("levels: {error}")))?;
        let mut levels = Vec::new();
        // Reading one byte more than expected detects a stream that is too long.
        let read = ZlibDecoder::new(packed.as_slice()).take(pixels + 1).read_to_end(&mut levels);
        read.map_err(|error| D::Error::custom(format!("levels: {error}")))?;
        if levels.len() as u64 != pixels {
            return Err(D::Error::custom(format!("expected {pixels} levels, found another number")));
        }
        Ok(Self { width, height, levels })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_back_the_same_and_refuses_what_it_is_not() {
        let raster = Raster { width: 3, height: 2, levels: vec![0, 1, 2, 253, 254, 255] };
        let text = serde_json::to_string(&raster).unwrap_or_default();
        assert_eq!(serde_json::from_str::<Raster>(&text).ok(), Some(raster));
        for (from, to) in [
            ("\"width\":3", "\"width\":4"),
            ("\"height\":2", "\"height\":4000000000"),
            ("\"levels\":\"", "\"levels\":\"%"),
        ] {
            assert!(serde_json::from_str::<Raster>(&text.replace(from, to)).is_err(), "{to}");
        }
    }

    #[test]
    fn levels_span_the_range() {
        assert_eq!([0.0, 0.5, 1.0, -3.0, 9.0].map(|value| level(value, (0.0, 1.0))), [LOW, 128, HIGH, LOW, HIGH]);
        assert_eq!(level(f64::NAN, (0.0, 1.0)), VOID);
        assert_eq!([lit(0.0, 0.0), lit(1.0, 1.0), lit(f64::NAN, 1.0)], [LOW, COLOURS * LIGHTS, VOID]);
    }
}
