//! A disc rolls down a deformable block. The case tests friction between two deformable bodies.

use crate::sources::prototype::elastic_disc;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("R/4", 4.0, 3), cells("R/8", 8.0, 3), cells("R/16", 16.0, 3)];

pub(crate) static CASE: Case = crate::heads::ROLLING_ON_BLOCK.with(LEVELS, 1, &claims).drawn_by(figures);

/// One slope with its reference.
#[derive(Clone, Copy)]
struct Slope {
    variant: &'static str,
    /// Displacement of the converged elastic disc on a rigid plane over the rigid disc's displacement, minus one.
    reference: CitedNumber,
    /// Largest deviations at each level, required before the solver existed.
    allowed: [f64; 3],
}

const SLOPES: [Slope; 2] = [
    Slope { variant: "60deg-mu.9", reference: elastic_disc::ROLLS_60_MU_9, allowed: [0.04, 0.015, 0.005] },
    Slope { variant: "30deg-mu.5", reference: elastic_disc::ROLLS_30_MU_5, allowed: [0.05, 0.02, 0.005] },
];

/// Returns the displacement divided by (1/3) g t² sin θ, minus one.
fn excess(done: &FinishedRun) -> Result<f64, MissingData> {
    let (time, x) = (&done.series().time, done.column("grain.x")?);
    let end = x.len() - 1;
    Ok(3.0 * (x[end] - x[0]) / (done.scene.gravity.x * time[end] * time[end]) - 1.0)
}

fn claims() -> Vec<Claim> {
    const ASKED: &str = "required at this resolution before the solver existed, and the uncertainty of the reference";
    let against_reference = |slope: Slope, level: Level, allowed: f64| {
        let run = Run::new(slope.variant, "mpm", level.resolution);
        claim(format!("displacement over the rigid one, less 1, {}", level.name), "1")
            .run(if level == LEVELS[2] { run.long() } else { run })
            .equals_cited(slope.reference, 1.0, |done| excess(&done[0]))
            .within(required(allowed + slope.reference.uncertainty, ASKED))
            .refuses(Control::solver("nodal contact that acts at a distance (2000)", "mpm:2000"))
    };
    let nodal = |slope: Slope| {
        claim("displacement over the rigid one, less 1", "1")
            .run(Run::new(slope.variant, "mpm:2000", LEVELS[1].resolution).known(
                "nodal contact supports the disc over a region of about √(2Rh), like a flat side: it rolls too little",
            )
            // The relative error is −1 if the disc does not move.
            .up_to(1.0))
            .equals_cited(slope.reference, 1.0, |done| excess(&done[0]))
            .within(required(slope.allowed[1] + slope.reference.uncertainty, ASKED))
            .refuses(Control::without_the_error("springs at the surface", "mpm", LEVELS[1].resolution))
    };
    let of_slope = |slope: Slope| {
        let [coarse, middle, fine] = [0, 1, 2].map(|at| against_reference(slope, LEVELS[at], slope.allowed[at]));
        [coarse, middle, fine, nodal(slope)]
    };
    SLOPES.into_iter().flat_map(of_slope).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for slope in SLOPES {
        for solver in ["mpm", "mpm:gap", "mpm:2000"] {
            let mut points = Vec::new();
            // Claims use the finest runs of `mpm` and `mpm:2000`, so these need no additional run.
            let levels = if solver == "mpm:gap" && !runner.is_thorough() { 2 } else { 3 };
            for cells in [2.0, 4.0, 8.0].into_iter().take(levels) {
                let done = runner.run(&Run::new(slope.variant, solver, Resolution::grid(cells, 3)));
                if let Some(excess) = done.ok().and_then(|done| excess(&done).ok()) {
                    points.push((cells, (excess - slope.reference.value).abs()));
                }
            }
            let label = format!("{}, {solver}", crate::rows::label(slope.variant));
            curves.push(Curve::new(label, Stroke::MarkedLine, points));
        }
    }
    Ok(vec![Figure::graph(
        "deviation",
        "Deviation from the converged elastic disc",
        "Error of the displacement over the resolution. The contacts are those of a disc on a rigid plane, here \
         between two deformable bodies.",
        [Axis::log("cells per radius"), Axis::log("|x − x_elastic| / x_rigid")],
        curves,
    )])
}
