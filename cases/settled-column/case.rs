//! Two thousand spheres settle in a column. Walls and floor carry the weight, and the packing agrees with LAMMPS and
//! LIGGGHTS.

use crate::rows::programs::PAIRS;
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::spread;

const LEVELS: &[Level] = &[fraction("dt=.2", 0.2)];

pub(crate) static CASE: Case = crate::heads::SETTLED_COLUMN.with(LEVELS, 0, &claims).drawn_by(figures);

/// Variants with columns from different random seeds. The spread between them gives the tolerances.
const COLUMNS: [&str; 4] = [PLAIN, "seed-12", "seed-13", "seed-14"];

fn run(solver: &'static str) -> Run {
    Run::new(PLAIN, solver, LEVELS[0].resolution)
}

/// Returns the mean of a column over the last fifth of the run.
fn settled(done: &FinishedRun, column: &str) -> Result<f64, MissingData> {
    let values = done.column(column)?;
    Ok(mean(&values[values.len() - values.len().div_ceil(5)..]))
}

fn weight(done: &FinishedRun) -> f64 {
    let mass: f64 = done.scene.grains.iter().map(|grain| grain.mass).sum();
    mass * done.scene.gravity.norm()
}

fn packing_fraction(done: &FinishedRun) -> Result<f64, MissingData> {
    let height = settled(done, "all.gravitational_energy")? / weight(done);
    let volume: f64 = done.scene.grains.iter().map(|grain| 4.0 / 3.0 * PI * grain.radius.powi(3)).sum();
    let base = done.scene.domain.map_or(f64::NAN, |domain| {
        let size = domain.high - domain.low;
        size.x * size.y
    });
    Ok(volume / (base * 2.0 * height))
}

fn coordination(done: &FinishedRun) -> Result<f64, MissingData> {
    settled(done, "packing.coordination")
}

/// Returns the vertical force on all walls (N).
fn carried(done: &FinishedRun) -> Result<f64, MissingData> {
    ["floor", "left", "right", "front", "back"]
        .iter()
        .map(|wall| Ok(-settled(done, &format!("{wall}.force_z"))?))
        .sum::<Result<f64, MissingData>>()
}

fn claims() -> Vec<Claim> {
    let weight = claim("weight carried by floor and walls", "N")
        .run(run(PAIRS[0][0]))
        .equals(Source::Derived("balance of forces at rest"), |done| {
            Ok(Measurement::relative(carried(&done[0])?, weight(&done[0])))
        })
        .within(judged(
            2e-3,
            "remaining motion at the end, 1e-4 to 1.1e-3 depending on the convention; relative to the weight",
        ))
        .refuses(Control::scene("a run that ends while they fall", |scene| scene.duration = Duration::Seconds(4.0)))
        .solver_independent();
    let beside = |[ours, program]: [&'static str; 2], quantity: &str, read: RunReader| {
        claim(format!("{quantity}, against {program}"), "1")
            // Each of our five runs takes one to two seconds.
            .runs([run(ours).slow(), run(program)])
            .runs(COLUMNS.map(|variant| Run { variant, ..run(PAIRS[0][0]) }.aside()))
            .agrees(Source::Program, move |done| {
                let columns: Vec<f64> = done[2..].iter().map(read).collect::<Result<_, _>>()?;
                let interval = spread(&columns).ok_or("columns that differ")?;
                Ok(Measurement::new(read(&done[0])?, read(&done[1])?, interval))
            })
            .within(one_interval(
                "in units of the 99 % interval of the difference of two columns, from the spread of four starts",
            ))
            .refuses(Control::our_contact_law("friction .05 for .5 in ours", |law| law.friction = 0.05))
    };
    let of_pair =
        |pair| [beside(pair, "packing fraction", packing_fraction), beside(pair, "coordination number", coordination)];
    [weight].into_iter().chain(PAIRS.into_iter().flat_map(of_pair)).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut runs = Vec::new();
    let pairs = if runner.is_thorough() { &PAIRS[..] } else { &PAIRS[..1] };
    for &[ours, program] in pairs {
        runs.push((ours, Stroke::Line, runner.run(&run(ours))?));
        // LAMMPS or LIGGGHTS has no curve if it is not installed and no run of it is stored.
        if let Ok(theirs) = runner.run(&run(program)) {
            runs.push((program, Stroke::Markers, theirs));
        }
    }
    let figure = |name: &str, title: &str, y: &str, column: &str, factor: fn(&FinishedRun) -> f64| {
        let curve = |(label, stroke, done): &(&str, Stroke, FinishedRun)| {
            let values = done.series().column(column).unwrap_or_default().iter().map(|value| value * factor(done));
            Curve::new(*label, *stroke, done.series().time.iter().copied().zip(values).collect())
        };
        let caption = "External solvers (markers) are compared with our solver with their contact convention (line), \
                       from the same initial state.";
        let axes = [Axis::linear("time t (s)"), Axis::linear(y)];
        Figure::graph(name, title, caption, axes, runs.iter().map(curve).collect())
    };
    Ok(vec![
        figure("floor", "Load on the floor", "force on the floor / weight (1)", "floor.force_z", |done| {
            -1.0 / weight(done)
        }),
        figure("coordination", "Coordination number", "contacts per sphere (1)", "packing.coordination", |_| 1.0),
        figure("height", "Height of the centre of mass", "height (m)", "all.gravitational_energy", |done| {
            1.0 / weight(done)
        }),
    ])
}
