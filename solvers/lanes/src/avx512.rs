//! Backend with eight lanes in 512-bit registers (AVX-512). A value of its type `V4` exists only if the processor has
//! AVX-512.

use crate::{Lanes, Quad, WIDEST};
use pulp::x86::V4;
use std::arch::x86_64::{__m256d, __m512d, __mmask8, _CMP_LT_OQ};

/// Returns two quads in a register.
#[inline(always)]
fn both(lanes: V4, low: Quad, high: Quad) -> __m512d {
    let [low, high]: [__m256d; 2] = [pulp::cast(low.0), pulp::cast(high.0)];
    lanes.avx512f._mm512_insertf64x4::<1>(lanes.avx512f._mm512_castpd256_pd512(low), high)
}

/// Returns the two quads of a register.
#[inline(always)]
fn split(register: __m512d) -> [Quad; 2] {
    let [low, high]: [[f64; 4]; 2] = pulp::cast(register);
    [Quad(low), Quad(high)]
}

/// Mask of the fourth numbers of two quads.
const FOURTH: __mmask8 = 0b1000_1000;

/// Mask of the sign bits of the first of two quads, to change the signs of its numbers.
const FIRST_OPPOSED: [u64; WIDEST] = [SIGN, SIGN, SIGN, SIGN, 0, 0, 0, 0];
/// Mask of the sign bit of a number.
const SIGN: u64 = 1 << 63;

/// Returns the quads of a table at eight indices, two per register: 0 and 2, 1 and 3, 4 and 6, 5 and 7. With this
/// order, the last step of the transposition puts the lanes in sequence.
#[inline(always)]
fn twos<const N: usize>(lanes: V4, table: &[[Quad; N]], number: usize, at: &[usize; WIDEST]) -> [__m512d; 4] {
    [
        both(lanes, table[at[0]][number], table[at[2]][number]),
        both(lanes, table[at[1]][number], table[at[3]][number]),
        both(lanes, table[at[4]][number], table[at[6]][number]),
        both(lanes, table[at[5]][number], table[at[7]][number]),
    ]
}

/// Returns the differences `to` − `from` of two pairs of quads. The fourth numbers of the quads are sums instead.
#[inline(always)]
fn less(lanes: V4, from: __m512d, to: __m512d) -> __m512d {
    lanes.avx512f._mm512_mask_add_pd(lanes.avx512f._mm512_sub_pd(to, from), FOURTH, to, from)
}

/// Transposes eight quads to four registers.
#[inline(always)]
fn turned(lanes: V4, [a, b, c, d]: [__m512d; 4]) -> [__m512d; 4] {
    let avx = lanes.avx512f;
    let [even_ab, odd_ab] = [avx._mm512_unpacklo_pd(a, b), avx._mm512_unpackhi_pd(a, b)];
    let [even_cd, odd_cd] = [avx._mm512_unpacklo_pd(c, d), avx._mm512_unpackhi_pd(c, d)];
    [
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(even_ab, even_cd),
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(odd_ab, odd_cd),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(even_ab, even_cd),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(odd_ab, odd_cd),
    ]
}

/// Returns both quads of each of four lanes. `[a, b]` hold the first and the last two numbers of the first quads;
/// `[c, d]` hold those of the second quads.
#[inline(always)]
fn in_pairs(lanes: V4, [a, b]: [__m512d; 2], [c, d]: [__m512d; 2]) -> [__m512d; 4] {
    let avx = lanes.avx512f;
    let [low, high] =
        [avx._mm512_shuffle_f64x2::<0b01_00_01_00>(a, b), avx._mm512_shuffle_f64x2::<0b11_10_11_10>(a, b)];
    let [other_low, other_high] =
        [avx._mm512_shuffle_f64x2::<0b01_00_01_00>(c, d), avx._mm512_shuffle_f64x2::<0b11_10_11_10>(c, d)];
    [
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(low, other_low),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(low, other_low),
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(high, other_high),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(high, other_high),
    ]
}

impl Lanes for V4 {
    type Register = __m512d;
    type Mask = __mmask8;
    type Pair = __m512d;
    const WIDTH: usize = WIDEST;

    #[inline(always)]
    fn splat(self, value: f64) -> __m512d {
        self.avx512f._mm512_set1_pd(value)
    }
    #[inline(always)]
    fn load(self, from: &[f64; WIDEST]) -> __m512d {
        pulp::cast(*from)
    }
    #[inline(always)]
    fn store(self, register: __m512d) -> [f64; WIDEST] {
        pulp::cast(register)
    }
    crate::arithmetic!(avx512f: add _mm512_add_pd, sub _mm512_sub_pd, mul _mm512_mul_pd, div _mm512_div_pd);
    #[inline(always)]
    fn sqrt(self, a: __m512d) -> __m512d {
        self.avx512f._mm512_sqrt_pd(a)
    }
    #[inline(always)]
    fn below(self, a: __m512d, b: __m512d) -> __mmask8 {
        self.avx512f._mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b)
    }
    #[inline(always)]
    fn choose(self, mask: __mmask8, yes: __m512d, no: __m512d) -> __m512d {
        self.avx512f._mm512_mask_blend_pd(mask, no, yes)
    }
    #[inline(always)]
    fn bits(self, mask: __mmask8) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn gather<const N: usize>(self, table: &[[Quad; N]], number: usize, at: &[usize; WIDEST]) -> [__m512d; 4] {
        turned(self, twos(self, table, number, at))
    }
    #[inline(always)]
    fn between<const N: usize>(
        self,
        table: &[[Quad; N]],
        number: usize,
        from: &[usize; WIDEST],
        to: &[usize; WIDEST],
    ) -> [__m512d; 4] {
        let (from, to) = (twos(self, table, number, from), twos(self, table, number, to));
        turned(
            self,
            [
                less(self, from[0], to[0]),
                less(self, from[1], to[1]),
                less(self, from[2], to[2]),
                less(self, from[3], to[3]),
            ],
        )
    }
    #[inline(always)]
    fn pack(self, integers: &[u32; WIDEST], bits: u32) -> [u32; WIDEST] {
        pulp::cast(self.avx512vl._mm256_maskz_compress_epi32(bits as __mmask8, pulp::cast(*integers)))
    }
    #[inline(always)]
    fn quads(self, [a, b, c, d]: [__m512d; 4]) -> [Quad; WIDEST] {
        let avx = self.avx512f;
        let [even_ab, odd_ab] = [avx._mm512_unpacklo_pd(a, b), avx._mm512_unpackhi_pd(a, b)];
        let [even_cd, odd_cd] = [avx._mm512_unpacklo_pd(c, d), avx._mm512_unpackhi_pd(c, d)];
        let [low, high] = [pulp::cast([0_u64, 1, 8, 9, 2, 3, 10, 11]), pulp::cast([4_u64, 5, 12, 13, 6, 7, 14, 15])];
        let [zero, two] = split(avx._mm512_permutex2var_pd(even_ab, low, even_cd));
        let [four, six] = split(avx._mm512_permutex2var_pd(even_ab, high, even_cd));
        let [one, three] = split(avx._mm512_permutex2var_pd(odd_ab, low, odd_cd));
        let [five, seven] = split(avx._mm512_permutex2var_pd(odd_ab, high, odd_cd));
        [zero, one, two, three, four, five, six, seven]
    }
    #[inline(always)]
    fn pairs(self, [[a, b, c, d], [e, f, g, h]]: [[__m512d; 4]; 2]) -> [__m512d; WIDEST] {
        let avx = self.avx512f;
        let [zero, two, four, six] = in_pairs(
            self,
            [avx._mm512_unpacklo_pd(a, b), avx._mm512_unpacklo_pd(c, d)],
            [avx._mm512_unpacklo_pd(e, f), avx._mm512_unpacklo_pd(g, h)],
        );
        let [one, three, five, seven] = in_pairs(
            self,
            [avx._mm512_unpackhi_pd(a, b), avx._mm512_unpackhi_pd(c, d)],
            [avx._mm512_unpackhi_pd(e, f), avx._mm512_unpackhi_pd(g, h)],
        );
        [zero, one, two, three, four, five, six, seven]
    }
    #[inline(always)]
    fn add_to(self, quads: &mut [Quad; 2], pair: __m512d) {
        let sum = self.avx512f._mm512_add_pd(both(self, quads[0], quads[1]), pair);
        *quads = split(sum);
    }
    #[inline(always)]
    fn oppose(self, quads: &mut [Quad; 2], pair: __m512d) {
        self.add_to(quads, self.avx512dq._mm512_xor_pd(pair, pulp::cast(FIRST_OPPOSED)));
    }
}
