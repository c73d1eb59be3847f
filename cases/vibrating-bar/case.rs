//! A bar vibrates along its length.

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, cells};
use crate::elastic::stiffen;
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::RunError;
use std::f64::consts::PI;

const LADDER: &[Rung] = &[cells("L/12", 12.5, 2), cells("L/25", 25.0, 2), cells("L/50", 50.0, 2)];
const SOURCE: &str = "u_tt = (E/ρ) u_xx, fixed-free (derivation)";

pub(crate) static CASE: Case = Case {
    name: "vibrating-bar",
    title: "A bar vibrates along its length",
    claim: "A bar in its first mode keeps its period, its amplitude and its energy.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Small strain, one direction, no contact.",
    ladder: LADDER,
    default_rung: LADDER[1],
    gates,
    figures,
};

/// ω (rad/s) and mean velocity at the start (m/s).
fn mode(scene: &Scene) -> (f64, f64) {
    let bar = &scene.bodies[0];
    let wave = bar.wave.map_or((f64::NAN, f64::NAN), |wave| (wave.wave_number, wave.amplitude));
    let material = scene.deformable[0].map_or(f64::NAN, |material| material.longitudinal_modulus());
    (wave.0 * (material / bar.density).sqrt(), 2.0 / PI * wave.1)
}

/// Mean of the periods between crossings of zero (s).
fn period(done: &Done) -> Result<f64, Missing> {
    let (time, velocity) = (&done.series().time, done.column("bar.vx")?);
    let crossings: Vec<f64> = (1..velocity.len())
        .filter(|&at| velocity[at - 1] * velocity[at] < 0.0)
        .map(|at| {
            let share = velocity[at - 1] / (velocity[at - 1] - velocity[at]);
            time[at - 1] + share * (time[at] - time[at - 1])
        })
        .collect();
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(last)) if crossings.len() > 2 => Ok(2.0 * (last - first) / (crossings.len() - 1) as f64),
        _ => Err(Missing("crossings of zero".to_owned())),
    }
}

fn gates() -> Vec<Gate> {
    let softer = || Control::scene("two per cent softer", |scene| stiffen(scene, 0.98));
    let runs = |rung: Rung| vec![Run::new(PLAIN, "mpm", rung.resolution)];
    let mut gates: Vec<Gate> = LADDER
        .iter()
        .zip([5e-3, 1.3e-3, 4e-4])
        .map(|(&rung, allowed)| {
            Gate::new(
                (format!("period, {} cells", rung.name), "s"),
                runs(rung),
                (Evidence::Analytic, SOURCE),
                (allowed, "dispersion of the grid, falling with the cell, and the strain of .01"),
                softer(),
                |done| {
                    let exact = 2.0 * PI / mode(&done[0].scene).0;
                    Ok(Measured::new(period(&done[0])?, exact, exact))
                },
            )
        })
        .collect();
    gates.push(Gate::new(
        ("mean velocity over two periods, worst", "m/s"),
        runs(LADDER[1]),
        (Evidence::Analytic, SOURCE),
        (0.02, "phase after two periods, and the strain of .01; in units of the amplitude"),
        softer(),
        |done| {
            let (frequency, amplitude) = mode(&done[0].scene);
            let exact = |time: f64| amplitude * (frequency * time).cos();
            Ok(Measured::worst(&done[0].series().time, done[0].column("bar.vx")?, exact, amplitude))
        },
    ));
    gates.push(Gate::new(
        ("total energy over two periods, worst", "J"),
        runs(LADDER[1]),
        (Evidence::Invariant, "conservation of energy"),
        (4e-3, "half a step between velocities and stresses"),
        Control::scene("damping of a hundredth per second", |scene| scene.global_damping = 0.01),
        |done| {
            let energy = done[0].column("all.total_energy")?;
            Ok(Measured::worst(&done[0].series().time, energy, |_| energy[0], energy[0]))
        },
    ));
    gates
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    let mut exact = Vec::new();
    for rung in LADDER {
        let done = bench.run(&Run::new(PLAIN, "mpm", rung.resolution))?;
        let (frequency, amplitude) = mode(&done.scene);
        let velocity = done.series().column("bar.vx").unwrap_or_default();
        let samples = done.series().time.iter().zip(velocity).step_by(4);
        curves.push(Curve::new(rung.name, Stroke::Line, samples.map(|(&time, &velocity)| (time, velocity)).collect()));
        exact = (0..=200)
            .map(|k| f64::from(k) / 10.0)
            .map(|time| (time, amplitude * (frequency * time).cos()))
            .collect();
    }
    curves.push(Curve::new("exact", Stroke::Dashed, exact));
    Ok(vec![Figure::graph(
        "velocity",
        "Mean velocity of the bar",
        "Two periods; cells along the length in the legend.",
        [Axis::linear("time t (s)"), Axis::linear("mean velocity (m/s)")],
        curves,
    )])
}
