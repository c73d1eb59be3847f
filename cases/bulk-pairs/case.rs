//! All material pairs of the round robin of bulk processes, against LIGGGHTS.

use crate::rows::programs::{LIGGGHTS, row, same_cycle};
use grainbench_harness::prelude::*;

/// Time step of the impact in the paper (Dosta et al. 2024).
const LEVELS: &[Level] = &[time_step("dt=5e-7 s", 5e-7)];

pub(crate) static CASE: Case = crate::heads::BULK_PAIRS.with(LEVELS, 0, &claims);

/// Variants with the names of their pairs.
const PAIRS: [(&str, &str); 8] = [
    ("m1-m1", "M1 on M1"),
    ("m1-m2", "M1 on M2"),
    ("m2-m2", "M2 on M2"),
    ("m1-steel", "M1 on steel"),
    ("m2-steel", "M2 on steel"),
    ("steel-steel", "steel on steel"),
    ("m1-wall", "M1 on a wall of steel"),
    ("m2-wall", "M2 on a wall of steel"),
];

/// Returns the claims on the force m Δv/Δt and on the torque I Δω/Δt on the first grain of a pair, over all steps.
fn claims() -> Vec<Claim> {
    let of_pair = |(variant, about): (&'static str, &str)| {
        let runs = || LIGGGHTS.map(|solver| Run::new(variant, solver, LEVELS[0].resolution));
        let stiffer = Control::our_contact_law("E* × 1.00001 in ours", |law| law.scale_normal(1.00001));
        let rougher = Control::our_contact_law("μ × 1.00001 in ours", |law| law.friction *= 1.00001);
        let [of_force, of_torque] = ["in units of the largest force", "in units of the largest torque"].map(same_cycle);
        [
            row(&format!("force, {about}, worst"), "N", of_force, runs(), stiffer, |done| {
                rate(done, &["a.vx", "a.vz"], done[0].scene.grains[0].mass)
            }),
            row(&format!("torque, {about}, worst"), "N m", of_torque, runs(), rougher, |done| {
                rate(done, &["a.omega_y"], done[0].scene.grains[0].inertia)
            }),
        ]
    };
    PAIRS.into_iter().flat_map(of_pair).collect()
}

/// Returns the largest difference between our rate and that of LIGGGHTS, in units of the largest rate of LIGGGHTS. A
/// rate is the change of a velocity in a step, times mass or moment of inertia, divided by the step.
fn rate(done: &[FinishedRun], columns: &[&str], inertia: f64) -> Result<Measurement, MissingData> {
    let [ours, theirs, ..] = done else { return Err("second run to compare with".into()) };
    let times = &theirs.series().time;
    let middle: Vec<f64> = times.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let gains = |values: &[f64]| -> Vec<f64> {
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        values.windows(2).zip(steps).map(|(pair, step)| inertia * (pair[1] - pair[0]) / step).collect()
    };
    let mut both = Vec::new();
    let mut largest = 0.0_f64;
    for column in columns {
        let (ours, theirs) = together(ours, theirs, column)?;
        let (ours, theirs) = (gains(&ours), gains(&theirs));
        largest = theirs.iter().fold(largest, |most, value| most.max(value.abs()));
        both.push((ours, theirs));
    }
    let found = both.iter().map(|(ours, theirs)| Ok(Measurement::worst_of(&middle, ours, theirs, largest)));
    Measurement::worst_read(found)
}
