//! Solver-independent claims: properties that any external solver with Hertz springs must satisfy in the eight tests,
//! in any contact convention. The claims use only sampled positions, velocities and spins, because an external solver
//! need not output contact forces.

use super::forms::{ALONG_AND_SPIN, ImpactParameters, change, restitution};
use super::turning::{BALLS, PLANE, STICKING, elastic, sliding_along, spinning};
use super::{CASE, DAMPED, ELASTIC, HERTZ, LEVELS, OBLIQUE, RESTITUTION, SLIDING, STEP};
use super::{at_angle, hertz, more_friction, peak, rebound, with_restitution};
use crate::exact::dashpot::no_tension_restitution;
use grainbench_harness::prelude::*;

/// Impact angles from the normal (degrees) of test 4 for external solvers.
const ANGLES: [f64; 2] = [40.0, 70.0];
/// Impact angle at which the contact sticks (degrees from the normal).
const STEEP: f64 = 20.0;
/// Largest relative error of a first-order integration scheme, for an impact of about a thousand steps.
const FIRST_ORDER: f64 = 1e-3;
const SCHEME: &str = "a first-order scheme has an error of about one step, and the impact takes a thousand steps or \
                      more";

pub(super) fn claims() -> Vec<Claim> {
    let mut claims: Vec<Claim> = ELASTIC.into_iter().flat_map(normal).collect();
    for variant in DAMPED {
        claims.extend([0.1, 0.3, 0.5, 0.8].map(|restitution| given_back(with_restitution(variant, restitution))));
    }
    for variant in OBLIQUE {
        for degrees in ANGLES {
            claims.extend(sliding(&at_angle(variant, degrees)));
        }
        claims.push(lever(at_angle(variant, STEEP), 3.0));
        claims.push(given_back(Run::new(variant, "dem", STEP.resolution)));
    }
    for variant in PLANE {
        for along in [15.0, 30.0] {
            claims.extend(sliding(&sliding_along(variant, along)));
        }
        claims.push(lever(sliding_along(variant, STICKING), 3.0));
    }
    for variant in BALLS {
        claims.extend(sliding(&elastic(variant, 12.0)));
        claims.push(coulomb(spinning(variant, 12.0)));
        claims.push(lever(spinning(variant, 12.0), 1.0));
        claims.push(lever(spinning(variant, STICKING), 3.0));
    }
    for variant in [BALLS[2], BALLS[3]] {
        claims.extend(momentum(&spinning(variant, 12.0)));
    }
    for variant in ["7-aluminium-alloy", "7-copper"] {
        claims.extend(gears(variant));
    }
    claims.into_iter().map(asked).collect()
}

/// Makes a claim solver-independent, with a longer time step, because external solvers may be a thousand times slower.
fn asked(mut claim: Claim) -> Claim {
    for run in claim.runs.iter_mut().filter(|run| run.resolution == STEP.resolution) {
        *run = run.at(LEVELS[1].resolution);
    }
    claim.solver_independent_springs()
}

/// Returns the largest overlap over the smallest radius, the relative difference of lever arms of friction.
fn depth(run: &Run) -> f64 {
    let relative_depth = |scene: &Scene| {
        let radius = scene.grains.iter().map(|grain| grain.radius).fold(f64::INFINITY, f64::min);
        hertz(scene).0 / radius
    };
    crate::runner(&CASE).scene(run).map_or(0.0, |scene| relative_depth(&scene))
}

/// Returns the overlap (m) at each sample, from the displacement of one or of two equal spheres since first contact.
fn overlap(done: &FinishedRun) -> Result<Vec<f64>, MissingData> {
    let times = done.scene.grains.len() as f64;
    let start = done.scene.grains[0].position.z;
    Ok(done.column("a.z")?.iter().map(|height| times * (start - height)).collect())
}

/// Returns the time at which the overlap returns to zero (s), interpolated between samples. NaN if it never does.
fn parted(done: &FinishedRun) -> Result<f64, MissingData> {
    let (overlap, time) = (overlap(done)?, &done.series().time);
    let last = overlap.iter().rposition(|&overlap| overlap > 0.0).unwrap_or_default();
    let Some(&next) = overlap.get(last + 1) else { return Ok(f64::NAN) };
    Ok(time[last] + (time[last + 1] - time[last]) * overlap[last] / (overlap[last] - next))
}

fn normal(variant: &'static str) -> [Claim; 3] {
    let run = || Run::new(variant, "dem", STEP.resolution);
    let stiffer = || Control::contact_law("E* 1 % too large", |law| law.scale_normal(1.01));
    [
        claim("deepest overlap, from places", "m")
            .run(run())
            .equals(HERTZ, |done| Ok(Measurement::relative(peak(&overlap(&done[0])?), hertz(&done[0].scene).0)))
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(stiffer()),
        claim("duration of contact, from places", "s")
            .run(run())
            .equals(HERTZ, |done| Ok(Measurement::relative(parted(&done[0])?, hertz(&done[0].scene).2)))
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(stiffer()),
        claim("rebound velocity over impact velocity", "1")
            .run(run())
            .equals(HERTZ, |done| Ok(Measurement::relative(rebound(&done[0])?, 1.0)))
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(Control::contact_law("e = .99", |law| law.damping_ratio = super::damping_ratio(0.99))),
    ]
}

/// Returns the claim on the coefficient of restitution of test 3 for the damping ratio of the scene. The dashpot of
/// some external solvers may pull, and with others the contact ends at zero force. The claim accepts both coefficients.
fn given_back(run: Run) -> Claim {
    let words = run.adjustment.as_ref().map_or("of the scene", |(name, _)| name);
    claim(format!("rebound velocity over impact velocity, {words}, or of a release at zero force"), "1")
        .run(run)
        .equals(RESTITUTION, |done| {
            let (found, ratio) = (rebound(&done[0])?, super::law(&done[0].scene).damping_ratio);
            let [late, early] = [restitution(ratio), no_tension_restitution(ratio)];
            Ok(Measurement::new(found, if found - late < early - found { late } else { early }, 1.0))
        })
        .within(computed(
            2.0 * FIRST_ORDER,
            "the release falls within a step, and a dashpot may be a step late: two of a thousand steps of the impact",
        ))
        .refuses(Control::contact_law("damping × 1.2", |law| law.damping_ratio *= 1.2))
}

/// Returns the claims on a contact that slides throughout: the loss of tangential velocity and the spin, computed from
/// the measured normal impulse. The claim on the rebound tests the normal impulse itself.
fn sliding(run: &Run) -> [Claim; 2] {
    let words = run.adjustment.as_ref().map_or("", |(name, _)| name);
    let sliding_claim = |at: usize, allowed: Tolerance, control: Control| {
        let (quantity, unit, _) = ALONG_AND_SPIN[at];
        claim(format!("{quantity} after sliding, {words}"), unit)
            .run(run.clone())
            .equals(SLIDING, move |done| {
                let (scene, grain) = (&done[0].scene, &done[0].scene.grains[0]);
                let impulse = grain.mass * (done[0].last("a.vz")? - grain.velocity.z);
                change(&done[0], at, impulse / ImpactParameters::from_scene(scene).stopping)
            })
            .within(allowed)
            .refuses(control)
    };
    let along = computed(
        FIRST_ORDER,
        "first order in Δt: the contact may stick in one of the thousand steps of the impact; relative to the change due \
         to friction",
    );
    let arm = computed(
        depth(run) + FIRST_ORDER,
        "the lever arm of friction is between R and R − overlap; the rest is first order in Δt; relative to the spin \
         due to friction",
    );
    [sliding_claim(0, along, more_friction()), sliding_claim(1, arm, wrong_inertia())]
}

fn wrong_inertia() -> Control {
    Control::grains("discs' inertia in spheres", |grain| grain.inertia *= 0.5 / 0.4)
}

/// Returns the claim on the impulse of friction with a strong dashpot, divided by μ times the impulse that stops the
/// approach. The expected value is a band, because conventions differ in the force that enters the Coulomb limit.
///
/// The spring force alone gives 1 + e. A contact that never pulls gives 1 + e′, with the larger e′ of a release at zero
/// force. The magnitude of a force that finally pulls adds e′ − e once more. If the dashpot force enters the limit, the
/// contact sticks until Mindlin's spring is displaced, which reduces the impulse slightly. The reduction is largest if
/// ζ gives e with a release at zero force and the spring is incremental.
fn coulomb(run: Run) -> Claim {
    let given = crate::runner(&CASE).scene(&run).map(|scene| ImpactParameters::from_scene(&scene));
    let [low, high] = given.map_or([0.0; 2], |meeting| {
        [1.0 + meeting.restitution - meeting.latest_start(), 1.0 + 2.0 * meeting.early - meeting.restitution]
    });
    claim("friction's impulse while sliding, over μ times the impulse that stops the approach", "1")
        .run(run)
        .between([low, high], SLIDING, |done| {
            let scene = &done[0].scene;
            let (grain, meeting) = (&scene.grains[0], ImpactParameters::from_scene(scene));
            Ok(grain.mass * (done[0].last("a.vx")? - grain.velocity.x) / meeting.impulse(1.0))
        })
        .within(computed(
            2.0 * FIRST_ORDER / (high - low),
            "two of a thousand steps of the impact; relative to the width of the band",
        ))
        .refuses(more_friction())
}

/// Returns the claim that angular momentum about the contact is conserved: I Δω = −a m Δv with the arm a of friction.
fn lever(run: Run, times: f64) -> Claim {
    let allowed = computed(
        times * depth(&run) + FIRST_ORDER,
        if times > 1.0 {
            "the lever arm is between R and R − overlap; a vibrating spring returns part of its impulse, so three \
             times that"
        } else {
            "the lever arm is between R and R − overlap"
        },
    );
    let words = run.adjustment.as_ref().map_or("", |(name, _)| name);
    claim(format!("arm of friction over R, −IΔω/(m R Δv), {words}"), "1")
        .run(run)
        .holds("angular momentum about the contact", |done| {
            let grain = &done[0].scene.grains[0];
            let turned = grain.inertia * (done[0].last("a.omega_y")? - grain.spin.y);
            let moved = grain.mass * grain.radius * (done[0].last("a.vx")? - grain.velocity.x);
            Ok(Measurement::relative(-turned / moved, 1.0))
        })
        .within(allowed)
        .refuses(wrong_inertia())
}

/// Returns the claims that momentum changes of test 8 are opposite, although one sphere is 125,000 times as heavy.
fn momentum(run: &Run) -> [Claim; 2] {
    let momentum_claim = |quantity: &str, columns: [&'static str; 2], axis: usize| {
        claim(quantity, "kg m/s")
            .run(run.clone())
            .holds("Newton's third law", move |done| {
                let grains = &done[0].scene.grains;
                let before = |at: usize| grains[at].velocity[axis];
                let gained = |at: usize| done[0].last(columns[at]).map(|now| grains[at].mass * (now - before(at)));
                let [first, second] = [gained(0)?, gained(1)?];
                Ok(Measurement::new(first + second, 0.0, first.abs()))
            })
            .within(computed(
                1.25e5 * 1e-10,
                "velocities are written with ten digits relative to the light sphere, and the other sphere is 125,000 \
                 times as heavy",
            ))
            .refuses(Control::scene("the second sphere a hundredth heavier", |scene| scene.grains[1].mass *= 1.01))
    };
    [
        momentum_claim("momentum that the second sphere gains, along the normal", ["a.vz", "b.vz"], 2),
        momentum_claim("momentum that the second sphere gains, along the contact", ["a.vx", "b.vx"], 0),
    ]
}

/// Returns the claims that test 7 has no friction, because both surfaces have the same velocity.
fn gears(variant: &'static str) -> [Claim; 3] {
    let gear_claim = |quantity: &str, unit, column: &'static str, is_spin: bool| {
        claim(quantity, unit)
            .run(Run::new(variant, "dem", STEP.resolution))
            .holds("surfaces without relative slip exert no friction", move |done| {
                let grain = &done[0].scene.grains[0];
                let (before, scale) =
                    if is_spin { (grain.spin.y, grain.spin.y) } else { (0.0, grain.spin.y * grain.radius) };
                Ok(Measurement::new(done[0].last(column)?, before, scale))
            })
            .within(computed(10.0 * 1e-10, "spins differ only in sign; velocities are written with ten digits"))
            .refuses(Control::scene("one sphere turns slower by a hundredth", |scene| scene.grains[1].spin *= 0.99))
    };
    [
        gear_claim("spin after an impact of gears", "rad/s", "a.omega_y", true),
        gear_claim("velocity along the contact after an impact of gears", "m/s", "a.vx", false),
        given_back(Run::new(variant, "dem", STEP.resolution)),
    ]
}
