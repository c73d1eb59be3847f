//! A wide silo that drains through a slit, evaluated in granular elements.

use crate::silo::claims::{Drained, Silo, case};
use crate::silo::collapse;
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case =
    case(crate::heads::SILO_WIDE, &|| SILO.claims(vec![SILO.turn(prototype::WIDE_TURN), SILO.symmetry()]), |runner| {
        SILO.figures(runner, &[])
    });

static SILO: Silo = Silo {
    variants: ["drained", "paper"],
    set: Set::Long,
    means: [prototype::WIDE_SINE, prototype::WIDE_PACKING],
    packings: include_str!("packings.csv"),
    bins: prototype::WIDE_INERTIA,
    label: "wide silo, drained",
    drained: Some(Drained {
        plateau: prototype::WIDE_PLATEAU,
        onset: prototype::WIDE_ONSET,
        angles: [prototype::WIDE_LARGEST, prototype::WIDE_WINDOW],
        correlations: [prototype::CRITERIA, prototype::WIDE_RATES],
        // Up to 14 τ, 33 elements have been in the last bin, so its mean is uncertain by at least 0.003.
        first_bins: 9,
        // The case `silo-tall` compares the curves of this silo with other flows.
        beside: None,
        others: &collapse::BESIDE_WIDE,
    }),
};
