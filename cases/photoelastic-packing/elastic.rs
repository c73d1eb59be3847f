//! Fifty of the discs as elastic bodies, whose contacts have no stiffness of their own.

use super::{FOUND, GROWTH, IMPOSED, LADDER, equilibrium, further_to_b, ratio_at_b, run, stages};
use crate::effect::Effect;
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use nalgebra::Vector3;

const VARIANT: &str = "fifty-elastic";
/// Two cells in the smallest radius.
const HALF: usize = 2;

/// The elastic discs.
pub(super) fn discs() -> Run {
    Run::new(VARIANT, "mpm", LADDER[HALF].resolution).long()
}

/// The same, left alone from stage A on.
fn alone() -> Run {
    discs().adjusted("walls that stay at stage A", |scene| {
        scene.walls.iter_mut().for_each(|wall| wall.motion.phases[1].velocity = Vector3::zeros());
    })
}

/// F_V at stages A and B.
fn vertical(done: &Done) -> Result<[f64; 2], Missing> {
    Ok(stages(done)?.map(|stage| stage.vertical))
}

pub(super) fn gates() -> Vec<Gate> {
    let mut gates = equilibrium(&[discs()], "50 elastic discs");
    gates.push(Gate::new(
        ("growth of F_V to stage B against that of discs left alone, 50 elastic discs", "1"),
        vec![discs(), alone().aside()],
        (Evidence::Invariant, IMPOSED),
        (2e-4, FOUND),
        further_to_b(),
        |done| {
            let ([_, sheared], [_, alone]) = (vertical(&done[0])?, vertical(&done[1])?);
            Ok(Measured::new(sheared / alone - 1.0, GROWTH, 1.0))
        },
    ));
    gates.push(Gate::new(
        ("F_V at stage B over that at stage A, walls at rest, 50 elastic discs", "1"),
        vec![alone().known(
            "forces fade at rest, the slower the longer it lasts and the more points a cell has (derivation)",
        )],
        (Evidence::Invariant, "elastic discs at rest go on bearing what they bear"),
        (1e-4, "discs on springs lose 1e-5"),
        Control::without_the_error("discs on springs", "dem", LADDER[0].resolution),
        |done| {
            let [a, b] = vertical(&done[0])?;
            Ok(Measured::new(b / a, 1.0, 1.0))
        },
    ));
    gates.push(Gate::new(
        ("F_H/F_V at stage B, 50 elastic discs against discs on springs", "1"),
        vec![discs(), run("fifty").aside()],
        (Evidence::OtherCode, "our DEM from the same start, its walls led to the same stage A and growth"),
        (0.018, "what packings differ by: twice the standard deviation over ten of them (derivation)"),
        Control::without(Effect::Friction),
        |done| Ok(Measured::new(ratio_at_b(&stages(&done[0])?), ratio_at_b(&stages(&done[1])?), 1.0)),
    ));
    gates
}
