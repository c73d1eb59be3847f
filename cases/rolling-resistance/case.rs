//! Rolling resistance: deceleration on a flat plane, and the largest slope at which a grain rests.

use crate::exact::one_grain::{OneGrain, State, course};
use crate::rows::on_plane::wrong_inertia;
use crate::rows::programs::{PAIRS, row, same_cycle};
use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Level = LEVELS[2];
const FLAT: [&str; 2] = ["sphere", "disc"];
const SLOPE: [&str; 2] = ["sphere-slope", "disc-slope"];

pub(crate) static CASE: Case = crate::heads::ROLLING_RESISTANCE.with(LEVELS, 2, &claims).drawn_by(figures);

fn rolling_friction(scene: &Scene) -> f64 {
    scene.laws.iter().flatten().map(|law| law.rolling_friction).fold(0.0, f64::max)
}

/// Returns the acceleration of a grain that rolls with rolling resistance (m/s²).
fn acceleration(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    (grain.along - rolling_friction(scene) * grain.onto) / (1.0 + grain.inertia_factor)
}

fn claims() -> Vec<Claim> {
    let rigid = claim("refusal of rolling resistance", "1")
        .run(Run::new(FLAT[0], "rigid", rigid::DEFAULT))
        .refused("rapier has no rolling resistance", Control::without(Effect::RollingResistance));
    let lammps =
        claim("refusal of a damped rolling spring", "1").run(Run::new(SLOPE[0], "lammps", STEP.resolution)).refused(
            "LAMMPS limits the sum of spring and dashpot; LIGGGHTS and `dem` limit the spring alone",
            Control::contact_law("no dashpot", |law| law.rolling_damping = 0.0),
        );
    let ours = FLAT.into_iter().flat_map(flat).chain(SLOPE.into_iter().flat_map(threshold)).chain([rigid]);
    ours.chain(FLAT.into_iter().flat_map(beside_programs)).chain(SLOPE.map(rolls_off)).chain([lammps]).collect()
}

fn rolls_off(variant: &'static str) -> Claim {
    let runs = PAIRS[1].map(|solver| Run { solver, ..tilted(variant, 1.001) });
    let control = Control::our_contact_law("the dashpot of the rolling spring × .999 in ours", |law| {
        law.rolling_damping *= 0.999
    });
    let allowed = same_cycle("in units of R");
    row("position over 4 s, worst", "m", allowed, runs, control, |done| worst(done, &["grain.x"], 1.0))
}

/// Returns the claims on a grain that rolls to rest, against LAMMPS and LIGGGHTS. R is 1 m.
fn beside_programs(variant: &'static str) -> [Claim; 2] {
    let time_step: f64 = 2e-5;
    let ahead = computed(
        CASE.number(variant, |scene| {
            let frequency = OneGrain::from_scene(scene).rolling_frequency(rolling_friction(scene));
            frequency.powi(2) * scene.grains[0].velocity.x * time_step.powi(2) * seconds(scene) / scene.grains[0].radius
        }),
        "the program counts one step of rolling in its evaluation of forces at the start. The moment k_r ωΔt then \
         decelerates by ω_r² v Δt for half a step or a whole step. A grain that starts at rest (on the slopes) is not \
         affected; in units of R",
    );
    PAIRS.map(|pair| {
        let allowed = if pair[1] == "lammps" { same_cycle("in units of R") } else { ahead.clone() };
        let runs = pair.map(|solver| Run::new(variant, solver, Resolution::TimeStep(time_step)));
        let control =
            Control::our_contact_law("rolling resistance × 1.00001 in ours", |law| law.rolling_friction *= 1.00001);
        row("position over 1 s, worst", "m", allowed, runs, control, |done| worst(done, &["grain.x"], 1.0))
    })
}

/// Returns the duration of a scene (s).
fn seconds(scene: &Scene) -> f64 {
    scene.duration.seconds().unwrap_or(f64::NAN)
}

fn flat(variant: &'static str) -> Vec<Claim> {
    let rolling_claim = |quantity: &str, control, of_spin: bool| {
        claim(quantity, "m/s²")
            .run(Run::new(variant, "dem", STEP.resolution))
            .equals(Source::Derived("dv/dt = g (sin θ − μ_r cos θ)/(1 + i) (derivation)"), move |done| {
                Ok(Measurement::relative(slowing(&done[0], of_spin)?, acceleration(&done[0].scene)))
            })
            .within(computed(
                CASE.number(variant, |scene| OneGrain::from_scene(scene).rung(0.5)),
                "the moment is constant once the rolling spring has yielded, and friction approaches its value as \
                 exp(−λt): remainder after half a second (derivation)",
            ))
            .refuses(control)
    };
    let more = Control::contact_law("rolling resistance × 1.01", |law| law.rolling_friction *= 1.01);
    vec![
        rolling_claim("deceleration on a flat plane", more, false),
        rolling_claim(
            "deceleration of the surface, RΩ",
            Control::scene("the inertia of the other shape", wrong_inertia),
            true,
        ),
    ]
}

/// Returns the mean acceleration over the second half of the run (m/s²), of the centre or of the surface RΩ.
fn slowing(done: &FinishedRun, of_spin: bool) -> Result<f64, MissingData> {
    let course = course(done)?;
    let (half, end) = (&course[course.len() / 2], &course[course.len() - 1]);
    let radius = done.scene.grains[0].radius;
    let speed = |at: &(f64, State)| if of_spin { at.1.omega * radius } else { at.1.v };
    Ok((speed(end) - speed(half)) / (end.0 - half.0))
}

/// Returns the run on a slope with tan θ = `factor` μ_r. The grain starts at its static overlap.
fn tilted(variant: &'static str, factor: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("tan θ = {factor} μ_r"), move |scene| {
        let angle = (factor * rolling_friction(scene)).atan();
        let magnitude = scene.gravity.norm();
        let axis = scene.dimension.count() - 1;
        scene.gravity.x = magnitude * angle.sin();
        scene.gravity[axis] = -magnitude * angle.cos();
    })
}

fn threshold(variant: &'static str) -> Vec<Claim> {
    let threshold_claim = |quantity: &str, factor: f64, allowed: Tolerance, wrong, by: f64| {
        claim(quantity, "m/s²")
            .run(tilted(variant, factor))
            .equals(
                Source::Derived("at rest iff tan θ ≤ μ_r, else (derivation) dv/dt = g (sin θ − μ_r cos θ)/(1 + i)"),
                |done| {
                    let scene = &done[0].scene;
                    let grain = OneGrain::from_scene(scene);
                    let unit = rolling_friction(scene) * grain.onto / (1.0 + grain.inertia_factor);
                    Ok(Measurement::new(slowing(&done[0], false)?, acceleration(scene).max(0.0), unit))
                },
            )
            .within(allowed)
            .refuses(Control::contact_law(wrong, move |law| law.rolling_friction *= by))
    };
    let comes_to_rest = computed(
        CASE.number(variant, |scene| OneGrain::from_scene(scene).rolled(rolling_friction(scene), 0.5 * seconds(scene))),
        "remainder of the critically damped motion of the rolling spring after half the time (derivation); in units of \
         μ_r g/(1 + i)",
    );
    let yields = rounding(1.0, "the moment is constant once the spring has yielded; in units of μ_r g/(1 + i)");
    vec![
        threshold_claim(
            "acceleration on a slope of tan θ = .999 μ_r",
            0.999,
            comes_to_rest,
            "rolling resistance × .998",
            0.998,
        ),
        threshold_claim(
            "acceleration on a slope of tan θ = 1.001 μ_r",
            1.001,
            yields,
            "rolling resistance × 1.002",
            1.002,
        ),
    ]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for variant in FLAT {
        let done = runner.run(&Run::new(variant, "dem", STEP.resolution))?;
        let start = done.scene.grains[0].velocity.x;
        let slope = acceleration(&done.scene);
        let states = course(&done).unwrap_or_default();
        let points = states.iter().step_by(5).map(|(t, state)| (*t, state.v)).collect();
        curves.push(Curve::new(variant, Stroke::Markers, points));
        let exact = vec![(0.0, start), (1.0, start + slope)];
        curves.push(Curve::new(format!("{variant}, exact"), Stroke::Dashed, exact));
    }
    Ok(vec![Figure::graph(
        "velocity",
        "Rolling to rest",
        "A sphere decelerates at (5/7) μ_r g and a disc at (2/3) μ_r g on a flat plane, with the rolling friction \
         μ_r = 0.05.",
        [Axis::linear("time t (s)"), Axis::linear("velocity v (m/s)")],
        curves,
    )])
}
