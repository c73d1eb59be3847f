//! Lanes of 256-bit registers. Whether the processor has them is what holding the token means.

use super::{Kernel, LANES, Lanes};
use pulp::x86::V3;
use pulp::{Simd, WithSimd};
use std::arch::x86_64::{__m256d, _CMP_LT_OQ};

impl Lanes for V3 {
    type Register = __m256d;

    #[inline(always)]
    fn splat(self, value: f64) -> __m256d {
        self.avx._mm256_set1_pd(value)
    }
    #[inline(always)]
    fn of(self, [a, b, c, d]: [f64; LANES]) -> __m256d {
        self.avx._mm256_setr_pd(a, b, c, d)
    }
    #[inline(always)]
    fn values(self, of: __m256d) -> [f64; LANES] {
        pulp::cast(of)
    }
    #[inline(always)]
    fn add(self, a: __m256d, b: __m256d) -> __m256d {
        self.avx._mm256_add_pd(a, b)
    }
    #[inline(always)]
    fn sub(self, a: __m256d, b: __m256d) -> __m256d {
        self.avx._mm256_sub_pd(a, b)
    }
    #[inline(always)]
    fn mul(self, a: __m256d, b: __m256d) -> __m256d {
        self.avx._mm256_mul_pd(a, b)
    }
    #[inline(always)]
    fn div(self, a: __m256d, b: __m256d) -> __m256d {
        self.avx._mm256_div_pd(a, b)
    }
    #[inline(always)]
    fn pick(self, a: __m256d, b: __m256d, yes: __m256d, no: __m256d) -> __m256d {
        self.avx._mm256_blendv_pd(no, yes, self.avx._mm256_cmp_pd::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn sums(self, [a, b, c, d]: [__m256d; LANES]) -> [f64; LANES] {
        // a₀+a₁, b₀+b₁, a₂+a₃, b₂+b₃; and of the others.
        let [ab, cd] = [self.avx._mm256_hadd_pd(a, b), self.avx._mm256_hadd_pd(c, d)];
        let crossed = self.avx._mm256_permute2f128_pd::<0x21>(ab, cd);
        self.values(self.add(self.avx._mm256_blend_pd::<0b1100>(ab, cd), crossed))
    }
}

/// A loop, compiled for this processor.
struct Compiled<K> {
    features: V3,
    kernel: K,
}

impl<K: Kernel> WithSimd for Compiled<K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.kernel.run(self.features);
    }
}

/// Runs a loop on this processor.
#[inline(always)]
pub(super) fn run(features: V3, kernel: impl Kernel) {
    Simd::vectorize(features, Compiled { features, kernel });
}
