//! A wide silo that drains through a slit, evaluated in granular elements.

use crate::silo::ELEMENTS;
use crate::silo::claims::{DrainNumbers, LEVELS, Silo, case};
use crate::silo::collapse;
use crate::silo::ensemble::Flow;
use crate::silo::paper::{DrainExpectations, PaperSize};
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = case(crate::heads::SILO_WIDE, &claims, figures);

static DRAINED: DrainNumbers = DrainNumbers {
    plateau: prototype::WIDE_PLATEAU,
    onset: prototype::WIDE_ONSET,
    angles: [prototype::WIDE_LARGEST, prototype::WIDE_WINDOW],
    correlations: [prototype::CRITERIA, prototype::WIDE_RATES],
    bins: prototype::WIDE_INERTIA,
};

fn silo() -> Silo {
    let run = Run::new("drained", "dem", LEVELS[0].resolution).read_by(ELEMENTS).kept().long();
    Silo {
        flow: Flow::Drained,
        run,
        means: [prototype::WIDE_SINE, prototype::WIDE_PACKING],
        packings: include_str!("packings.csv"),
    }
}

fn full_size() -> PaperSize {
    PaperSize {
        variant: "paper",
        label: "wide silo, drained",
        bins: DRAINED.bins,
        drained: Some(DrainExpectations {
            numbers: &DRAINED,
            // Up to 14 τ, 33 elements have been in the last bin, so its mean is uncertain by at least 0.003.
            bins: 9,
            // The case `silo-tall` compares the curves of this silo with other flows.
            beside: None,
            others: &collapse::BESIDE_WIDE,
        }),
    }
}

fn claims() -> Vec<Claim> {
    let silo = silo();
    let own = vec![silo.turn(prototype::WIDE_TURN), silo.symmetry()];
    [own, silo.of_every(), silo.of_drains(&DRAINED), full_size().claims()].concat()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut all = crate::silo::figures::all(&runner.run(&silo().run)?, DRAINED.bins);
    all.extend(full_size().figures(runner));
    Ok(all)
}
