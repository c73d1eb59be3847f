//! Search for numbers that are not finite in a value of any serialisable type.

use serde::ser::{
    self, Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use std::fmt::Display;

/// Returns true if all numbers in a value are finite.
#[must_use]
pub fn is_finite(value: &impl Serialize) -> bool {
    value.serialize(Search).is_ok()
}

/// Serialiser that visits all parts of a value and returns an error at the first number that is not finite.
struct Search;

/// Error: the value contains a number that is not finite.
#[derive(Debug, thiserror::Error)]
#[error("a number that is not finite")]
struct NonFiniteNumber;

impl ser::Error for NonFiniteNumber {
    fn custom<T: Display>(_: T) -> Self {
        Self
    }
}

type FiniteResult = Result<(), NonFiniteNumber>;

/// Serialiser methods for values without floating-point numbers.
macro_rules! passed_over {
    ($($method:ident($($kind:ty),*);)*) => {
        $(fn $method(self, $(_: $kind),*) -> FiniteResult { Ok(()) })*
    };
}

/// Serialiser methods for values with several parts, which are searched next.
macro_rules! entered {
    ($($method:ident($($kind:ty),*);)*) => {
        $(fn $method(self, $(_: $kind),*) -> Result<Self, NonFiniteNumber> { Ok(self) })*
    };
}

/// Implementations of serialiser traits for values with several parts, which may have names.
macro_rules! parts {
    ($($part:ident: $($method:ident($($name:ty)?)),*;)*) => {
        $(impl $part for Search {
            type Ok = ();
            type Error = NonFiniteNumber;
            $(fn $method<T: ?Sized + Serialize>(&mut self, $(_: $name,)? part: &T) -> FiniteResult {
                part.serialize(Search)
            })*
            fn end(self) -> FiniteResult { Ok(()) }
        })*
    };
}

parts! {
    SerializeSeq: serialize_element();
    SerializeTuple: serialize_element();
    SerializeTupleStruct: serialize_field();
    SerializeTupleVariant: serialize_field();
    SerializeMap: serialize_key(), serialize_value();
    SerializeStruct: serialize_field(&'static str);
    SerializeStructVariant: serialize_field(&'static str);
}

impl Serializer for Search {
    type Ok = ();
    type Error = NonFiniteNumber;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = Self;
    type SerializeStructVariant = Self;

    passed_over! {
        serialize_bool(bool);
        serialize_i8(i8);
        serialize_i16(i16);
        serialize_i32(i32);
        serialize_i64(i64);
        serialize_u8(u8);
        serialize_u16(u16);
        serialize_u32(u32);
        serialize_u64(u64);
        serialize_char(char);
        serialize_str(&str);
        serialize_bytes(&[u8]);
        serialize_none();
        serialize_unit();
        serialize_unit_struct(&'static str);
        serialize_unit_variant(&'static str, u32, &'static str);
    }

    fn serialize_f32(self, value: f32) -> FiniteResult {
        if value.is_finite() { Ok(()) } else { Err(NonFiniteNumber) }
    }

    fn serialize_f64(self, value: f64) -> FiniteResult {
        if value.is_finite() { Ok(()) } else { Err(NonFiniteNumber) }
    }

    fn serialize_some<T: ?Sized + Serialize>(self, value: &T) -> FiniteResult {
        value.serialize(self)
    }

    fn serialize_newtype_struct<T: ?Sized + Serialize>(self, _: &'static str, value: &T) -> FiniteResult {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> FiniteResult {
        value.serialize(self)
    }

    entered! {
        serialize_seq(Option<usize>);
        serialize_tuple(usize);
        serialize_tuple_struct(&'static str, usize);
        serialize_tuple_variant(&'static str, u32, &'static str, usize);
        serialize_map(Option<usize>);
        serialize_struct(&'static str, usize);
        serialize_struct_variant(&'static str, u32, &'static str, usize);
    }
}

#[cfg(test)]
mod tests {
    use super::is_finite;

    #[derive(serde::Serialize)]
    enum State {
        At { place: Option<[f64; 2]>, name: &'static str },
        Of(Vec<(u8, f32)>),
    }

    #[test]
    fn a_number_that_is_not_finite_is_found_wherever_it_is() {
        let at = |y: f64| State::At { place: Some([0.0, y]), name: "a" };
        assert!(is_finite(&vec![at(1.0), State::Of(vec![(1, 2.0)]), State::At { place: None, name: "" }]));
        for wrong in [at(f64::NAN), at(f64::INFINITY), State::Of(vec![(1, 2.0), (2, f32::NEG_INFINITY)])] {
            assert!(!is_finite(&[at(1.0), wrong]));
        }
    }
}
