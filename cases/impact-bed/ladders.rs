//! Effect of a longer time step, and of softer steel of ball and walls, on the height of the ball.

use super::{DEEP, MET, half_the_density, height, of_two_beds};
use grainbench_harness::prelude::*;

/// Variants for the comparison of time steps. They start 20 ms after the release of the ball.
const BEDS: [&str; 3] = ["down", "down-2", "down-3"];
/// Time steps (s). The first is the time step of the paper.
const STEPS: [f64; 4] = [5e-7, 1e-6, 2e-6, 4e-6];
/// Young's moduli (GPa) of the steel of ball and walls, with the variants.
const STEEL: [(f64, &str); 3] = [(210.0, "down"), (21.0, "down-21-gpa"), (2.1, "down-2-gpa")];

fn on(variant: &'static str, step: f64) -> Run {
    Run::new(variant, "dem:liggghts", Resolution::TimeStep(step)).long().kept()
}

fn at_30_ms(done: &FinishedRun) -> Result<f64, MissingData> {
    height(done, DEEP - MET)
}

pub(super) fn claims() -> Vec<Claim> {
    let steps = STEPS[1..].iter().map(|&step| {
        let runs = BEDS.into_iter().flat_map(|bed| [on(bed, step), on(bed, STEPS[0]).aside()]);
        beside(&format!("height of the ball at 30 ms with a step of {step:e} s for 5e-7 s, worst of three beds"), runs)
            .refuses(half_the_density())
    });
    let steel = STEEL[1..].iter().map(|&(modulus, variant)| {
        let runs = [on(variant, STEPS[2]), on(STEEL[0].1, STEPS[2]).aside()];
        beside(&format!("height of the ball at 30 ms with steel of {modulus} GPa for 210 GPa"), runs)
            .refuses(half_the_density())
    });
    steps.chain(steel).collect()
}

/// Returns the claim that runs agree with their reference runs. Runs and reference runs alternate in `runs`.
fn beside(quantity: &str, runs: impl IntoIterator<Item = Run>) -> ClaimWithTolerance {
    claim(quantity, "mm")
        .runs(runs)
        .agrees(Source::Ourselves("the same with the step of the paper, or with steel"), |done| {
            let pairs = done.chunks_exact(2);
            Measurement::worst_read(
                pairs.map(|pair| Ok(Measurement::new(at_30_ms(&pair[0])?, at_30_ms(&pair[1])?, 1.0))),
            )
        })
        .within(of_two_beds())
}

pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for (number, bed) in BEDS.into_iter().enumerate() {
        let points: Result<Vec<(f64, f64)>, RunError> = STEPS
            .into_iter()
            .map(|step| Ok((step * 1e6, at_30_ms(&runner.run(&on(bed, step))?).unwrap_or(f64::NAN))))
            .collect();
        curves.push(Curve::new(format!("own bed {}", number + 1), Stroke::MarkedLine, points?));
    }
    Ok(vec![Figure::graph(
        "steps",
        "Height of the ball over the time step",
        "Height of the ball at 30 ms on three of our beds. The paper's step is 0.5 µs, 6 % of Rayleigh's. By the \
         published spread between beds, 95 % of the pairs of beds differ by at most 0.39 mm.",
        [Axis::log("time step (µs)"), Axis::linear("height at 30 ms (mm)")],
        curves,
    )])
}
