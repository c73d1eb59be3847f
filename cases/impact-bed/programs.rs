//! Comparison with LIGGGHTS on our beds.

use super::{DEEP, FINE, MET, STEP, height, lighten, of_two_beds};
use crate::rows::programs::{ENERGY, LIGGGHTS, row};
use grainbench_harness::compare::perturbed::{self, DivergenceColumns, PERTURBED, Sum};
use grainbench_harness::prelude::*;
use grainbench_solver::perturbed::move_one;

pub(super) fn claims() -> Vec<Claim> {
    vec![beginning(), after_the_horizon(), on_the_bed()]
}

/// Returns the claim that our solver and LIGGGHTS agree to rounding on a thousand grains up to 0.25 ms. Later, LIGGGHTS
/// differs because it retains the history of a contact that has opened. The ball hits the bed at 0.24 ms.
fn beginning() -> Claim {
    const UNTIL: f64 = 2.5e-4;
    let runs = LIGGGHTS.map(|solver| Run::new("thousand", solver, FINE));
    let allowed = rounding(
        1.0,
        "rounding only, because both programs use the same integration cycle with another \
                                 order of sums; in units of the radius of the ball",
    );
    let control = Control::our_contact_law("E* × 1.00001 in ours", |law| law.scale_normal(1.00001));
    row("height of the ball on a thousand grains until .25 ms, worst", "m", allowed, runs, control, |done| {
        let (ours, theirs) = together(&done[0], &done[1], "ball.z")?;
        let until = done[1].series().time.partition_point(|time| *time < UNTIL + 1e-9);
        let radius = done[0].scene.grains[0].radius;
        Ok(Measurement::worst_of(&done[1].series().time[..until], &ours[..until], &theirs[..until], radius))
    })
}

/// Returns the claim on time averages of a thousand grains after the predictability horizon at 3.7 ms.
fn after_the_horizon() -> Claim {
    const MOTION: Sum = Sum {
        column: ENERGY,
        words: "logarithm of the kinetic energy of a thousand grains and the ball",
        unit: "1",
        logarithm: true,
    };
    const PARTING: DivergenceColumns = &[MOTION.column];
    let on = |solver| Run::new("thousand-deep", solver, STEP).slow();
    let perturbed = [on(LIGGGHTS[0]).aside(), on(LIGGGHTS[0]).adjusted(PERTURBED, move_one).aside()];
    let control = Control::our_contact_law("no friction in ours", |law| law.friction = 0.0);
    perturbed::statistics(PARTING, MOTION, [LIGGGHTS.map(on), perturbed].concat(), control)
}

/// Returns the claim on the height of the ball on 25,000 grains, from just before the impact.
fn on_the_bed() -> Claim {
    let runs = LIGGGHTS.map(|solver| Run::new("down", solver, STEP).slow());
    let control = Control::ours("half the density of the ball in ours", lighten);
    row("height of the ball at 30 ms, one bed", "mm", of_two_beds(), runs, control, |done| {
        Ok(Measurement::new(height(&done[0], DEEP - MET)?, height(&done[1], DEEP - MET)?, 1.0))
    })
}
