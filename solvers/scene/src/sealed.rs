//! Files that are read back by this program alone: a line that says what it is and of which format, the number of bytes that
//! follow the hash (8 bytes, little end first), their BLAKE3 hash (32 bytes), and the bytes.

/// Bytes of length and hash.
const HEAD: u64 = 40;
/// Digits that a format of ours may have, and the end of the line.
const DIGITS: usize = 11;

/// Why bytes are no such file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Broken {
    /// It is another kind of file.
    Foreign,
    /// It is of an earlier format.
    Older(u32),
    /// It is of a later format.
    Newer(u32),
    /// It is longer or shorter than it says: what it says, and what it is (B).
    Length(u64, u64),
    /// Its bytes are not those that were written.
    Changed,
}

/// The bytes of a file of some kind and format.
pub(crate) fn seal(magic: &[u8], format: u32, body: &[u8]) -> Vec<u8> {
    let mut bytes = [magic, format.to_string().as_bytes(), b"\n"].concat();
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(blake3::hash(body).as_bytes());
    bytes.extend(body);
    bytes
}

/// What was sealed.
pub(crate) fn open<'b>(magic: &[u8], format: u32, bytes: &'b [u8]) -> Result<&'b [u8], Broken> {
    let start = &bytes[..bytes.len().min(magic.len() + DIGITS)];
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let number = line.strip_prefix(magic).ok_or(Broken::Foreign)?;
    let after_line = bytes.get(line.len() + 1..).unwrap_or_default();
    match std::str::from_utf8(number).ok().and_then(|digits| digits.parse::<u32>().ok()) {
        Some(found) if found == format => {}
        Some(found) if found > format => return Err(Broken::Newer(found)),
        Some(found @ 1..) => return Err(Broken::Older(found)),
        _ => return Err(Broken::Foreign),
    }
    let whole = |expected: u64| Broken::Length(expected, after_line.len() as u64);
    let (length, rest) = after_line.split_first_chunk::<8>().ok_or_else(|| whole(HEAD))?;
    let (hash, body) = rest.split_first_chunk::<32>().ok_or_else(|| whole(HEAD))?;
    let length = u64::from_le_bytes(*length);
    if length != body.len() as u64 {
        return Err(whole(HEAD.saturating_add(length)));
    }
    if blake3::hash(body).as_bytes() != hash {
        return Err(Broken::Changed);
    }
    Ok(body)
}
