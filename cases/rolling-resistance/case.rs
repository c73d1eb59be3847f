//! Rolling resistance: deceleration on a flat plane, and the threshold of rest on a slope.

use crate::bench::Bench;
use crate::case::{Case, Rung, fraction};
use crate::effect::Effect;
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::incline::wrong_inertia;
use crate::one_grain::{OneGrain, course};
use crate::program_rows;
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Rung = LADDER[2];
const FLAT: [&str; 2] = ["sphere", "disc"];
const SLOPE: [&str; 2] = ["sphere-slope", "disc-slope"];
const SOURCE: &str = "dv/dt = g (sin θ − μ_r cos θ)/(1 + i) (derivation)";

pub(crate) static CASE: Case = Case {
    name: "rolling-resistance",
    title: "Rolling resistance",
    claim: "A grain that rolls is slowed down at μ_r g/(1 + i), and stays at rest on a slope up to tan θ = μ_r.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Only the limit of the moment is felt: the stiffness of the rolling spring, which LIGGGHTS and others choose \
               differently, changes how a grain comes to rest and nothing that is gated here.",
    ladder: LADDER,
    default_rung: STEP,
    gates,
    figures,
};

fn rolling_friction(scene: &Scene) -> f64 {
    scene.laws.iter().flatten().map(|law| law.rolling_friction).fold(0.0, f64::max)
}

/// The acceleration of a grain that rolls against its resistance (m/s²).
fn acceleration(scene: &Scene) -> f64 {
    let grain = OneGrain::of(scene);
    (grain.along - rolling_friction(scene) * grain.onto) / (1.0 + grain.inertia_factor)
}

fn gates() -> Vec<Gate> {
    let rigid = Gate::refused(
        Run::new(FLAT[0], "rigid", rigid_rows::DEFAULT),
        "refusal of rolling resistance",
        "rapier has no resistance against rolling",
        Control::without(Effect::RollingResistance),
    );
    let lammps = Gate::refused(
        Run::new(SLOPE[0], "lammps", STEP.resolution),
        "refusal of a damped rolling spring",
        "LAMMPS limits spring and dashpot together, LIGGGHTS and we the spring alone",
        Control::scene("no dashpot", |scene| scene.change_laws(|law| law.rolling_damping = 0.0)),
    );
    let rolls_off = |variant| program_rows::rolling_off(move |solver| Run { solver, ..tilted(variant, 1.001) });
    let ours = FLAT.into_iter().flat_map(flat).chain(SLOPE.into_iter().flat_map(threshold)).chain([rigid]);
    ours.chain(FLAT.into_iter().flat_map(program_rows::rolling)).chain(SLOPE.map(rolls_off)).chain([lammps]).collect()
}

fn flat(variant: &'static str) -> Vec<Gate> {
    let gate = |quantity: &str, control, of_spin: bool| Gate {
        quantity: quantity.to_owned(),
        unit: "m/s²",
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 1e-6,
        because: "once the rolling spring has yielded the moment is constant",
        runs: vec![Run::new(variant, "dem", STEP.resolution)],
        measure: measure(move |done| {
            let exact = acceleration(&done[0].scene);
            Ok(Measured::new(slowing(&done[0], of_spin)?, exact, exact))
        }),
        control,
    };
    let more = Control::scene("rolling resistance × 1.01", |scene| {
        scene.change_laws(|law| law.rolling_friction *= 1.01);
    });
    vec![
        gate("deceleration on a flat plane", more, false),
        gate("deceleration of the surface, RΩ", Control::scene("the inertia of the other shape", wrong_inertia), true),
    ]
}

/// Mean acceleration over the second half of the run (m/s²), of the centre or of the surface RΩ.
fn slowing(done: &Done, of_spin: bool) -> Result<f64, Missing> {
    let course = course(done)?;
    let (half, end) = (&course[course.len() / 2], &course[course.len() - 1]);
    let radius = done.scene.grains[0].radius;
    let speed = |at: &(f64, crate::one_grain::State)| if of_spin { at.1.omega * radius } else { at.1.v };
    Ok((speed(end) - speed(half)) / (end.0 - half.0))
}

/// The slope at a factor times the threshold, at the static overlap.
fn tilted(variant: &'static str, factor: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("tan θ = {factor} μ_r"), move |scene| {
        let angle = (factor * rolling_friction(scene)).atan();
        let magnitude = scene.gravity.norm();
        let axis = scene.dimension.count() - 1;
        scene.gravity.x = magnitude * angle.sin();
        scene.gravity[axis] = -magnitude * angle.cos();
    })
}

fn threshold(variant: &'static str) -> Vec<Gate> {
    let gate = |quantity: &str, factor: f64, control| Gate {
        quantity: quantity.to_owned(),
        unit: "m/s²",
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: "at rest iff tan θ ≤ μ_r, else (derivation) dv/dt = g (sin θ − μ_r cos θ)/(1 + i)",
        allowed: 2e-5,
        because: "a fiftieth of what a thousandth of μ_r is worth, in units of μ_r g/(1 + i); by then the spring has come to \
                  rest or has yielded",
        runs: vec![tilted(variant, factor)],
        measure: measure(move |done| {
            let scene = &done[0].scene;
            let grain = OneGrain::of(scene);
            let unit = rolling_friction(scene) * grain.onto / (1.0 + grain.inertia_factor);
            Ok(Measured::new(slowing(&done[0], false)?, acceleration(scene).max(0.0), unit))
        }),
        control,
    };
    vec![
        gate(
            "acceleration on a slope of tan θ = .999 μ_r",
            0.999,
            Control::scene("rolling resistance × .998", |scene| scene.change_laws(|law| law.rolling_friction *= 0.998)),
        ),
        gate(
            "acceleration on a slope of tan θ = 1.001 μ_r",
            1.001,
            Control::scene("rolling resistance × 1.002", |scene| scene.change_laws(|law| law.rolling_friction *= 1.002)),
        ),
    ]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for variant in FLAT {
        let done = bench.run(&Run::new(variant, "dem", STEP.resolution))?;
        let start = done.scene.grains[0].velocity.x;
        let slope = acceleration(&done.scene);
        let states = course(&done).unwrap_or_default();
        let points = states.iter().step_by(5).map(|(t, state)| (*t, state.v)).collect();
        curves.push(Curve { label: variant.to_owned(), stroke: Stroke::Markers, points });
        let exact = vec![(0.0, start), (1.0, start + slope)];
        curves.push(Curve { label: format!("{variant}, exact"), stroke: Stroke::Dashed, points: exact });
    }
    Ok(vec![Figure {
        name: "velocity".to_owned(),
        title: "Rolling to rest".to_owned(),
        caption: "μ_r = .05 on a flat plane: a sphere is slowed down at (5/7) μ_r g, a disc at (2/3) μ_r g.".to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "time t (s)".to_owned(), logarithmic: false },
            y: Axis { label: "velocity v (m/s)".to_owned(), logarithmic: false },
            curves,
        }),
    }])
}
