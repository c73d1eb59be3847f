//! Mean of a quantity, and its standard deviations between codes and between beds of one code.

use std::collections::BTreeMap;

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
    /// Returns the statistics of values, each given with the name of its code. Returns `None` if there are fewer than
    /// two codes or no code has two beds.
    #[must_use]
    pub fn from_values<'a>(values: impl IntoIterator<Item = (&'a str, f64)>) -> Option<Self> {
        let mut codes: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        values.into_iter().for_each(|(code, value)| codes.entry(code).or_default().push(value));
        let means: Vec<f64> = codes.values().map(|code_values| mean(code_values)).collect();
        let freedom: usize = codes.values().map(|code_values| code_values.len() - 1).sum();
        if means.len() < 2 || freedom == 0 {
            return None;
        }
        let about =
            |code_values: &Vec<f64>| code_values.iter().map(|value| (value - mean(code_values)).powi(2)).sum::<f64>();
        let all = mean(&means);
        let between: f64 = means.iter().map(|value| (value - all).powi(2)).sum();
        Some(Self {
            mean: all,
            code: (between / (means.len() - 1) as f64).sqrt(),
            bed: (codes.values().map(about).sum::<f64>() / freedom as f64).sqrt(),
        })
    }

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

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two codes with two beds each have the means 1 and 3. Each bed differs by 1 from the mean of its code.
    #[test]
    fn tells_codes_from_beds() {
        let spread = Spread::from_values([("a", 0.0), ("a", 2.0), ("b", 2.0), ("b", 4.0)]).unwrap();
        assert_eq!((spread.mean, spread.code, spread.bed), (2.0, 2.0_f64.sqrt(), 2.0_f64.sqrt()));
        assert!((spread.allowed(1, 1) - 2.0 * 6.0_f64.sqrt()).abs() < 1e-14);
        assert_eq!(Spread::from_values([("a", 0.0), ("a", 2.0)]), None);
        assert_eq!(Spread::from_values([("a", 0.0), ("b", 2.0)]), None);
    }
}
