//! Against what our solvers make of the same scene.

use super::widened;
use grainbench_harness::expect::Measured;
use grainbench_harness::tolerance::Made;
use grainbench_harness::verdict::Verdict;
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::Outputs;
use grainbench_scene::refined::refined;
use grainbench_reports::number;
use grainbench_scene::record::Series;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Solver;

/// What our solvers owe each other beside what is measured: a millionth of the scale.
const FLOOR: f64 = 1e-6;
/// Most values of our runs that are compared.
const MOST_SAMPLES: u64 = 2_000_000;

/// What our solvers make of a scene at the times of some outputs.
pub(super) struct Ours {
    /// Conventions, and one of them with half the time step.
    pub(super) runs: Vec<(&'static str, Series)>,
    twin: Series,
    /// Place of each observed sample in the series of the runs.
    places: Vec<usize>,
}

pub(super) fn ours(scene: &Scene, step: f64, observed: &Observed) -> Result<Ours, String> {
    let steps = &observed.series.step;
    let (Some(&last), true) = (steps.last(), steps.windows(2).all(|pair| pair[0] < pair[1])) else {
        return Err("the steps do not grow".to_owned());
    };
    let off = |(step_, time): (&u64, &f64)| (*step_ as f64 * step - time).abs() > 1e-6 * step.max(*time);
    if let Some(at) = steps.iter().zip(&observed.series.time).position(off) {
        return Err(format!("the time {} s is no whole number of steps of {step} s", observed.series.time[at]));
    }
    let interval = steps.iter().fold(0, |all, &step| common_divisor(all, step)).max(1);
    if last / interval > MOST_SAMPLES {
        return Err(format!("{} samples are more than {MOST_SAMPLES}", last / interval));
    }
    let run = |convention: Convention, halves: u64| {
        let (scene, resolution) =
            refined(&Scene { snapshots: 0, snapshot_times: Vec::new(), ..scene.clone() }, step, [last, interval], halves);
        let record = Dem::new(convention).run(&scene, &resolution, &mut ());
        record.map(|record| record.series).map_err(|error| error.to_string())
    };
    let conventions = [Convention::CUNDALL_STRACK, Convention::LAMMPS, Convention::LIGGGHTS];
    let mut runs = Vec::new();
    for convention in conventions {
        runs.push((convention.name, run(convention, 1)?));
    }
    let places = steps.iter().map(|step| (step / interval) as usize).collect();
    Ok(Ours { runs, twin: run(Convention::LAMMPS, 2)?, places })
}

fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl Ours {
    /// A column of one of the runs at the observed samples.
    pub(super) fn at(&self, series: &Series, name: &str) -> Option<Vec<f64>> {
        let values = series.column(name)?;
        self.places.iter().map(|&place| values.get(place).copied()).collect()
    }
}

/// Columns that are compared: of the motion, the kinetic energy, and the forces of contacts and walls.
pub(super) fn is_compared(name: &str) -> bool {
    let quantity = name.rsplit_once('.').map_or(name, |(_, quantity)| quantity);
    ["x", "y", "z", "vx", "vy", "vz", "kinetic_energy", "normal_force", "shear_force"].contains(&quantity)
        || quantity.starts_with("omega")
        || quantity.starts_with("force_")
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().map(f64::abs).fold(0.0, f64::max)
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Coordinates from where they start, all else as it is.
fn difference_from_start(values: &[f64], unit: &str) -> Vec<f64> {
    let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
    values.iter().map(|value| value - start).collect()
}

/// A row a column: against the convention that is nearest as a whole, within what the conventions and half the time step
/// leave open.
pub(super) fn compare(
    scene: &Scene,
    ours: &Ours,
    outputs: &Outputs,
    observed: &Observed,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Vec<Verdict> {
    struct Compared<'c> {
        name: &'c str,
        unit: &'c str,
        values: &'c [f64],
        scale: f64,
        runs: Vec<Vec<f64>>,
        twin: Vec<f64>,
        open: f64,
    }
    let mut columns: Vec<Compared<'_>> = Vec::new();
    for (at, column) in observed.series.columns.iter().enumerate().filter(|(_, column)| is_compared(&column.name)) {
        let runs: Option<Vec<Vec<f64>>> = ours.runs.iter().map(|(_, series)| ours.at(series, &column.name)).collect();
        let (Some(runs), Some(twin)) = (runs, ours.at(&ours.twin, &column.name)) else { continue };
        let (values, moves) = (&observed.series.values[at], &observed.uncertainty[at]);
        columns.push(Compared {
            name: &column.name,
            unit: &column.unit,
            values,
            scale: 0.0,
            runs,
            twin,
            open: largest(moves),
        });
    }
    let extent = |unit: &str| {
        let of_unit = columns.iter().filter(|column| column.unit == unit);
        of_unit.map(|column| largest(&difference_from_start(&column.runs[1], unit))).fold(0.0, f64::max)
    };
    // One scale for all columns of a unit: what does not move along one axis is not judged by its rounding there, nor what
    // hardly turns by its own spin.
    let radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
    let end = observed.series.time.last().copied().unwrap_or_default();
    let way = extent("m").max(1e-6 * radius);
    let speed = if end > 0.0 { extent("m/s").max(way / end) } else { extent("m/s") };
    // Grains at rest have no energy that others could be measured by: a thousandth of the speed is rest.
    let mass: f64 = scene.grains.iter().map(|grain| grain.mass).sum();
    let energy = extent("J").max(0.5 * mass * (1e-3 * speed).powi(2));
    let (spin, force) = (extent("rad/s").max(speed / radius), extent("N"));
    for column in &mut columns {
        column.scale = match column.unit {
            "m" => way,
            "m/s" => speed,
            "rad/s" => spin,
            "N" => force,
            _ => energy,
        };
    }
    columns.retain(|column| column.scale > 0.0);
    let distance = |run: usize| -> f64 {
        columns.iter().map(|column| largest(&difference(column.values, &column.runs[run])) / column.scale).sum()
    };
    let nearest = (0..ours.runs.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    let mut verdicts = Vec::new();
    for column in &columns {
        let expected = &column.runs[nearest];
        let between = column.runs.iter().map(|run| largest(&difference(run, expected))).fold(0.0, f64::max);
        // Programs print forces with the velocities of the full step, half a step after those that moved the grains: of a
        // dashpot that is twice what half the step changes.
        let times = if column.unit == "N" { 3.0 } else { 1.0 };
        let halved = times * largest(&difference(&column.twin, &column.runs[1]));
        let [between, halved, open] = [between, halved, column.open].map(|part| part / column.scale);
        let found = Measured::worst_of(&observed.series.time, column.values, expected, column.scale);
        let mut verdict = row(format!("{} over the run, worst", column.name), column.unit);
        verdict.source = format!("{}, the nearest of our conventions, at the file's time step", ours.runs[nearest].0);
        verdict.tolerance = Made::Computed;
        verdict.allowed = FLOOR + between + halved;
        verdict.because = format!(
            "conventions differ by {}, half the step by {}{}, and {} beside",
            number::fraction(between),
            number::fraction(halved / times),
            if times > 1.0 { format!(", taken {times} times") } else { String::new() },
            number::fraction(FLOOR)
        );
        verdicts.push(widened(verdict, open, outputs).judged(&found));
    }
    verdicts
}
