//! Target quantity of the cost study: the displacement of a grain that first slides and then rolls, for several
//! stiffnesses.

use crate::exact::one_grain::OneGrain;
use crate::rows::one_grain_cost::displacement;
use grainbench_harness::subject::TargetQuantity;

pub(crate) fn subjects() -> Vec<TargetQuantity> {
    displacement(
        "backspin",
        &["disc", "sphere"],
        0.5,
        OneGrain::rigid_backspin,
        "2001 paper, section on backspin; derivation",
    )
}
