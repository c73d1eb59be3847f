//! Measurements and claims shared by the backspin cases of an elastic grain on a rigid and on a deformable plane. The
//! reference values of the sphere come from an independent prototype.

use crate::exact::one_grain::{OneGrain, course, last};
use crate::sources::prototype::elastic_sphere::{BACKSPIN, WORK};
use grainbench_harness::prelude::*;

/// Time after which the grain rolls without sliding (s).
pub(crate) const ROLLS: f64 = 0.5;
/// Result of the prototype for the rolling velocity of the sphere.
const SPEED: &str = "mean velocity of rolling 1.459 to 1.478 m/s, where a rigid sphere has 10/7";

/// Returns the last displacement divided by that of a rigid grain, minus one.
pub(crate) fn excess(done: &FinishedRun) -> Result<f64, MissingData> {
    let (t, state) = last(done)?;
    Ok(state.x / OneGrain::from_scene(&done.scene).rigid_backspin(t).x - 1.0)
}

/// Returns mean velocity and mean surface speed ΩR (m/s) from [`ROLLS`] to the end.
pub(crate) fn rolling(done: &FinishedRun) -> Result<(f64, f64), MissingData> {
    let radius = done.scene.grains[0].radius;
    let states: Vec<_> = course(done)?.into_iter().filter(|(t, _)| *t >= ROLLS).collect();
    if states.is_empty() {
        return Err("samples after .5 s".into());
    }
    let mean = |value: &dyn Fn(usize) -> f64| (0..states.len()).map(value).sum::<f64>() / states.len() as f64;
    Ok((mean(&|at| states[at].1.v), mean(&|at| states[at].1.omega * radius)))
}

/// Returns the negative control for the sliding phase: 0.7 times the friction.
pub(crate) fn slippery() -> Control {
    Control::contact_law("friction × .7", |law| law.friction *= 0.7)
}

/// Returns the claims that displacement and rolling velocity of the sphere agree with the prototype. `asked` is the
/// error of the displacement that was required at the resolution `level` before the solver existed.
pub(crate) fn sphere(level: &str, asked: f64, run: Run) -> [Claim; 2] {
    [
        claim(format!("displacement at .8 s over the rigid one, less 1, {level}"), "1")
            .run(run.clone())
            .equals_cited(BACKSPIN, 1.0, |done| excess(&done[0]))
            .within(required(
                asked + BACKSPIN.uncertainty,
                "required at this resolution before the solver existed, and the uncertainty of the reference",
            ))
            .refuses(slippery().coarser(Resolution::grid(3.0, 2))),
        claim(format!("mean velocity of rolling, {level}"), "m/s")
            .run(run)
            .between([1.43, 1.48], Source::Printed(&WORK, SPEED), |done| Ok(rolling(&done[0])?.0))
            .within(exactly("the band was required before the solver existed"))
            .refuses(Control::scene("a tenth less spin", |scene| scene.grains[0].spin *= 0.9)),
    ]
}
