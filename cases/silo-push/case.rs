//! The deposit of the wide silo with half of its floor pushed up, evaluated in granular elements.

use crate::silo::claims::{Silo, case};
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case =
    case(crate::heads::SILO_PUSH, &|| SILO.claims(Vec::new()), |runner| SILO.figures(runner, &[]));

static SILO: Silo = Silo {
    variants: ["pushed", "deep"],
    set: Set::Long,
    means: [prototype::PUSH_SINE, prototype::PUSH_PACKING],
    packings: include_str!("packings.csv"),
    bins: prototype::PUSH_INERTIA,
    label: "tall silo, pushed",
    drained: None,
};
