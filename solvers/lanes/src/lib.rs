//! Numbers several at a time. A law is written once, for a [`Number`]; loops take points or contacts one by one, four by
//! four or eight by eight, with vector instructions where the processor has them.
//!
//! Every operation is that of each lane by itself, rounded once, and sums over lanes have one order: the same bits on
//! all processors. So nothing is fused, and no loop is left to the compiler to reorder. [`logarithm`] is here for the same
//! reason: that of a system's library depends on the processor.
//!
//! And the threads of one run stand here ([`Team`]): who computes what never shows in the numbers either.
//!
//! Whatever computes with lanes is inlined into the loop that is compiled for the processor. Closures may not be, and
//! then every operation is a call: there are none, but those that only look something up.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
pub mod logarithm;
mod number;
mod plain;
pub mod probe;
mod processor;
mod team;

pub use number::{Number, Wide};
pub use plain::Plain;
pub use processor::{FourKernel, Kernel, PROCESSOR, Processor};
pub use team::{Team, take_off};

use serde::{Deserialize, Serialize};

/// Lanes of a register of four.
pub const LANES: usize = 4;
/// Lanes of the widest register.
pub const WIDEST: usize = 8;

/// Four numbers that are loaded together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(align(32))]
pub struct Quad(pub [f64; 4]);

impl Quad {
    /// Adds to each of its numbers.
    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        self.0 = [a + e, b + f, c + g, d + h];
    }

    /// Subtracts from each of its numbers.
    #[inline(always)]
    pub fn subtract(&mut self, other: &Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        self.0 = [a - e, b - f, c - g, d - h];
    }
}

/// What computes with registers of several numbers.
pub trait Lanes: Copy + 'static {
    /// So many numbers.
    type Register: Copy;
    /// So many answers.
    type Mask: Copy;
    /// Two quads together.
    type Pair: Copy;
    /// Numbers in a register.
    const WIDTH: usize;

    /// The same number in every lane.
    fn splat(self, value: f64) -> Self::Register;
    /// The first numbers of a row, one for each lane.
    fn load(self, from: &[f64; WIDEST]) -> Self::Register;
    /// The number in each lane, into the first of a row.
    fn store(self, of: Self::Register) -> [f64; WIDEST];
    /// `a + b`.
    fn add(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a − b`.
    fn sub(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a b`.
    fn mul(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a / b`.
    fn div(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `√a`.
    fn sqrt(self, a: Self::Register) -> Self::Register;
    /// Where `a < b`.
    fn below(self, a: Self::Register, b: Self::Register) -> Self::Mask;
    /// `yes` where it is so, else `no`.
    fn choose(self, mask: Self::Mask, yes: Self::Register, no: Self::Register) -> Self::Register;
    /// The answers as bits, that of the first lane lowest.
    fn bits(self, mask: Self::Mask) -> u32;
    /// The quads of a table whose entries have several, those of a number at the first places of `at`, turned: the first
    /// numbers of all in one register, and so on.
    fn gather<const N: usize>(self, table: &[[Quad; N]], of: usize, at: &[usize; WIDEST]) -> [Self::Register; 4];
    /// The quads at the first places of `to` less those at `from`, turned as [`gather`](Self::gather) turns them; of the fourth
    /// numbers the sum.
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        of: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [Self::Register; 4];
    /// The whole numbers whose bit is set, first, in their order; what follows them is not said. The first bit is lowest.
    fn pack(self, of: &[u32; WIDEST], bits: u32) -> [u32; WIDEST];
    /// The opposite of [`gather`](Self::gather): a quad for each lane, in the first of a row.
    fn quads(self, of: [Self::Register; 4]) -> [Quad; WIDEST];
    /// The same of two: two quads for each lane.
    fn pairs(self, of: [[Self::Register; 4]; 2]) -> [Self::Pair; WIDEST];
    /// Adds to each number of two quads.
    fn add_to(self, quads: &mut [Quad; 2], pair: Self::Pair);
    /// Subtracts from each number of the first quad, and adds to those of the second.
    fn oppose(self, quads: &mut [Quad; 2], pair: Self::Pair);
}

/// Two quads for each lane, from those of one and of the other.
#[inline(always)]
fn paired([a, b, c, d, e, f, g, h]: [Quad; WIDEST], [i, j, k, l, m, n, o, p]: [Quad; WIDEST]) -> [[Quad; 2]; WIDEST] {
    [[a, i], [b, j], [c, k], [d, l], [e, m], [f, n], [g, o], [h, p]]
}

/// Adds to each number of two quads.
#[inline(always)]
fn add_both([one, other]: &mut [Quad; 2], pair: [Quad; 2]) {
    one.add(&pair[0]);
    other.add(&pair[1]);
}

/// Subtracts from each number of the first quad, and adds to those of the second.
#[inline(always)]
fn oppose_both([one, other]: &mut [Quad; 2], pair: [Quad; 2]) {
    one.subtract(&pair[0]);
    other.add(&pair[1]);
}

/// What computes with four lanes.
pub trait FourLanes: Lanes {
    /// A number for each lane.
    fn of(self, values: [f64; LANES]) -> Self::Register;
    /// The number in each lane.
    fn values(self, of: Self::Register) -> [f64; LANES];
    /// The sums over the lanes of four registers, (a₀ + a₁) + (a₂ + a₃).
    fn sums(self, of: [Self::Register; LANES]) -> [f64; LANES];
}

#[cfg(test)]
mod tests;
