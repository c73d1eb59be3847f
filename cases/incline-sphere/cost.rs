//! Target quantity of accuracy: rolling and slipping down a plane in three dimensions, over stiffness.

use crate::exact::one_grain::OneGrain;
use crate::rows::one_grain_cost::displacement;
use grainbench_harness::subject::TargetQuantity;

pub(crate) fn subjects() -> Vec<TargetQuantity> {
    const SOURCE: &str = "2001 paper, eqs. 23-26";
    displacement("incline-sphere", &["45deg-mu.495", "60deg-mu2_7"], 0.3, OneGrain::rigid_incline, SOURCE)
}
