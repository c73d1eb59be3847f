//! SIMD computation with identical results on all processors. Code is written once for a [`Number`]. Loops process
//! points or contacts one by one, four by four or eight by eight, with vector instructions if the processor has them.
//!
//! Every operation acts on each lane separately and is rounded once. Sums over lanes have a fixed order. Results are
//! thus equal bit for bit on all processors. For this reason, operations are not fused and loops are not reordered. The
//! crate has its own [`logarithm`], because results of the system library's logarithm depend on the processor.
//!
//! The crate also provides the threads of a run ([`Team`]). The distribution of work among threads does not affect the
//! results.
//!
//! All code that computes with lanes is inlined into the loop that is compiled for a processor. Closures may not be
//! inlined, and then every operation would be a call. Closures are thus used only for lookups.

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

pub use number::{Number, SimdPack};
pub use plain::ScalarBackend;
pub use processor::{FourKernel, Kernel, PROCESSOR, Processor};
pub use team::{Team, take_off};

use serde::{Deserialize, Serialize};

/// Number of lanes of a 256-bit register.
pub const LANES: usize = 4;
/// Number of lanes of the widest register (512 bits).
pub const WIDEST: usize = 8;

/// Four numbers that are loaded together into a 256-bit register.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(align(32))]
pub struct Quad(pub [f64; 4]);

impl Quad {
    /// Adds another quad.
    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        self.0 = [a + e, b + f, c + g, d + h];
    }

    /// Subtracts another quad.
    #[inline(always)]
    pub fn subtract(&mut self, other: &Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        self.0 = [a - e, b - f, c - g, d - h];
    }
}

/// Operations on registers of several numbers.
pub trait Lanes: Copy + 'static {
    /// Register with one number per lane.
    type Register: Copy;
    /// Mask with one flag per lane.
    type Mask: Copy;
    /// Pair of quads, one from each of two sets of four registers.
    type Pair: Copy;
    /// Numbers per register.
    const WIDTH: usize;

    /// Returns the same number in every lane.
    fn splat(self, value: f64) -> Self::Register;
    /// Loads the first numbers of `from`, one per lane.
    fn load(self, from: &[f64; WIDEST]) -> Self::Register;
    /// Returns the number of each lane at the start of an array. The remaining entries are zero.
    fn store(self, register: Self::Register) -> [f64; WIDEST];
    /// Returns `a + b`.
    fn add(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns `a − b`.
    fn sub(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns `a b`.
    fn mul(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns `a / b`.
    fn div(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns `√a`.
    fn sqrt(self, a: Self::Register) -> Self::Register;
    /// Returns the mask of `a < b`.
    fn below(self, a: Self::Register, b: Self::Register) -> Self::Mask;
    /// Returns `yes` where the mask is set, otherwise `no`.
    fn choose(self, mask: Self::Mask, yes: Self::Register, no: Self::Register) -> Self::Register;
    /// Returns the mask as bits, with the first lane as the lowest bit.
    fn bits(self, mask: Self::Mask) -> u32;
    /// Gathers quad `number` of the table entries at the first indices of `at`, and transposes these quads. The first
    /// register holds the first number of every quad, the second register the second number, and so on.
    fn gather<const N: usize>(self, table: &[[Quad; N]], number: usize, at: &[usize; WIDEST]) -> [Self::Register; 4];
    /// Returns the differences `to` − `from` between quad `number` of the table entries at the first indices of `to` and of
    /// `from`, transposed as in [`gather`](Self::gather). The fourth register holds sums instead of differences.
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        number: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [Self::Register; 4];
    /// Moves the integers whose bit is set to the front, in their order. The remaining entries are unspecified. The
    /// lowest bit belongs to the first integer.
    fn pack(self, integers: &[u32; WIDEST], bits: u32) -> [u32; WIDEST];
    /// Reverses [`gather`](Self::gather): returns one quad per lane at the start of an array.
    fn quads(self, registers: [Self::Register; 4]) -> [Quad; WIDEST];
    /// Transposes two sets of four registers: returns a pair of quads per lane, one quad from each set.
    fn pairs(self, registers: [[Self::Register; 4]; 2]) -> [Self::Pair; WIDEST];
    /// Adds a pair of quads to two quads.
    fn add_to(self, quads: &mut [Quad; 2], pair: Self::Pair);
    /// Subtracts the first quad of a pair from the first of two quads, and adds the second quad to the second.
    fn oppose(self, quads: &mut [Quad; 2], pair: Self::Pair);
}

/// Implements the arithmetic of [`Lanes`] by instructions of the processor.
#[cfg(target_arch = "x86_64")]
macro_rules! arithmetic {
    ($features:ident: $($name:ident $instruction:ident),*) => {
        $(#[inline(always)]
        fn $name(self, a: Self::Register, b: Self::Register) -> Self::Register {
            self.$features.$instruction(a, b)
        })*
    };
}
#[cfg(target_arch = "x86_64")]
use arithmetic;

/// Implements the pairs of [`Lanes`] for backends that add a pair of quads one by one.
macro_rules! pairs_of_quads {
    () => {
        type Pair = [Quad; 2];

        #[inline(always)]
        fn pairs(self, [one, other]: [[Self::Register; 4]; 2]) -> [[Quad; 2]; WIDEST] {
            let [a, b, c, d, e, f, g, h] = self.quads(one);
            let [i, j, k, l, m, n, o, p] = self.quads(other);
            [[a, i], [b, j], [c, k], [d, l], [e, m], [f, n], [g, o], [h, p]]
        }
        #[inline(always)]
        fn add_to(self, [one, other]: &mut [Quad; 2], pair: [Quad; 2]) {
            one.add(&pair[0]);
            other.add(&pair[1]);
        }
        #[inline(always)]
        fn oppose(self, [one, other]: &mut [Quad; 2], pair: [Quad; 2]) {
            one.subtract(&pair[0]);
            other.add(&pair[1]);
        }
    };
}
use pairs_of_quads;

/// Operations with exactly four lanes.
pub trait FourLanes: Lanes {
    /// Returns a register with these numbers.
    fn register(self, values: [f64; LANES]) -> Self::Register;
    /// Returns the numbers of a register.
    fn values(self, register: Self::Register) -> [f64; LANES];
    /// Returns the sums over the lanes of four registers, (a₀ + a₁) + (a₂ + a₃).
    fn sums(self, registers: [Self::Register; LANES]) -> [f64; LANES];
}

#[cfg(test)]
mod tests;
