//! How far a value may be off because cells and steps are finite, from three levels of resolution.
//!
//! With values f₁, f₂, f₃ of levels h, rh, r²h the observed order is p = ln((f₃ − f₂)/(f₂ − f₁))/ln r, and the value of
//! level h is uncertain by U = F_s |f₁ − f₂|/(rᵖ − 1). The factor of safety F_s is 1.25 where p is within a tenth of
//! the order that the method has, and 3 elsewhere, with p between ½ and that order. Where the differences change sign
//! or grow, U is three times the largest of them (ASME V&V 20-2009, section 2; Eça & Hoekstra 2014).

use serde::{Deserialize, Serialize};

/// Ratio of one level's step or cell to that of the next finer one.
pub const RATIO: f64 = 2.0;
/// The lowest order that is believed.
const LEAST_ORDER: f64 = 0.5;

/// What three levels tell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Variant of the claim.
    pub variant: String,
    /// Solver.
    pub solver: String,
    /// Resolution of the claim.
    pub resolution: String,
    /// Quantity.
    pub quantity: String,
    /// Resolutions of the levels, fine to coarse.
    pub levels: [String; 3],
    /// What was measured at each, in units of the claim's scale, from what is expected.
    pub values: [f64; 3],
    /// Observed order; none where the differences change sign or grow.
    pub order: Option<f64>,
    /// Factor of safety.
    pub safety: f64,
    /// U of the claim's level, in units of the claim's scale.
    pub uncertainty: f64,
}

/// Order, factor of safety and uncertainty of the finest of three values, fine to coarse, of a method of order
/// `formal`.
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
        // f(h) = 1 + .3 h² at h = 1, 2, 4: off by .3 at the finest.
        let (order, safety, uncertainty) = of_finest([1.3, 2.2, 5.8], 2.0);
        assert!(order.is_some_and(|order| (order - 2.0).abs() < 1e-12) && safety == 1.25);
        assert!((uncertainty - 1.25 * 0.3).abs() < 1e-12);
        // Of first order where the method claims the second: three times what is left.
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
