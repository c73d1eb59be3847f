//! A tall silo that drains through a slit, evaluated in granular elements.

use crate::silo::ELEMENTS;
use crate::silo::claims::{DrainNumbers, GONE, LEVELS, Silo, case, no_springs};
use crate::silo::ensemble::{Flow, gone};
use crate::silo::paper::{DrainExpectations, PaperSize};
use crate::silo::{collapse, flows};
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = case(crate::heads::SILO_TALL, &claims, figures);

static DRAINED: DrainNumbers = DrainNumbers {
    plateau: prototype::TALL_PLATEAU,
    onset: prototype::TALL_ONSET,
    angles: [prototype::TALL_LARGEST, prototype::TALL_WINDOW],
    correlations: [prototype::CRITERIA, prototype::TALL_RATES],
    bins: prototype::TALL_INERTIA,
};

fn silo() -> Silo {
    let run = Run::new("drained", "dem", LEVELS[0].resolution).read_by(ELEMENTS).kept().slow();
    Silo {
        flow: Flow::Drained,
        run,
        means: [prototype::TALL_SINE, prototype::TALL_PACKING],
        packings: include_str!("packings.csv"),
    }
}

fn full_size() -> PaperSize {
    PaperSize {
        variant: "paper",
        label: "tall silo, drained",
        bins: DRAINED.bins,
        drained: Some(DrainExpectations {
            numbers: &DRAINED,
            bins: DRAINED.bins.len(),
            beside: Some(&collapse::PAPER[0]),
            others: &collapse::PAPER,
        }),
    }
}

fn claims() -> Vec<Claim> {
    let silo = silo();
    let own = vec![
        silo.deposit(prototype::DEPOSIT),
        silo.equals(GONE, prototype::TALL_GONE, no_springs(), gone),
        silo.turn(prototype::TALL_TURN),
        silo.symmetry(),
        silo.beside_lammps(GONE, gone),
        collapse::of_drains(silo.run.clone(), &collapse::TENTH[0], ["the wide silo", ""]),
        collapse::of_strained(silo.run.clone(), &collapse::TENTH, ""),
    ];
    [own, silo.of_every(), silo.of_drains(&DRAINED), full_size().claims()].concat()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let done = runner.run(&silo().run)?;
    let mut all = crate::silo::figures::all(&done, DRAINED.bins);
    all.extend(flows::figures(&done, "tall silo, drained", &collapse::TENTH));
    all.extend(full_size().figures(runner));
    Ok(all)
}
