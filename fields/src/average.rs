//! Time averages over frames, with confidence intervals.

use grainbench_harness::statistics::interval;

/// A mean with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Mean {
    /// Mean of all values.
    pub value: f64,
    /// Half width of the confidence interval with the confidence level [`grainbench_harness::statistics::CONFIDENCE`];
    /// `None` for fewer than two blocks.
    pub half_width: Option<f64>,
    /// Number of blocks.
    pub blocks: usize,
}

/// Returns the mean of a time series, with its confidence interval from the means of `blocks` equal blocks.
///
/// Neighbouring frames are correlated, but blocks longer than the correlation time are independent. If the blocks do
/// not cover the whole series, the first values count only for the mean. Returns `None` for an empty series.
#[must_use]
pub fn mean(values: &[f64], blocks: usize) -> Option<Mean> {
    let average = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let blocks = blocks.clamp(1, values.len());
    let length = values.len() / blocks;
    let means: Vec<f64> = values[values.len() - length * blocks..].chunks(length).map(average).collect();
    Some(Mean { value: average(values), half_width: interval(&means).map(|(_, half_width)| half_width), blocks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_the_blocks() {
        // The blocks have the means 1, 2, 3 and 4, so their standard deviation is s = √(5/3). Student's t for 3 degrees of
        // freedom at 99 % is 5.840909.
        let values = [0.5, 1.5, 2.0, 2.0, 3.0, 3.0, 4.5, 3.5];
        let found = mean(&values, 4).unwrap();
        assert!((found.value - 2.5).abs() < 1e-15 && found.blocks == 4);
        assert!((found.half_width.unwrap() - 5.840_909 * (5.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-5);
        assert_eq!(mean(&[], 4), None);
        assert_eq!(mean(&[2.0], 4), Some(Mean { value: 2.0, half_width: None, blocks: 1 }));
    }
}
