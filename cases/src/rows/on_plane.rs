//! Runs of a grain on a plane, and their negative controls.

use crate::exact::one_grain::{OneGrain, State, last, normal_axis, rest_at_overlap};
use grainbench_harness::prelude::*;

/// Time step of runs that are compared with rigid solutions.
pub(crate) const STEP: Resolution = Resolution::CriticalFraction(0.01);
/// Static overlap divided by R at which soft contacts of all conventions nearly agree with a rigid contact.
pub(crate) const NEARLY_RIGID: f64 = 1e-5;
/// Damping ratio of the damped runs.
pub(crate) const DAMPING: f64 = 0.5;

/// Variant of a scene with one grain on a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// Variant of the scene.
    pub(crate) variant: &'static str,
    /// True if a rigid grain finally rolls without slip.
    pub(crate) rolls: bool,
    /// Largest relative effects of lift-off on velocity and spin, for the solver `rigid` at its default resolution;
    /// `None` unless rotation lifts the contact point off the plane at 1 s.
    pub(crate) lifts: Option<[f64; 2]>,
}

impl Plane {
    /// Returns a negative control: wrong inertia for a rolling grain, larger friction for a slipping grain.
    pub(crate) fn control(self) -> Control {
        if self.rolls { other_inertia() } else { stronger_friction() }
    }
}

/// Replaces the moment of inertia of a disc by that of a sphere, or that of a sphere by that of a disc.
pub(crate) fn wrong_inertia(scene: &mut Scene) {
    let factor = if scene.grain_shape.inertia_factor() > 0.45 { 0.4 } else { 0.5 };
    let grain = &mut scene.grains[0];
    grain.inertia = factor * grain.mass * grain.radius * grain.radius;
}

/// Places the grain exactly in contact with the plane, without overlap.
pub(crate) fn touching(scene: &mut Scene) {
    let axis = normal_axis(scene);
    scene.grains[0].position[axis] = scene.grains[0].radius;
}

/// Returns the negative control for sliding grains: friction that is 5 % larger.
pub(crate) fn stronger_friction() -> Control {
    Control::contact_law("friction ×1.05", |law| law.friction *= 1.05)
}

/// Returns the negative control for rolling grains: the moment of inertia of the other shape, disc or sphere.
pub(crate) fn other_inertia() -> Control {
    Control::scene("the inertia of the other shape", wrong_inertia)
}

/// Returns a run at a static overlap of `ratio`·R.
pub(crate) fn at_overlap(
    variant: &'static str,
    solver: &'static str,
    ratio: f64,
    damping: f64,
    step: Resolution,
) -> Run {
    let name = format!("overlap/R = {ratio:e}, damping ratio {damping}");
    Run::new(variant, solver, step).adjusted(&name, move |scene| rest_at_overlap(scene, ratio, damping))
}

/// Returns a run at a static overlap of 1e-5 R, with or without a tangential dashpot. A slipping grain runs without it,
/// because contact conventions differ in whether the dashpot force counts in the Coulomb limit.
pub(crate) fn nearly_rigid(variant: &'static str, tangential_dashpot: bool) -> Run {
    if tangential_dashpot {
        return at_overlap(variant, "dem:lammps", NEARLY_RIGID, DAMPING, STEP);
    }
    let name = format!("overlap/R = {NEARLY_RIGID:e}, damping ratio {DAMPING} along the normal alone");
    Run::new(variant, "dem:lammps", STEP).adjusted(&name, |scene| {
        rest_at_overlap(scene, NEARLY_RIGID, DAMPING);
        scene.change_laws(|law| law.tangential_damping = 0.0);
    })
}

/// Result of the comparison of a run with a rigid solution.
type Comparison = Result<Measurement, MissingData>;

/// Function that compares a quantity of the last state of a run with its solution.
pub(crate) type EndReader = fn(&FinishedRun, fn(State) -> f64) -> Comparison;

/// Returns solver-independent claims on a grain that slides and then rolls, for a contact so stiff that all conventions
/// nearly agree: displacement, velocity halfway through the slide, final velocity and final spin.
pub(crate) fn near_rigid(
    variant: &'static str,
    source: Source,
    halfway: fn(&FinishedRun) -> Comparison,
    end: EndReader,
    [x, half, v, omega]: [Tolerance; 4],
) -> [Claim; 4] {
    let near_rigid_claim = |quantity: &str, unit, rolls, tolerance, pick: Option<fn(State) -> f64>| {
        claim(format!("{quantity}, nearly rigid contact"), unit)
            .run(nearly_rigid(variant, rolls))
            .equals(source, move |done| pick.map_or_else(|| halfway(&done[0]), |pick| end(&done[0], pick)))
            .within(tolerance)
            .refuses(if rolls { other_inertia() } else { stronger_friction() })
            .solver_independent()
    };
    [
        near_rigid_claim("displacement at 1 s", "m", false, x, Some(|state| state.x)),
        near_rigid_claim("velocity halfway through the slide", "m/s", false, half, None),
        near_rigid_claim("velocity at 1 s", "m/s", true, v, Some(|state| state.v)),
        near_rigid_claim("spin at 1 s", "rad/s", true, omega, Some(|state| state.omega)),
    ]
}

/// Compares a quantity of the last state with the exact value, in units of this value.
pub(crate) fn end(done: &FinishedRun, exact: impl Fn(&OneGrain, f64) -> State, pick: fn(State) -> f64) -> Comparison {
    let (t, state) = last(done)?;
    Ok(Measurement::relative(pick(state), pick(exact(&OneGrain::from_scene(&done.scene), t))))
}

/// Returns the claims on the final velocity of rolling, which agrees to rounding with the solution for the lever arm of
/// each convention. `exact` returns the velocity (m/s) in a scene for a lever arm (m).
pub(crate) fn final_velocity(
    variant: &'static str,
    source: Source,
    exact: fn(&Scene, f64) -> f64,
    allowed: &Tolerance,
) -> Vec<Claim> {
    let speed_claim = |solver, quantity: &str, other| {
        claim(quantity, "m/s")
            .run(at_overlap(variant, solver, 1e-3, DAMPING, STEP))
            .equals(source, move |done| {
                let arm = OneGrain::from_scene(&done[0].scene).arm(solver);
                Ok(Measurement::relative(last(&done[0])?.1.v, exact(&done[0].scene, arm)))
            })
            .within(allowed.clone())
            .refuses(other)
    };
    vec![
        speed_claim("dem:lammps", "final velocity, arm R", Control::solver("torque arm R − overlap/2", "dem:liggghts")),
        speed_claim("dem:liggghts", "final velocity, arm R − overlap/2", Control::solver("torque arm R", "dem:lammps")),
    ]
}
