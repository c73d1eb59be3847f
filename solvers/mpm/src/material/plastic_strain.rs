//! Plastic strain of a material point, or its absence.

use crate::off::Off;
use std::ops::Range;

/// Equivalent plastic strain ε_p of a material point, or its absence.
pub trait PlasticStrain: Copy {
    /// Those of a range of points, in a list that has none where no material yields.
    fn those_of(list: &mut [f64], range: Range<usize>) -> &mut [f64];
    /// That of a point, by its place in the list.
    fn read(list: &[f64], at: usize) -> Self;
    /// Puts it back there.
    fn write(self, list: &mut [f64], at: usize);
    /// ε_p; zero where it is absent.
    fn value(self) -> f64;
}

impl PlasticStrain for f64 {
    #[inline(always)]
    fn those_of(list: &mut [f64], range: Range<usize>) -> &mut [f64] {
        &mut list[range]
    }
    #[inline(always)]
    fn read(list: &[f64], at: usize) -> Self {
        list[at]
    }
    #[inline(always)]
    fn write(self, list: &mut [f64], at: usize) {
        list[at] = self;
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

impl PlasticStrain for Off {
    #[inline(always)]
    fn those_of(_list: &mut [f64], _range: Range<usize>) -> &mut [f64] {
        &mut []
    }
    #[inline(always)]
    fn read(_list: &[f64], _at: usize) -> Self {
        Self
    }
    #[inline(always)]
    fn write(self, _list: &mut [f64], _at: usize) {}
    #[inline(always)]
    fn value(self) -> f64 {
        0.0
    }
}
