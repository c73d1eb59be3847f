//! Time averages with confidence intervals, for series that can no longer be compared sample by sample.

use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// Number of blocks into which a series is divided.
pub const BLOCKS: usize = 8;
/// Confidence level of the intervals.
pub const CONFIDENCE: f64 = 0.99;

/// Returns the arithmetic mean; NaN for an empty list.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

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
    if first.len() != second.len() {
        return None;
    }
    let (first, second) = (block_means(first, blocks)?, block_means(second, blocks)?);
    let differences: Vec<f64> = first.iter().zip(&second).map(|(a, b)| b - a).collect();
    let (_, half_width) = interval(&differences)?;
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
    let (_, variance) = mean_and_variance(values);
    let half_width = quantile(CONFIDENCE, values.len() as f64 - 1.0)? * (2.0 * variance).sqrt();
    (half_width > 0.0).then_some(half_width)
}

/// Returns the mean of n independent values and the half-width t s/√n of its confidence interval. Here s is the
/// standard deviation, and t is Student's t. Returns none for fewer than two values.
#[must_use]
pub fn interval(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let (mean, variance) = mean_and_variance(values);
    Some((mean, quantile(CONFIDENCE, count - 1.0)? * (variance / count).sqrt()))
}

/// Returns the mean and the variance s² of independent values; the variance of a single value is NaN.
#[must_use]
pub fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let mean = mean(values);
    (mean, values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0))
}

/// Returns the mean of n independent values and the half-width t s √(1 + 1/n) of the prediction interval for one further value.
/// Here s is the standard deviation, and t is Student's t. Returns none for fewer than two values or if all are equal.
#[must_use]
pub fn next_value(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let half_width = spread(values)? * (0.5 * (1.0 + 1.0 / count)).sqrt();
    Some((mean(values), half_width))
}

/// Returns the mean over time of several runs of one scene, and the half-width of the prediction interval for the mean of one
/// further run. All series have the same sample times.
///
/// The series are cut into `blocks` blocks of equal length; the first samples that fill no block are not used. The variance s²
/// and the correlation ρ ≥ 0 of consecutive blocks follow from the deviations of the block means from the mean of all n runs in
/// the same block. A trend that all runs share cancels. With the effective number of blocks b = `blocks` (1 − ρ)/(1 + ρ), but
/// at least 1, the half-width is t s √((1 + 1/n)/b). Here t is Student's t for (n − 1) b degrees of freedom. It is chosen such
/// that all of `judged` such intervals hold with the confidence level [`CONFIDENCE`] (Bonferroni). Returns none for fewer than
/// two runs, or if a block would be empty.
#[must_use]
pub fn next_mean(runs: &[&[f64]], blocks: usize, judged: usize) -> Option<(f64, f64)> {
    let (count, width) = (runs.len() as f64, blocks as f64);
    let means = runs.iter().map(|run| block_means(run, blocks)).collect::<Option<Vec<_>>>()?;
    let of_all: Vec<f64> = (0..blocks).map(|at| means.iter().map(|run| run[at]).sum::<f64>() / count).collect();
    let off = |run: &Vec<f64>| run.iter().zip(&of_all).map(|(mean, all)| mean - all).collect();
    let off: Vec<Vec<f64>> = means.iter().map(off).collect();
    let variance = off.iter().flatten().map(|off| off * off).sum::<f64>() / (width * (count - 1.0));
    let shared = off.iter().flat_map(|run| run.windows(2)).map(|pair| pair[0] * pair[1]).sum::<f64>();
    let correlation = shared / ((width - 1.0) * (count - 1.0)) / variance.max(f64::MIN_POSITIVE);
    let correlation = correlation.clamp(0.0, 1.0);
    let effective = (width * (1.0 - correlation) / (1.0 + correlation)).max(1.0);
    let level = 1.0 - (1.0 - CONFIDENCE) / judged.max(1) as f64;
    let half_width = quantile(level, (count - 1.0) * effective)? * (variance * (1.0 + 1.0 / count) / effective).sqrt();
    Some((of_all.iter().sum::<f64>() / width, half_width))
}

/// Returns the means over blocks of equal length; the first samples that fill no block are not used. Returns none if a block
/// would be empty.
fn block_means(values: &[f64], blocks: usize) -> Option<Vec<f64>> {
    let length = values.len() / blocks.max(2);
    let used = values.len().checked_sub(length * blocks).filter(|_| length > 0)?;
    Some(values[used..].chunks_exact(length).map(|block| block.iter().sum::<f64>() / length as f64).collect())
}

/// Returns Student's t of the two-sided interval with a confidence level.
fn quantile(level: f64, degrees_of_freedom: f64) -> Option<f64> {
    Some(StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?.inverse_cdf(0.5 + 0.5 * level))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Student's t for one degree of freedom is 63.66 at 99 %. Two values that differ by 2 have s = √2.
    #[test]
    fn two_kinds_of_random_numbers_differ() {
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

    fn trend(at: usize) -> f64 {
        0.05 * at as f64
    }

    /// The interval misses the true difference in at most 3 % of cases; 1 % is expected.
    #[test]
    fn intervals_have_their_coverage() {
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

    /// The prediction interval misses the mean of a further run in at most 4 % of cases (1 % expected), also if the samples are
    /// correlated over more than a block. A mean that is wrong by six times the scatter is found in nine of ten runs.
    #[test]
    fn a_further_run_lies_in_its_interval() {
        for memory in [0.0, 0.9, 0.99] {
            let run = |seed: u64| -> Vec<f64> {
                let mut state = 0.0;
                let step = |(at, x): (usize, f64)| {
                    state = memory * state + x;
                    trend(at) + state
                };
                noise(seed).skip(50).take(400).enumerate().map(step).collect()
            };
            let outside = |off: f64| {
                let is_outside = |seed: &u64| {
                    let runs: Vec<Vec<f64>> = (0..8).map(|at| run(1 + 1000 * at + seed)).collect();
                    let runs: Vec<&[f64]> = runs.iter().map(Vec::as_slice).collect();
                    let (mean, half_width) = next_mean(&runs, BLOCKS, 1).unwrap();
                    let further = run(9000 + seed).iter().sum::<f64>() / 400.0;
                    (further + off - mean).abs() > half_width
                };
                (1..=400_u64).filter(is_outside).count()
            };
            let scatter = (1.0_f64 / 12.0 / 400.0).sqrt() / (1.0 - memory);
            assert!(outside(0.0) <= 16, "{memory}: {}", outside(0.0));
            assert!(outside(6.0 * scatter) > 360, "{memory}: {}", outside(6.0 * scatter));
        }
    }

    #[test]
    fn a_known_prediction() {
        // Blocks 1, 1 and −1, −1: the correlation is 1, so that only the means of the two runs count. s² = 2.
        let known = next_mean(&[&[1.0, 1.0], &[-1.0, -1.0]], 2, 1).unwrap();
        assert!(known.0 == 0.0 && (known.1 - 63.656_741 * 3.0_f64.sqrt()).abs() < 1e-3, "{known:?}");
        // Blocks 1, −1 and −1, 1: no positive correlation. s² = 2, t(.995, 2) = 9.9248.
        let known = next_mean(&[&[1.0, -1.0], &[-1.0, 1.0]], 2, 1).unwrap();
        assert!(known.0 == 0.0 && (known.1 - 9.924_843 * 1.5_f64.sqrt()).abs() < 1e-4, "{known:?}");
        // Ten intervals at once: t(.9995, 2) = 31.599.
        let known = next_mean(&[&[1.0, -1.0], &[-1.0, 1.0]], 2, 10).unwrap();
        assert!((known.1 - 31.599_055 * 1.5_f64.sqrt()).abs() < 1e-3, "{known:?}");
        assert_eq!((next_mean(&[&[1.0, 2.0]], 2, 1), next_mean(&[&[1.0], &[2.0]], 2, 1)), (None, None));
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
