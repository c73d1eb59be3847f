//! The deposit of the wide silo with half of its floor pushed up, evaluated in granular elements.

use crate::silo::ELEMENTS;
use crate::silo::claims::{LEVELS, Silo, case};
use crate::silo::ensemble::Flow;
use crate::silo::paper::PaperSize;
use crate::sources::prototype::silo as prototype;
use grainbench_harness::prelude::*;

pub(crate) static CASE: Case = case(crate::heads::SILO_PUSH, &claims, figures);

fn silo() -> Silo {
    let run = Run::new("pushed", "dem", LEVELS[0].resolution).read_by(ELEMENTS).kept().long();
    Silo {
        flow: Flow::Pushed,
        run,
        means: [prototype::PUSH_SINE, prototype::PUSH_PACKING],
        packings: include_str!("packings.csv"),
    }
}

fn full_size() -> PaperSize {
    PaperSize { variant: "deep", label: "tall silo, pushed", bins: prototype::PUSH_INERTIA, drained: None }
}

fn claims() -> Vec<Claim> {
    [silo().of_every(), full_size().claims()].concat()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut all = crate::silo::figures::all(&runner.run(&silo().run)?, prototype::PUSH_INERTIA);
    all.extend(full_size().figures(runner));
    Ok(all)
}
