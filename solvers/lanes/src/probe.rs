//! Benchmark kernels for the peak performance of this processor on one thread: memory bandwidth, and arithmetic in
//! registers. The peak is a reference for other loops.

use crate::{Kernel, Lanes, Number, Processor, Quad, SimdPack};

/// Bytes that [`stream`] reads and writes per quad.
pub const BYTES_OF_A_QUAD: usize = 3 * size_of::<Quad>();

/// Adds each quad of `from` to the quad of `to` with the same index. For each quad, two quads are read and one is
/// written.
pub fn stream(to: &mut [Quad], from: &[Quad]) {
    to.iter_mut().zip(from).for_each(|(to, from)| to.add(from));
}

/// Multiplies and adds `times` times in the registers of a processor. Returns the number of multiplications and
/// additions, and a sum of the results. The sum keeps the compiler from removing the loop.
#[must_use]
pub fn compute(processor: Processor, times: u64) -> (u64, f64) {
    processor.run(Compute { times })
}

/// Number of independent chains of operations, so that no operation waits for the previous one.
const CHAINS: usize = 12;

/// Kernel of [`compute`].
struct Compute {
    times: u64,
}

impl Kernel for Compute {
    type Output = (u64, f64);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> (u64, f64) {
        let (less, more) = (SimdPack::splat(lanes, 0.999), SimdPack::splat(lanes, 1e-3));
        // The initial numbers are unknown to the compiler, so it cannot compute the result in advance.
        let mut chains = [SimdPack::splat(lanes, 0.0); CHAINS];
        for (number, chain) in chains.iter_mut().enumerate() {
            *chain = SimdPack::splat(lanes, std::hint::black_box(number as f64));
        }
        for _ in 0..self.times {
            for chain in &mut chains {
                *chain = *chain * less + more;
            }
        }
        let mut sum = SimdPack::splat(lanes, 0.0);
        for chain in chains {
            sum = sum + chain;
        }
        (2 * self.times * (CHAINS * L::WIDTH) as u64, sum.first())
    }
}
