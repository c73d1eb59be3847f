//! Manufactured vortex with large rotation and shear.

use crate::exact::manufactured::{error, order};
use grainbench_harness::prelude::*;

const CELLS: [f64; 4] = [16.0, 32.0, 64.0, 128.0];
const LEVELS: &[Level] =
    &[level("1/16", CELLS[0]), level("1/32", CELLS[1]), level("1/64", CELLS[2]), level("1/128", CELLS[3])];
const SOLVERS: [(&str, &str); 3] = [
    ("quadratic B-splines, FLIP with spin", "mpm"),
    ("uGIMP, FLIP", "mpm+gimp+flip"),
    ("hat functions, FLIP", "mpm+linear+flip"),
];
const KEEPS_NO_NOISE: &str = "mpm+apic";
const SOURCE: Source = Source::Derived("manufactured solution (derivation)");

/// Returns a level with time steps so small that their error is below the error of the grid.
const fn level(name: &'static str, cells: f64) -> Level {
    Level { name, resolution: Resolution::Grid { cells, points: 3, courant: 0.1 } }
}

pub(crate) static CASE: Case = crate::heads::MMS_VORTEX.with(LEVELS, 1, &claims).drawn_by(figures);

/// Returns the run up to 0.5 s, when the rotation is largest.
fn run(solver: &'static str, level: Level) -> Run {
    Run::new(PLAIN, solver, level.resolution).adjusted("to .5 s", |scene| scene.duration = Duration::Seconds(0.5))
}

fn claims() -> Vec<Claim> {
    let damped = || Control::scene("a damping of .3 per second", |scene| scene.global_damping = 0.3);
    let off = |quantity: String, run: Run, tolerance, control| {
        claim(quantity, "m")
            .run(run)
            .equals(SOURCE, |done| Ok(Measurement::new(error(&done[0])?, 0.0, 1.0)))
            .within(tolerance)
            .refuses(control)
    };
    let converges = |quantity: &'static str, runs: Vec<Run>| {
        claim(quantity, "1")
            .runs(runs)
            .converges_at_least(1.0, SOURCE, |done| order(done, &CELLS))
            .within(exactly(
                "the force is discontinuous at the edges, where a grid method is of first order (derivation)",
            ))
            .refuses(damped())
    };
    let mut claims = Vec::new();
    for solver in ["mpm", "mpm+gimp+flip"] {
        claims.push(converges(
            "order in the cell at the largest turn, 16 to 32 cells",
            LEVELS[..2].iter().map(|&level| run(solver, level).slow()).collect(),
        ));
        for (level, allowed) in LEVELS.iter().zip([0.036, 9.5e-3]) {
            claims.push(off(
                format!("root mean square error of the displacement at the largest turn, {} cells", level.name),
                if *level == LEVELS[0] { run(solver, *level) } else { run(solver, *level).slow() },
                judged(
                    allowed,
                    "discretisation, of second order; in units of 1 m, the radius of the ring and nearly the largest \
                     displacement",
                ),
                damped(),
            ));
        }
    }
    claims.push(converges(
        "order in the cell at the largest turn, 16 to 128 cells",
        LEVELS.iter().map(|&level| run(KEEPS_NO_NOISE, level).long()).collect(),
    ));
    claims.push(off(
        "root mean square error of the displacement at the largest turn, 1/128 cells".to_owned(),
        run("mpm", LEVELS[3]).long().known(
            "with FLIP, points keep velocities that the grid does not resolve. With 128 cells these velocities grow \
             until the largest rotation, and points have an error of eight cells. A transfer that removes these \
             velocities converges",
        ).up_to(0.1),
        judged(0.036 / 8.0, "an eighth of the tolerance with 16 cells: at least first order in the cell"),
        Control::without_the_error("APIC", KEEPS_NO_NOISE, LEVELS[3].resolution),
    ));
    let back = |run, tolerance, control| {
        let quantity = "root mean square error of the displacement when all is back, t = 1 s, 1/32 cells";
        off(quantity.to_owned(), run, tolerance, control)
    };
    let full = |solver| Run::new(PLAIN, solver, LEVELS[1].resolution).slow();
    claims.push(back(full(KEEPS_NO_NOISE), judged(7e-3, "discretisation; in units of 1 m"), damped()));
    claims.push(back(
        full("mpm"),
        judged(1.2e-2, "discretisation, and velocities of the points that the grid does not resolve; in units of 1 m"),
        damped(),
    ));
    claims
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for (label, solver) in SOLVERS {
        let mut measured = Vec::new();
        for level in [level("1/4", 4.0), level("1/8", 8.0), LEVELS[0]] {
            let run = run(solver, level);
            if let (Resolution::Grid { cells, .. }, Ok(done)) = (level.resolution, runner.run(&run)) {
                measured.extend(error(&done).ok().map(|error| (1.0 / cells, error)));
            }
        }
        curves.push(Curve::new(label, Stroke::MarkedLine, measured));
    }
    curves.push(Curve::new("slope 2", Stroke::Dashed, vec![(1.0 / 16.0, 5e-3), (1.0 / 4.0, 8e-2)]));
    Ok(vec![Figure::graph(
        "convergence",
        "Error of the displacement over the cell length",
        "Root mean square error over the material points at t = 0.5 s, when the rotation is largest, with three shape \
         functions.",
        [Axis::log("cell length h (m)"), Axis::log("rms error (m)")],
        curves,
    )])
}
