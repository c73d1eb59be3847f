//! Impact on 100,000 grains, while the ball moves down.

use super::{half_the_density, height};
use crate::rows::bulk::of_packings;
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;

/// Variants with our own beds, each with another random seed.
const OWN: [&str; 5] =
    ["hundred-thousand", "hundred-thousand-2", "hundred-thousand-3", "hundred-thousand-4", "hundred-thousand-5"];
/// Time of the comparison (s), while the ball moves down.
const DOWN: f64 = 0.03;

fn on_all() -> [Run; 5] {
    OWN.map(|variant| Run::new(variant, "dem:liggghts", super::STEP).paper_size().kept())
}

pub(super) fn claims() -> Vec<Claim> {
    let quantity = ("height of the ball at 30 ms, 100,000 grains, mean of five beds".to_owned(), "mm");
    let at_30_ms = of_packings(
        quantity,
        on_all().to_vec(),
        (dosta::HEIGHT_30_100K, dosta::HEIGHT_30_100K_HALF),
        |done| height(done, DOWN),
        "in units of 2 √(s_code² + s_bed² (1/5 + 1)), with s_code from two codes on one bed and s_bed between our \
         beds; fixed before any run",
    );
    vec![at_30_ms.refuses(half_the_density())]
}

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let codes = vec![(DOWN * 1e3, dosta::HEIGHT_30_100K.value)];
    let mut curves = vec![Curve::new("LIGGGHTS and MUSEN, one bed", Stroke::Markers, codes)];
    for (number, run) in on_all().iter().enumerate() {
        let done = runner.run(run)?;
        curves.push(Curve::new(format!("own bed {}", number + 1), Stroke::Line, super::course(&done)));
    }
    Ok(Figure::graph(
        "hundred-thousand",
        "Height of the ball, 100,000 grains",
        "Height of the ball's centre on our five beds of 100,000 grains. The marker is the height of two codes at 30 \
         ms on one bed (Dosta et al. 2024, derived).",
        [Axis::linear("time (ms)"), Axis::linear("height (mm)")],
        curves,
    ))
}
