//! A cohesive disc on a slope: the threshold between rolling and sliding.

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, fraction};
use crate::effect::Effect;
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};

use crate::one_grain::{OneGrain, State, course};
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Rung = LADDER[2];
const SOURCE: &str = "rolls iff m g sin θ/3 ≤ μ m g cos θ + c (derivation; Cundall & Strack 1979, eq. 19)";

pub(crate) static CASE: Case = Case {
    name: "cohesive-disc",
    title: "A cohesive disc on an inclined plane",
    claim: "Cohesion adds to the strength of a contact: the threshold between rolling and sliding is met to a thousandth, \
            and beyond it the disc slides at the rate that the strength leaves.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Cohesion here is shear strength that needs no load, and only while grains overlap: nothing is said about \
               tension, which this law does not have.",
    ladder: LADDER,
    default_rung: STEP,
    gates,
    figures,
};

/// The cohesion at which the disc just rolls (N).
fn threshold(scene: &Scene) -> f64 {
    let grain = OneGrain::of(scene);
    let share = grain.inertia_factor / (1.0 + grain.inertia_factor);
    grain.mass * (grain.along * share - grain.friction * grain.onto)
}

fn with_cohesion(factor: f64) -> Run {
    Run::new(PLAIN, "dem", STEP.resolution).adjusted(&format!("c = {factor} of the threshold"), move |scene| {
        let cohesion = factor * threshold(scene);
        scene.change_laws(|law| law.cohesion = cohesion);
    })
}

/// Growth of the surface's slip, d(v − ΩR)/dt, over the second half of the run: measured and exact, in units of g sin θ.
fn slip(done: &Done) -> Result<Measured, Missing> {
    let scene = &done.scene;
    let grain = OneGrain::of(scene);
    let cohesion = scene.laws.iter().flatten().map(|law| law.cohesion).fold(0.0, f64::max);
    let course = course(done)?;
    let (half, end) = (&course[course.len() / 2], &course[course.len() - 1]);
    let slip = |state: &State| state.v - state.omega * grain.radius;
    let left = (threshold(scene) - cohesion) / grain.mass;
    let exact = (left * (1.0 + grain.inertia_factor) / grain.inertia_factor).max(0.0);
    Ok(Measured::new((slip(&end.1) - slip(&half.1)) / (end.0 - half.0), exact, grain.along))
}

fn gates() -> Vec<Gate> {
    let gate = |quantity: &str, factor: f64, control| Gate {
        quantity: quantity.to_owned(),
        unit: "m/s²",
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 1e-10,
        because: "once the spring has come to rest or has yielded the force is constant; in units of g sin θ",
        runs: vec![with_cohesion(factor)],
        measure: measure(|done| slip(&done[0])),
        control,
    };
    let rigid = Gate::refused(
        Run::new(PLAIN, "rigid", rigid_rows::DEFAULT),
        "refusal of cohesion",
        "rapier's contacts only push",
        Control::without(Effect::Cohesion),
    );
    let programs = ["lammps", "liggghts"].map(|program| {
        Gate::refused(
            Run::new(PLAIN, program, STEP.resolution),
            "refusal of cohesion",
            "its cohesion attracts along the normal; shear strength that needs no load it has none",
            Control::scene("no cohesion", |scene| scene.change_laws(|law| law.cohesion = 0.0)),
        )
    });
    let ours = vec![
        rigid,
        gate(
            "growth of slip, cohesion a thousandth above the threshold",
            1.001,
            Control::scene("cohesion × .998", |scene| scene.change_laws(|law| law.cohesion *= 0.998)),
        ),
        gate(
            "growth of slip, cohesion a thousandth below the threshold",
            0.999,
            Control::scene("cohesion × 1.002", |scene| scene.change_laws(|law| law.cohesion *= 1.002)),
        ),
        gate(
            "growth of slip, half the cohesion",
            0.5,
            Control::scene("cohesion × 1.002", |scene| scene.change_laws(|law| law.cohesion *= 1.002)),
        ),
    ];
    ours.into_iter().chain(programs).collect()
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for factor in [0.5, 0.9, 0.999, 1.001] {
        let done = bench.run(&with_cohesion(factor))?;
        let radius = done.scene.grains[0].radius;
        let states = course(&done).unwrap_or_default();
        let points = states.iter().map(|(t, state)| (*t, state.v - state.omega * radius)).collect();
        curves.push(Curve { label: format!("c = {factor} of the threshold"), stroke: Stroke::Line, points });
    }
    Ok(vec![Figure {
        name: "slip".to_owned(),
        title: "Slip of the surface".to_owned(),
        caption: "60°, μ = .2: without cohesion the disc would slide; with the threshold's it rolls.".to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "time t (s)".to_owned(), logarithmic: false },
            y: Axis { label: "slip velocity v − ΩR (m/s)".to_owned(), logarithmic: false },
            curves,
        }),
    }])
}
