//! Figures of the nine discs, like Figs 5-9 of the paper.

use super::modal::{Modal, law};
use super::{DISTORTION, FIGURE_STEP, LEVELS, MODAL, ORDER, SPEEDS, TURN, modal_error, modal_run};
use crate::sources::literature::cundall_strack_1979::RESIDUAL_AMPLITUDE;
use grainbench_harness::force_plot::force_plot;
use grainbench_harness::prelude::*;

pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut all = Vec::new();
    for (name, variant, title, caption) in [
        (
            "forces",
            "static-1",
            "Contact forces after compression",
            "κ = 1, at rest; bars through the contacts with the orientation of the force and a width proportional to it, as \
             in Fig. 5(b). The walls carry shear at the corner discs although they only move towards each other.",
        ),
        (
            "forces-distortion",
            DISTORTION[3],
            "Contact forces in distortion",
            "κ = 1, φ = 30°, after the walls have turned by .35°: one diagonal carries the load and its contacts slip \
             at the corners and at the centre. The corner discs of the other diagonal have separated from the walls, \
             as in Fig. 8(b).",
        ),
    ] {
        let done = runner.run(&Run::new(variant, "dem:1979", LEVELS[0].resolution))?;
        if let Some(snapshot) = done.record.snapshots.last() {
            all.push(Figure::forces(name, title, caption, force_plot(snapshot)));
        }
    }
    all.push(damping(runner)?);
    all.push(speed(runner, "speed-stiff", "Speed of loading, k_n = k_s = 1.35e9", ["fast", "slow"], [0.12, 0.04])?);
    all.push(speed(
        runner,
        "speed-soft",
        "Speed of loading, k_n = k_s = 1.5e8",
        ["soft-fast", "soft-slow"],
        [0.36, 0.12],
    )?);
    all.push(residual_over_step(runner)?);
    for (name, angle, variants) in [
        ("distortion-15deg", "15°", [DISTORTION[0], DISTORTION[1]]),
        ("distortion-30deg", "30°", [DISTORTION[2], DISTORTION[3]]),
    ] {
        all.push(distortion(runner, name, angle, variants)?);
    }
    all.push(convergence(runner)?);
    Ok(all)
}

/// Returns the force between centre and edge over its static value, by cycles from the stop of the walls.
fn after_stop(done: &FinishedRun, stop: u64, cycles: usize) -> Vec<(f64, f64)> {
    let phase = &done.scene.walls[0].motion.phases[0];
    let travel = phase.velocity.norm() * stop as f64 * done.record.provenance.time_step;
    let rest = Modal::from_scene(&done.scene).at_rest().edge * law(&done.scene).normal_stiffness() * travel;
    let force = done.series().column("centre-edge.normal_force").unwrap_or_default();
    force
        .iter()
        .skip(stop as usize)
        .take(cycles)
        .enumerate()
        .map(|(cycle, force)| (cycle as f64, force / rest))
        .collect()
}

fn damping(runner: &Runner) -> Result<Figure, RunError> {
    let run = |variant| runner.run(&Run::new(variant, "dem", FIGURE_STEP));
    Ok(Figure::graph(
        "damping",
        "Effect of damping",
        "Force between centre and edge after the walls stop, as in Fig. 6: without damping it oscillates about F_eq, with \
         contact and global damping it settles there.",
        [Axis::linear("cycles after the walls stop"), Axis::linear("F_n / F_eq, centre-edge")],
        vec![
            Curve::new("1: no damping", Stroke::Line, after_stop(&run("fast")?, 40, 160)),
            Curve::new("2: contact and global damping", Stroke::Line, after_stop(&run("damped-fast")?, 40, 160)),
        ],
    ))
}

fn speed(
    runner: &Runner,
    name: &str,
    title: &str,
    variants: [&'static str; 2],
    speeds: [f64; 2],
) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for ((variant, speed), stop) in variants.into_iter().zip(speeds).zip([40, 120]) {
        let done = runner.run(&Run::new(variant, "dem", FIGURE_STEP))?;
        curves.push(Curve::new(format!("wall velocity {speed}"), Stroke::Line, after_stop(&done, stop, 160)));
    }
    Ok(Figure::graph(
        name,
        title,
        "As in Fig. 7: faster loading leaves a larger oscillation of the same frequency.",
        [Axis::linear("cycles after the walls stop"), Axis::linear("F_n / F_eq, centre-edge")],
        curves,
    ))
}

/// Returns the figure of the remaining amplitude after 40 cycles over the step, which the paper does not print.
fn residual_over_step(runner: &Runner) -> Result<Figure, RunError> {
    let scene = runner.scene(&Run::new("kappa-1", "dem", FIGURE_STEP))?;
    let modal = Modal::from_scene(&scene);
    let critical = scene.critical_time_step();
    let points =
        (10..=260).map(|at| f64::from(at) * 1e-3).map(|f| (f, modal.residual(40, f * critical))).collect::<Vec<_>>();
    let printed = [0.01, 0.26].map(|f| (f, RESIDUAL_AMPLITUDE.value)).to_vec();
    Ok(Figure::graph(
        "residual",
        "Residual oscillation against the time step",
        "Amplitude left after 40 cycles of loading at κ = 1, from the exact answer of the cycle (both modes added). The paper \
         prints .15 F_eq without its step; the curve crosses it several times.",
        [Axis::linear("Δt / critical step"), Axis::linear("amplitude / F_eq, centre-edge")],
        vec![
            Curve::new("exact answer of the cycle", Stroke::Dashed, points),
            Curve::new("printed in the paper", Stroke::Dashed, printed),
        ],
    ))
}

fn distortion(runner: &Runner, name: &str, angle: &str, variants: [&'static str; 2]) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for (variant, kappa) in variants.into_iter().zip(["2/3", "1"]) {
        let done = runner.run(&Run::new(variant, "dem:1979", LEVELS[0].resolution))?;
        for (column, force) in [("centre-edge.normal_force", "F_n"), ("centre-edge.shear_force", "F_s")] {
            let values = done.series().column(column).unwrap_or_default();
            let points =
                values.iter().skip(TURN).enumerate().map(|(cycle, value)| (cycle as f64, value.abs() / 1e8)).collect();
            curves.push(Curve::new(format!("{force}, κ = {kappa}"), Stroke::Line, points));
        }
    }
    Ok(Figure::graph(
        name,
        &format!("Distortion at constant volume, φ = {angle}"),
        "Normal and shear force between centre and edge while the walls turn about their centres, as in Fig. 9.",
        [Axis::linear("cycles after the walls begin to turn"), Axis::linear("force (10⁸ N)")],
        curves,
    ))
}

fn convergence(runner: &Runner) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for variant in MODAL {
        let mut points = Vec::new();
        for &level in ORDER {
            let done: Vec<FinishedRun> =
                SPEEDS.iter().map(|&speed| runner.run(&modal_run(variant, level, speed))).collect::<Result<_, _>>()?;
            let run = &done[0].record.provenance;
            if let (Ok(worst), Some(critical)) = (modal_error(&done), run.critical_time_step) {
                points.push((run.time_step / critical, worst.error().abs()));
            }
        }
        curves.push(Curve::new(variant, Stroke::MarkedLine, points));
    }
    let square: Vec<(f64, f64)> = [0.0125, 0.1].iter().map(|f| (*f, 0.8 * f * f)).collect();
    curves.push(Curve::new("slope 2", Stroke::Dashed, square));
    Ok(Figure::graph(
        "convergence",
        "Deviation from the continuous answer",
        "Worst displacement error over ten periods of the slow mode, in units of the wall travel, in the limit of small \
         overlaps: at a finite one geometry adds 5 × 10⁻⁵.",
        [Axis::log("Δt / critical step"), Axis::log("worst error / wall travel")],
        curves,
    ))
}
