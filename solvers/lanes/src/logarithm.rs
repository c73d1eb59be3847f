//! Natural logarithm without branches, with equal bits on every processor. The logarithm of the system library has
//! several versions, selected by the processor, and needs a function call.

/// Bit pattern of √½ as `f64`.
const ROOT_OF_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
/// ln 2 as a sum of two numbers: its first twenty bits, so that the product with an exponent is exact, and the remainder.
const LN_2: [f64; 2] = [0.693_146_705_627_441_4, 4.749_325_039_031_672_6e-7];

/// Returns ln x of a positive normal number, within one unit in the last place. For other numbers, the result is unspecified.
///
/// The number is split as x = 2^k (1 + f) with 1 + f from √½ to √2. With s = f/(2 + f), ln(1 + f) = 2 artanh s = 2s + s
/// R with R = 2 (s²/3 + s⁴/5 + …). Ten terms of R are used, for s² < .0295. Since 2s = f − f²/2 + s f²/2, the large
/// part f is not rounded:
///
/// ```text
/// ln x = k ln 2 + f − (f²/2 − s (f²/2 + R))
/// ```
#[inline(always)]
#[must_use]
pub fn ln(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = (bits.wrapping_sub(ROOT_OF_HALF) as i64) >> 52;
    let f = f64::from_bits(bits.wrapping_sub((exponent << 52) as u64)) - 1.0;
    let exponent = exponent as i32 as f64;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let odd = 2.0 / 3.0 + w * (2.0 / 7.0 + w * (2.0 / 11.0 + w * (2.0 / 15.0 + w * (2.0 / 19.0))));
    let even = 2.0 / 5.0 + w * (2.0 / 9.0 + w * (2.0 / 13.0 + w * (2.0 / 17.0 + w * (2.0 / 21.0))));
    let rest = z * (odd + z * even);
    let half = 0.5 * f * f;
    exponent * LN_2[0] + (f - (half - (s * (half + rest) + exponent * LN_2[1])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The result agrees with the logarithm of the system library, whose error is at most .52 of a unit in the last
    /// place in good implementations.
    #[test]
    fn is_the_logarithm() {
        let near_one = (-2000..=2000).map(|number| 1.0 + f64::from(number) * 1.7e-4);
        let all = (-900..900).map(|number| 1.37 * 2.0_f64.powi(number)).chain(near_one.filter(|&x| x > 0.0));
        for x in all.chain([f64::MIN_POSITIVE, f64::MAX, 0.5_f64.sqrt(), 2.0_f64.sqrt(), 1.0 + f64::EPSILON]) {
            let (found, expected) = (ln(x), x.ln());
            assert!((found - expected).abs() <= 1.01 * f64::EPSILON * expected.abs(), "ln {x}: {found} for {expected}");
        }
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(2.0), std::f64::consts::LN_2);
    }
}
