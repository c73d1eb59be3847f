//! Detection of compression by the first bytes of a file, not by its name.

use std::io::{self, BufRead, Cursor, Read};

use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

const GZIP: &[u8] = &[0x1f, 0x8b];
const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

/// First bytes of unsupported files, and the text for the error message.
const UNREADABLE: [(&[u8], &str); 5] = [
    (&[0xfd, b'7', b'z', b'X', b'Z', 0], "a file compressed by xz (unpack it with `xz -dk`)"),
    (b"BZh", "a file compressed by bzip2 (unpack it with `bzip2 -dk`)"),
    (b"PK\x03\x04", "a file compressed by zip (unpack it with `unzip`)"),
    (b"\xf8\xff\xff\xff\xff\xff\xff\xffDUMPATOM", BINARY_DUMP),
    (b"\xf6\xff\xff\xff\xff\xff\xff\xffDUMPCUSTOM", BINARY_DUMP),
];
const BINARY_DUMP: &str =
    "a binary dump of LAMMPS (write it as text: a file name of `dump` that does not end in `.bin`)";

/// Length of the longest first bytes in [`UNREADABLE`] (B).
const MARK: u64 = 18;

/// Content of an input, or the name of its unsupported format.
pub(crate) type Decoded<'r> = Result<Box<dyn Read + 'r>, &'static str>;

/// Detects the format of `reader` from its first bytes, and decompresses gzip and zstd.
pub(crate) fn decoded<'r>(mut reader: impl BufRead + 'r) -> io::Result<Decoded<'r>> {
    let mut head = Vec::new();
    reader.by_ref().take(MARK).read_to_end(&mut head)?;
    if let Some((_, name)) = UNREADABLE.iter().find(|(mark, _)| head.starts_with(mark)) {
        return Ok(Err(*name));
    }
    let is = |mark: &[u8]| head.starts_with(mark);
    let (gzip, zstd) = (is(GZIP), is(ZSTD));
    let whole = Cursor::new(head).chain(reader);
    let content: Box<dyn Read + 'r> = if gzip {
        // A gzip file may be a sequence of gzip files, for example from `cat a.gz b.gz`.
        Box::new(MultiGzDecoder::new(whole))
    } else if zstd {
        Box::new(ZstdFrames { decoder: FrameDecoder::new(), source: whole, inside: false })
    } else {
        Box::new(whole)
    };
    Ok(Ok(content))
}

/// Reader of a zstd file, which may be a sequence of zstd frames.
struct ZstdFrames<R: BufRead> {
    decoder: FrameDecoder,
    source: R,
    inside: bool,
}

impl<R: BufRead> Read for ZstdFrames<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        loop {
            if !self.inside {
                if self.source.fill_buf()?.is_empty() {
                    return Ok(0);
                }
                match self.decoder.reset(&mut self.source) {
                    Ok(()) => self.inside = true,
                    Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame {
                        length, ..
                    })) => {
                        io::copy(&mut self.source.by_ref().take(u64::from(length)), &mut io::sink())?;
                        continue;
                    }
                    Err(error) => return Err(io::Error::new(io::ErrorKind::InvalidData, error)),
                }
            }
            let count = self.decoder.read(out)?;
            if count > 0 || out.is_empty() {
                return Ok(count);
            }
            if self.decoder.is_finished() {
                self.inside = false;
                continue;
            }
            let blocks = BlockDecodingStrategy::UptoBlocks(1);
            let decoded = self.decoder.decode_blocks(&mut self.source, blocks);
            decoded.map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
        }
    }
}
