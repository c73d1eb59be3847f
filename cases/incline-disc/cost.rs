//! Target quantity of the cost study: the displacement of a disc that rolls or slips down a plane, for several
//! stiffnesses.

use crate::exact::one_grain::OneGrain;
use crate::rows::one_grain_cost::displacement;
use grainbench_harness::subject::TargetQuantity;

pub(crate) fn subjects() -> Vec<TargetQuantity> {
    displacement("incline-disc", &["60deg-mu.9", "60deg-mu.3"], 0.3, OneGrain::rigid_incline, "MPM 2000 eq. 25")
}
