//! Mean of a quantity, and its standard deviations between codes and between beds of one code.

/// Statistics of a quantity over all codes and beds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean over all codes. The value of a code is the mean over its beds.
    pub mean: f64,
    /// Standard deviation of the codes' means.
    pub code: f64,
    /// Pooled standard deviation of the beds about the mean of their code.
    pub bed: f64,
}

impl Spread {
    /// Returns the largest accepted difference between the mean of another code and the mean of the published codes.
    /// The other code has m = `own` beds, and each published code has n = `published` beds.
    ///
    /// The difference is 2 √(s_code² + s_bed² (1/m + 1/n)), with the standard deviations s_code between codes and s_bed
    /// between beds.
    #[must_use]
    pub fn allowed(&self, own: usize, published: usize) -> f64 {
        2.0 * self.deviation(own, published)
    }

    /// Returns the standard deviation √(s_code² + s_bed² (1/m + 1/n)) with m = `own` and n = `published`.
    #[must_use]
    pub fn deviation(&self, own: usize, published: usize) -> f64 {
        let beds = 1.0 / own as f64 + 1.0 / published as f64;
        (self.code * self.code + self.bed * self.bed * beds).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With the variances 2 between codes and 2 between beds, the variance of a difference of single beds is 2 + 2 · 2.
    #[test]
    fn tells_codes_from_beds() {
        let spread = Spread { mean: 2.0, code: 2.0_f64.sqrt(), bed: 2.0_f64.sqrt() };
        assert!((spread.allowed(1, 1) - 2.0 * 6.0_f64.sqrt()).abs() < 1e-14);
    }
}
