//! Time averages with confidence intervals, for series that can no longer be compared sample by sample.

use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// Number of blocks into which a series is divided.
pub const BLOCKS: usize = 8;
/// Confidence level of the intervals.
pub const CONFIDENCE: f64 = 0.99;

/// Means of two series, and the confidence interval of the difference of the means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Mean of the first series.
    pub first: f64,
    /// Mean of the second series.
    pub second: f64,
    /// Half-width of the confidence interval of the difference.
    pub half_width: f64,
}

/// Returns the means of two series with the same sample times, and the confidence interval of their difference, from
/// block averages.
///
/// Both series are cut into `blocks` blocks of equal length; the samples left over at the start are not used. The
/// differences of the block means are treated as independent (Flyvbjerg & Petersen 1989). The confidence interval of
/// their mean has the half-width t s/√n. Here s is the standard deviation of the n differences, and t is Student's t
/// for n − 1 degrees of freedom. A trend that both series share cancels in the differences. Returns none if a block
/// would be empty, or if the series have different lengths.
#[must_use]
pub fn difference(first: &[f64], second: &[f64], blocks: usize) -> Option<Estimate> {
    let length = first.len().min(second.len()) / blocks.max(2);
    if length == 0 || first.len() != second.len() {
        return None;
    }
    let skipped = first.len() - length * blocks;
    let means = |values: &[f64]| -> Vec<f64> {
        values[skipped..].chunks_exact(length).map(|block| block.iter().sum::<f64>() / length as f64).collect()
    };
    let (first, second) = (means(first), means(second));
    let count = blocks as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let differences: Vec<f64> = first.iter().zip(&second).map(|(a, b)| b - a).collect();
    let of_all = mean(&differences);
    let variance = differences.iter().map(|value| (value - of_all).powi(2)).sum::<f64>() / (count - 1.0);
    let half_width = quantile(count - 1.0)? * (variance / count).sqrt();
    Some(Estimate { first: mean(&first), second: mean(&second), half_width })
}

/// Returns the minimum, the median and the maximum; none for an empty list.
#[must_use]
pub fn range(values: &[f64]) -> Option<[f64; 3]> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (first, last) = (sorted.first()?, sorted.last()?);
    let middle = 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]);
    Some([*first, middle, *last])
}

/// Returns the median; NaN for an empty list.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    range(values).map_or(f64::NAN, |[_, middle, _]| middle)
}

/// Returns the half-width t s √2 of the prediction interval for the difference of two further values. Here s is the standard
/// deviation of the given independent values, and t is Student's t. Returns none for fewer than two values or if all are equal.
#[must_use]
pub fn spread(values: &[f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let half_width = quantile(count - 1.0)? * (2.0 * variance).sqrt();
    (half_width > 0.0).then_some(half_width)
}

/// Returns the mean of n independent values and the half-width t s/√n of its confidence interval. Here s is the
/// standard deviation, and t is Student's t. Returns none for fewer than two values.
#[must_use]
pub fn interval(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Some((mean, quantile(count - 1.0)? * (variance / count).sqrt()))
}

/// Returns the mean of n independent values and the half-width t s √(1 + 1/n) of the prediction interval for one further value.
/// Here s is the standard deviation, and t is Student's t. Returns none for fewer than two values or if all are equal.
#[must_use]
pub fn next_value(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let half_width = spread(values)? * (0.5 * (1.0 + 1.0 / count)).sqrt();
    Some((values.iter().sum::<f64>() / count, half_width))
}

/// Returns Student's t of the two-sided interval with the confidence level [`CONFIDENCE`].
fn quantile(degrees_of_freedom: f64) -> Option<f64> {
    Some(StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?.inverse_cdf(0.5 + 0.5 * CONFIDENCE))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// Student's t for one degree of freedom is 63.66 at 99 %. Two values that differ by 2 have s = √2.
    #[test]
    fn two_draws_are_told_apart_by_their_kind() {
        let half = spread(&[1.0, 3.0]).unwrap();
        assert!((half - 2.0 * 63.656_741).abs() < 1e-3, "{half}");
        assert_eq!((spread(&[1.0]), spread(&[1.0, 1.0])), (None, None));
    }

    #[test]
    fn the_middle_and_the_ends() {
        assert_eq!(range(&[3.0, 1.0, 2.0]), Some([1.0, 2.0, 3.0]));
        assert_eq!(range(&[4.0, 1.0, 2.0, 3.0]), Some([1.0, 2.5, 4.0]));
        assert_eq!(range(&[]), None);
        assert!(median(&[4.0, 1.0, 2.0, 3.0]) == 2.5 && median(&[]).is_nan());
    }

    /// Returns pseudo-random numbers between −0.5 and 0.5.
    fn noise(seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed;
        std::iter::repeat_with(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        })
    }

    /// The interval misses the true difference about as often as the confidence level states.
    #[test]
    fn the_interval_holds_what_it_says() {
        let trend = |at: usize| 0.05 * at as f64;
        let course =
            |seed: u64| -> Vec<f64> { noise(seed).take(160).enumerate().map(|(at, x)| trend(at) + x).collect() };
        let outside = |off: f64| {
            (1..=400_u64)
                .filter(|&seed| {
                    let second: Vec<f64> = course(seed + 1000).iter().map(|value| value + off).collect();
                    let estimate = difference(&course(seed), &second, BLOCKS).unwrap();
                    (estimate.second - estimate.first).abs() > estimate.half_width
                })
                .count()
        };
        assert!(outside(0.0) <= 12, "{}", outside(0.0));
        assert!(outside(0.3) > 390, "{}", outside(0.3));
    }

    #[test]
    fn a_known_interval() {
        // Differences 1, −1, 1, −1: s² = 4/3, t(.995, 3) = 5.8409.
        let estimate = difference(&[0.0; 4], &[1.0, -1.0, 1.0, -1.0], 4).unwrap();
        assert!((estimate.half_width - 5.840_909 * (1.0_f64 / 3.0).sqrt()).abs() < 1e-5, "{estimate:?}");
        let (mean, half_width) = interval(&[1.0, -1.0, 1.0, -1.0]).unwrap();
        assert!(mean == 0.0 && (half_width - estimate.half_width).abs() < 1e-12);
        assert_eq!(interval(&[1.0]), None);
        // Values −1, 1, −1, 1: mean 0, s² = 4/3, times 1 + 1/4.
        let (mean, half_width) = next_value(&[-1.0, 1.0, -1.0, 1.0]).unwrap();
        assert!(mean == 0.0 && (half_width - 5.840_909 * (5.0_f64 / 3.0).sqrt()).abs() < 1e-5, "{half_width}");
        assert_eq!(next_value(&[1.0]), None);
        assert_eq!(difference(&[0.0; 3], &[0.0; 3], 4), None);
        assert_eq!(difference(&[0.0; 8], &[0.0; 9], 4), None);
    }
}
