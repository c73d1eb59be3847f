//! Lanes that any processor has: numbers in a row.

use crate::{FourLanes, LANES, Lanes, Quad, WIDEST};

/// So many numbers in a row, one or four.
#[derive(Clone, Copy, Debug)]
pub struct Plain<const WIDTH: usize>;

/// An answer as bits, so that it picks a number without a branch: all of them, or none.
#[inline(always)]
const fn all_bits(yes: bool) -> u64 {
    if yes { u64::MAX } else { 0 }
}

impl<const WIDTH: usize> Lanes for Plain<WIDTH> {
    type Register = [f64; WIDTH];
    type Mask = [u64; WIDTH];
    type Pair = [Quad; 2];
    const WIDTH: usize = WIDTH;

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; WIDTH] {
        [value; WIDTH]
    }
    #[inline(always)]
    fn load(self, from: &[f64; WIDEST]) -> [f64; WIDTH] {
        let mut of = [0.0; WIDTH];
        of.copy_from_slice(&from[..WIDTH]);
        of
    }
    #[inline(always)]
    fn store(self, of: [f64; WIDTH]) -> [f64; WIDEST] {
        let mut row = [0.0; WIDEST];
        row[..WIDTH].copy_from_slice(&of);
        row
    }
    #[inline(always)]
    fn add(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = a;
        for lane in 0..WIDTH {
            of[lane] = a[lane] + b[lane];
        }
        of
    }
    #[inline(always)]
    fn sub(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = a;
        for lane in 0..WIDTH {
            of[lane] = a[lane] - b[lane];
        }
        of
    }
    #[inline(always)]
    fn mul(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = a;
        for lane in 0..WIDTH {
            of[lane] = a[lane] * b[lane];
        }
        of
    }
    #[inline(always)]
    fn div(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = a;
        for lane in 0..WIDTH {
            of[lane] = a[lane] / b[lane];
        }
        of
    }
    #[inline(always)]
    fn sqrt(self, a: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = a;
        for lane in 0..WIDTH {
            of[lane] = a[lane].sqrt();
        }
        of
    }
    #[inline(always)]
    fn below(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [u64; WIDTH] {
        let mut of = [0; WIDTH];
        for lane in 0..WIDTH {
            of[lane] = all_bits(a[lane] < b[lane]);
        }
        of
    }
    #[inline(always)]
    fn choose(self, mask: [u64; WIDTH], yes: [f64; WIDTH], no: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut of = yes;
        for lane in 0..WIDTH {
            of[lane] = f64::from_bits(yes[lane].to_bits() & mask[lane] | no[lane].to_bits() & !mask[lane]);
        }
        of
    }
    #[inline(always)]
    fn bits(self, mask: [u64; WIDTH]) -> u32 {
        let mut bits = 0;
        for (lane, each) in mask.into_iter().enumerate() {
            bits |= (each as u32 & 1) << lane;
        }
        bits
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], of: usize, at: &[usize; WIDEST]) -> [[f64; WIDTH]; 4] {
        let mut rows = [[0.0; 4]; WIDTH];
        for lane in 0..WIDTH {
            rows[lane] = table[at[lane]][of].0;
        }
        turned(rows)
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        of: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [[f64; WIDTH]; 4] {
        let mut rows = [[0.0; 4]; WIDTH];
        for lane in 0..WIDTH {
            rows[lane] = less(&table[from[lane]][of], &table[to[lane]][of]);
        }
        turned(rows)
    }
    #[inline(always)]
    fn pack(self, of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        packed(of, bits)
    }
    #[inline(always)]
    fn quads(self, of: [[f64; WIDTH]; 4]) -> [Quad; WIDEST] {
        let mut quads = [Quad::default(); WIDEST];
        for lane in 0..WIDTH {
            quads[lane] = Quad([of[0][lane], of[1][lane], of[2][lane], of[3][lane]]);
        }
        quads
    }
    #[inline(always)]
    fn pairs(self, of: [[[f64; WIDTH]; 4]; 2]) -> [[Quad; 2]; WIDEST] {
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

/// Columns for rows.
#[inline(always)]
fn turned<const WIDTH: usize>(rows: [[f64; 4]; WIDTH]) -> [[f64; WIDTH]; 4] {
    let mut columns = [[0.0; WIDTH]; 4];
    for row in 0..WIDTH {
        for column in 0..4 {
            columns[column][row] = rows[row][column];
        }
    }
    columns
}

impl FourLanes for Plain<LANES> {
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

/// A quad less another; of the fourth numbers the sum.
#[inline(always)]
const fn less(Quad(from): &Quad, Quad(to): &Quad) -> [f64; 4] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] + from[3]]
}

/// The whole numbers whose bit is set, first.
#[inline(always)]
fn packed(of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
    let (mut all, mut count) = ([0; WIDEST], 0);
    for (lane, &value) in of.iter().enumerate() {
        // Each is written, and the next over it where it was not wanted: no branch to foretell.
        all[count % WIDEST] = value;
        count += (bits >> lane & 1) as usize;
    }
    all
}
