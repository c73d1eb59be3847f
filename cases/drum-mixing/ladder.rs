//! Effect of half and of twice the time step on the number of M1 spheres in zone 2, compared with the effect of
//! rounding.

use super::{DRUM, EARLY, ZONES, beside, counted, course, of_paper, published};
use grainbench_harness::data::Data;
use grainbench_harness::prelude::*;

/// Time up to which runs are compared (s).
const UNTIL: f64 = 0.5;
/// Half the time step of the case (s).
const HALF: f64 = 1.5e-6;
/// Time step of the case, increased by a millionth (s).
const ROUNDED: f64 = 3.000_003e-6;
/// Twice the time step of the case (s).
const TWICE: f64 = 6e-6;
/// Drum of the paper up to the time [`UNTIL`].
static SHORTER: Data = Data {
    name: "published-half",
    needs: super::PUBLISHED.needs,
    scene: |folder| Ok(Scene { duration: Duration::Seconds(UNTIL), ..published(folder)? }),
};

fn with(step: f64) -> Run {
    Run::new(PLAIN, "dem:liggghts", Resolution::TimeStep(step)).from_data(&SHORTER).read_by(ZONES).long().kept()
}

pub(super) fn claims() -> Vec<Claim> {
    let steps = [("half the step", HALF), ("a step longer by a millionth", ROUNDED), ("twice the step", TWICE)];
    steps.into_iter().map(|(words, step)| worst(words, with(step)).refuses(beside())).collect()
}

fn worst(step: &str, run: Run) -> ClaimWithTolerance {
    claim(format!("M1 in zone 2 to .5 s with {step}, worst"), "1")
        .runs([run, of_paper().aside()])
        .agrees(Source::Ourselves("the same with the step of the case"), |done| {
            let times = course(DRUM).into_iter().map(|[time, ..]| time).filter(|&time| time < UNTIL + 1e-9);
            Measurement::worst_read(
                times.map(|time| Ok(Measurement::relative(counted(&done[0], time)?, counted(&done[1], time)?))),
            )
        })
        .within(required(EARLY.0, "tolerance of a count relative to either code until .5 s"))
}
