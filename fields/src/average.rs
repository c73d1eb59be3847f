//! Means over frames, with the interval that their scatter leaves.

use grainbench_harness::statistics::interval;

/// A mean and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Mean {
    /// The mean.
    pub value: f64,
    /// Half the interval that holds it with [`grainbench_harness::statistics::CONFIDENCE`]; none of fewer than two blocks.
    pub half_width: Option<f64>,
    /// Blocks that it was found from.
    pub blocks: usize,
}

/// The mean of numbers in order of time, with its interval from the means of `blocks` equal blocks of them: neighbouring
/// frames are not independent, blocks longer than their memory are. What is left over at the start is in the mean alone. None
/// of no numbers.
#[must_use]
pub fn mean(values: &[f64], blocks: usize) -> Option<Mean> {
    let of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let blocks = blocks.clamp(1, values.len());
    let length = values.len() / blocks;
    let means: Vec<f64> = values[values.len() - length * blocks..].chunks(length).map(of).collect();
    Some(Mean { value: of(values), half_width: interval(&means).map(|(_, half_width)| half_width), blocks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_the_blocks() {
        // Blocks of means 1, 2, 3, 4: s = √(5/3); Student's t of 3 degrees at 99 % is 5.840909.
        let values = [0.5, 1.5, 2.0, 2.0, 3.0, 3.0, 4.5, 3.5];
        let found = mean(&values, 4).unwrap();
        assert!((found.value - 2.5).abs() < 1e-15 && found.blocks == 4);
        assert!((found.half_width.unwrap() - 5.840_909 * (5.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-5);
        assert_eq!(mean(&[], 4), None);
        assert_eq!(mean(&[2.0], 4), Some(Mean { value: 2.0, half_width: None, blocks: 1 }));
    }
}
