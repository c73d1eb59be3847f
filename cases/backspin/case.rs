//! A grain set down with spin and no velocity (2001 paper, and the disc beside it).

#[path = "elastic.rs"]
mod elastic;

use crate::bench::Bench;
use crate::case::{Case, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, measure};
use crate::incline::{DAMPING, STEP, at_overlap, more_friction, nearly_rigid, wrong_inertia};
use crate::one_grain::{OneGrain, State, course, last};
use crate::program_rows;
use crate::rigid_rows::{self, Row};
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const VARIANTS: [&str; 2] = ["disc", "sphere"];
const RIGID: &[Row] = &[
    Row { variant: "disc", rolls: true, x: 2e-3, v: 5e-5, omega: 1.5e-4 },
    Row { variant: "sphere", rolls: true, x: 2e-3, v: 2.5e-5, omega: 8e-5 },
];

pub(crate) static CASE: Case = Case {
    name: "backspin",
    title: "Backspin",
    claim: "A spinning grain set down on a flat plane slides, is driven forwards by friction, and rolls on at f RΩ₀, with \
            f = 1/3 for a disc and 2/7 for a sphere.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "The final velocity does not depend on μ, on stiffness or on damping: alone it would pass a solver with a \
               wrong friction law. Displacement does depend on μ. One contact, constant load.",
    ladder: LADDER,
    default_rung: LADDER[2],
    gates,
    figures,
};

fn gates() -> Vec<Gate> {
    let dem = VARIANTS.into_iter().flat_map(|variant| [rigid(variant), final_motion(variant), near_rigid(variant)].concat());
    dem.chain(rigid_rows::backspins(RIGID)).chain(program_rows::one_grain(&VARIANTS)).chain(elastic::gates()).collect()
}

fn rigid(variant: &'static str) -> Vec<Gate> {
    let gate = |quantity: &str, unit, allowed, because, control, pick: fn(State) -> f64| Gate {
        quantity: quantity.to_owned(),
        unit,
        evidence: Evidence::Analytic,
        scope: Scope::Named,
        source: "2001 paper, section on backspin; derivation",
        allowed,
        because,
        runs: vec![at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP)],
        measure: measure(move |done| {
            let (t, state) = last(&done[0])?;
            let exact = pick(OneGrain::of(&done[0].scene).rigid_backspin(t));
            Ok(Measured::new(pick(state), exact, exact))
        }),
        control,
    };
    vec![
        gate(
            "displacement at 1 s",
            "m",
            3e-3,
            "the spring must be stretched before it slides and relaxes when it rolls: ∝ √(overlap/R), here 1e-3",
            Control::scene("friction ×1.05", more_friction),
            |state| state.x,
        ),
        gate(
            "spin at 1 s",
            "rad/s",
            1e-9,
            "momentum about the contact fixes it once the spring has come to rest",
            Control::scene("the inertia of the other shape", wrong_inertia),
            |state| state.omega,
        ),
        Gate {
            quantity: "velocity halfway through the slide".to_owned(),
            unit: "m/s",
            evidence: Evidence::Analytic,
            scope: Scope::Named,
            source: "v = μ g t up to t_s",
            allowed: 1e-3,
            because: "in LAMMPS' convention it slides from the start, but without friction for the first half step",
            runs: vec![at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP)],
            measure: measure(|done| velocity_halfway(&done[0])),
            control: Control::scene("friction ×1.05", more_friction),
        },
    ]
}

/// Against the rigid answer where the contact is so stiff that conventions hardly differ: fair to any solver.
fn near_rigid(variant: &'static str) -> Vec<Gate> {
    type Pick = fn(&Done) -> Result<Measured, Missing>;
    let gate = |quantity: &str, unit, allowed, tangential_dashpot, control, pick: Pick| Gate {
        quantity: format!("{quantity}, nearly rigid contact"),
        unit,
        evidence: Evidence::Analytic,
        scope: Scope::AnySolver,
        source: "2001 paper, section on backspin; derivation",
        allowed,
        because: if tangential_dashpot {
            "a torque arm between R and R − overlap/2, at overlap/R = 1e-5"
        } else {
            "the contact is elastic before it slides and rings when it rolls: ∝ √(overlap/R), here 1e-5"
        },
        runs: vec![nearly_rigid(variant, tangential_dashpot)],
        measure: measure(move |done| pick(&done[0])),
        control,
    };
    let friction = || Control::scene("friction ×1.05", more_friction);
    let inertia = || Control::scene("the inertia of the other shape", wrong_inertia);
    vec![
        gate("displacement at 1 s", "m", 5e-5, false, friction(), |done| {
            let (t, state) = last(done)?;
            let exact = OneGrain::of(&done.scene).rigid_backspin(t).x;
            Ok(Measured::new(state.x, exact, exact))
        }),
        gate("velocity halfway through the slide", "m/s", 2e-4, false, friction(), velocity_halfway),
        gate("velocity at 1 s", "m/s", 1e-5, true, inertia(), |done| {
            let (t, state) = last(done)?;
            let exact = OneGrain::of(&done.scene).rigid_backspin(t).v;
            Ok(Measured::new(state.v, exact, exact))
        }),
        gate("spin at 1 s", "rad/s", 1e-5, true, inertia(), |done| {
            let (t, state) = last(done)?;
            let exact = OneGrain::of(&done.scene).rigid_backspin(t).omega;
            Ok(Measured::new(state.omega, exact, exact))
        }),
    ]
}

fn velocity_halfway(done: &Done) -> Result<Measured, Missing> {
    let grain = OneGrain::of(&done.scene);
    let halfway = 0.5 * grain.backspin_velocity(grain.radius) / (grain.friction * grain.onto);
    let course = course(done)?;
    let near = course.iter().min_by(|a, b| (a.0 - halfway).abs().total_cmp(&(b.0 - halfway).abs()));
    let (t, state) = near.copied().ok_or_else(|| Missing("samples".to_owned()))?;
    let exact = grain.rigid_backspin(t).v;
    Ok(Measured::new(state.v, exact, exact))
}

fn final_motion(variant: &'static str) -> Vec<Gate> {
    let gate = |solver: &'static str, quantity: &str, other: Control| {
        let at_contact = solver == "dem:liggghts";
        Gate {
            quantity: quantity.to_owned(),
            unit: "m/s",
            evidence: Evidence::Analytic,
            scope: Scope::Named,
            source: "v = iR²Ω₀a/(a² + iR²) with arm a (derivation)",
            allowed: 1e-9,
            because: "momentum about the contact fixes it once the spring has come to rest",
            runs: vec![at_overlap(variant, solver, 1e-3, DAMPING, STEP)],
            measure: measure(move |done| {
                let (_, state) = last(&done[0])?;
                let grain = OneGrain::of(&done[0].scene);
                let arm = if at_contact { grain.radius * (1.0 - 0.5 * grain.overlap_ratio) } else { grain.radius };
                let exact = grain.backspin_velocity(arm);
                Ok(Measured::new(state.v, exact, exact))
            }),
            control: other,
        }
    };
    vec![
        gate("dem:lammps", "final velocity, arm R", Control::solver("torque arm R − overlap/2", "dem:liggghts")),
        gate("dem:liggghts", "final velocity, arm R − overlap/2", Control::solver("torque arm R", "dem:lammps")),
    ]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for variant in VARIANTS {
        let done = bench.run(&at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP))?;
        let grain = OneGrain::of(&done.scene);
        let states = course(&done).unwrap_or_default();
        let surface = |state: &State| state.omega * grain.radius;
        let thin = |of: &dyn Fn(&State) -> f64| states.iter().step_by(4).map(|(t, state)| (*t, of(state))).collect();
        let curve = |label: String, stroke, points| Curve { label, stroke, points };
        curves.push(curve(format!("{variant}: v"), Stroke::Markers, thin(&|state| state.v)));
        curves.push(curve(format!("{variant}: ΩR"), Stroke::Markers, thin(&surface)));
        let exact = |of: &dyn Fn(State) -> f64| {
            (0..=200).map(|k| f64::from(k) / 200.0).map(|t| (t, of(grain.rigid_backspin(t)))).collect()
        };
        curves.push(curve(format!("{variant}: v, rigid"), Stroke::Dashed, exact(&|state| state.v)));
        curves.push(curve(format!("{variant}: ΩR, rigid"), Stroke::Dashed, exact(&|state| surface(&state))));
    }
    let velocity = Figure {
        name: "velocity".to_owned(),
        title: "From sliding to rolling".to_owned(),
        caption: "Velocity rises and surface speed falls at constant rates until they meet; from there the grain rolls. \
                  dem:lammps at overlap/R = 1e-3 (markers), rigid answer (dashes)."
            .to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "time t (s)".to_owned(), logarithmic: false },
            y: Axis { label: "velocity v, surface speed ΩR (m/s)".to_owned(), logarithmic: false },
            curves,
        }),
    };
    Ok(vec![velocity, rigid_rows::figure(bench, RIGID, OneGrain::rigid_backspin)?, elastic::figure(bench)?])
}
