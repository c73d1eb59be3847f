//! A hundred elastic discs in a box keep their energy.

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::Duration;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];

pub(crate) static CASE: Case = Case {
    name: "disc-gas",
    title: "A gas of discs",
    claim: "Without damping and friction the energy of motion and springs together is kept over 10⁵ steps and hundreds of \
            collisions.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "A wrong but conservative force would pass, and so would a grain that passes through another. Few discs \
               touch at a time.",
    ladder: LADDER,
    default_rung: LADDER[2],
    gates,
    figures,
};

/// The scene at a rung, over the same simulated time: that of 10⁵ steps at the finest.
fn run(rung: Rung) -> Run {
    let cycles = (1e5 * 0.01 / fraction_of(rung)).round() as u64;
    Run::new(PLAIN, "dem", rung.resolution).adjusted(&format!("{cycles} cycles"), move |scene| {
        scene.duration = Duration::Cycles(cycles);
    })
}

fn fraction_of(rung: Rung) -> f64 {
    match rung.resolution {
        grainbench_scene::solver::Resolution::CriticalFraction(fraction) => fraction,
        grainbench_scene::solver::Resolution::TimeStep(step)
        | grainbench_scene::solver::Resolution::Rigid { step, .. } => step,
        grainbench_scene::solver::Resolution::Grid { courant, .. } => courant,
    }
}

fn energy(done: &Done) -> Result<Measured, Missing> {
    let energy = done.column("all.total_energy")?;
    Ok(Measured::worst(&done.series().time, energy, |_| energy[0], energy[0]))
}

fn gates() -> Vec<Gate> {
    let conserved = Gate {
        quantity: "total energy over 10⁵ steps, worst".to_owned(),
        unit: "J",
        evidence: Evidence::Invariant,
        scope: Scope::AnySolver,
        source: "conservation of energy",
        allowed: 1e-4,
        because: "the kink of the force where contacts begin and end, at a hundredth of the critical step",
        runs: vec![run(LADDER[2])],
        measure: measure(|done| energy(&done[0])),
        control: Control::scene("dashpots of 1e-3 of critical", |scene| {
            let law = scene.laws[0].unwrap_or_default();
            let rate = 2e-3 * (law.normal_stiffness / scene.grains[0].mass).sqrt();
            scene.change_laws(|law| law.normal_damping = rate);
        }),
    };
    let same_sign = Gate {
        quantity: "number of discs in the box in the end".to_owned(),
        unit: "1",
        evidence: Evidence::Invariant,
        scope: Scope::AnySolver,
        source: "walls keep the discs in",
        allowed: 0.0,
        because: "a count",
        runs: vec![run(LADDER[2])],
        measure: measure(|done| {
            let snapshot = done[0].record.snapshots.last().ok_or_else(|| Missing("snapshot".to_owned()))?;
            let inside = |x: f64| (0.0..=40.0).contains(&x);
            let count = snapshot.grains.iter().filter(|grain| inside(grain.position.x) && inside(grain.position.y)).count();
            Ok(Measured::new(count as f64, done[0].scene.grains.len() as f64, 1.0))
        }),
        control: Control::scene("one wall missing", |scene| {
            scene.walls.pop();
        }),
    };
    vec![conserved, same_sign, rigid_rows::refuses_cycles(PLAIN), rigid_rows::gas_energy(PLAIN, 9.0, energy)]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for &rung in LADDER {
        let done = bench.run(&run(rung))?;
        let energy = done.series().column("all.total_energy").unwrap_or_default();
        let samples = energy.len().div_ceil(400).max(1);
        let points = done.series().time.iter().zip(energy).step_by(samples);
        curves.push(Curve {
            label: format!("Δt = {} of critical", fraction_of(rung)),
            stroke: Stroke::Line,
            points: points.map(|(t, e)| (*t, (e / energy[0] - 1.0) * 1e3)).collect(),
        });
    }
    Ok(vec![Figure {
        name: "energy".to_owned(),
        title: "Drift of the total energy".to_owned(),
        caption: "The same simulated time at three steps. Spikes are impacts in progress, steps what they left behind."
            .to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "time t (s)".to_owned(), logarithmic: false },
            y: Axis { label: "(E − E₀)/E₀ (10⁻³)".to_owned(), logarithmic: false },
            curves,
        }),
    }])
}
