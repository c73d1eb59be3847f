//! LIGGGHTS on the same bed as ours.

use super::LEVELS;
use crate::rows::programs::row;
use grainbench_harness::compare::pointwise::together;
use grainbench_harness::prelude::*;

/// LIGGGHTS on a thousand grains, until what it keeps of contacts that open and close again is felt: the ball meets the bed at
/// .24 ms.
pub(super) fn beside() -> Claim {
    const UNTIL: f64 = 2.5e-4;
    let runs = ["dem:liggghts", "liggghts"].map(|solver| Run::new("thousand", solver, LEVELS[1].resolution));
    let allowed = judged(1e-11, "the same cycle: order of sums; in units of its radius");
    let control = Control::ours("E* × 1.00001 in ours", |scene| scene.change_laws(|law| law.scale_normal(1.00001)));
    row("height of the ball on a thousand grains until .25 ms, worst", "m", allowed, runs, control, |done| {
        let (ours, theirs) = together(&done[0], &done[1], "ball.z")?;
        let until = done[1].series().time.partition_point(|time| *time < UNTIL + 1e-9);
        let radius = done[0].scene.grains[0].radius;
        Ok(Measured::worst_of(&done[1].series().time[..until], &ours[..until], &theirs[..until], radius))
    })
}
