//! One lane: a number by itself, on any processor.

use crate::{Lanes, Quad, WIDEST};

/// One number at a time.
#[derive(Clone, Copy, Debug)]
pub struct Single;

impl Lanes for Single {
    type Register = f64;
    type Mask = bool;
    type Pair = [Quad; 2];
    const WIDTH: usize = 1;

    #[inline(always)]
    fn splat(self, value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn load(self, from: &[f64; WIDEST]) -> f64 {
        from[0]
    }
    #[inline(always)]
    fn store(self, of: f64) -> [f64; WIDEST] {
        [of, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }
    #[inline(always)]
    fn add(self, a: f64, b: f64) -> f64 {
        a + b
    }
    #[inline(always)]
    fn sub(self, a: f64, b: f64) -> f64 {
        a - b
    }
    #[inline(always)]
    fn mul(self, a: f64, b: f64) -> f64 {
        a * b
    }
    #[inline(always)]
    fn div(self, a: f64, b: f64) -> f64 {
        a / b
    }
    #[inline(always)]
    fn sqrt(self, a: f64) -> f64 {
        a.sqrt()
    }
    #[inline(always)]
    fn below(self, a: f64, b: f64) -> bool {
        a < b
    }
    #[inline(always)]
    fn choose(self, mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn bits(self, mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], of: usize, at: &[usize; WIDEST]) -> [f64; 4] {
        table[at[0]][of].0
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        of: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [f64; 4] {
        less(&table[from[0]][of], &table[to[0]][of])
    }
    #[inline(always)]
    fn pack(self, of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        packed(of, bits)
    }
    #[inline(always)]
    fn quads(self, of: [f64; 4]) -> [Quad; WIDEST] {
        let none = Quad::default();
        [Quad(of), none, none, none, none, none, none, none]
    }
    #[inline(always)]
    fn pairs(self, of: [[f64; 4]; 2]) -> [[Quad; 2]; WIDEST] {
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

/// A quad less another; of the fourth numbers the sum.
#[inline(always)]
pub(crate) const fn less(Quad(from): &Quad, Quad(to): &Quad) -> [f64; 4] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] + from[3]]
}

/// The whole numbers whose bit is set, first.
#[inline(always)]
pub(crate) fn packed(of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
    let (mut all, mut count) = ([0; WIDEST], 0);
    for (lane, &value) in of.iter().enumerate() {
        // Each is written, and the next over it where it was not wanted: no branch to foretell.
        all[count % WIDEST] = value;
        count += (bits >> lane & 1) as usize;
    }
    all
}
