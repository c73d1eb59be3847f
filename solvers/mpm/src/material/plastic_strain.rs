//! Equivalent plastic strain of a material point, as a number or as an absent effect.

use crate::off::AbsentEffect;
use std::ops::Range;

/// Equivalent plastic strain ε_p of a material point: `f64`, or [`AbsentEffect`] for laws without yielding.
pub trait PlasticStrain: Copy {
    /// Returns the values of a range of points; an empty slice for laws without yielding.
    fn those_of(list: &mut [f64], range: Range<usize>) -> &mut [f64];
    /// Reads the value of a point by its index in the list.
    fn read(list: &[f64], at: usize) -> Self;
    /// Writes the value of a point to the list.
    fn write(self, list: &mut [f64], at: usize);
    /// Returns ε_p; zero if it is absent.
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

impl PlasticStrain for AbsentEffect {
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
