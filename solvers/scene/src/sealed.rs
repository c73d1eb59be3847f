//! Sealed files, which only this program reads. A file consists of a line with kind and format, the number of content
//! bytes (8 bytes, little-endian), the BLAKE3 hash of the content (32 bytes), and the content.

/// Number of bytes of length and hash.
const HEAD: u64 = 40;
/// Largest number of digits of a format number (10), plus the end of the line.
const DIGITS: usize = 11;

/// Reason why bytes are not a valid sealed file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SealError {
    /// Another kind of file.
    Foreign,
    /// Earlier format.
    Older(u32),
    /// Later format.
    Newer(u32),
    /// Wrong length: the expected and the actual number of bytes after the first line (B).
    Length(u64, u64),
    /// The bytes differ from those that were written.
    Changed,
}

/// Returns the bytes of a file with the given kind (`magic`), format and content.
#[must_use]
pub fn seal(magic: &[u8], format: u32, body: &[u8]) -> Vec<u8> {
    let mut bytes = [magic, format.to_string().as_bytes(), b"\n"].concat();
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(blake3::hash(body).as_bytes());
    bytes.extend(body);
    bytes
}

/// Returns the content of a file of the given kind (`magic`) and format.
///
/// # Errors
/// When the bytes are not a valid file of this kind and format.
pub fn open<'b>(magic: &[u8], format: u32, bytes: &'b [u8]) -> Result<&'b [u8], SealError> {
    let start = &bytes[..bytes.len().min(magic.len() + DIGITS)];
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let number = line.strip_prefix(magic).ok_or(SealError::Foreign)?;
    let after_line = bytes.get(line.len() + 1..).unwrap_or_default();
    match std::str::from_utf8(number).ok().and_then(|digits| digits.parse::<u32>().ok()) {
        Some(found) if found == format => {}
        Some(found) if found > format => return Err(SealError::Newer(found)),
        Some(found @ 1..) => return Err(SealError::Older(found)),
        _ => return Err(SealError::Foreign),
    }
    let whole = |expected: u64| SealError::Length(expected, after_line.len() as u64);
    let (length, rest) = after_line.split_first_chunk::<8>().ok_or_else(|| whole(HEAD))?;
    let (hash, body) = rest.split_first_chunk::<32>().ok_or_else(|| whole(HEAD))?;
    let length = u64::from_le_bytes(*length);
    if length != body.len() as u64 {
        return Err(whole(HEAD.saturating_add(length)));
    }
    if blake3::hash(body).as_bytes() != hash {
        return Err(SealError::Changed);
    }
    Ok(body)
}
