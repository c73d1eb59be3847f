//! Walls whose motion is a function of time, in each solver. A disc on a uniformly accelerated belt rolls without slip.
//!
//! Only friction at the lowest point acts along the belt, so m a = F and I α = F R with I = m R²/2. The lowest point
//! moves with the belt. Velocity and displacement of the disc are therefore a third of those of the belt, as long as F
//! = m A/3 is below μ m g. A is the acceleration of the belt.

use crate::common::{scene, simulated};
use grainbench::solver::resolution::Resolution;

/// Final velocity of the belt (m/s).
const SPEED: f64 = 1.0;
const RISING: f64 = 0.4; // time until the belt has its final velocity (s)
const END: f64 = 0.6; // duration of the run (s), as in its scene

/// Returns the displacement of the disc at the end (m).
fn way(solver: &str, resolution: &Resolution, motion: &str) -> f64 {
    let text = include_str!("../scenes/drawn-belt.toml").replace("{ velocity = [1.0, 0.0] }", motion);
    let record = simulated(solver, &scene(&text), resolution);
    *record.series.column("disc.x").unwrap().last().unwrap()
}

#[test]
fn a_disc_rolls_on_a_belt_that_is_drawn_off_evenly() {
    let third = SPEED * (END - 0.5 * RISING) / 3.0;
    let ramp = format!("{{ velocity = [{SPEED:?}, 0.0], ramp = {RISING:?} }}");
    let rows = (0..=64_u32).map(|at| {
        let t = END * f64::from(at) / 64.0;
        let way = if t < RISING { 0.5 * SPEED * t * t / RISING } else { SPEED * (t - 0.5 * RISING) };
        format!("[{t:?}, {way:?}, 0.0]")
    });
    let table = format!("{{ table = [{}] }}", rows.collect::<Vec<_>>().join(", "));
    let at_once = format!("{{ velocity = [{SPEED:?}, 0.0] }}");
    // The grid method has a larger error in rolling (see `incline-disc`), but its results with a table and with the
    // function agree.
    for (solver, resolution, off) in [
        ("dem", Resolution::CriticalFraction(0.02), 2e-3),
        ("rigid", Resolution::substeps(32), 1e-2),
        ("mpm", Resolution::grid(4.0, 2), 0.1),
    ] {
        let found = way(solver, &resolution, &ramp);
        assert!((found - third).abs() < off * third, "{solver}: {found}, not {third}");
        let sampled = way(solver, &resolution, &table);
        assert!((sampled - found).abs() < 5e-3 * third, "{solver}: {sampled} by a table, {found} by the ramp");
        let other = way(solver, &resolution, &at_once);
        assert!((other - third).abs() > 0.2 * third, "{solver}: {other} where the belt runs at once");
    }
}
