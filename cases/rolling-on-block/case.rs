//! A disc rolls down a deformable block: friction between two deformable bodies.

use crate::bench::Bench;
use crate::case::{Case, Rung, cells};
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] = &[cells("R/4", 4.0, 3), cells("R/8", 8.0, 3), cells("R/16", 16.0, 3)];
const REFERENCE: &str = "independent prototype of the elastic disc, Richardson over 2 to 16 cells a radius";

pub(crate) static CASE: Case = Case {
    name: "rolling-on-block",
    title: "A disc rolls on a deformable block",
    claim: "Between two deformable bodies the disc rolls as on a rigid plane: a body behind the contact costs no accuracy.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "The elastic answer comes from a prototype of the same family of methods, not in closed form.",
    ladder: LADDER,
    default_rung: LADDER[1],
    gates,
    figures,
};

/// One slope.
#[derive(Clone, Copy)]
struct Slope {
    variant: &'static str,
    /// Displacement over the rigid one, less one, of the converged elastic disc; both references are certain to .1 %.
    excess: f64,
    /// Allowed deviation, by rung.
    allowed: [f64; 3],
}

const SLOPES: [Slope; 2] = [
    Slope { variant: "60deg-mu.9", excess: 0.0065, allowed: [0.04, 0.015, 0.005] },
    Slope { variant: "30deg-mu.5", excess: -0.003, allowed: [0.05, 0.02, 0.005] },
];
const UNCERTAINTY: f64 = 0.001;

/// Displacement over (1/3) g t² sin θ, less one.
fn excess(done: &Done) -> Result<f64, Missing> {
    let (time, x) = (&done.series().time, done.column("grain.x")?);
    let end = x.len() - 1;
    Ok(3.0 * (x[end] - x[0]) / (done.scene.gravity.x * time[end] * time[end]) - 1.0)
}

fn gates() -> Vec<Gate> {
    let mut gates = Vec::new();
    for slope in SLOPES {
        for (rung, allowed) in LADDER.iter().zip(slope.allowed) {
            let run = Run::new(slope.variant, "mpm", rung.resolution);
            gates.push(Gate::new(
                (format!("displacement over the rigid one, less 1, {}", rung.name), "1"),
                vec![if *rung == LADDER[2] { run.long() } else { run }],
                (Evidence::OtherCode, REFERENCE),
                (allowed + UNCERTAINTY, "discretisation at this resolution, and the reference's own uncertainty"),
                Control::solver("nodal contact that acts at a distance (2000)", "mpm:2000"),
                move |done| Ok(Measured::new(excess(&done[0])?, slope.excess, 1.0)),
            ));
        }
        gates.push(Gate::new(
            ("displacement over the rigid one, less 1", "1"),
            vec![Run::new(slope.variant, "mpm:2000", LADDER[1].resolution).known(
                "nodal contact holds the disc up over a patch of about √(2Rh), as if it had a flat side: it rolls too little",
            )],
            (Evidence::OtherCode, REFERENCE),
            (slope.allowed[1] + UNCERTAINTY, "what a contact that acts at the surface reaches at this resolution"),
            Control::without_the_error("springs at the surface", "mpm", LADDER[1].resolution),
            move |done| Ok(Measured::new(excess(&done[0])?, slope.excess, 1.0)),
        ));
    }
    gates
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for slope in SLOPES {
        for (solver, stroke) in [("mpm", Stroke::MarkedLine), ("mpm:gap", Stroke::MarkedLine), ("mpm:2000", Stroke::Dashed)] {
            let mut points = Vec::new();
            for (cells, rung) in [4.0, 8.0].into_iter().zip(LADDER) {
                if let Ok(excess) = excess(&bench.run(&Run::new(slope.variant, solver, rung.resolution))?) {
                    points.push((cells, (excess - slope.excess).abs()));
                }
            }
            curves.push(Curve::new(format!("{} {solver}", slope.variant), stroke, points));
        }
    }
    Ok(vec![Figure::graph(
        "deviation",
        "Deviation from the converged elastic disc",
        "The same contacts as against a rigid plane, between two deformable bodies.",
        [Axis::log("cells a radius"), Axis::log("|x − x_elastic| / x_rigid")],
        curves,
    )])
}
