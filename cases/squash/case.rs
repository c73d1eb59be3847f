//! The worked example of Cundall & Strack (1979): the calculation cycle, exactly.

#[path = "elastic.rs"]
mod elastic;

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::motion::Moment;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.05", 0.05)];

pub(crate) static CASE: Case = Case {
    name: "squash",
    title: "Two discs squashed between two walls",
    claim: "The calculation cycle is that of the 1979 paper: forces of the first three cycles, and of 200, are those \
            that the paper's equations give, to rounding.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "One dimension, no friction, no rotation and no contact that opens. It tells the order of operations in a \
               cycle and nothing about contact detection: a code may pass and still find contacts one step late.",
    ladder: LADDER,
    default_rung: LADDER[0],
    gates,
    figures,
};

fn run() -> Run {
    Run::new(PLAIN, "dem", LADDER[0].resolution)
}

/// q = kΔt²/m and the unit of force k v Δt, from the scene and the step that was run.
fn units(done: &Done) -> (f64, f64) {
    let stiffness = done.scene.laws.iter().flatten().map(|law| law.normal_stiffness).fold(0.0, f64::max);
    let time_step = done.record.provenance.time_step;
    let speed = done.scene.walls[0].motion.phases[0].velocity.norm();
    (stiffness * time_step * time_step / done.scene.grains[0].mass, stiffness * speed * time_step)
}

/// Displacement of disc x after `n` cycles in units of vΔt.
fn displacement(n: f64, q: f64) -> f64 {
    let theta = 2.0 * ((3.0 * q).sqrt() / 2.0).asin();
    (n - (n * theta).sin() / theta.sin()) / 3.0
}

/// Forces (F_A, F_B) of the first three cycles in units of k v Δt.
fn first_cycles(cycle: u32, q: f64) -> (f64, f64) {
    match cycle {
        1 => (1.0, 0.0),
        2 => (2.0 - q, 2.0 * q),
        _ => (3.0 - 4.0 * q + 3.0 * q * q, 8.0 * q - 6.0 * q * q),
    }
}

fn gates() -> Vec<Gate> {
    let late = || {
        Control::scene("the left wall starts one cycle late", |scene| {
            scene.walls[0].motion.phases[0].start = Moment::Cycle(1);
        })
    };
    let mut gates = Vec::new();
    for cycle in 1..=3_u32 {
        for (contact, column) in [("A", "A.normal_force"), ("B", "B.normal_force"), ("C", "C.normal_force")] {
            gates.push(Gate {
                quantity: format!("normal force at {contact}, cycle {cycle}"),
                unit: "N",
                evidence: Evidence::Analytic,
                scope: Scope::Named,
                source: "Cundall & Strack 1979, eqs. 1-7",
                allowed: 1e-12,
                because: "rounding of positions of order R, in units of k v Δt with v Δt = 1e-3 R",
                runs: vec![run()],
                measure: measure(move |done| {
                    let (q, unit) = units(&done[0]);
                    let (side, middle) = first_cycles(cycle, q);
                    let expected = if column.starts_with('B') { middle } else { side };
                    Ok(Measured::new(done[0].at_step(column, u64::from(cycle))?, expected * unit, unit))
                }),
                control: match (cycle, contact) {
                    (1, "B") => Control::scene("the discs overlap by 1e-6 R at the start", |scene| {
                        scene.grains[1].position.x -= 1e-6;
                    }),
                    (2, "C") | (1, "C") => Control::scene("the right wall starts one cycle late", |scene| {
                        scene.walls[1].motion.phases[0].start = Moment::Cycle(1);
                    }),
                    (3, _) => Control::scene("the mass of disc y off by a millionth", |scene| {
                        scene.grains[1].mass *= 1.0 + 1e-6;
                        scene.grains[0].mass *= 1.0 + 1e-6;
                    }),
                    _ => late(),
                },
            });
        }
    }
    gates.push(Gate {
        quantity: "normal force at A over 200 cycles, worst".to_owned(),
        unit: "N",
        evidence: Evidence::Analytic,
        scope: Scope::Named,
        source: "closed solution of the paper's recurrence (derivation)",
        allowed: 1e-10,
        because: "rounding adds up over 200 cycles; in units of k v Δt",
        runs: vec![run()],
        measure: measure(worst_at_a),
        control: Control::scene("damping of 1e-6 of critical", |scene| {
            scene.change_laws(|law| law.normal_damping = 2e-6);
        }),
    });
    gates.push(rigid_rows::refuses_cycles(PLAIN));
    gates.extend(elastic::DISCS.gates(|run| run));
    gates
}

fn worst_at_a(done: &[Done]) -> Result<Measured, Missing> {
    let (q, unit) = units(&done[0]);
    let expected: Vec<f64> =
        done[0].series().step.iter().map(|&n| (n as f64 - displacement(n as f64, q)) * unit).collect();
    Ok(Measured::worst_of(&done[0].series().time, done[0].column("A.normal_force")?, &expected, unit))
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let done = bench.run(&run())?;
    let (q, unit) = units(&done);
    let measured = |column: &str| -> Vec<(f64, f64)> {
        let values = done.series().column(column).unwrap_or_default();
        done.series().step.iter().zip(values).take(61).map(|(&n, force)| (n as f64, force / unit)).collect()
    };
    let exact = |of: &dyn Fn(f64) -> f64| (0..=60).map(|n| (f64::from(n), of(f64::from(n)))).collect();
    let curve = |label: &str, stroke, points| Curve { label: label.to_owned(), stroke, points };
    Ok(vec![Figure {
        name: "forces".to_owned(),
        title: "Forces at the walls and between the discs".to_owned(),
        caption: "Each cycle of the solver against the closed solution of the paper's recurrence. The wall force leads; \
                  the discs pass it on after the disturbance has crossed them."
            .to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "calculation cycle n".to_owned(), logarithmic: false },
            y: Axis { label: "normal force / (k v Δt)".to_owned(), logarithmic: false },
            curves: vec![
                curve("wall A, dem", Stroke::Markers, measured("A.normal_force")),
                curve("between, B, dem", Stroke::Markers, measured("B.normal_force")),
                curve("A, exact", Stroke::Dashed, exact(&|n| n - displacement(n, q))),
                curve("B, exact", Stroke::Dashed, exact(&|n| 2.0 * displacement(n, q))),
            ],
        }),
    }, elastic::figure(bench)?])
}
