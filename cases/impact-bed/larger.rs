//! Beds of fifty and of a hundred thousand grains: the ball on its way down, and at rest where codes agree that it comes to rest.

use super::{half_the_density, height, mean};
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;
use grainbench_harness::source::Cited;
use grainbench_reference::round_robin::Spread;

/// Beds of our own, of another seed each, and how many grains are in each.
struct Beds {
    grains: &'static str,
    variants: [&'static str; 5],
}

const FIFTY: Beds = Beds {
    grains: "50,000",
    variants: ["fifty-thousand", "fifty-thousand-2", "fifty-thousand-3", "fifty-thousand-4", "fifty-thousand-5"],
};
const HUNDRED: Beds = Beds {
    grains: "100,000",
    variants: [
        "hundred-thousand",
        "hundred-thousand-2",
        "hundred-thousand-3",
        "hundred-thousand-4",
        "hundred-thousand-5",
    ],
};
/// When the ball is looked at (s): while it goes down, and when it lies still in both codes' bed of 100,000.
const DOWN: f64 = 0.03;
const STILL: f64 = 0.06;

impl Beds {
    fn runs(&self) -> [Run; 5] {
        self.variants.map(|variant| Run::new(variant, "dem:liggghts", super::STEP).paper_size().kept())
    }

    /// The mean of five beds at a time, in units of what it may be off by: codes' deviation from two of them, |a − b|/√2, beds'
    /// from ours.
    fn mean_at(&self, time: f64, cited: Cited, half: Cited) -> Claim {
        let quantity = format!("height of the ball at {:.0} ms, {} grains, mean of five beds", time * 1e3, self.grains);
        claim(&quantity, "mm")
            .of_all(self.runs())
            .equals(cited.source(), move |done| {
                let heights: Vec<f64> = done.iter().map(|done| height(done, time)).collect::<Result<_, _>>()?;
                let own = mean(&heights);
                let variance = heights.iter().map(|height| (height - own).powi(2)).sum::<f64>() / (heights.len() - 1) as f64;
                let code = half.value * std::f64::consts::SQRT_2;
                let allowed = Spread { mean: cited.value, code, bed: variance.sqrt() }.allowed(heights.len(), 1);
                Ok(Measured::new(own, cited.value, allowed))
            })
            .within(computed(
                1.0,
                "in units of 2 √(s_code² + s_bed² (1/5 + 1)), s_code from two codes on one bed, s_bed between our beds: decided \
                 before any was hit",
            ))
            .refuses(half_the_density())
    }
}

pub(super) fn claims() -> Vec<Claim> {
    vec![
        FIFTY.mean_at(DOWN, dosta::HEIGHT_30_50K, dosta::HEIGHT_30_50K_HALF),
        HUNDRED.mean_at(DOWN, dosta::HEIGHT_30_100K, dosta::HEIGHT_30_100K_HALF),
        HUNDRED.mean_at(STILL, dosta::HEIGHT_60_100K, dosta::HEIGHT_60_100K_HALF),
    ]
}

/// The ball's course on our beds of 100,000 and where two codes have it, where the runs are kept.
pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let codes = vec![(DOWN * 1e3, dosta::HEIGHT_30_100K.value), (STILL * 1e3, dosta::HEIGHT_60_100K.value)];
    let mut curves = vec![Curve::new("LIGGGHTS and MUSEN, one bed", Stroke::Markers, codes)];
    for (number, run) in HUNDRED.runs().iter().enumerate() {
        let done = runner.run(run)?;
        let heights = done.column("ball.z").unwrap_or_default();
        let course = done.series().time.iter().zip(heights).map(|(time, height)| (time * 1e3, height * 1e3)).collect();
        curves.push(Curve::new(format!("own bed {}", number + 1), Stroke::Line, course));
    }
    Ok(Figure::graph(
        "hundred-thousand",
        "Height of the ball, 100,000 grains",
        "Height of the ball's centre over time on five beds of 100,000 grains of our own, and where two codes have it at 30 and \
         60 ms on one bed (Dosta et al. 2024, derived).",
        [Axis::linear("time (ms)"), Axis::linear("height (mm)")],
        curves,
    ))
}
