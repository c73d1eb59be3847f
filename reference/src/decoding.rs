//! Plain or compressed: decided by the first bytes, never by the name.

use std::io::{self, BufRead, BufReader, Cursor, Read};

use flate2::bufread::MultiGzDecoder;

const GZIP: &[u8] = &[0x1f, 0x8b];

/// Compressions that are recognised in order to say so, rather than to complain about bytes that are no text.
const UNREADABLE: [(&[u8], &str); 4] = [
    (&[0xfd, b'7', b'z', b'X', b'Z', 0], "xz (unpack it with `xz -dk`)"),
    (&[0x28, 0xb5, 0x2f, 0xfd], "zstd (unpack it with `zstd -dk`)"),
    (b"BZh", "bzip2 (unpack it with `bzip2 -dk`)"),
    (b"PK\x03\x04", "zip (unpack it with `unzip`)"),
];

/// The longest of the marks above.
const MARK: u64 = 6;

/// What the first bytes of an input announce.
pub(crate) enum Decoded<'r> {
    /// Text, decompressed on the way where it was gzip.
    Text(Box<dyn BufRead + 'r>),
    /// A compression that is not read here, by name.
    Unreadable(&'static str),
}

/// Looks at the first bytes of `reader` and unpacks gzip.
pub(crate) fn decoded<'r>(mut reader: impl BufRead + 'r) -> io::Result<Decoded<'r>> {
    let mut head = Vec::new();
    reader.by_ref().take(MARK).read_to_end(&mut head)?;
    if let Some((_, name)) = UNREADABLE.iter().find(|(mark, _)| head.starts_with(mark)) {
        return Ok(Decoded::Unreadable(name));
    }
    let is_gzip = head.starts_with(GZIP);
    let whole = Cursor::new(head).chain(reader);
    Ok(Decoded::Text(if is_gzip {
        // A gzip file may be several ones in a row, as `cat a.gz b.gz` leaves it.
        Box::new(BufReader::new(MultiGzDecoder::new(whole)))
    } else {
        Box::new(whole)
    }))
}
