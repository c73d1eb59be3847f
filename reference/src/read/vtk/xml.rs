//! XML files with points, `PolyData` and `UnstructuredGrid`. Numbers are text, encoded in place, or in the appended
//! data.

use super::{Array, Bytes, Points};
use crate::read::binary::Number;
use crate::read::digits::Digits;
use crate::read::read_error::{ReadError, quoted};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::reader::Reader;
use std::io::Read;

/// Start of the tag with appended data.
const APPENDED: &[u8] = b"<AppendedData";
/// Name of the tag of an array.
const ARRAY: &[u8] = b"DataArray";
/// Last tag of every file.
const END: &[u8] = b"</VTKFile>";
/// Name of the supported compression.
const ZLIB: &str = "vtkZLibDataCompressor";

/// Reads points and their data.
pub(super) fn read(bytes: Bytes<'_>) -> Result<Points, ReadError> {
    let all = bytes.all();
    if !all.trim_ascii_end().ends_with(END) {
        return Err(bytes.error_at(all.len(), "`</VTKFile>`", "the end of the file"));
    }
    let cut = memchr::memmem::find(all, APPENDED);
    let appended = cut.map(|cut| appended(&bytes, cut)).transpose()?;
    let xml = Bytes::new(bytes.file(), &all[..cut.unwrap_or(all.len())]);
    File { bytes: xml, appended, ..File::default() }.points()
}

/// Returns the appended data after the XML part: the bytes after the underscore that begins the data.
fn appended<'b>(bytes: &Bytes<'b>, cut: usize) -> Result<Stream<'b>, ReadError> {
    let all = &bytes.all()[cut..];
    let fault = |expected: &str, found: &str| bytes.error_at(cut, expected, found);
    let head = memchr::memchr(b'>', all).ok_or_else(|| fault("`<AppendedData …>`", "the end of the file"))?;
    let is_text = memchr::memmem::find(&all[..head], b"base64").is_some();
    let start = memchr::memchr(b'_', &all[head..]).ok_or_else(|| fault("`_` before the data", "none"))?;
    let end = memchr::memmem::rfind(all, b"</AppendedData>");
    let end = end.ok_or_else(|| bytes.error_at(usize::MAX, "`</AppendedData>`", "the end of the file"))?;
    Ok(Stream { data: all.get(head + start + 1..end).unwrap_or_default(), is_text })
}

/// Attributes and text of the tag of an array.
struct DataArray {
    name: String,
    kind: String,
    components: usize,
    format: String,
    offset: usize,
    at: usize,
    text: String,
}

#[derive(Default)]
struct File<'b> {
    bytes: Bytes<'b>,
    appended: Option<Stream<'b>>,
    is_big: bool,
    /// True if lengths are stored in eight bytes, false for four bytes.
    wide: bool,
    compressor: Option<String>,
    /// Array whose tag is open.
    array: Option<DataArray>,
    /// Number of pieces that have begun.
    pieces: usize,
    positions: Option<Array>,
    arrays: Vec<Array>,
    time: Option<f64>,
}

impl File<'_> {
    fn points(mut self) -> Result<Points, ReadError> {
        let mut reader = Reader::from_reader(self.bytes.all());
        let mut path: Vec<Vec<u8>> = Vec::new();
        loop {
            let at = reader.buffer_position() as usize;
            let event =
                reader.read_event().map_err(|error| self.bytes.error_at(at, "XML", quoted(&error.to_string())))?;
            let is_in_array = path.last().is_some_and(|name| name == ARRAY);
            match event {
                Event::Start(tag) => {
                    self.open(&tag, at)?;
                    self.pieces += usize::from(tag.name().as_ref() == b"Piece");
                    path.push(tag.name().as_ref().to_vec());
                }
                Event::Empty(tag) => {
                    self.open(&tag, at)?;
                    if tag.name().as_ref() == ARRAY {
                        self.close(path.last().map(Vec::as_slice))?;
                    }
                }
                Event::Text(text) if is_in_array => self.add(&String::from_utf8_lossy(&text)),
                Event::CData(text) if is_in_array => self.add(&String::from_utf8_lossy(&text)),
                Event::GeneralRef(reference) => {
                    let text = self.resolved(&reference, at)?;
                    self.add(&text);
                }
                Event::End(_) => {
                    path.pop();
                    if is_in_array {
                        self.close(path.last().map(Vec::as_slice))?;
                    }
                }
                Event::Eof => break,
                _ => {}
            }
        }
        let positions = self.positions.ok_or_else(|| self.bytes.error_at(0, "an array in `<Points>`", "none"))?;
        Ok(Points::of_moment(self.bytes.file(), self.time, positions, self.arrays))
    }

    /// Adds text to the array whose tag is open.
    fn add(&mut self, text: &str) {
        if let Some(array) = &mut self.array {
            array.text.push_str(text);
        }
    }

    /// Returns the text of a reference such as `&#32;` or `&amp;`. Entities that a file defines are not supported.
    fn resolved(&self, reference: &BytesRef<'_>, at: usize) -> Result<String, ReadError> {
        let name = String::from_utf8_lossy(reference);
        let letter = reference.resolve_char_ref().ok().flatten();
        let known = letter.map(String::from).or_else(|| resolve_predefined_entity(&name).map(str::to_owned));
        let expected = "one of the entities `&lt;`, `&gt;`, `&amp;`, `&apos;` and `&quot;`, or the number of a letter";
        known.ok_or_else(|| self.bytes.error_at(at, expected, quoted(&format!("&{name};"))))
    }

    /// Reads the attributes of a tag.
    fn open(&mut self, tag: &BytesStart<'_>, at: usize) -> Result<(), ReadError> {
        let value = |key: &str| {
            tag.try_get_attribute(key).ok().flatten().map(|found| String::from_utf8_lossy(&found.value).into_owned())
        };
        match tag.name().as_ref() {
            b"VTKFile" => {
                let kind = value("type").unwrap_or_default();
                if !["PolyData", "UnstructuredGrid"].contains(&kind.as_str()) {
                    let expected = "a file of the type `PolyData` or `UnstructuredGrid`";
                    return Err(self.bytes.error_at(at, expected, quoted(&kind)));
                }
                self.is_big = value("byte_order").is_some_and(|order| order == "BigEndian");
                self.wide = value("header_type").is_some_and(|header| header == "UInt64");
                self.compressor = value("compressor");
            }
            ARRAY => {
                let count = |key: &str, usual: usize| match value(key) {
                    None => Ok(usual),
                    Some(text) => text
                        .parse()
                        .map_err(|_| self.bytes.error_at(at, format!("a whole number in `{key}`"), quoted(&text))),
                };
                self.array = Some(DataArray {
                    name: value("Name").unwrap_or_default(),
                    kind: value("type").unwrap_or_default(),
                    components: count("NumberOfComponents", 1)?,
                    format: value("format").unwrap_or_else(|| "ascii".to_owned()),
                    offset: count("offset", 0)?,
                    at,
                    text: String::new(),
                });
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads the array whose tag ends if it contains positions, data of points, or the time. Numbers of a further piece of
    /// the file are appended to the array of the same name.
    fn close(&mut self, parent: Option<&[u8]>) -> Result<(), ReadError> {
        let Some(array) = self.array.take() else { return Ok(()) };
        let is_in = |name: &[u8]| parent.is_some_and(|parent| parent == name);
        let is_time = is_in(b"FieldData") && self.pieces == 0 && array.name.eq_ignore_ascii_case("TimeValue");
        if !(is_in(b"Points") || is_in(b"PointData") || is_time) {
            return Ok(());
        }
        let read = self.numbers(&array)?;
        let components = if is_in(b"Points") { 3 } else { array.components };
        if components == 0 || read.numbers.len() % components != 0 {
            let expected = format!("a whole number of points of {components} numbers in {}", quoted(&array.name));
            return Err(self.bytes.error_at(array.at, expected, read.numbers.len().to_string()));
        }
        let read = Array { components, ..read };
        let known = if is_in(b"Points") {
            self.positions.as_mut()
        } else if is_time {
            self.time = read.numbers.first().copied();
            return Ok(());
        } else {
            self.arrays.iter_mut().find(|known| known.name == array.name)
        };
        match known {
            Some(known) if known.components == components => {
                known.numbers.extend(read.numbers);
                known.digits = known.digits.with(&read.digits);
            }
            Some(_) => {
                let expected = "as many components as in the piece before";
                return Err(self.bytes.error_at(array.at, expected, components.to_string()));
            }
            None if is_in(b"Points") => self.positions = Some(read),
            None => self.arrays.push(read),
        }
        Ok(())
    }

    fn numbers(&self, array: &DataArray) -> Result<Array, ReadError> {
        let DataArray { name, components, at, text, .. } = array;
        let fault = |expected: &str, found: String| {
            self.bytes.error_at(*at, format!("{expected} in the array {}", quoted(name)), found)
        };
        let kind = Number::of_xml(&array.kind).ok_or_else(|| fault("a type of numbers", quoted(&array.kind)))?;
        let (numbers, digits) = match array.format.as_str() {
            "ascii" => {
                let mut digits = Digits::default();
                let number = |word: &str| {
                    digits.see(word.as_bytes());
                    fast_float2::parse::<f64, _>(word).map_err(|_| fault("a number", quoted(word)))
                };
                let numbers = text.split_ascii_whitespace().map(number).collect::<Result<_, _>>()?;
                (numbers, kind.digits(digits))
            }
            "binary" | "appended" => {
                let encoded: Vec<u8>;
                let stream = if array.format == "binary" {
                    encoded = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
                    Stream { data: &encoded, is_text: true }
                } else {
                    let appended = self.appended.ok_or_else(|| fault("`<AppendedData>`", "none".to_owned()))?;
                    let data = appended.data.get(array.offset..);
                    let data =
                        data.ok_or_else(|| fault("an offset inside the appended data", array.offset.to_string()))?;
                    Stream { data, ..appended }
                };
                let bytes = self.unpacked(stream).map_err(|what| fault("complete encoded data", what))?;
                if bytes.len() % kind.size() != 0 {
                    return Err(fault("a whole number of values", format!("{} bytes", bytes.len())));
                }
                (kind.decode(&bytes, self.is_big), kind.digits(Digits::exact()))
            }
            other => return Err(fault("the format `ascii`, `binary` or `appended`", quoted(other))),
        };
        Ok(Array { name: name.clone(), components: *components, numbers, digits })
    }

    /// Decodes the bytes of the numbers in an array. Their length precedes them; compressed data consist of blocks.
    fn unpacked(&self, mut stream: Stream<'_>) -> Result<Vec<u8>, String> {
        let size = if self.wide { 8 } else { 4 };
        let kind = if self.wide { Number::U64 } else { Number::U32 };
        let lengths = |bytes: &[u8]| -> Vec<usize> {
            kind.decode(bytes, self.is_big).iter().map(|length| *length as usize).collect()
        };
        let Some(compressor) = &self.compressor else {
            let whole = stream.ahead(size)?;
            let length = lengths(&whole)[0];
            return if stream.is_apart(size) {
                stream.take(size)?;
                stream.take(length)
            } else {
                let whole = length.checked_add(size).ok_or("a length above the limit")?;
                Ok(stream.take(whole)?.split_off(size))
            };
        };
        if compressor != ZLIB {
            return Err(format!("a compression by {}; only {ZLIB} is supported", quoted(compressor)));
        }
        let blocks = lengths(&stream.ahead(size)?)[0];
        let head = blocks
            .checked_add(3)
            .and_then(|words| words.checked_mul(size))
            .ok_or("a number of blocks above the limit")?;
        let head = lengths(&stream.take(head)?);
        let (most, packed) = (head[1].max(head[2]), &head[3..]);
        let total = packed
            .iter()
            .try_fold(0_usize, |sum, length| sum.checked_add(*length))
            .ok_or("a total length of blocks above the limit")?;
        let mut data = &stream.take(total)?[..];
        let mut bytes = Vec::new();
        for length in packed {
            let (block, rest) = data.split_at(*length);
            let decoder = ZlibDecoder::new(block);
            decoder.take(most as u64).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
            if bytes.len() as u64 > super::MOST {
                return Err(format!("more than {} bytes", super::MOST));
            }
            data = rest;
        }
        Ok(bytes)
    }
}

/// Bytes that are stored as they are or as base-64 text.
#[derive(Clone, Copy)]
struct Stream<'s> {
    data: &'s [u8],
    is_text: bool,
}

impl Stream<'_> {
    /// Returns the next `count` bytes. The reading position does not change.
    fn ahead(mut self, count: usize) -> Result<Vec<u8>, String> {
        self.take(count)
    }

    /// Returns true if the first `count` bytes are encoded separately from the following bytes. In base-64 text,
    /// padding then follows them.
    fn is_apart(&self, count: usize) -> bool {
        !self.is_text || !count.is_multiple_of(3) && self.data.get(count.div_ceil(3) * 4 - 1) == Some(&b'=')
    }

    /// Reads the next `count` bytes. Base-64 text is read up to the end of the group of letters with the last of these
    /// bytes, and the other bytes of the group are ignored.
    fn take(&mut self, count: usize) -> Result<Vec<u8>, String> {
        let length = if self.is_text { count.div_ceil(3).saturating_mul(4) } else { count };
        let Some(piece) = self.data.get(..length) else {
            return Err(format!("{} bytes of {length}", self.data.len()));
        };
        self.data = &self.data[length..];
        if !self.is_text {
            return Ok(piece.to_vec());
        }
        let mut bytes = STANDARD.decode(piece).map_err(|error| error.to_string())?;
        if bytes.len() < count {
            return Err(format!("{} bytes of {count}", bytes.len()));
        }
        bytes.truncate(count);
        Ok(bytes)
    }
}
