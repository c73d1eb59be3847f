//! A cohesive disc on a slope: the threshold between rolling and sliding.

use crate::exact::one_grain::{OneGrain, State, course};
use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Level = LEVELS[2];
const STRENGTH: Source = Source::Derived(
    "rolls iff m g sin θ/3 ≤ μ m g cos θ + c (derivation; the strength is Cundall & Strack 1979, eq. 19)",
);

pub(crate) static CASE: Case = crate::heads::COHESIVE_DISC.with(LEVELS, 2, &claims).drawn_by(figures);

/// Returns the cohesion at which the disc just rolls (N).
fn threshold(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    grain.mass * (grain.along * grain.share() - grain.friction * grain.onto)
}

fn with_cohesion(factor: f64) -> Run {
    // The paper's limit applies to the spring alone. A limit on spring and dashpot would be reached while the load
    // builds up.
    Run::new(PLAIN, "dem:1979", STEP.resolution).adjusted(&format!("c = {factor} of the threshold"), move |scene| {
        let cohesion = factor * threshold(scene);
        scene.change_laws(|law| law.cohesion = cohesion);
    })
}

/// Compares the rate d(v − ΩR)/dt of slip in the second half of the run with the exact rate, in units of g sin θ.
fn slip(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let scene = &done.scene;
    let grain = OneGrain::from_scene(scene);
    let cohesion = scene.laws.iter().flatten().map(|law| law.cohesion).fold(0.0, f64::max);
    let course = course(done)?;
    let (half, end) = (&course[course.len() / 2], &course[course.len() - 1]);
    let slip = |state: &State| state.v - state.omega * grain.radius;
    let left = (threshold(scene) - cohesion) / grain.mass;
    let exact = (left * (1.0 + grain.inertia_factor) / grain.inertia_factor).max(0.0);
    Ok(Measurement::new((slip(&end.1) - slip(&half.1)) / (end.0 - half.0), exact, grain.along))
}

fn claims() -> Vec<Claim> {
    let steps = |scene: &Scene| STEP.resolution.steps(scene).map_or(f64::NAN, |(_, steps)| steps as f64);
    let rounding = 4.0 * f64::EPSILON * CASE.number(PLAIN, steps);
    let strength_claim = |quantity: &str, factor: f64, wrong, by: f64| {
        claim(quantity, "m/s²")
            .run(with_cohesion(factor))
            .equals(STRENGTH, |done| slip(&done[0]))
            .within(computed(
                rounding,
                "the force is constant once the spring is at rest or has yielded: position, velocity, spin and spring \
                 each have a rounding of ε per step; in units of g sin θ",
            ))
            .refuses(Control::contact_law(wrong, move |law| law.cohesion *= by))
    };
    let refusal = |solver, step| claim("refusal of cohesion", "1").run(Run::new(PLAIN, solver, step));
    let programs = ["lammps", "liggghts"].map(|program| {
        refusal(program, STEP.resolution).refused(
            "its cohesion attracts along the normal; it has no shear strength without load",
            Control::contact_law("no cohesion", |law| law.cohesion = 0.0),
        )
    });
    let ours = [
        refusal("rigid", rigid::DEFAULT)
            .refused("the contacts of rapier can only push", Control::without(Effect::Cohesion)),
        strength_claim("growth of slip, cohesion a thousandth above the threshold", 1.001, "cohesion × .998", 0.998),
        strength_claim("growth of slip, cohesion a thousandth below the threshold", 0.999, "cohesion × 1.002", 1.002),
        strength_claim("growth of slip, half the cohesion", 0.5, "cohesion × 1.002", 1.002),
    ];
    ours.into_iter().chain(programs).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for factor in [0.5, 0.9, 0.999, 1.001] {
        let done = runner.run(&with_cohesion(factor))?;
        let radius = done.scene.grains[0].radius;
        let states = course(&done).unwrap_or_default();
        let points = states.iter().map(|(t, state)| (*t, state.v - state.omega * radius)).collect();
        curves.push(Curve::new(format!("c = {factor} of the threshold"), Stroke::Line, points));
    }
    Ok(vec![Figure::graph(
        "slip",
        "Slip of the surface",
        "A disc on a plane at 60° with μ = 0.2. Without cohesion it slides. Above the threshold of cohesion it rolls \
         and the slip velocity stays zero.",
        [Axis::linear("time t (s)"), Axis::linear("slip velocity v − ΩR (m/s)")],
        curves,
    )])
}
