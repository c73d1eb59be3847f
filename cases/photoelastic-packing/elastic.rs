//! A packing of fifty elastic discs. Their contacts have no stiffness parameter.

use super::{FOUND, IMPOSED, LEVELS, equilibrium, experiment, further_to_b, ratio_at_b, run, stages};
use crate::stage::NEAR_IN_GROWTH;
use grainbench_harness::prelude::*;

const VARIANT: &str = "fifty-elastic";
/// Index of the level with two cells in the smallest radius.
const HALF: usize = 2;

pub(super) fn discs() -> Run {
    Run::new(VARIANT, "mpm", LEVELS[HALF].resolution).long()
}

fn alone() -> Run {
    discs().adjusted("walls that stay at stage A", |scene| {
        scene.walls.iter_mut().for_each(|wall| wall.motion.phases[1].velocity = Vector3::zeros());
    })
}

/// Returns the vertical wall force F_V (N/m) at stages A and B.
fn vertical(done: &FinishedRun) -> Result<[f64; 2], MissingData> {
    Ok(stages(done)?.map(|stage| stage.vertical))
}

pub(super) fn claims() -> Vec<Claim> {
    let mut claims = equilibrium(&[discs()], "50 elastic discs");
    claims.extend([
        claim("growth of F_V to stage B against that of discs left alone, 50 elastic discs", "1")
            .runs([discs(), alone().aside()])
            .holds(IMPOSED, |done| {
                let ([_, sheared], [_, alone]) = (vertical(&done[0])?, vertical(&done[1])?);
                Ok(Measurement::new(sheared / alone - 1.0, experiment::GROWTH.value, 1.0))
            })
            .within(computed(NEAR_IN_GROWTH, FOUND))
            .refuses(further_to_b()),
        claim("F_V at stage B over that at stage A, walls at rest, 50 elastic discs", "1")
            .run(
                alone()
                    .known(
                        "contact forces decay at rest; the decay becomes slower with time and with more points per \
                            cell (derivation)",
                    )
                    .up_to(0.02),
            )
            .holds("the forces on elastic discs at rest do not change", |done| {
                let [a, b] = vertical(&done[0])?;
                Ok(Measurement::relative(b / a, 1.0))
            })
            .within(judged(1e-4, "discs on springs lose 1e-5"))
            .refuses(Control::without_the_error("discs on springs", "dem:1979", LEVELS[0].resolution)),
        claim("F_H/F_V at stage B, 50 elastic discs against discs on springs", "1")
            .runs([discs(), run("fifty").aside()])
            .agrees(
                Source::Ourselves("discs on springs from the same start, with the same stage A and growth"),
                |done| Ok(Measurement::new(ratio_at_b(&stages(&done[0])?), ratio_at_b(&stages(&done[1])?), 1.0)),
            )
            .within(judged(
                0.018,
                "spread between packings: twice the standard deviation over ten packings (derivation)",
            ))
            .refuses(Control::without(Effect::Friction)),
    ]);
    claims
}
