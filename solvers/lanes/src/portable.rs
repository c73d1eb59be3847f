//! Four lanes that any processor has.

use crate::single::less;
use crate::{FourLanes, LANES, Lanes, Quad, WIDEST};

/// Four numbers in a row.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

/// An operation on each lane.
#[inline(always)]
fn each<T>(a: [f64; LANES], b: [f64; LANES], operation: impl Fn(f64, f64) -> T) -> [T; LANES] {
    [operation(a[0], b[0]), operation(a[1], b[1]), operation(a[2], b[2]), operation(a[3], b[3])]
}

impl Lanes for Portable {
    type Register = [f64; LANES];
    type Mask = [bool; LANES];
    type Pair = [Quad; 2];
    const WIDTH: usize = LANES;

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; LANES] {
        [value; LANES]
    }
    #[inline(always)]
    fn load(self, &[a, b, c, d, ..]: &[f64; WIDEST]) -> [f64; LANES] {
        [a, b, c, d]
    }
    #[inline(always)]
    fn store(self, [a, b, c, d]: [f64; LANES]) -> [f64; WIDEST] {
        [a, b, c, d, 0.0, 0.0, 0.0, 0.0]
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
    fn sqrt(self, a: [f64; LANES]) -> [f64; LANES] {
        a.map(f64::sqrt)
    }
    #[inline(always)]
    fn below(self, a: [f64; LANES], b: [f64; LANES]) -> [bool; LANES] {
        each(a, b, |a, b| a < b)
    }
    #[inline(always)]
    fn choose(self, mask: [bool; LANES], yes: [f64; LANES], no: [f64; LANES]) -> [f64; LANES] {
        let pick = |lane: usize| if mask[lane] { yes[lane] } else { no[lane] };
        [pick(0), pick(1), pick(2), pick(3)]
    }
    #[inline(always)]
    fn bits(self, [a, b, c, d]: [bool; LANES]) -> u32 {
        u32::from(a) | u32::from(b) << 1 | u32::from(c) << 2 | u32::from(d) << 3
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], of: usize, at: &[usize; WIDEST]) -> [[f64; LANES]; 4] {
        turned([table[at[0]][of].0, table[at[1]][of].0, table[at[2]][of].0, table[at[3]][of].0])
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        of: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [[f64; LANES]; 4] {
        turned([
            less(&table[from[0]][of], &table[to[0]][of]),
            less(&table[from[1]][of], &table[to[1]][of]),
            less(&table[from[2]][of], &table[to[2]][of]),
            less(&table[from[3]][of], &table[to[3]][of]),
        ])
    }
    #[inline(always)]
    fn pack(self, of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        crate::single::packed(of, bits)
    }
    #[inline(always)]
    fn quads(self, of: [[f64; LANES]; 4]) -> [Quad; WIDEST] {
        let ([a, b, c, d], none) = (turned(of), Quad::default());
        [Quad(a), Quad(b), Quad(c), Quad(d), none, none, none, none]
    }
    #[inline(always)]
    fn pairs(self, of: [[[f64; LANES]; 4]; 2]) -> [[Quad; 2]; WIDEST] {
        crate::paired(self.quads(of[0]), self.quads(of[1]))
    }
    #[inline(always)]
    fn add_to(self, quads: &mut [Quad; 2], pair: [Quad; 2]) {
        crate::add_both(quads, pair);
    }
    #[inline(always)]
    fn oppose(self, quads: &mut [Quad; 2], pair: [Quad; 2]) {
        crate::oppose_both(quads, pair);
    }
}

/// Rows for columns.
#[inline(always)]
fn turned([a, b, c, d]: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    [[a[0], b[0], c[0], d[0]], [a[1], b[1], c[1], d[1]], [a[2], b[2], c[2], d[2]], [a[3], b[3], c[3], d[3]]]
}

impl FourLanes for Portable {
    #[inline(always)]
    fn of(self, values: [f64; LANES]) -> [f64; LANES] {
        values
    }
    #[inline(always)]
    fn values(self, of: [f64; LANES]) -> [f64; LANES] {
        of
    }
    #[inline(always)]
    fn sums(self, of: [[f64; LANES]; LANES]) -> [f64; LANES] {
        of.map(|lanes| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]))
    }
}
