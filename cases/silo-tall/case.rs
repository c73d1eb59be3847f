//! A tall silo that drains through a slit, evaluated in granular elements.

use crate::silo::claims::{Drained, GONE, Silo, case, no_springs};
use crate::silo::collapse;
use crate::silo::ensemble::gone;
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = case(crate::heads::SILO_TALL, &claims, |runner| SILO.figures(runner, &collapse::TENTH));

static SILO: Silo = Silo {
    variants: ["drained", "paper"],
    set: Set::Tests,
    means: [prototype::TALL_SINE, prototype::TALL_PACKING],
    packings: include_str!("packings.csv"),
    bins: prototype::TALL_INERTIA,
    label: "tall silo, drained",
    drained: Some(Drained {
        plateau: prototype::TALL_PLATEAU,
        onset: prototype::TALL_ONSET,
        angles: [prototype::TALL_LARGEST, prototype::TALL_WINDOW],
        correlations: [prototype::CRITERIA, prototype::TALL_RATES],
        first_bins: prototype::TALL_INERTIA.len(),
        beside: Some(&collapse::PAPER[0]),
        others: &collapse::PAPER,
    }),
};

fn claims() -> Vec<Claim> {
    SILO.claims(vec![
        SILO.deposit(prototype::DEPOSIT),
        SILO.equals(GONE, prototype::TALL_GONE, no_springs(), gone),
        SILO.turn(prototype::TALL_TURN),
        SILO.symmetry(),
        SILO.beside_lammps(GONE, gone),
        collapse::of_drains(SILO.run(), &collapse::TENTH[0], ["the wide silo", ""]),
        collapse::of_strained(SILO.run(), &collapse::TENTH, ""),
    ])
}
