//! Against what our solvers make of the same scene.

use super::covered::Covered;
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::compare::peers::{Compared, Peer, against};
use grainbench_harness::tolerance::Made;
use grainbench_harness::verdict::Verdict;
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;
use grainbench_scene::refined::refined;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Solver;

/// What our solvers owe each other beside what is measured: a millionth of the scale.
const FLOOR: f64 = 1e-6;
/// Most particle-steps that one of our solvers is run for: about half an hour.
const MOST_WORK: f64 = 2e10;
/// Most values of our runs that are compared.
const MOST_SAMPLES: u64 = 2_000_000;

/// What our conventions make of a scene over the time of some outputs, one of them with half the time step too.
pub(super) fn ours(scene: &Scene, step: f64, observed: &Observed) -> Result<Vec<Peer>, String> {
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
    let work = last as f64 * scene.grains.len() as f64;
    if work > MOST_WORK {
        return Err(format!("{last} steps of {step} s are more than our solvers are run for here"));
    }
    let run = |convention: Convention, halves: u64| {
        let scene = Scene { snapshots: 0, snapshot_times: Vec::new(), ..scene.clone() };
        let (scene, resolution) = refined(&scene, step, [last, interval], halves);
        let record = Dem::new(convention).run(&scene, &resolution, &mut ());
        record.map(|record| record.series).map_err(|error| error.to_string())
    };
    let peer = |convention: Convention| {
        let half_step = (convention == Convention::LAMMPS).then(|| run(convention, 2)).transpose()?;
        Ok(Peer { name: convention.name.to_owned(), series: run(convention, 1)?, half_step })
    };
    [Convention::DEFAULT, Convention::CUNDALL_STRACK, Convention::LAMMPS, Convention::LIGGGHTS]
        .map(peer)
        .into_iter()
        .collect()
}

fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Columns that are compared: of the motion, the kinetic energy, and the forces of contacts and walls.
pub(super) fn is_compared(name: &str) -> bool {
    let quantity = name.rsplit_once('.').map_or(name, |(_, quantity)| quantity);
    ["x", "y", "z", "vx", "vy", "vz", "kinetic_energy", "normal_force", "shear_force"].contains(&quantity)
        || quantity.starts_with("omega")
        || quantity.starts_with("force_")
}

/// A row a column: against the convention that is nearest as a whole, within what the conventions and half the time
/// step leave open.
pub(super) fn compare(
    scene: &Scene,
    ours: &[Peer],
    outputs: &Outputs,
    observed: &Observed,
    covered: &Covered,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Vec<Verdict> {
    let radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
    let mass: f64 = scene.grains.iter().map(|grain| grain.mass).sum();
    let end = observed.series.time.last().copied().unwrap_or_default();
    // What hardly moves or turns is not judged by its rounding: a way of a millionth of the radius, the speed that
    // leads there, that speed at the rim. Grains at rest have no energy that others could be measured by: a thousandth
    // of the speed is rest.
    let scale = |extent: &dyn Fn(&str) -> f64, unit: &str| {
        let way = extent("m").max(1e-6 * radius);
        let speed = if end > 0.0 { extent("m/s").max(way / end) } else { extent("m/s") };
        match unit {
            "m" => way,
            "m/s" => speed,
            "rad/s" => extent("rad/s").max(speed / radius),
            "N" => extent("N"),
            _ => extent("J").max(0.5 * mass * (1e-3 * speed).powi(2)),
        }
    };
    let Some((nearest, columns)) = against(&observed.series, &observed.uncertainty, ours, is_compared, scale) else {
        return Vec::new();
    };
    columns.into_iter().map(|of| column(&of, nearest, outputs, covered, row)).collect()
}

fn column(
    of: &Compared<'_>,
    nearest: &str,
    outputs: &Outputs,
    covered: &Covered,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Verdict {
    // Programs print forces with the velocities of the full step, half a step after those that moved the grains: of a
    // dashpot that is twice what half the step changes.
    let times = if of.unit == "N" { 3.0 } else { 1.0 };
    let row = Verdict {
        source: format!("{nearest}, the nearest of our conventions, at the file's time step"),
        tolerance: Made::Computed,
        allowed: FLOOR + of.between + times * of.halved,
        because: format!(
            "conventions differ by {}, half the step by {}{}, and {} beside",
            number::fraction(of.between),
            number::fraction(of.halved),
            if times > 1.0 { format!(", taken {times} times") } else { String::new() },
            number::fraction(FLOOR)
        ),
        ..row(format!("{}, {}", of.name, covered.words()), of.unit)
    };
    super::judged(row, of.open, outputs, &of.measured)
}
