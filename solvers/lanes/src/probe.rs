//! What this processor does at most on one thread, to measure loops by: numbers streamed through memory, and arithmetic in
//! registers.

use crate::{Kernel, Lanes, Number, Processor, Quad, Wide};

/// Bytes that [`stream`] reads and writes for each quad.
pub const BYTES_OF_A_QUAD: usize = 3 * size_of::<Quad>();

/// Adds quads to others, one after the other: each is read with another and written back.
pub fn stream(to: &mut [Quad], from: &[Quad]) {
    to.iter_mut().zip(from).for_each(|(to, from)| to.add(from));
}

/// Multiplies and adds in registers, so many times over, as wide as the processor's are. Gives how many numbers were
/// multiplied or added, and a number that depends on all of them.
#[must_use]
pub fn compute(processor: Processor, times: u64) -> (u64, f64) {
    processor.run(Compute { times })
}

/// Sums in registers at the same time: enough for none to wait for the one before.
const CHAINS: usize = 12;

/// The loop of [`compute`].
struct Compute {
    times: u64,
}

impl Kernel for Compute {
    type Output = (u64, f64);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> (u64, f64) {
        let (less, more) = (Wide::splat(lanes, 0.999), Wide::splat(lanes, 1e-3));
        // From numbers that the compiler does not know, or it would know what comes of them.
        let mut chains = [Wide::splat(lanes, 0.0); CHAINS];
        for (number, chain) in chains.iter_mut().enumerate() {
            *chain = Wide::splat(lanes, std::hint::black_box(number as f64));
        }
        for _ in 0..self.times {
            for chain in &mut chains {
                *chain = *chain * less + more;
            }
        }
        let mut sum = Wide::splat(lanes, 0.0);
        for chain in chains {
            sum = sum + chain;
        }
        (2 * self.times * (CHAINS * L::WIDTH) as u64, sum.first())
    }
}
