//! Two thousand spheres settle in a column: the weight is carried, and the packing is that of both programs.

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::program_rows::PAIRS;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_reference::statistics::spread;
use grainbench_scene::scene::Duration;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[fraction("dt=.2", 0.2)];

pub(crate) static CASE: Case = Case {
    name: "settled-column",
    title: "Spheres settle in a column",
    claim: "Two thousand spheres that fall into a column come to rest, walls and floor carry their weight, and packing \
            fraction and coordination are those of LAMMPS and LIGGGHTS as far as one column can tell.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Sums over one column: what is smaller than the spread from column to column is not seen. The load on the floor \
               and the ratio of stresses are no gates: they spread by a tenth, and friction hardly moves them in so short a \
               column. The height is that of the centre of mass.",
    ladder: LADDER,
    default_rung: LADDER[0],
    gates,
    figures,
};

/// Columns of ours that give the spread.
const COLUMNS: [&str; 4] = [PLAIN, "seed-12", "seed-13", "seed-14"];

fn run(solver: &'static str) -> Run {
    Run::new(PLAIN, solver, LADDER[0].resolution)
}

/// The mean of a column over the last fifth of the run.
fn settled(done: &Done, column: &str) -> Result<f64, Missing> {
    let values = done.column(column)?;
    let last = &values[values.len() - values.len().div_ceil(5)..];
    Ok(last.iter().sum::<f64>() / last.len() as f64)
}

fn weight(done: &Done) -> f64 {
    let mass: f64 = done.scene.grains.iter().map(|grain| grain.mass).sum();
    mass * done.scene.gravity.norm()
}

fn packing_fraction(done: &Done) -> Result<f64, Missing> {
    let height = settled(done, "all.gravitational_energy")? / weight(done);
    let volume: f64 = done.scene.grains.iter().map(|grain| 4.0 / 3.0 * std::f64::consts::PI * grain.radius.powi(3)).sum();
    let base = done.scene.domain.map_or(f64::NAN, |domain| {
        let size = domain.high - domain.low;
        size.x * size.y
    });
    Ok(volume / (base * 2.0 * height))
}

fn coordination(done: &Done) -> Result<f64, Missing> {
    settled(done, "packing.coordination")
}

/// What all walls carry.
fn carried(done: &Done) -> Result<f64, Missing> {
    ["floor", "left", "right", "front", "back"]
        .iter()
        .map(|wall| Ok(-settled(done, &format!("{wall}.force_z"))?))
        .sum::<Result<f64, Missing>>()
}

type Read = fn(&Done) -> Result<f64, Missing>;

fn gates() -> Vec<Gate> {
    let mut gates = Vec::new();
    gates.push(Gate {
        quantity: "weight carried by floor and walls".to_owned(),
        unit: "N",
        evidence: Evidence::Analytic,
        scope: Scope::AnySolver,
        source: "balance of forces at rest",
        allowed: 2e-3,
        because: "what still moves at the end, by convention 1e-4 to 1.1e-3; relative to the weight",
        runs: vec![run(PAIRS[0][1])],
        measure: measure(|done| Ok(Measured::new(carried(&done[0])?, weight(&done[0]), weight(&done[0])))),
        control: Control::scene("a run that ends while they fall", |scene| scene.duration = Duration::Seconds(4.0)),
    });
    let quantities: [(&str, Read); 2] =
        [("packing fraction", packing_fraction), ("coordination number", coordination)];
    let smooth = Control::ours("friction .05 for .5 in ours", |scene| scene.change_laws(|law| law.friction = 0.05));
    for [program, ours] in PAIRS {
        for (quantity, read) in quantities {
            let columns = COLUMNS.map(|variant| Run { variant, ..run(PAIRS[0][1]) }.aside());
            gates.push(Gate {
                quantity: format!("{quantity}, against {ours}"),
                unit: "1",
                evidence: Evidence::OtherCode,
                scope: Scope::Named,
                source: "the program, run on the deck of the same scene",
                allowed: 1.0,
                because: "in units of the 99 % interval of the difference of two columns, from the spread of four starts",
                // Five runs of a second or two each.
                runs: [run(program).slow(), run(ours)].into_iter().chain(columns).collect(),
                measure: measure(move |done| {
                    let columns: Vec<f64> = done[2..].iter().map(read).collect::<Result<_, _>>()?;
                    let interval = spread(&columns).ok_or_else(|| Missing("columns that differ".to_owned()))?;
                    Ok(Measured::new(read(&done[0])?, read(&done[1])?, interval))
                }),
                control: smooth.clone(),
            });
        }
    }
    gates
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut runs = Vec::new();
    for [program, ours] in PAIRS {
        runs.push((ours, Stroke::Line, bench.run(&run(ours))?));
        // Without the program and without its stored run there is nothing to draw.
        if let Ok(theirs) = bench.run(&run(program)) {
            runs.push((program, Stroke::Markers, theirs));
        }
    }
    let figure = |name: &str, title: &str, y: &str, column: &str, factor: fn(&Done) -> f64| Figure {
        name: name.to_owned(),
        title: title.to_owned(),
        caption: "Both programs, and our solver in the convention of each, from the same start.".to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis::linear("time t (s)"),
            y: Axis::linear(y),
            curves: runs
                .iter()
                .map(|(label, stroke, done)| Curve {
                    label: (*label).to_owned(),
                    stroke: *stroke,
                    points: done
                        .series()
                        .time
                        .iter()
                        .copied()
                        .zip(done.series().column(column).unwrap_or_default().iter().map(|value| value * factor(done)))
                        .collect(),
                })
                .collect(),
        }),
    };
    Ok(vec![
        figure("floor", "Load on the floor", "force on the floor / weight (1)", "floor.force_z", |done| -1.0 / weight(done)),
        figure("coordination", "Coordination number", "spheres touched (1)", "packing.coordination", |_| 1.0),
        figure("height", "Height of the centre of mass", "height (m)", "all.gravitational_energy", |done| {
            1.0 / weight(done)
        }),
    ])
}
