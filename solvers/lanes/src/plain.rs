//! Portable backend: lanes as an array of numbers.

use crate::{FourLanes, LANES, Lanes, Quad, WIDEST};

/// Portable backend. Its registers are arrays of `WIDTH` numbers, one or four.
#[derive(Clone, Copy, Debug)]
pub struct ScalarBackend<const WIDTH: usize>;

/// Repeats an expression for each lane, for at most four lanes. The repetitions are written out. Otherwise the compiler
/// would have to unroll a loop for every operation in every kernel.
macro_rules! each {
    ($lane:ident of $count:expr => $do:expr) => {{
        const { assert!($count <= LANES) };
        each!(@ 0, $lane of $count => $do);
        each!(@ 1, $lane of $count => $do);
        each!(@ 2, $lane of $count => $do);
        each!(@ 3, $lane of $count => $do);
    }};
    (@ $number:literal, $lane:ident of $count:expr => $do:expr) => {
        if $number < $count {
            let $lane: usize = $number;
            $do;
        }
    };
}

/// Arithmetic of two registers, lane by lane.
macro_rules! lane_by_lane {
    ($($name:ident $operator:tt);*) => {
        $(#[inline(always)]
        fn $name(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
            let mut result = a;
            each!(lane of WIDTH => result[lane] = a[lane] $operator b[lane]);
            result
        })*
    };
}

/// Returns a flag as a mask with all bits set or no bit set, so that a number can be selected without a branch.
#[inline(always)]
const fn all_bits(yes: bool) -> u64 {
    if yes { u64::MAX } else { 0 }
}

/// Returns `yes` if all bits of `mask` are set, and `no` if no bit is set.
#[inline(always)]
const fn chosen(mask: u64, yes: f64, no: f64) -> f64 {
    f64::from_bits(yes.to_bits() & mask | no.to_bits() & !mask)
}

impl<const WIDTH: usize> Lanes for ScalarBackend<WIDTH> {
    type Register = [f64; WIDTH];
    type Mask = [u64; WIDTH];
    const WIDTH: usize = WIDTH;

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; WIDTH] {
        [value; WIDTH]
    }
    #[inline(always)]
    fn load(self, from: &[f64; WIDEST]) -> [f64; WIDTH] {
        let mut register = [0.0; WIDTH];
        register.copy_from_slice(&from[..WIDTH]);
        register
    }
    #[inline(always)]
    fn store(self, register: [f64; WIDTH]) -> [f64; WIDEST] {
        let mut row = [0.0; WIDEST];
        row[..WIDTH].copy_from_slice(&register);
        row
    }
    lane_by_lane!(add +; sub -; mul *; div /);
    #[inline(always)]
    fn sqrt(self, a: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut result = a;
        each!(lane of WIDTH => result[lane] = a[lane].sqrt());
        result
    }
    #[inline(always)]
    fn below(self, a: [f64; WIDTH], b: [f64; WIDTH]) -> [u64; WIDTH] {
        let mut result = [0; WIDTH];
        each!(lane of WIDTH => result[lane] = all_bits(a[lane] < b[lane]));
        result
    }
    #[inline(always)]
    fn choose(self, mask: [u64; WIDTH], yes: [f64; WIDTH], no: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut result = yes;
        each!(lane of WIDTH => result[lane] = chosen(mask[lane], yes[lane], no[lane]));
        result
    }
    #[inline(always)]
    fn bits(self, mask: [u64; WIDTH]) -> u32 {
        let mut bits = 0;
        each!(lane of WIDTH => bits |= (mask[lane] as u32 & 1) << lane);
        bits
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], number: usize, at: &[usize; WIDEST]) -> [[f64; WIDTH]; 4] {
        let mut rows = [[0.0; 4]; WIDTH];
        each!(lane of WIDTH => rows[lane] = table[at[lane]][number].0);
        turned(rows)
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        number: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [[f64; WIDTH]; 4] {
        let mut rows = [[0.0; 4]; WIDTH];
        each!(lane of WIDTH => rows[lane] = less(&table[from[lane]][number], &table[to[lane]][number]));
        turned(rows)
    }
    #[inline(always)]
    fn pack(self, integers: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        let (mut all, mut count) = ([0; WIDEST], 0);
        for (lane, &value) in integers.iter().enumerate() {
            // Every integer is written. If its bit is not set, the next integer overwrites it. This avoids an
            // unpredictable branch.
            all[count % WIDEST] = value;
            count += (bits >> lane & 1) as usize;
        }
        all
    }
    #[inline(always)]
    fn quads(self, rows: [[f64; WIDTH]; 4]) -> [Quad; WIDEST] {
        let mut quads = [Quad::default(); WIDEST];
        each!(lane of WIDTH => quads[lane] = Quad([rows[0][lane], rows[1][lane], rows[2][lane], rows[3][lane]]));
        quads
    }
    crate::pairs_of_quads!();
}

/// Transposes one quad per lane to four registers.
#[inline(always)]
fn turned<const WIDTH: usize>(rows: [[f64; 4]; WIDTH]) -> [[f64; WIDTH]; 4] {
    let mut columns = [[0.0; WIDTH]; 4];
    each!(row of WIDTH => each!(column of 4 => columns[column][row] = rows[row][column]));
    columns
}

impl FourLanes for ScalarBackend<LANES> {
    #[inline(always)]
    fn register(self, values: [f64; LANES]) -> [f64; LANES] {
        values
    }
    #[inline(always)]
    fn values(self, register: [f64; LANES]) -> [f64; LANES] {
        register
    }
    #[inline(always)]
    fn sums(self, registers: [[f64; LANES]; LANES]) -> [f64; LANES] {
        registers.map(|lanes| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]))
    }
}

/// Returns the difference `to` − `from` of two quads. The fourth number is the sum instead.
#[inline(always)]
const fn less(Quad(from): &Quad, Quad(to): &Quad) -> [f64; 4] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] + from[3]]
}
