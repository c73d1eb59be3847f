//! Target quantity of the cost study: the displacement of a sphere that rolls or slips down a plane, for several
//! stiffnesses.

use crate::exact::one_grain::OneGrain;
use crate::rows::one_grain_cost::displacement;
use grainbench_harness::subject::TargetQuantity;

pub(crate) fn subjects() -> Vec<TargetQuantity> {
    displacement(
        "incline-sphere",
        &["45deg-mu.495", "60deg-mu2_7"],
        0.3,
        OneGrain::rigid_incline,
        "2001 paper, eqs. 23-26",
    )
}
