//! Types of binary numbers in files of VTK and NumPy.

use crate::read::digits::Digits;
use NumberKind::{Float, Signed, Unsigned};

/// Kind of a binary number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberKind {
    Signed,
    Unsigned,
    Float,
}

/// Type of a binary number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    kind: NumberKind,
    /// Size of a number (B).
    size: usize,
}

impl Number {
    pub(crate) const U32: Self = Self { kind: Unsigned, size: 4 };
    pub(crate) const U64: Self = Self { kind: Unsigned, size: 8 };

    /// Returns the number type of a kind and size (B), or `None` if there is no such type.
    pub(crate) fn new(kind: NumberKind, size: usize) -> Option<Self> {
        let sizes: &[usize] = if kind == Float { &[4, 8] } else { &[1, 2, 4, 8] };
        sizes.contains(&size).then_some(Self { kind, size })
    }

    /// Returns the number type of a type name in a legacy VTK file.
    pub(crate) fn of_legacy(word: &str) -> Option<Self> {
        let (kind, size) = match word {
            "char" | "vtktypechar" => (Signed, 1),
            "unsigned_char" | "bit" => (Unsigned, 1),
            "short" => (Signed, 2),
            "unsigned_short" => (Unsigned, 2),
            "int" => (Signed, 4),
            "unsigned_int" => (Unsigned, 4),
            "long" | "vtktypeint64" | "vtkIdType" => (Signed, 8),
            "unsigned_long" | "vtktypeuint64" => (Unsigned, 8),
            "float" => (Float, 4),
            "double" => (Float, 8),
            _ => return None,
        };
        Self::new(kind, size)
    }

    /// Returns the number type of a type name in an XML file, such as `UInt8`.
    pub(crate) fn of_xml(word: &str) -> Option<Self> {
        let kinds = [("Int", Signed), ("UInt", Unsigned), ("Float", Float)];
        let (kind, bits) = kinds.into_iter().find_map(|(name, kind)| Some((kind, word.strip_prefix(name)?)))?;
        let size = [("8", 1), ("16", 2), ("32", 4), ("64", 8)].into_iter().find(|(known, _)| *known == bits)?.1;
        Self::new(kind, size)
    }

    /// Returns the number type of a type name of NumPy, such as `u1`, without its byte order.
    pub(crate) fn of_numpy(word: &str) -> Option<Self> {
        let (letter, size) = word.split_at_checked(1)?;
        let size = [("1", 1), ("2", 2), ("4", 4), ("8", 8)].into_iter().find(|(known, _)| *known == size)?.1;
        match (letter, size) {
            ("i", _) => Self::new(Signed, size),
            ("u", _) | ("b", 1) => Self::new(Unsigned, size),
            ("f", _) => Self::new(Float, size),
            _ => None,
        }
    }

    pub(crate) const fn size(self) -> usize {
        self.size
    }

    /// Marks printed digits as single precision if the type is a float of four bytes.
    pub(crate) fn digits(self, printed: Digits) -> Digits {
        if (self.kind, self.size) == (Float, 4) { printed.single() } else { printed }
    }

    /// Decodes numbers from bytes, whose count is a multiple of the size. `is_big` is true for big-endian numbers.
    pub(crate) fn decode(self, bytes: &[u8], is_big: bool) -> Vec<f64> {
        let one = |chunk: &[u8]| {
            let mut wide = [0_u8; 8];
            for (at, byte) in chunk.iter().enumerate() {
                wide[if is_big { chunk.len() - 1 - at } else { at }] = *byte;
            }
            let bits = u64::from_le_bytes(wide);
            let unused = 64 - 8 * self.size;
            match (self.kind, self.size) {
                // The shifts extend the sign.
                (Signed, _) => ((bits << unused) as i64 >> unused) as f64,
                (Unsigned, _) => bits as f64,
                (Float, 4) => f64::from(f32::from_bits(bits as u32)),
                (Float, _) => f64::from_bits(bits),
            }
        };
        bytes.chunks_exact(self.size).map(one).collect()
    }
}
