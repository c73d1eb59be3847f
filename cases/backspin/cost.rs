//! Target quantity of accuracy: the transition from sliding to rolling, over stiffness.

use crate::exact::one_grain::OneGrain;
use crate::rows::one_grain_cost::displacement;
use grainbench_harness::subject::TargetQuantity;

pub(crate) fn subjects() -> Vec<TargetQuantity> {
    const SOURCE: &str = "2001 paper, section on backspin; derivation";
    displacement("backspin", &["disc", "sphere"], 0.5, OneGrain::rigid_backspin, SOURCE)
}
