//! Claims that our contact forces equal the forces in the contact dumps and wall dumps of LAMMPS and LIGGGHTS.
//!
//! At output, both programs evaluate the forces between grains again, with the velocities of the full step. The dumped
//! dashpot forces therefore differ from the forces that moved the grains, so runs with contacts between grains are
//! undamped. The dumped wall forces are the forces that moved the grains.

use crate::rows::programs::{PAIRS, discs_for, row, stiffer};
use grainbench_harness::compare::pointwise::worst;
use grainbench_harness::prelude::*;

const BECAUSE: &str = "rounding only, because both programs use the same integration cycle and round positions alike; \
                       in units of the largest force";

/// Returns the claims that the forces in `columns` equal those of LAMMPS and of LIGGGHTS. `unit` returns the unit of
/// the error (N) from the scene and the time step (s).
#[must_use]
pub fn forces(
    runs: impl Fn(&'static str) -> Run,
    columns: &'static [&'static str],
    unit: impl Fn(&Scene, f64) -> f64 + Clone + Send + Sync + 'static,
) -> Vec<Claim> {
    let force_row = |pair: [&'static str; 2]| {
        let unit = unit.clone();
        row("force at contacts, worst", "N", rounding(1.0, BECAUSE), pair.map(&runs), stiffer(), move |done| {
            worst(done, columns, unit(&done[0].scene, done[0].record.provenance.time_step))
        })
    };
    PAIRS.map(force_row).to_vec()
}

/// Returns the claims on the contact forces of the nine discs, in units of k_n δ, where δ is the travel of the walls.
/// LIGGGHTS moves walls as meshes and does not report the wall force on each disc, so wall forces are compared with
/// LAMMPS only. `rounded` is the rounding tolerance of positions.
#[must_use]
pub fn nine_discs(variant: &'static str, resolution: Resolution, rounded: &Tolerance) -> Vec<Claim> {
    const BETWEEN: &[&str] =
        &["centre-edge.normal_force", "corner-edge.normal_force", "centre-edge.shear_force", "corner-edge.shear_force"];
    const AT_WALLS: &[&str] = &["wall-edge.normal_force", "wall-corner.normal_force", "wall-corner.shear_force"];
    let unit = |scene: &Scene, time_step: f64| {
        let phase = &scene.walls[0].motion.phases[0];
        let stiffness = scene.laws[0].map_or(0.0, |law| law.normal_stiffness());
        stiffness * phase.velocity.norm() * phase.stop.seconds(time_step)
    };
    let force_row = |pair: [&'static str; 2], quantity: &str, columns: &'static [&'static str]| {
        let runs = pair.map(|solver| discs_for(pair[1], Run::new(variant, solver, resolution)));
        row(quantity, "N", rounded.clone(), runs, stiffer(), move |done| {
            worst(done, columns, unit(&done[0].scene, done[0].record.provenance.time_step))
        })
    };
    vec![
        force_row(PAIRS[0], "forces between discs, worst", BETWEEN),
        force_row(PAIRS[1], "forces between discs, worst", BETWEEN),
        force_row(PAIRS[0], "forces at walls, worst", AT_WALLS),
    ]
}
