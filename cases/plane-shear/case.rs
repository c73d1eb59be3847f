//! Ten thousand discs in plane shear, against a stored LAMMPS run.

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_reference::{StoredRun, ThermoRow};
use grainbench_scene::solver::{Resolution, RunError};

/// The stored run's own step.
const LADDER: &[Rung] = &[Rung { name: "dt=1e-4 s", resolution: Resolution::TimeStep(1e-4) }];

pub(crate) static CASE: Case = Case {
    name: "plane-shear",
    title: "Ten thousand discs in plane shear",
    claim: "In LAMMPS' convention the kinetic energy of a dense, polydisperse, frictional and damped packing in shear is that \
            of LAMMPS itself.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Another program, not an exact answer: an error that both share is not seen. Kinetic energy is a sum over \
               grains; it is sensitive to every one here only because nothing has had time to become chaotic.",
    ladder: LADDER,
    default_rung: LADDER[0],
    gates,
    figures,
};

fn run() -> Run {
    Run::new(PLAIN, "dem:lammps", LADDER[0].resolution)
}

fn stored() -> Result<Vec<ThermoRow>, Missing> {
    let run = StoredRun::load("lammps", "plane-shear-10k").map_err(|error| Missing(format!("reference: {error}")))?;
    Ok(run.thermo().to_vec())
}

/// Our column against a column of the reference, at the times of the reference; `per` divides ours.
fn compare(done: &Done, column: &str, of: fn(&ThermoRow) -> f64, factor: f64) -> Result<Measured, Missing> {
    let reference = stored()?;
    let expected: Vec<f64> = reference.iter().map(of).collect();
    let values: Vec<f64> = reference
        .iter()
        .map(|row| done.at_step(column, row.step).map(|value| value * factor))
        .collect::<Result<_, _>>()?;
    let time: Vec<f64> = reference.iter().map(|row| row.time).collect();
    let largest = expected.iter().copied().fold(0.0, f64::max);
    Ok(Measured::worst_of(&time, &values, &expected, largest))
}

fn gates() -> Vec<Gate> {
    const SOURCE: &str = "LAMMPS 29 Sep 2021, gran/hooke/history (stored run plane-shear-10k)";
    vec![
        Gate {
            quantity: "kinetic energy of translation over 2000 steps, worst".to_owned(),
            unit: "1",
            evidence: Evidence::OtherCode,
            scope: Scope::Named,
            source: SOURCE,
            allowed: 1e-11,
            because: "order of sums; one ulp in one position is worth 2e-13 and LAMMPS prints 15 digits; relative to the \
                      largest value",
            runs: vec![run()],
            measure: measure(|done| compare(&done[0], "all.kinetic_energy", |row| row.kinetic_energy, 1.0)),
            control: Control::solver("torque arm R − overlap/2, cap on the spring", "dem:liggghts"),
        },
        rigid_rows::refuses_periodic_axes(PLAIN),
    ]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let done = bench.run(&run())?;
    let ours = done.series().time.iter().zip(done.series().column("all.kinetic_energy").unwrap_or_default());
    let points = stored().unwrap_or_default().iter().map(|row| (row.time, row.kinetic_energy)).collect();
    Ok(vec![Figure {
        name: "kinetic-energy".to_owned(),
        title: "Kinetic energy in plane shear".to_owned(),
        caption: "Ten thousand discs, walls at −1 and +1 from t = 0: dem:lammps and LAMMPS itself.".to_owned(),
        drawing: Drawing::Graph(Graph {
            x: Axis { label: "time t (mean diameter / wall speed)".to_owned(), logarithmic: false },
            y: Axis { label: "kinetic energy (lj units)".to_owned(), logarithmic: false },
            curves: vec![
                Curve { label: "LAMMPS".to_owned(), stroke: Stroke::Markers, points },
                Curve { label: "dem:lammps".to_owned(), stroke: Stroke::Line, points: ours.map(|(t, e)| (*t, *e)).collect() },
            ],
        }),
    }])
}
