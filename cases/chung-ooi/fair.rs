//! What any program with Hertz's springs owes in the eight tests, whatever it leaves to convention: read from places, velocities
//! and spins of grains at samples, for a program need not tell the forces at contacts.

use super::forms::{Meeting, restitution};
use super::turning::{BALLS, PLANE, STICKING, elastic, sliding_along, spinning};
use super::{CASE, DAMPED, ELASTIC, HERTZ, LEVELS, OBLIQUE, RESTITUTION, SLIDING, STEP};
use super::{at_angle, hertz, peak, rebound, with_restitution};
use crate::exact::dashpot::no_tension_restitution;
use grainbench_harness::prelude::*;

/// Angles of impact from the normal (degrees) of test 4 that any program is asked for.
const ANGLES: [f64; 2] = [40.0, 70.0];
/// Angle at which the contact sticks.
const STEEP: f64 = 20.0;
/// What a scheme may be off by, of an impact that takes some thousand steps.
const FIRST_ORDER: f64 = 1e-3;
const SCHEME: &str = "a scheme of first order is off by about a step of an impact that takes a thousand and more";

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

/// A claim as others are asked for it: with steps three times as long as ours, for theirs may take a thousand times our time.
fn asked(mut claim: Claim) -> Claim {
    for run in claim.runs.iter_mut().filter(|run| run.resolution == STEP.resolution) {
        *run = run.at(LEVELS[1].resolution);
    }
    claim.fair_to_any_springs()
}

/// The scene of a run; the gates make their runs of scenes that are right, so there is one.
fn scene(run: &Run) -> Option<Scene> {
    let mut scene = CASE.variant(run.variant).ok()?;
    if let Some((_, change)) = &run.adjustment {
        change(&mut scene);
    }
    Some(scene)
}

/// Deepest overlap of the elastic impact over the smallest radius: how far arms of friction between R and R − overlap differ.
fn depth(run: &Run) -> f64 {
    let of = |scene: &Scene| {
        let radius = scene.grains.iter().map(|grain| grain.radius).fold(f64::INFINITY, f64::min);
        hertz(scene).0 / radius
    };
    scene(run).as_ref().map_or(0.0, of)
}

/// Overlap (m) by the way of the first sphere from where it touches: twice that way where two alike meet.
fn overlap(done: &Done) -> Result<Vec<f64>, Missing> {
    let times = done.scene.grains.len() as f64;
    let start = done.scene.grains[0].position.z;
    Ok(done.column("a.z")?.iter().map(|height| times * (start - height)).collect())
}

/// When the overlap is zero again (s), between the samples about it; no number where it never is.
fn parted(done: &Done) -> Result<f64, Missing> {
    let (overlap, time) = (overlap(done)?, &done.series().time);
    let last = overlap.iter().rposition(|&overlap| overlap > 0.0).unwrap_or_default();
    let Some(&next) = overlap.get(last + 1) else { return Ok(f64::NAN) };
    Ok(time[last] + (time[last + 1] - time[last]) * overlap[last] / (overlap[last] - next))
}

/// Tests 1 and 2: an elastic impact.
fn normal(variant: &'static str) -> [Claim; 3] {
    let run = || Run::new(variant, "dem", STEP.resolution);
    let stiffer = || Control::scene("E* 1 % too large", |scene| scene.change_laws(|law| law.scale_normal(1.01)));
    [
        claim("deepest overlap, from places", "m")
            .of(run())
            .equals(HERTZ, |done| {
                let exact = hertz(&done[0].scene).0;
                Ok(Measured::new(peak(&overlap(&done[0])?), exact, exact))
            })
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(stiffer()),
        claim("duration of contact, from places", "s")
            .of(run())
            .equals(HERTZ, |done| {
                let exact = hertz(&done[0].scene).2;
                Ok(Measured::new(parted(&done[0])?, exact, exact))
            })
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(stiffer()),
        claim("rebound velocity over impact velocity", "1")
            .of(run())
            .equals(HERTZ, |done| Ok(Measured::new(rebound(&done[0])?, 1.0, 1.0)))
            .within(computed(FIRST_ORDER, SCHEME))
            .refuses(Control::scene("e = .99", |scene| {
                scene.change_laws(|law| law.damping_ratio = super::damping_ratio(0.99));
            })),
    ]
}

/// Test 3: the coefficient comes back, or what the same dashpot gives where the contact lets go at zero force. The scene says
/// which dashpot there is, and programs differ in whether it may pull; neither is preferred.
fn given_back(run: Run) -> Claim {
    let words = run.adjustment.as_ref().map_or("of the scene", |(name, _)| name);
    claim(format!("rebound velocity over impact velocity, {words}, or of a release at zero force"), "1")
        .of(run)
        .equals(RESTITUTION, |done| {
            let (found, ratio) = (rebound(&done[0])?, super::law(&done[0].scene).damping_ratio);
            let [late, early] = [restitution(ratio), no_tension_restitution(ratio)];
            Ok(Measured::new(found, if found - late < early - found { late } else { early }, 1.0))
        })
        .within(computed(
            2.0 * FIRST_ORDER,
            "release falls within a step and a dashpot may be a step late: two of an impact of a thousand",
        ))
        .refuses(Control::scene("damping × 1.2", |scene| scene.change_laws(|law| law.damping_ratio *= 1.2)))
}

/// Impulse along the normal on the first sphere (N s).
fn normal_impulse(done: &Done) -> Result<f64, Missing> {
    let grain = &done.scene.grains[0];
    Ok(grain.mass * (done.last("a.vz")? - grain.velocity.z))
}

/// A contact that slides throughout: what friction takes of the velocity, and the spin that it gives, by the impulse along the
/// normal that the impact had. Whether that is the right one the rebound shows.
fn sliding(run: &Run) -> [Claim; 2] {
    let of = |quantity: &str, unit, column: &'static str, at: usize, allowed: Tolerance, control: Control| {
        let words = run.adjustment.as_ref().map_or("", |(name, _)| name);
        claim(format!("{quantity} after sliding, {words}"), unit)
            .of(run.clone())
            .equals(SLIDING, move |done| {
                let scene = &done[0].scene;
                let meeting = Meeting::of(scene);
                let after = meeting.after(scene, normal_impulse(&done[0])? / meeting.stopping)[at];
                let before = [scene.grains[0].velocity.x, scene.grains[0].spin.y][at];
                Ok(Measured::new(done[0].last(column)?, after, (after - before).abs()))
            })
            .within(allowed)
            .refuses(control)
    };
    let arm = computed(
        depth(run) + FIRST_ORDER,
        "friction acts at a distance between R and R − overlap; beside it first order in Δt; of the spin that it gives",
    );
    [
        of(
            "velocity along the contact",
            "m/s",
            "a.vx",
            0,
            computed(
                FIRST_ORDER,
                "first order in Δt: one step of an impact of a thousand, which may stick; of what friction takes",
            ),
            Control::scene("friction × 1.2", |scene| scene.change_laws(|law| law.friction *= 1.2)),
        ),
        of("spin", "rad/s", "a.omega_y", 1, arm, wrong_inertia()),
    ]
}

fn wrong_inertia() -> Control {
    Control::scene("discs' inertia in spheres", |scene| {
        scene.grains.iter_mut().for_each(|grain| grain.inertia *= 0.5 / 0.4);
    })
}

/// Where the dashpot is large, what it does to Coulomb's limit is convention: the spring's force alone gives 1 + e, a contact
/// that never pulls 1 + e′ with the larger e′ of a release at zero force, and the magnitude of a force that pulls in the end
/// adds e′ − e once more. A dashpot that counts in the limit pushes before Mindlin's spring is stretched, which takes a little:
/// most where the dashpot is made for a release at zero force and the spring grows by what is added to its stretch.
fn coulomb(run: Run) -> Claim {
    let given = scene(&run).as_ref().map(Meeting::of);
    let [low, high] = given.map_or([0.0; 2], |meeting| {
        [1.0 + meeting.restitution - meeting.latest_start(), 1.0 + 2.0 * meeting.early - meeting.restitution]
    });
    claim("friction's impulse while sliding, over μ times the impulse that stops the approach", "1")
        .of(run)
        .between([low, high], SLIDING, |done| {
            let scene = &done[0].scene;
            let (grain, meeting) = (&scene.grains[0], Meeting::of(scene));
            Ok(grain.mass * (done[0].last("a.vx")? - grain.velocity.x) / meeting.impulse(1.0))
        })
        .within(computed(
            2.0 * FIRST_ORDER / (high - low),
            "two steps of an impact of a thousand; of the width of the band",
        ))
        .refuses(Control::scene("friction × 1.2", |scene| scene.change_laws(|law| law.friction *= 1.2)))
}

/// Angular momentum about the contact stays what it was, whether it sticks or slides: I Δω = −a m Δv with the arm a of friction.
fn lever(run: Run, times: f64) -> Claim {
    let allowed = computed(
        times * depth(&run) + FIRST_ORDER,
        if times > 1.0 {
            "the arm is between R and R − overlap, and a spring that rings pulls back a part of what it pushed: three times that"
        } else {
            "the arm is between R and R − overlap"
        },
    );
    let words = run.adjustment.as_ref().map_or("", |(name, _)| name);
    claim(format!("arm of friction over R, −IΔω/(m R Δv), {words}"), "1")
        .of(run)
        .holds("angular momentum about the contact", |done| {
            let grain = &done[0].scene.grains[0];
            let turned = grain.inertia * (done[0].last("a.omega_y")? - grain.spin.y);
            let moved = grain.mass * grain.radius * (done[0].last("a.vx")? - grain.velocity.x);
            Ok(Measured::new(-turned / moved, 1.0, 1.0))
        })
        .within(allowed)
        .refuses(wrong_inertia())
}

/// Test 8: what one sphere loses the other has, though it is 125,000 times as heavy.
fn momentum(run: &Run) -> [Claim; 2] {
    let of = |quantity: &str, columns: [&'static str; 2], axis: usize| {
        claim(quantity, "kg m/s")
            .of(run.clone())
            .holds("Newton's third law", move |done| {
                let grains = &done[0].scene.grains;
                let gained = |at: usize| Ok(grains[at].mass * (done[0].last(columns[at])? - grains[at].velocity[axis]));
                let [first, second] = [gained(0)?, gained(1)?];
                Ok(Measured::new(first + second, 0.0, first.abs()))
            })
            .within(computed(
                1.25e5 * 1e-10,
                "velocities are told to ten digits of the light sphere's, and the other is 125,000 times as heavy",
            ))
            .refuses(Control::scene("the second sphere a hundredth heavier", |scene| scene.grains[1].mass *= 1.01))
    };
    [
        of("momentum that the second sphere gains, along the normal", ["a.vz", "b.vz"], 2),
        of("momentum that the second sphere gains, along the contact", ["a.vx", "b.vx"], 0),
    ]
}

/// Test 7: surfaces that meet at one velocity feel no friction.
fn gears(variant: &'static str) -> [Claim; 3] {
    let of = |quantity: &str, unit, column: &'static str, is_spin: bool| {
        claim(quantity, unit)
            .of(Run::new(variant, "dem", STEP.resolution))
            .holds("surfaces that do not slip against each other exert no friction", move |done| {
                let grain = &done[0].scene.grains[0];
                let (before, scale) =
                    if is_spin { (grain.spin.y, grain.spin.y) } else { (0.0, grain.spin.y * grain.radius) };
                Ok(Measured::new(done[0].last(column)?, before, scale))
            })
            .within(computed(10.0 * 1e-10, "spins differ in sign alone; velocities are told to ten digits"))
            .refuses(Control::scene("one sphere turns slower by a hundredth", |scene| scene.grains[1].spin *= 0.99))
    };
    [
        of("spin after an impact of gears", "rad/s", "a.omega_y", true),
        of("velocity along the contact after an impact of gears", "m/s", "a.vx", false),
        given_back(Run::new(variant, "dem", STEP.resolution)),
    ]
}
