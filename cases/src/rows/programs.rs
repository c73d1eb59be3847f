//! Claims that our solver in the contact convention of LAMMPS or LIGGGHTS gives the results of a stored or live run of
//! that program.

use crate::rows::on_plane::{DAMPING, at_overlap};
use grainbench_harness::prelude::*;
use grainbench_scene::dimension::GrainShape;

/// Pairs of solvers: our solver in the contact convention of a program, and the program.
pub(crate) const PAIRS: [[&str; 2]; 2] = [["dem:lammps", "lammps"], ["dem:liggghts", "liggghts"]];
/// Our solver in the contact convention of LIGGGHTS, and LIGGGHTS.
pub(crate) const LIGGGHTS: [&str; 2] = PAIRS[1];

/// Column of the kinetic energy of translation.
pub(crate) const ENERGY: &str = "all.kinetic_energy";

/// Time step for one grain on a plane: 1e-4 s.
const STEP: Resolution = Resolution::TimeStep(1e-4);

/// Returns the claim that our run (first) agrees with the run of LAMMPS or LIGGGHTS (second).
pub(crate) fn row(
    quantity: &str,
    unit: &'static str,
    tolerance: Tolerance,
    runs: [Run; 2],
    control: Control,
    measure: impl RunsReader<Measurement>,
) -> Claim {
    claim(format!("{quantity}, against {}", runs[1].solver), unit)
        .runs(runs)
        .agrees(Source::Program, measure)
        .within(tolerance)
        .refuses(control)
}

/// Returns the tolerance for rounding in two programs with the same integration cycle. `unit` states the unit of the error.
pub(crate) fn same_cycle(unit: &str) -> Tolerance {
    rounding(1.0, format!("rounding only, because both programs use the same integration cycle; {unit}"))
}

/// Returns the claim on the kinetic energy at each time, before motion becomes chaotic, in units of the largest energy.
/// `until` states the compared part of the run.
pub(crate) fn kinetic_energy(until: &str, runs: [Run; 2], control: Control) -> Claim {
    let allowed = rounding(
        2.0,
        "rounding only, because both programs use the same integration cycle with another order of sums; an energy has \
         twice the relative error of velocities",
    );
    let quantity = format!("kinetic energy of translation {until}, worst");
    row(&quantity, "J", allowed, runs, control, |done| worst(done, &[ENERGY], largest(done[1].column(ENERGY)?)))
}

/// Returns the claims on the position of one grain on a plane over one second, undamped and damped. In the damped runs,
/// the conventions of LAMMPS and LIGGGHTS give different results.
pub(crate) fn one_grain(variants: &[&'static str]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for &variant in variants {
        for (pair, [other, _]) in PAIRS.into_iter().zip([PAIRS[1], PAIRS[0]]) {
            // The stiffness affects when a grain starts to slip and how a grain starts to roll.
            let stiffer =
                Control::our_contact_law("tangential stiffness × 1.001 in ours", |law| law.scale_tangential(1.001));
            let other = Control::solver("ours in the convention of the other program", other);
            for (words, damping, control) in [("undamped", 0.0, stiffer), ("damped", DAMPING, other)] {
                let (quantity, allowed) = (format!("position over 1 s, {words}, worst"), same_cycle("in units of R"));
                let runs = pair.map(|solver| at_overlap(variant, solver, 1e-3, damping, STEP));
                claims.push(row(&quantity, "m", allowed, runs, control, |done| {
                    let is_flat = done[0].scene.dimension.count() == 2;
                    let axes = ["grain.x", if is_flat { "grain.y" } else { "grain.z" }];
                    worst(done, &axes, done[0].scene.grains[0].radius)
                }));
            }
        }
    }
    claims
}

/// Replaces discs by a layer of spheres of equal mass, because LIGGGHTS moves walls inwards only in three dimensions.
pub(crate) fn layer_of_spheres(scene: &mut Scene) {
    scene.grain_shape = GrainShape::Sphere;
    let factor = GrainShape::Sphere.inertia_factor();
    scene.grains.iter_mut().for_each(|grain| grain.inertia = factor * grain.mass * grain.radius * grain.radius);
}

/// Returns the run of discs that is compared with a program: for LIGGGHTS a run of one layer of spheres.
pub(crate) fn discs_for(program: &str, run: Run) -> Run {
    if program == "liggghts" { run.adjusted("one layer of spheres", layer_of_spheres) } else { run }
}

pub(crate) fn stiffer() -> Control {
    Control::our_contact_law("stiffness off by 1e-6 in ours", |law| law.scale_normal(1.0 + 1e-6))
}

/// Returns the claims that the forces in `columns` equal the forces in the contact dumps and wall dumps of LAMMPS and of
/// LIGGGHTS. `unit` returns the unit of the error (N) from the scene.
///
/// At output, both programs evaluate the forces between grains again, with the velocities of the full step. The dumped
/// dashpot forces therefore differ from the forces that moved the grains, so runs with contacts between grains are
/// undamped. The dumped wall forces are the forces that moved the grains.
pub(crate) fn forces(
    runs: impl Fn(&'static str) -> Run,
    columns: &'static [&'static str],
    unit: fn(&Scene) -> f64,
) -> [Claim; 2] {
    const BECAUSE: &str = "rounding only, because both programs use the same integration cycle and round positions \
                           alike; in units of the largest force";
    PAIRS.map(|pair| {
        let (quantity, allowed) = ("force at contacts, worst", rounding(1.0, BECAUSE));
        row(quantity, "N", allowed, pair.map(&runs), stiffer(), move |done| worst(done, columns, unit(&done[0].scene)))
    })
}
