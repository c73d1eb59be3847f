//! Comparison of positions and contact forces with LAMMPS and LIGGGHTS.

use super::{DISTORTION, LEVELS, MODAL, law, over_radius, rounded, travel};
use crate::rows::programs::{PAIRS, discs_for, layer_of_spheres, row, stiffer};
use grainbench_harness::prelude::*;

const STEP: Resolution = LEVELS[0].resolution;
/// Columns with the compared positions.
const POSITIONS: [&str; 4] = ["edge.x", "edge.y", "corner.x", "corner.y"];
const BETWEEN: [&str; 4] =
    ["centre-edge.normal_force", "corner-edge.normal_force", "centre-edge.shear_force", "corner-edge.shear_force"];
const AT_WALLS: [&str; 3] = ["wall-edge.normal_force", "wall-corner.normal_force", "wall-corner.shear_force"];

pub(super) fn claims() -> Vec<Claim> {
    // Positions are in units of the travel of the walls.
    let over_all_cycles = |variant, pair| {
        let quantity = "position over all cycles, worst";
        row(quantity, "m", rounded(variant), runs(variant, pair), stiffer(), |done| {
            worst(done, &POSITIONS, travel(&done[0]))
        })
    };
    let positions = MODAL.into_iter().flat_map(|variant| PAIRS.map(|pair| over_all_cycles(variant, pair)));
    // LIGGGHTS moves walls as meshes and does not report the wall force on each disc.
    let forces = [
        forces(PAIRS[0], "forces between discs, worst", &BETWEEN),
        forces(PAIRS[1], "forces between discs, worst", &BETWEEN),
        forces(PAIRS[0], "forces at walls, worst", &AT_WALLS),
    ];
    positions.chain(PAIRS.map(while_walls_turn)).chain(forces).collect()
}

fn runs(variant: &'static str, pair: [&'static str; 2]) -> [Run; 2] {
    pair.map(|solver| discs_for(pair[1], Run::new(variant, solver, STEP)))
}

/// Returns the claim on contact forces, in units of k_n δ with the travel δ of the walls.
fn forces(pair: [&'static str; 2], quantity: &str, columns: &'static [&'static str]) -> Claim {
    let unit = |done: &FinishedRun| {
        let (phase, time_step) = (&done.scene.walls[0].motion.phases[0], done.record.provenance.time_step);
        law(&done.scene).normal_stiffness() * phase.velocity.norm() * phase.stop.seconds(time_step)
    };
    let variant = "kappa-1";
    row(quantity, "N", rounded(variant), runs(variant, pair), stiffer(), move |done| {
        worst(done, columns, unit(&done[0]))
    })
}

/// Returns the claim on the positions while the walls rotate, without damping. LAMMPS and LIGGGHTS have no global
/// damping, and a damped contact of LIGGGHTS depends on where one `run` command ends and the next begins.
fn while_walls_turn(pair: [&'static str; 2]) -> Claim {
    fn undamped(scene: &mut Scene) {
        scene.global_damping = 0.0;
        scene.change_laws(|law| law.stiffness_damping = 0.0);
    }
    let variant = DISTORTION[1];
    let runs = pair.map(|solver| {
        let run = Run::new(variant, solver, STEP);
        if pair[1] == "liggghts" {
            run.adjusted("undamped, one layer of spheres", |scene| {
                undamped(scene);
                layer_of_spheres(scene);
            })
        } else {
            run.adjusted("undamped", undamped)
        }
    });
    let control = Control::ours("walls that turn faster by 1e-6 in ours", |scene| {
        scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases).for_each(|phase| phase.spin *= 1.0 + 1e-6);
    });
    let allowed = rounding(
        3.0 / over_radius(variant),
        "rounding only, because both programs use the same integration cycle: sliding contacts preserve the rounding \
         of positions up to 3R",
    );
    row("position while the walls turn, worst", "m", allowed, runs, control, |done| {
        worst(done, &POSITIONS, travel(&done[0]))
    })
}
