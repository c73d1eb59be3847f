//! Number types in files of VTK and NumPy.

use crate::read::digits::Digits;

/// Number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    /// Returns the number type of a type name in a legacy VTK file.
    pub(crate) fn of_legacy(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "vtktypechar" => Self::I8,
            "unsigned_char" | "bit" => Self::U8,
            "short" => Self::I16,
            "unsigned_short" => Self::U16,
            "int" => Self::I32,
            "unsigned_int" => Self::U32,
            "long" | "vtktypeint64" | "vtkIdType" => Self::I64,
            "unsigned_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    /// Returns the number type of a type name in an XML file.
    pub(crate) fn of_xml(word: &str) -> Option<Self> {
        Some(match word {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    /// Returns the number type of a type name of NumPy, without its byte order.
    pub(crate) fn of_numpy(word: &str) -> Option<Self> {
        Some(match word {
            "i1" => Self::I8,
            "u1" | "b1" => Self::U8,
            "i2" => Self::I16,
            "u2" => Self::U16,
            "i4" => Self::I32,
            "u4" => Self::U32,
            "i8" => Self::I64,
            "u8" => Self::U64,
            "f4" => Self::F32,
            "f8" => Self::F64,
            _ => return None,
        })
    }

    /// Returns the size of a number (B).
    pub(crate) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Returns the digits of binary numbers of this type.
    pub(crate) fn digits(self) -> Digits {
        if self == Self::F32 { Digits::exact().single() } else { Digits::exact() }
    }

    /// Decodes numbers from bytes, whose count is a multiple of the size. `is_big` is true for big-endian numbers.
    pub(crate) fn decode(self, bytes: &[u8], is_big: bool) -> Vec<f64> {
        let one = |chunk: &[u8]| {
            let mut wide = [0_u8; 8];
            for (at, byte) in chunk.iter().enumerate() {
                wide[if is_big { chunk.len() - 1 - at } else { at }] = *byte;
            }
            let bits = u64::from_le_bytes(wide);
            match self {
                Self::I8 => f64::from(bits as u8 as i8),
                Self::I16 => f64::from(bits as u16 as i16),
                Self::I32 => f64::from(bits as u32 as i32),
                Self::I64 => bits as i64 as f64,
                Self::U8 | Self::U16 | Self::U32 | Self::U64 => bits as f64,
                Self::F32 => f64::from(f32::from_bits(bits as u32)),
                Self::F64 => f64::from_bits(bits),
            }
        };
        bytes.chunks_exact(self.size()).map(one).collect()
    }
}
