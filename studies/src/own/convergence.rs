//! Reference value of a solver from its own levels, with an uncertainty.
//!
//! Let f₁, f₂, f₃ be the values at the three finest levels h₁ < h₂ < h₃. The observed order p solves
//!
//! ```text
//! (f₃ − f₂)/(f₂ − f₁) = (h₃ᵖ − h₂ᵖ)/(h₂ᵖ − h₁ᵖ)
//! ```
//!
//! With it, the reference is Richardson's extrapolation f₀ = f₁ − δ with δ = (f₂ − f₁) h₁ᵖ/(h₂ᵖ − h₁ᵖ). In δ, p is at most
//! the order of the method. The grid convergence index F_s |δ| is the uncertainty of f₁, with a factor of safety F_s of 1.25
//! or 3 (ASME V&V 20-2009, section 2; Roache 1994). The extrapolation already subtracts δ, so that the uncertainty of f₀ is
//! (F_s − 1)|δ|. F_s is 1.25 only if p is 1 or the order of the method within 10 %, and if the three levels before the finest
//! level show an order too. The uncertainty is never smaller than the change of f₀ that the finest level causes.
//!
//! If the differences change sign or grow, or if p is below ½, above 4 or above twice the order of the method, no order is
//! visible: the levels are not in the asymptotic range. Then the reference is f₁, and its uncertainty is the
//! range from the smallest to the largest of the three values. In a chaotic scene, single values scatter, so their mean is
//! the reference.

use grainbench_harness::statistics::mean_and_variance;
use grainbench_reports::study::estimate::Basis;

/// Smallest order of which an extrapolation makes use.
const LEAST_ORDER: f64 = 0.5;
/// Largest order of which an extrapolation makes use, and its largest multiple of the order of the method. A larger order is
/// not asymptotic.
const LARGEST_ORDER: [f64; 2] = [4.0, 2.0];
/// Relative deviation of the observed order from a whole order that is expected.
const NEAR: f64 = 0.1;
/// Factor of safety of an order that is confirmed, and of any other order.
const SAFETY: [f64; 2] = [1.25, 3.0];
/// Quantile of Student's t at 95 %, for four degrees of freedom: five runs of a chaotic scene.
const STUDENT: f64 = 2.776;

/// Value at a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelValue {
    /// Length of a time step or a cell, in any unit.
    pub size: f64,
    /// Value of the quantity.
    pub value: f64,
}

/// Reference value of a quantity, and its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Estimate of the value at infinite resolution.
    pub value: f64,
    /// Half-width of the interval that contains the limit of infinite resolution.
    pub uncertainty: f64,
    /// Observed order; none if it is not visible.
    pub order: Option<f64>,
    /// Method of the estimate.
    pub basis: Basis,
}

/// Returns the reference of the values at two or more levels, from coarse to fine. `formal` is the order of the method.
/// Differences up to `rounding` count as rounding errors. Returns none for fewer levels, or if a value is not finite.
#[must_use]
pub fn reference(levels: &[LevelValue], formal: f64, rounding: f64) -> Option<Reference> {
    let finite = levels.iter().all(|level| level.value.is_finite() && level.size > 0.0);
    let &[.., middle, fine] = levels else { return None };
    if !finite {
        return None;
    }
    let near = (middle.value - fine.value).abs();
    let spread =
        |value: f64, uncertainty: f64| Some(Reference { value, uncertainty, order: None, basis: Basis::Spread });
    let &[.., coarse, _, _] = levels else { return spread(fine.value, SAFETY[1] * near.max(rounding)) };
    let last = [coarse, middle, fine];
    if range(&last) <= rounding {
        return spread(fine.value, rounding);
    }
    let Some((value, correction, order)) = extrapolated(last, formal) else {
        return spread(fine.value, range(&last).max(rounding));
    };
    let whole = [1.0, formal].iter().any(|whole| (order - whole).abs() <= NEAR * whole);
    let before = match levels {
        [.., coarsest, _, _, _] => extrapolated([*coarsest, coarse, middle], formal),
        _ => None,
    };
    let safety = if whole && before.is_some() { SAFETY[0] } else { SAFETY[1] };
    let moved = before.map_or(0.0, |(before, ..)| (value - before).abs());
    let uncertainty = ((safety - 1.0) * correction.abs()).max(moved).max(rounding);
    Some(Reference { value, uncertainty, order: Some(order), basis: Basis::Extrapolated })
}

/// Returns the reference of a chaotic scene: the mean of the values at up to three of the finest levels. `deviation` is the
/// standard deviation of five perturbed runs. The uncertainty is the largest one of the spread of the levels, of the 95 %
/// interval of their mean, and of the rounding error.
#[must_use]
pub fn ensemble(levels: &[LevelValue], deviation: f64, rounding: f64) -> Option<Reference> {
    let last = &levels[levels.len().saturating_sub(3)..];
    if last.len() < 2 || last.iter().any(|level| !level.value.is_finite()) {
        return None;
    }
    let count = last.len() as f64;
    let value = last.iter().map(|level| level.value).sum::<f64>() / count;
    let uncertainty = range(last).max(scatter(deviation) / count.sqrt()).max(rounding);
    Some(Reference { value, uncertainty, order: None, basis: Basis::Ensemble })
}

/// Returns the half-width of the 95 % interval of a single run, from the standard deviation of five perturbed runs.
#[must_use]
pub fn scatter(deviation: f64) -> f64 {
    STUDENT * deviation
}

/// Returns the sample standard deviation; zero for fewer than two values.
#[must_use]
pub fn deviation(values: &[f64]) -> f64 {
    if values.len() < 2 { 0.0 } else { mean_and_variance(values).1.sqrt() }
}

fn range(levels: &[LevelValue]) -> f64 {
    let most = levels.iter().map(|level| level.value).fold(f64::NEG_INFINITY, f64::max);
    most - levels.iter().map(|level| level.value).fold(f64::INFINITY, f64::min)
}

/// Returns the extrapolated value, the correction of the finest value, and the observed order of three levels from coarse to
/// fine. Returns none if no order in the asymptotic range is visible.
fn extrapolated([coarse, middle, fine]: [LevelValue; 3], formal: f64) -> Option<(f64, f64, f64)> {
    let (far, near) = (coarse.value - middle.value, middle.value - fine.value);
    let asymptotic = LEAST_ORDER..=LARGEST_ORDER[0].min(LARGEST_ORDER[1] * formal);
    let order = order([coarse.size, middle.size, fine.size], far / near).filter(|order| asymptotic.contains(order))?;
    let believed = order.min(formal);
    let correction = near * fine.size.powf(believed) / (middle.size.powf(believed) - fine.size.powf(believed));
    Some((fine.value - correction, correction, order))
}

/// Largest order that is sought.
const MOST_ORDER: f64 = 20.0;

/// Returns the order for the ratio of the differences of values at three sizes from coarse to fine, by bisection. Returns
/// none if the ratio belongs to no positive order.
fn order([coarse, middle, fine]: [f64; 3], ratio: f64) -> Option<f64> {
    let (mut low, mut high) = (1e-6, MOST_ORDER);
    // Ratios of sizes have powers that are neither too large nor too small.
    let (far, near) = (coarse / fine, middle / fine);
    let ratio_of = |p: f64| (far.powf(p) - near.powf(p)) / (near.powf(p) - 1.0);
    if !(ratio.is_finite() && ratio > ratio_of(low)) {
        return None;
    }
    if ratio >= ratio_of(high) {
        return Some(high);
    }
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        if ratio_of(middle) < ratio { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(sizes: &[f64], value: impl Fn(f64) -> f64) -> Vec<LevelValue> {
        sizes.iter().map(|&size| LevelValue { size, value: value(size) }).collect()
    }

    /// f(h) = 1 + 0.3 h², at sizes whose ratios differ: the extrapolation is exact.
    #[test]
    fn a_known_order_is_found_at_uneven_sizes() {
        let found = reference(&levels(&[6.0, 4.0, 2.5, 1.0], |h| 1.0 + 0.3 * h * h), 2.0, 1e-14).unwrap();
        assert!((found.order.unwrap() - 2.0).abs() < 1e-6 && found.basis == Basis::Extrapolated, "{found:?}");
        assert!((found.value - 1.0).abs() < 1e-6 && (found.uncertainty - 0.25 * 0.3).abs() < 1e-6, "{found:?}");
    }

    /// f(h) = h + h² has order 1 in the limit. The interval contains the limit 0, which the extrapolation misses.
    #[test]
    fn a_mixed_order_is_within_the_uncertainty() {
        let found = reference(&levels(&[0.8, 0.4, 0.2, 0.1], |h| h + h * h), 2.0, 1e-14).unwrap();
        assert!(found.value.abs() > 1e-3 && found.value.abs() < found.uncertainty, "{found:?}");
    }

    /// Three levels alone cannot confirm their order, so that the factor of safety is 3.
    #[test]
    fn three_levels_are_less_certain_than_four() {
        let three = reference(&levels(&[4.0, 2.0, 1.0], |h| 1.0 + 0.3 * h), 2.0, 1e-14).unwrap();
        assert!((three.uncertainty - 2.0 * 0.3).abs() < 1e-6, "{three:?}");
    }

    #[test]
    fn values_without_order_are_uncertain_by_their_spread() {
        for values in [[1.0, 1.25, 1.125], [1.0, 1.1, 1.3]] {
            let at = |size: f64| values[(2.0 - size.log2()) as usize];
            let found = reference(&levels(&[4.0, 2.0, 1.0], at), 2.0, 1e-14).unwrap();
            let spread = values.iter().fold(0.0_f64, |most, value| most.max((value - values[0]).abs()));
            assert!(found.order.is_none() && found.basis == Basis::Spread && found.value == values[2]);
            assert!((found.uncertainty - spread).abs() < 1e-12, "{found:?}");
        }
        let two = reference(&levels(&[2.0, 1.0], |h| h), 2.0, 0.0).unwrap();
        assert!((two.value, two.uncertainty) == (1.0, 3.0), "{two:?}");
        assert_eq!(reference(&levels(&[1.0], |h| h), 2.0, 0.0), None);
        assert_eq!(reference(&levels(&[2.0, 1.0], |_| f64::NAN), 2.0, 0.0), None);
    }

    /// f(h) = hᵖ at three levels. The orders 4.5, 2.5 of a method of first order, and 0.4 are not asymptotic.
    #[test]
    fn an_order_outside_the_asymptotic_range_is_not_visible() {
        for (order, formal, is_visible) in [
            (4.5, 2.0, false),
            (2.5, 1.0, false),
            (0.4, 2.0, false),
            (3.9, 2.0, true),
            (1.9, 1.0, true),
            (0.6, 2.0, true),
        ] {
            let found = reference(&levels(&[4.0, 2.0, 1.0], |h: f64| h.powf(order)), formal, 1e-14).unwrap();
            assert_eq!(found.order.is_some(), is_visible, "{order}: {found:?}");
            let spread = 4.0_f64.powf(order) - 1.0;
            assert_eq!((found.uncertainty - spread).abs() < 1e-9 * spread, !is_visible, "{order}: {found:?}");
        }
    }

    #[test]
    fn rounding_is_not_taken_for_divergence() {
        let values = [1.0, 1.0 + 1e-16, 1.0 - 2e-16];
        let found = reference(&levels(&[4.0, 2.0, 1.0], |h| values[(2.0 - h.log2()) as usize]), 2.0, 1e-12).unwrap();
        assert!(found.uncertainty == 1e-12, "{found:?}");
    }

    /// The mean of five numbers with known standard deviation √2.5.
    #[test]
    fn an_ensemble_scatters() {
        assert!((deviation(&[1.0, 2.0, 3.0, 4.0, 5.0]) - 2.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(deviation(&[1.0]), 0.0);
        let found =
            ensemble(&levels(&[8.0, 4.0, 2.0, 1.0], |h| if h == 8.0 { 100.0 } else { 1.0 }), 0.3, 1e-12).unwrap();
        assert!(found.value == 1.0 && (found.uncertainty - 2.776 * 0.3 / 3.0_f64.sqrt()).abs() < 1e-12, "{found:?}");
        // A mean that all runs share, such as the momentum, is known up to its rounding error.
        assert!(ensemble(&levels(&[2.0, 1.0], |_| 1.0), 0.0, 1e-12).unwrap().uncertainty == 1e-12);
    }
}
