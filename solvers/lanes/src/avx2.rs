//! Backend with four lanes in 256-bit registers (AVX2). A value of its type `V3` exists only if the processor has AVX2.

use crate::{FourLanes, LANES, Lanes, Quad, WIDEST};
use pulp::x86::V3;
use std::arch::x86_64::{__m256d, _CMP_LT_OQ};

impl Lanes for V3 {
    type Register = __m256d;
    type Mask = __m256d;
    const WIDTH: usize = LANES;

    #[inline(always)]
    fn splat(self, value: f64) -> __m256d {
        self.avx._mm256_set1_pd(value)
    }
    #[inline(always)]
    fn load(self, &[a, b, c, d, ..]: &[f64; WIDEST]) -> __m256d {
        pulp::cast([a, b, c, d])
    }
    #[inline(always)]
    fn store(self, register: __m256d) -> [f64; WIDEST] {
        let [a, b, c, d] = pulp::cast(register);
        [a, b, c, d, 0.0, 0.0, 0.0, 0.0]
    }
    crate::arithmetic!(avx: add _mm256_add_pd, sub _mm256_sub_pd, mul _mm256_mul_pd, div _mm256_div_pd);
    #[inline(always)]
    fn sqrt(self, a: __m256d) -> __m256d {
        self.avx._mm256_sqrt_pd(a)
    }
    #[inline(always)]
    fn below(self, a: __m256d, b: __m256d) -> __m256d {
        self.avx._mm256_cmp_pd::<_CMP_LT_OQ>(a, b)
    }
    #[inline(always)]
    fn choose(self, mask: __m256d, yes: __m256d, no: __m256d) -> __m256d {
        self.avx._mm256_blendv_pd(no, yes, mask)
    }
    #[inline(always)]
    fn bits(self, mask: __m256d) -> u32 {
        self.avx._mm256_movemask_pd(mask).cast_unsigned()
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], number: usize, at: &[usize; WIDEST]) -> [__m256d; 4] {
        let rows = [
            pulp::cast(table[at[0]][number].0),
            pulp::cast(table[at[1]][number].0),
            pulp::cast(table[at[2]][number].0),
            pulp::cast(table[at[3]][number].0),
        ];
        turned(self, rows)
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        number: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [__m256d; 4] {
        let rows = [
            less(self, table[from[0]][number], table[to[0]][number]),
            less(self, table[from[1]][number], table[to[1]][number]),
            less(self, table[from[2]][number], table[to[2]][number]),
            less(self, table[from[3]][number], table[to[3]][number]),
        ];
        turned(self, rows)
    }
    #[inline(always)]
    fn pack(self, integers: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        let places = PLACES[(bits & 255) as usize];
        pulp::cast(self.avx2._mm256_permutevar8x32_epi32(pulp::cast(*integers), pulp::cast(places)))
    }
    #[inline(always)]
    fn quads(self, registers: [__m256d; 4]) -> [Quad; WIDEST] {
        let ([a, b, c, d], none) = (turned(self, registers), Quad::default());
        let quad = |row| Quad(pulp::cast(row));
        [quad(a), quad(b), quad(c), quad(d), none, none, none, none]
    }
    crate::pairs_of_quads!();
}

/// Returns the difference `to` − `from` of two quads. The fourth number is the sum instead.
#[inline(always)]
fn less(lanes: V3, from: Quad, to: Quad) -> __m256d {
    let (from, to): (__m256d, __m256d) = (pulp::cast(from.0), pulp::cast(to.0));
    lanes.avx._mm256_blend_pd::<0b1000>(lanes.avx._mm256_sub_pd(to, from), lanes.avx._mm256_add_pd(to, from))
}

/// Transposes four registers.
#[inline(always)]
fn turned(lanes: V3, [a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    let avx = lanes.avx;
    let [even_ab, odd_ab] = [avx._mm256_unpacklo_pd(a, b), avx._mm256_unpackhi_pd(a, b)];
    let [even_cd, odd_cd] = [avx._mm256_unpacklo_pd(c, d), avx._mm256_unpackhi_pd(c, d)];
    [
        avx._mm256_permute2f128_pd::<0x20>(even_ab, even_cd),
        avx._mm256_permute2f128_pd::<0x20>(odd_ab, odd_cd),
        avx._mm256_permute2f128_pd::<0x31>(even_ab, even_cd),
        avx._mm256_permute2f128_pd::<0x31>(odd_ab, odd_cd),
    ]
}

impl FourLanes for V3 {
    #[inline(always)]
    fn register(self, [a, b, c, d]: [f64; LANES]) -> __m256d {
        self.avx._mm256_setr_pd(a, b, c, d)
    }
    #[inline(always)]
    fn values(self, register: __m256d) -> [f64; LANES] {
        pulp::cast(register)
    }
    #[inline(always)]
    fn sums(self, [a, b, c, d]: [__m256d; LANES]) -> [f64; LANES] {
        // a₀+a₁, b₀+b₁, a₂+a₃, b₂+b₃, and likewise for c and d.
        let [ab, cd] = [self.avx._mm256_hadd_pd(a, b), self.avx._mm256_hadd_pd(c, d)];
        let crossed = self.avx._mm256_permute2f128_pd::<0x21>(ab, cd);
        self.values(self.add(self.avx._mm256_blend_pd::<0b1100>(ab, cd), crossed))
    }
}

/// Lanes whose bit is set, in order, for each pattern of eight bits. The remaining entries are zero.
static PLACES: [[u32; WIDEST]; 256] = {
    let mut all = [[0; WIDEST]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < WIDEST {
            if bits >> lane & 1 == 1 {
                all[bits][count] = lane as u32;
                count += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    all
};
