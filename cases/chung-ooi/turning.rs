//! Tests 5 to 8 for our solver: the friction impulse of each convention within 10⁻³, and figures that include sticking
//! contacts.

use super::forms::{ALONG_AND_SPIN, ImpactParameters, change};
use super::{SLIDING, STEP, test};
use grainbench_harness::prelude::*;

/// Variants of test 5.
pub(super) const PLANE: [&str; 2] = ["5-steel", "5-polyethylene"];
/// Variants of tests 6 and 8.
pub(super) const BALLS: [&str; 4] = ["6-aluminium-alloy", "6-nylon", "8-aluminium-alloy", "8-nylon"];
/// Velocity (m/s) of test 5 and spin (rad/s) of tests 6 and 8 at which the contact sticks.
pub(super) const STICKING: f64 = 2.0;

/// Returns the run of test 5 with a velocity along the plane (m/s).
pub(super) fn sliding_along(variant: &'static str, along: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution)
        .adjusted(&format!("{along} m/s along the plane"), move |scene| scene.grains[0].velocity.x = along)
}

/// Time step of test 8. Its critical step is that of the lighter sphere on the stiffer material, about forty times
/// shorter than the critical step of the studied contact.
pub(super) const OF_TEST_8: Resolution = Resolution::CriticalFraction(0.1);

/// Returns the run of test 6 or 8 with a spin (rad/s).
pub(super) fn spinning(variant: &'static str, spin: f64) -> Run {
    Run::new(variant, "dem", if variant.starts_with('8') { OF_TEST_8 } else { STEP.resolution })
        .adjusted(&format!("{spin} rad/s"), move |scene| scene.grains[0].spin.y = spin)
}

/// Returns the run of test 6 or 8 without a dashpot. All conventions agree in this run.
pub(super) fn elastic(variant: &'static str, spin: f64) -> Run {
    spinning(variant, spin).adjusted(&format!("{spin} rad/s, e = 1"), move |scene| {
        scene.grains[0].spin.y = spin;
        scene.change_laws(|law| law.damping_ratio = 0.0);
    })
}

pub(super) fn claims() -> Vec<Claim> {
    let runs = PLANE.map(|variant| sliding_along(variant, 30.0)).into_iter();
    runs.chain(BALLS.map(|variant| spinning(variant, 12.0))).flat_map(|run| sharp(&run)).collect()
}

/// Returns the claims on velocity and spin after sliding. With Cundall & Strack's limit, friction has the impulse
/// μ(1+e) m* v_n. A limit on spring and dashpot lacks the part before the tangential spring is displaced.
fn sharp(run: &Run) -> Vec<Claim> {
    let is_plane = run.variant.starts_with('5');
    let sharp_claims =
        |solver: &'static str, other: &'static str, words: &str, factor: fn(&ImpactParameters) -> f64| {
            [0, 1].map(|at: usize| {
                let (quantity, unit, _) = ALONG_AND_SPIN[at];
                claim(format!("{quantity} after sliding, {words}"), unit)
                    .run(Run { solver, ..run.clone() })
                    .equals(SLIDING, move |done| {
                        change(&done[0], at, factor(&ImpactParameters::from_scene(&done[0].scene)))
                    })
                    .within(computed(
                        1e-3,
                        "the dashpot is half a step late, first order in Δt: less than one of a thousand steps of the \
                         impact; relative to the change due to friction",
                    ))
                    .refuses(if is_plane {
                        Control::contact_law("friction × 1.01", |law| law.friction *= 1.01)
                    } else {
                        Control::solver("the limit of the other convention", other)
                    })
            })
        };
    let spring = sharp_claims("dem:1979", "dem", "μ(1+e) m* v_n", |meeting| 1.0 + meeting.restitution);
    let pushing = sharp_claims("dem", "dem:1979", "μ(1+e−2ζ²/(2ρ/3−1)) m* v_n", |meeting| {
        1.0 + meeting.restitution - meeting.latest_start()
    });
    if is_plane { spring.to_vec() } else { [spring, pushing].concat() }
}

/// Returns the paper's figures of slip after the impact over slip before it, each over v_n, and over μ in test 5.
pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let slides = |done: &FinishedRun, friction: f64| -> Option<(f64, f64)> {
        let (grain, before) = (&done.scene.grains[0], ImpactParameters::from_scene(&done.scene));
        let onto = friction * grain.velocity.z.abs();
        let other = match done.scene.grains.get(1) {
            Some(second) => done.last("b.vx").ok()? + done.last("b.omega_y").ok()? * second.radius,
            None => 0.0,
        };
        let after = done.last("a.vx").ok()? - done.last("a.omega_y").ok()? * grain.radius - other;
        Some((before.slip.abs() / onto, before.slip.signum() * after / (friction * done.last("a.vz").ok()?)))
    };
    let (mut plane, mut balls) = (Vec::new(), Vec::new());
    for variant in PLANE {
        let mut points = Vec::new();
        for along in [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 15.0, 20.0] {
            points.extend(slides(&runner.run(&sliding_along(variant, along))?, 0.3));
        }
        plane.push(Curve::new(test(variant), Stroke::Markers, points));
    }
    for variant in BALLS {
        let mut points = Vec::new();
        for spin in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 9.0, 12.0] {
            points.extend(slides(&runner.run(&spinning(variant, spin))?, 1.0));
        }
        balls.push(Curve::new(test(variant), Stroke::Markers, points));
    }
    let line = |from: f64, to: f64, value: fn(f64) -> f64| [from, to].map(|x| (x, value(x))).to_vec();
    plane.push(Curve::new("slides throughout", Stroke::Dashed, line(7.0, 13.4, |before| before - 7.0)));
    balls.push(Curve::new("slides throughout", Stroke::Dashed, line(2.1, 6.0, |before| (before - 2.1) / 0.5)));
    let caption = "Slip velocity s of the surfaces after the impact over the value before it, both divided by the normal \
         velocity v_n. The dashed line holds if the surfaces slide during the whole impact. If they stick, the \
         tangential spring oscillates. No closed form is known there, and only momentum is checked.";
    Ok(vec![
        Figure::graph(
            "recoil-elastic",
            "Slip of the surfaces after an oblique elastic impact (test 5)",
            caption,
            [Axis::linear("slip before, s / (μ v_n)"), Axis::linear("slip after, s′ / (μ v_n′)")],
            plane,
        ),
        Figure::graph(
            "recoil-turning",
            "Slip of the surfaces after an impact of a rotating sphere (tests 6 and 8)",
            caption,
            [Axis::linear("slip before, s / v_n"), Axis::linear("slip after, s′ / v_n′")],
            balls,
        ),
    ])
}
