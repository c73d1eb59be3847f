//! A slab of 369 grains in shear. Plastic grains are compared with grains on springs.

mod chains;
mod coarse;
mod figures;
mod measures;
mod paper;
mod pictures;
mod sides;
mod springs;
mod yielding;

use grainbench_harness::prelude::*;

/// Returns a resolution with `cells` cells across the slab and two points per cell and axis, as in the paper.
const fn grid(cells: f64) -> Resolution {
    Resolution::grid(cells, 2)
}

const LEVELS: &[Level] =
    &[fraction("dt=.05", 0.05), cells("L/75", 75.0, 2), cells("L/150", 150.0, 2), cells("L/300", 300.0, 2)];

pub(crate) static CASE: Case = crate::heads::POLYDISPERSE_SHEAR.with(LEVELS, 0, &claims).drawn_by(figures::figures);

fn claims() -> Vec<Claim> {
    [coarse::claims(), springs::claims(), paper::claims(), yielding::claims()].concat()
}

/// Number of snapshots during the run: one every 2.5 % of shear.
const FRAMES: u32 = 31;
/// Mean shear at which the paper shows force chains.
const CHAINS: [f64; 2] = [0.63, 0.71];

/// Returns a run that ends at a mean shear, with `snapshots` equally spaced snapshots.
fn to_shear(run: Run, shear: f64, snapshots: u32) -> Run {
    run.adjusted(&format!("to {:.0} % shear", 100.0 * shear), move |scene| sheared(scene, shear, snapshots))
}

/// Returns the time of a mean shear (s).
fn time_of(scene: &Scene, shear: f64) -> f64 {
    let speed = scene.driven.iter().map(|driven| driven.velocity.y).fold(0.0, f64::max);
    let width = scene.domain.map_or(0.0, |domain| domain.high.x - domain.low.x);
    shear * width / speed
}

/// Ends the run at a mean shear. If `snapshots` is not zero, adds snapshots at the shears of the paper's force chains.
fn sheared(scene: &mut Scene, shear: f64, snapshots: u32) {
    scene.duration = Duration::Seconds(time_of(scene, shear));
    scene.snapshots = snapshots;
    let on_the_way = CHAINS.into_iter().filter(|&at| snapshots > 0 && at < shear);
    scene.snapshot_times = on_the_way.map(|at| time_of(scene, at)).collect();
}

/// Returns an entry of the energy budget at the end (J).
fn entry(done: &FinishedRun, name: &str) -> Result<f64, MissingData> {
    done.last(&format!("budget.{name}"))
}

/// Returns the increase of an entry of the energy budget since the start (J).
fn gained(done: &FinishedRun, name: &str) -> Result<f64, MissingData> {
    let column = done.column(&format!("budget.{name}"))?;
    Ok(column[column.len() - 1] - column[0])
}

/// Compares the change of momentum with the impulse of the driven grains, in units of the largest impulse.
fn momentum(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let budget_column = |name: &str| done.column(&format!("budget.{name}"));
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for axis in ["x", "y"] {
        let (momentum, impulse) =
            (budget_column(&format!("momentum_{axis}"))?, budget_column(&format!("impulse_{axis}"))?);
        for (momentum_now, impulse_now) in momentum.iter().zip(impulse) {
            worst = worst.max((momentum_now - momentum[0] - impulse_now).abs());
            largest = largest.max(impulse_now.abs());
        }
    }
    Ok(Measurement::new(worst, 0.0, largest))
}
