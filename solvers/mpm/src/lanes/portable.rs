//! Lanes that any processor has.

use super::{LANES, Lanes};

/// Four numbers in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

/// An operation on each lane.
#[inline(always)]
fn each(a: [f64; LANES], b: [f64; LANES], operation: impl Fn(f64, f64) -> f64) -> [f64; LANES] {
    [operation(a[0], b[0]), operation(a[1], b[1]), operation(a[2], b[2]), operation(a[3], b[3])]
}

impl Lanes for Portable {
    type Register = [f64; LANES];

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; LANES] {
        [value; LANES]
    }
    #[inline(always)]
    fn of(self, values: [f64; LANES]) -> [f64; LANES] {
        values
    }
    #[inline(always)]
    fn values(self, of: [f64; LANES]) -> [f64; LANES] {
        of
    }
    #[inline(always)]
    fn add(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn pick(self, a: [f64; LANES], b: [f64; LANES], yes: [f64; LANES], no: [f64; LANES]) -> [f64; LANES] {
        let pick = |lane: usize| if a[lane] < b[lane] { yes[lane] } else { no[lane] };
        [pick(0), pick(1), pick(2), pick(3)]
    }
    #[inline(always)]
    fn sums(self, of: [[f64; LANES]; LANES]) -> [f64; LANES] {
        of.map(|lanes| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]))
    }
}
