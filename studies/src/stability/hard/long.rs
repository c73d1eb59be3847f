//! Rest during many time steps without creep.

use super::{HardCase, case, end, kinetic, near};
use crate::stability::failure::Failure;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Record;
use std::fmt::Write as _;

/// Duration of the run, in units of a tenth of the critical time step.
const STEPS: f64 = 1e6;

pub(super) fn cases() -> Vec<HardCase> {
    vec![case(
        "heap-at-rest-for-1e6-steps",
        "six discs in a heap come to rest and stay at rest: after 10⁶ steps of the springs each disc is within R/100 \
         of its place, and none moves",
        &heap(),
        at_rest,
    )]
}

/// Returns the scene of a heap: rows of three, two and one discs between two vertical walls, with friction and
/// dashpots.
///
/// All masses are 1 and k = 1e6, so that a tenth of the critical time step is 2e-4 s.
fn heap() -> String {
    let mut text = format!(
        "title = 'A heap'\ndimension = 2\ngravity = [0.0, -10.0]\nduration = {:?}\nmaterials.m.density = {:?}\n\
         [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\ntangential_stiffness = 2.857142857e5\nfriction = 0.5\n\
         normal_damping = 500.0\ntangential_damping = 500.0\n",
        STEPS * 2e-4,
        std::f64::consts::FRAC_1_PI
    );
    let rise = 3.0_f64.sqrt();
    for (at, (x, y)) in
        [(-2.0, 0.0), (0.0, 0.0), (2.0, 0.0), (-1.0, rise), (1.0, rise), (0.0, 2.0 * rise)].iter().enumerate()
    {
        let _ = write!(text, "[grains.g{at}]\nmaterial = 'm'\nradius = 1.0\nposition = [{x:?}, {:?}]\n", y + 1.0);
    }
    for (name, point, normal) in
        [("floor", [0.0, 0.0], [0.0, 1.0]), ("left", [-3.0, 0.0], [1.0, 0.0]), ("right", [3.0, 0.0], [-1.0, 0.0])]
    {
        let _ = write!(text, "[walls.{name}]\nmaterial = 'm'\nplane = {{ point = {point:?}, normal = {normal:?} }}\n");
    }
    text + "[output]\nevery = 1.0\n[probes]\nall = { system = true }\n"
}

fn at_rest(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    for (grain, start) in grains.iter().zip(&scene.grains) {
        near(&format!("displacement of grain {}", grain.id), (grain.position - start.position).norm(), 0.0, 0.01)?;
    }
    near("kinetic energy", kinetic(grains, scene), 0.0, 1e-6)
}
