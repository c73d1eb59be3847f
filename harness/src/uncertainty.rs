//! Numerical uncertainty from finite cells and time steps, estimated from three resolution levels.
//!
//! With values f₁, f₂, f₃ at levels h, rh, r²h, the observed order is p = ln((f₃ − f₂)/(f₂ − f₁))/ln r. The uncertainty
//! at level h is U = F_s |f₁ − f₂|/(rᵖ − 1). The factor of safety F_s is 1.25 if p differs from the method's order by
//! at most 10 %, and 3 otherwise. In U, p is limited to values from ½ to the method's order. If the differences change
//! sign or grow, U is three times the larger difference (ASME V&V 20-2009, section 2; Eça & Hoekstra 2014).

use serde::{Deserialize, Serialize};

/// Ratio of the time step or cell size of a level to that of the next finer level.
pub const RATIO: f64 = 2.0;
/// Smallest order used in an estimate.
const LEAST_ORDER: f64 = 0.5;

/// Result of three resolution levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Variant of the claim.
    pub variant: String,
    /// Name of the claim's solver.
    pub solver: String,
    /// Resolution of the claim, in words.
    pub resolution: String,
    /// Quantity of the claim, in words.
    pub quantity: String,
    /// Resolutions of the three levels in words, from fine to coarse.
    pub levels: [String; 3],
    /// Error at each level, divided by the claim's scale.
    pub values: [f64; 3],
    /// Observed order; none if the differences change sign or grow.
    pub order: Option<f64>,
    /// Factor of safety F_s.
    pub safety: f64,
    /// Uncertainty U at the claim's level, divided by the claim's scale.
    pub uncertainty: f64,
}

/// Returns the observed order, the factor of safety and the uncertainty of the finest of three values. The values are
/// ordered from fine to coarse, and `formal` is the order of the method.
#[must_use]
pub fn of_finest([fine, middle, coarse]: [f64; 3], formal: f64) -> (Option<f64>, f64, f64) {
    let (near, far) = (fine - middle, middle - coarse);
    let order = (far / near).ln() / RATIO.ln();
    if !(near * far > 0.0 && order > 0.0) {
        return (None, 3.0, 3.0 * if near.is_nan() || near.abs() > far.abs() { near.abs() } else { far.abs() });
    }
    let safety = if (order - formal).abs() <= 0.1 * formal { 1.25 } else { 3.0 };
    let believed = order.clamp(LEAST_ORDER, formal);
    (Some(order), safety, safety * near.abs() / (RATIO.powf(believed) - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_order_is_found_and_the_error_is_within() {
        // f(h) = 1 + 0.3 h² at h = 1, 2, 4 has an error of 0.3 at the finest level.
        let (order, safety, uncertainty) = of_finest([1.3, 2.2, 5.8], 2.0);
        assert!(order.is_some_and(|order| (order - 2.0).abs() < 1e-12) && safety == 1.25);
        assert!((uncertainty - 1.25 * 0.3).abs() < 1e-12);
        // First order, although the method has second order: the uncertainty is three times the remaining error.
        let (order, safety, uncertainty) = of_finest([1.3, 1.6, 2.2], 2.0);
        assert!(order.is_some_and(|order| (order - 1.0).abs() < 1e-12) && safety == 3.0);
        assert!((uncertainty - 0.9).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_converge_is_uncertain_by_its_scatter() {
        let (order, safety, uncertainty) = of_finest([1.0, 1.25, 1.125], 2.0);
        assert!(order.is_none() && safety == 3.0 && uncertainty == 0.75);
        assert!(of_finest([f64::NAN, 1.0, 2.0], 2.0).2.is_nan());
    }
}
