//! Printed digits of a column of numbers, and the uncertainty of the numbers that follows from them.

/// Number of values at the start of a column that are all examined. A later value is examined only if it is longer than
/// all examined values, or if it is the first with a fraction.
const LOOKED_AT: u32 = 32;

/// Default number of significant digits of the format `%g`.
const USUAL: u32 = 6;

/// Format of the numbers in a column, derived from their texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Digits {
    looked_at: u32,
    longest: usize,
    significant: u32,
    /// Smallest and largest number of decimals of numbers without an exponent.
    decimals: Option<(u32, u32)>,
    /// True if a number has decimals that end in zero. The format `%g` never prints such a zero.
    padded: bool,
    /// True if a number has decimals other than a single zero.
    has_fraction: bool,
    has_exponent: bool,
    /// True if the numbers have single precision (f32), even if more digits are printed.
    single: bool,
}

impl Digits {
    /// Returns the digits of binary numbers, which are exact.
    pub(crate) fn exact() -> Self {
        Self { significant: 17, ..Self::default() }
    }

    /// Returns the combined digits of columns.
    pub(crate) fn all<'d>(columns: impl IntoIterator<Item = &'d Self>) -> Self {
        columns.into_iter().fold(Self::default(), |all, digits| all.with(digits))
    }

    /// Marks the numbers as single precision.
    pub(crate) fn single(self) -> Self {
        Self { single: true, ..self }
    }

    /// Returns the largest number of significant digits in the column.
    #[must_use]
    pub fn significant(&self) -> u32 {
        self.significant
    }

    /// Updates the digits by the text of a number.
    #[inline]
    pub(crate) fn see(&mut self, text: &[u8]) {
        let is_first_fraction = !self.has_fraction && !text.ends_with(b".0") && text.contains(&b'.');
        if self.looked_at < LOOKED_AT || text.len() > self.longest || is_first_fraction {
            self.look(text);
        }
    }

    #[cold]
    fn look(&mut self, text: &[u8]) {
        self.looked_at = self.looked_at.saturating_add(1);
        self.longest = self.longest.max(text.len());
        let exponent = text.iter().position(|byte| matches!(byte, b'e' | b'E'));
        let mantissa = &text[..exponent.unwrap_or(text.len())];
        let digits = mantissa.iter().filter(|byte| byte.is_ascii_digit());
        // Leading zeros are not significant, except in zero itself.
        let counted = digits.skip_while(|byte| **byte == b'0').count();
        self.significant = self.significant.max(u32::try_from(counted).unwrap_or(u32::MAX));
        let point = mantissa.iter().position(|byte| *byte == b'.');
        self.has_exponent |= exponent.is_some();
        self.has_fraction |= point.is_some_and(|point| &mantissa[point..] != b".0");
        if exponent.is_none() {
            self.padded |= point.is_some() && mantissa.last() == Some(&b'0');
            let behind = point.map_or(0, |point| mantissa.len() - point - 1);
            let behind = u32::try_from(behind).unwrap_or(u32::MAX);
            let (fewest, most) = self.decimals.unwrap_or((behind, behind));
            self.decimals = Some((fewest.min(behind), most.max(behind)));
        }
    }

    /// Returns the uncertainty of a printed number `value`: half a unit of its last printed digit.
    ///
    /// The format `%g` removes trailing zeros, so a column of round numbers seems to have few digits. It is assumed to
    /// have as many digits as the rest of the file, but at most six, the default of `%g`.
    #[must_use]
    pub fn uncertainty(&self, value: f64, of_file: &Digits) -> f64 {
        let is_padded = self.is_padded(of_file);
        if value == 0.0 && !is_padded {
            return 0.0;
        }
        let shown = self.significant.max(of_file.significant.min(USUAL)).clamp(1, 17);
        // An f64 has no more than 17 digits.
        let general = if value == 0.0 || shown == 17 {
            0.5 * f64::EPSILON * value.abs()
        } else {
            let leading = value.abs().log10().floor();
            0.5 * 10_f64.powf(leading + 1.0 - f64::from(shown))
        };
        let printed = match self.decimals {
            Some((fewest, most)) if fewest == most && is_padded => {
                general.max(0.5 * 10_f64.powi(-(most.min(400) as i32)))
            }
            _ => general,
        };
        // An f32 may differ from the exact number by this much.
        if self.single { printed.max(0.5 * f64::from(f32::EPSILON) * value.abs()) } else { printed }
    }

    /// Returns half a unit of the last printed digit of `value`, or zero in a column of whole numbers.
    #[must_use]
    pub fn half_unit(&self, value: f64, of_file: &Digits) -> f64 {
        let is_whole = matches!(self.decimals, Some((_, 0))) && !self.has_exponent;
        if is_whole { 0.0 } else { self.uncertainty(value, of_file) }
    }

    /// Returns true if trailing zeros count as printed digits.
    ///
    /// If a column has only numbers such as `0.0` and `2.0`, and the file has more digits elsewhere, trailing zeros do
    /// not count: programs write exact whole numbers in this form.
    fn is_padded(&self, of_file: &Digits) -> bool {
        let has_more = of_file.has_exponent || of_file.decimals.is_some_and(|(_, most)| most > 1);
        self.padded && (self.has_fraction || !has_more)
    }

    /// Returns the combined digits of two columns.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        self.looked_at = self.looked_at.saturating_add(other.looked_at);
        self.longest = self.longest.max(other.longest);
        self.significant = self.significant.max(other.significant);
        self.padded |= other.padded;
        self.has_fraction |= other.has_fraction;
        self.has_exponent |= other.has_exponent;
        self.single |= other.single;
        self.decimals = match (self.decimals, other.decimals) {
            (Some(one), Some(two)) => Some((one.0.min(two.0), one.1.max(two.1))),
            (one, two) => one.or(two),
        };
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits_of(texts: &[&str]) -> Digits {
        let mut digits = Digits::default();
        texts.iter().for_each(|text| digits.see(text.as_bytes()));
        digits
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-9 * expected, "{found:e} {expected:e}");
    }

    #[test]
    fn general_format() {
        let digits = digits_of(&["0", "1", "-0.00123457", "150.25"]);
        assert_eq!(digits.significant(), 6);
        close(digits.uncertainty(1.0, &digits), 0.5e-5);
        close(digits.uncertainty(-0.001_234_57, &digits), 0.5e-8);
        assert_eq!(digits.uncertainty(0.0, &digits), 0.0);
        // A column with few digits is assumed to have up to six digits if the file has more elsewhere.
        close(digits_of(&["0.5"]).uncertainty(0.5, &digits), 0.5e-6);
        close(digits_of(&["0.5"]).uncertainty(0.5, &digits_of(&["0.12345678901234567"])), 0.5e-6);
    }

    /// Python writes zero as `0.0`. In a file with more digits elsewhere, such a number is not rounded to tenths.
    #[test]
    fn a_whole_number_with_a_point_is_not_rounded_to_tenths() {
        let of_file = digits_of(&["0.0", "0.02125", "1e-05"]);
        assert_eq!(digits_of(&["0.0", "0.0"]).uncertainty(0.0, &of_file), 0.0);
        close(digits_of(&["0.0", "0.4"]).uncertainty(0.0, &of_file), 0.05);
        close(digits_of(&["0.0"]).uncertainty(0.0, &digits_of(&["0.0", "0.4"])), 0.05);
        let mut long = digits_of(&["0.0"; 64]);
        long.see(b"0.4");
        close(long.uncertainty(0.0, &of_file), 0.05);
    }

    #[test]
    fn whole_numbers_have_no_half_unit() {
        let whole = digits_of(&["3", "4"]);
        assert_eq!(whole.half_unit(3.0, &whole), 0.0);
        close(digits_of(&["3", "4.5"]).half_unit(3.0, &digits_of(&["4.5"])), 0.05);
    }

    #[test]
    fn full_precision() {
        let digits = digits_of(&["0.12345678901234567", "1"]);
        assert_eq!(digits.uncertainty(1.0, &digits), 0.5 * f64::EPSILON);
    }

    #[test]
    fn fixed_and_scientific_format() {
        let fixed = digits_of(&["0.500000", "-0.000123", "150.250000"]);
        close(fixed.uncertainty(0.5, &fixed), 0.5e-6);
        close(fixed.uncertainty(0.0, &fixed), 0.5e-6);
        let scientific = digits_of(&["1.000000e+00", "0.000000e+00"]);
        close(scientific.uncertainty(2000.0, &scientific), 0.5e-3);
    }
}
