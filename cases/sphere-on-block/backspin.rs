//! The 2001 paper's sphere set down on the deformable plane with backspin: it slides, is spun down, and rolls on.

use super::{FLAT, LADDER, set_down};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::one_grain::{OneGrain, course, last};
use crate::verdict::Evidence;

const VARIANT: &str = "backspin";
const PAPER: &str = "2001 paper, section on backspin: a rigid sphere";
/// Allowed deviation from the rigid sphere at R/4 and R/8.
const ALLOWED: [f64; 2] = [0.035, 0.02];
/// From when on the sphere rolls (s).
const ROLLS: f64 = 0.5;

/// Displacement over that of a rigid sphere, less one.
fn excess(done: &Done) -> Result<f64, Missing> {
    let (t, state) = last(done)?;
    Ok(state.x / OneGrain::of(&done.scene).rigid_backspin(t).x - 1.0)
}

/// Mean velocity while it rolls (m/s).
fn speed(done: &Done) -> Result<f64, Missing> {
    let speeds: Vec<f64> = course(done)?.into_iter().filter(|(t, _)| *t >= ROLLS).map(|(_, state)| state.v).collect();
    if speeds.is_empty() { Err(Missing("samples after .5 s".to_owned())) } else { Ok(speeds.iter().sum::<f64>() / speeds.len() as f64) }
}

fn slippery() -> Control {
    Control::scene("friction × .7", |scene| scene.change_laws(|law| law.friction *= 0.7))
}

pub(super) fn gates() -> Vec<Gate> {
    let mut gates = Vec::new();
    for (rung, allowed) in LADDER[1..].iter().zip(ALLOWED) {
        let runs = || vec![Run::new(VARIANT, "mpm", rung.resolution).long()];
        gates.push(Gate::new(
            (format!("displacement at .8 s over the rigid one, less 1, {}", rung.name), "1"),
            runs(),
            (Evidence::Analytic, PAPER),
            (allowed, "elasticity, +1.5 % in an independent prototype on a rigid plane, and discretisation"),
            slippery(),
            |done| Ok(Measured::new(excess(&done[0])?, 0.0, 1.0)),
        ));
        gates.push(Gate::new(
            (format!("mean velocity of rolling, {}", rung.name), "m/s"),
            runs(),
            (Evidence::OtherCode, "independent prototype of the elastic sphere: 1.459 to 1.478; rigid 10/7"),
            (0.025, "the band 1.43 to 1.48"),
            Control::scene("a tenth less spin", |scene| scene.grains[0].spin *= 0.9),
            |done| Ok(Measured::new(speed(&done[0])?, 1.455, 1.0)),
        ));
    }
    for solver in ["mpm:2000", "mpm:2001"] {
        let run = set_down(VARIANT, solver);
        gates.push(Gate::new(
            ("displacement at .8 s over the rigid one, less 1, touching at the start, R/4", "1"),
            vec![run.long().known(FLAT)],
            (Evidence::Analytic, PAPER),
            (ALLOWED[0], "what a contact that acts at the surface reaches at this resolution"),
            Control::without_the_error("springs at the surface", "mpm", LADDER[1].resolution),
            |done| Ok(Measured::new(excess(&done[0])?, 0.0, 1.0)),
        ));
    }
    gates
}
