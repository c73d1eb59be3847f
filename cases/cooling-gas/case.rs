//! Ten thousand inelastic discs cool by Haff's law at the rate of hard discs.

use crate::rows::programs::{ENERGY, PAIRS, row};
use crate::sources::prototype::event_driven_gas::{COOLING_RATE, SPREAD};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1)];

pub(crate) static CASE: Case = crate::heads::COOLING_GAS.with(LEVELS, 0, &claims).drawn_by(figures);

/// Time (s) from which the initially equal speeds have a Maxwell distribution.
const FROM: f64 = 2.0;
/// Time (s) up to which the kinetic energies of our solver and of LAMMPS or LIGGGHTS agree to rounding.
const FORETOLD: f64 = 2.01;
/// Time at which the runs of negative controls end (s).
const CONTROL_END: f64 = 5.0;
/// Coefficient of restitution of the scene.
const RESTITUTION: f64 = 0.9;

fn run(variant: &'static str, solver: &'static str) -> Run {
    Run::new(variant, solver, LEVELS[0].resolution)
}

/// Returns time (s) and 1/√T (1/√J) of each sample. T = E/N is the kinetic energy per disc.
fn course(done: &FinishedRun) -> Result<Vec<(f64, f64)>, MissingData> {
    let count = done.scene.grains.len() as f64;
    Ok(samples(done, ENERGY)?.into_iter().map(|(time, energy)| (time, (energy / count).powf(-0.5))).collect())
}

/// Returns the slope of 1/√T against t (1/(s √J)) by least squares, from [`FROM`] on.
fn cooling_rate(done: &FinishedRun) -> Result<f64, MissingData> {
    let course: Vec<(f64, f64)> = course(done)?.into_iter().filter(|(time, _)| *time >= FROM).collect();
    let count = course.len() as f64;
    let (time, value) = course.iter().fold((0.0, 0.0), |sum, at| (sum.0 + at.0 / count, sum.1 + at.1 / count));
    let (cross, square) = course
        .iter()
        .fold((0.0, 0.0), |sum, at| (sum.0 + (at.0 - time) * (at.1 - value), sum.1 + (at.0 - time).powi(2)));
    Ok(cross / square)
}

/// Returns number density n (1/m²), pair correlation χ at contact, diameter d (m) and mass m (kg).
fn gas(scene: &Scene) -> (f64, f64, f64, f64) {
    let (radius, mass) = (scene.grains[0].radius, scene.grains[0].mass);
    let size = scene.domain.map_or(f64::NAN, |domain| (domain.high - domain.low).xy().product());
    let number = scene.grains.len() as f64 / size;
    let packing_fraction = number * PI * radius * radius;
    (number, (1.0 - 7.0 / 16.0 * packing_fraction) / (1.0 - packing_fraction).powi(2), 2.0 * radius, mass)
}

/// Returns Enskog's cooling rate d(1/√T)/dt (1/(s √J), derivation).
fn enskog(scene: &Scene) -> f64 {
    const A2: f64 = -0.027;
    let (number, correlation, diameter, mass) = gas(scene);
    (1.0 - RESTITUTION.powi(2)) * PI.sqrt() / 2.0 * correlation * number * diameter / mass.sqrt()
        * (1.0 + 3.0 / 16.0 * A2)
}

/// Returns ω t_c, the number of collisions of a disc during a contact, for a stiffness k (N/m). The temperature is the
/// mean of the run, with T = 1/(1 + 0.058 t)² from t = 2 to 12.
fn in_contact(stiffness: f64) -> f64 {
    // The scene has φ = 0.2 and d = m = 1; the time average of √T is 0.721.
    let (packing_fraction, mean_root) = (0.2_f64, 0.721);
    let correlation = (1.0 - 7.0 / 16.0 * packing_fraction) / (1.0 - packing_fraction).powi(2);
    2.0 * PI.sqrt() * correlation * 4.0 * packing_fraction / PI * mean_root * PI * (0.5 / stiffness).sqrt()
}

/// Student's t of 23 degrees of freedom at 99 %.
const STUDENT: f64 = 2.807;

/// Returns the 99 % interval between one run and the mean of the prototype's 24 runs, relative to the cooling rate.
fn interval() -> f64 {
    STUDENT * SPREAD.value / COOLING_RATE.value * (1.0 + 1.0 / 24.0_f64).sqrt()
}

/// Returns the claim that a gas with the contact stiffness k (N/m) has the cooling rate of hard discs.
fn as_hard_discs(run: Run, stiffness: f64) -> Claim {
    claim(format!("cooling rate d(1/√T)/dt, k = {stiffness:e}"), "1/(s √J)")
        .run(run)
        .equals(COOLING_RATE.source(), |done| Ok(Measurement::relative(cooling_rate(&done[0])?, COOLING_RATE.value)))
        .within(computed(
            interval() + in_contact(stiffness),
            "t s √(1 + 1/24) with Student's t = 2.81 and s of 24 seeds, and ω t_c for the duration of contacts",
        ))
        .refuses(deader())
}

/// Returns the negative control of claims without LAMMPS and LIGGGHTS. Claims on one run share one control run.
fn deader() -> Control {
    Control::scene("dashpots of e = .86 for .9", damped(0.86))
}

/// Returns a change of the coefficient of restitution. It also shortens the run, which still shows the wrong slope.
fn damped(restitution: f64) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    move |scene| {
        // ζ = −ln e/√(π² + ln² e).
        let ratio = -restitution.ln() / PI.hypot(restitution.ln());
        scene.change_laws(|law| law.damping_ratio = ratio);
        scene.duration = Duration::Seconds(CONTROL_END);
    }
}

fn claims() -> Vec<Claim> {
    let mut claims = vec![
        as_hard_discs(run(PLAIN, "dem"), 2e4),
        as_hard_discs(run("stiff", "dem").slow(), 2e5),
        claim("cooling rate over that of Enskog's theory", "1")
            .run(run(PLAIN, "dem"))
            .at_most(
                1.0,
                Source::Derived(
                    "collisions make the velocities of neighbours similar, so they collide more slowly than in theory",
                ),
                |done| Ok(cooling_rate(&done[0])? / enskog(&done[0].scene)),
            )
            .within(computed(interval(), "the interval of one run"))
            .refuses(deader()),
    ];
    for pair in PAIRS {
        let allowed = computed(
            STUDENT * SPREAD.value / COOLING_RATE.value * 2.0_f64.sqrt(),
            "the 99 % interval of the difference of two runs, t s √2 with s of 24 seeds",
        );
        let runs = || pair.map(|solver| run(PLAIN, solver));
        let control = Control::ours("dashpots of e = .92 for .9", damped(0.92));
        claims.push(row("cooling rate", "1/(s √J)", allowed, runs(), control, |done| {
            let theirs = cooling_rate(&done[1])?;
            Ok(Measurement::relative(cooling_rate(&done[0])?, theirs))
        }));
        let allowed = rounding(
            2.0,
            "rounding only, because both programs use the same integration cycle; an energy \
                                     has twice the relative error of velocities",
        );
        let control = Control::ours("dashpots × 1.001 in ours", |scene| {
            scene.change_laws(|law| law.damping_ratio *= 1.001);
            scene.duration = Duration::Seconds(FORETOLD);
        });
        let quantity = format!("kinetic energy over the first {FORETOLD} s, worst");
        claims.push(row(&quantity, "J", allowed, runs(), control, |done| {
            let (ours, theirs) = (done[0].column(ENERGY)?, done[1].column(ENERGY)?);
            let times = &done[1].series().time;
            let known = times.iter().take_while(|time| **time <= FORETOLD).count();
            Ok(Measurement::worst_of(&times[..known], ours, &theirs[..known], theirs[0]))
        }));
    }
    claims
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let ours = runner.run(&run(PLAIN, "dem"))?;
    let course_of_ours = course(&ours).unwrap_or_default();
    let mut curves = vec![Curve::new("dem", Stroke::Line, course_of_ours.clone())];
    for [_, program] in PAIRS {
        // LAMMPS or LIGGGHTS has no curve if it is not installed and no run of it is stored.
        if let Ok(theirs) = runner.run(&run(PLAIN, program)) {
            curves.push(Curve::new(program, Stroke::Markers, course(&theirs).unwrap_or_default()));
        }
    }
    let start = course_of_ours.into_iter().find(|(time, _)| *time >= FROM).unwrap_or((FROM, 1.0));
    let line = |rate: f64| vec![start, (12.0, start.1 + rate * (12.0 - start.0))];
    curves.push(Curve::new("Enskog's theory", Stroke::Dashed, line(enskog(&ours.scene))));
    curves.push(Curve::new("hard discs, event by event", Stroke::Dashed, line(COOLING_RATE.value)));
    Ok(vec![Figure::graph(
        "cooling",
        "Haff's law: cooling of a gas of inelastic discs",
        "T is the kinetic energy per disc. In Haff's law 1/√T is a straight line in time. The dashed lines begin \
         when the initial speeds, which are equal, have become a Maxwellian distribution.",
        [Axis::linear("time t (s)"), Axis::linear("1/√T (1/√J)")],
        curves,
    )])
}
