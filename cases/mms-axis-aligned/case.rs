//! Order of convergence for a manufactured solution along an axis.

use crate::exact::manufactured::{error, order};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("1/16", 16.0, 2), cells("1/32", 32.0, 2), cells("1/64", 64.0, 2)];
const CELLS: [f64; 3] = [16.0, 32.0, 64.0];
const GIMP: &str = "mpm+gimp+flip";
const SPLINES: &str = "mpm+flip";
const HATS: &str = "mpm+linear+flip";
/// Points per cell and axis for B-splines. The sum over moving points is a quadrature whose error does not decrease
/// with the cell length. With fewer points this error dominates (order 1.3 with four, 1.8 with six).
const POINTS_OF_SPLINES: u32 = 10;
/// Points per cell and axis for uGIMP, enough for a small quadrature error.
const POINTS_OF_GIMP: u32 = 4;
/// Courant number at which the error of the time step is below the error of the cell length. With 0.4, the order of
/// B-splines falls to 1.7 between 32 and 128 cells. The order of uGIMP is 1.98 to 2.00 with 0.4 and with 0.1.
const SMALL_STEP: f64 = 0.1;
const SOURCE: Source = Source::Derived("manufactured solution (derivation)");

pub(crate) static CASE: Case = crate::heads::MMS_AXIS_ALIGNED.with(LEVELS, 1, &claims).drawn_by(figures);

fn runs(solver: &'static str, points: u32) -> Vec<Run> {
    CELLS.map(|cells| Run::new(PLAIN, solver, Resolution::grid(cells, points))).to_vec()
}

/// Returns runs with time steps so small that the error of the cell length dominates.
fn in_small_steps(solver: &'static str, points: u32) -> Vec<Run> {
    let resolution = |cells| Resolution::Grid { cells, points, courant: SMALL_STEP };
    CELLS.map(|cells| Run::new(PLAIN, solver, resolution(cells))).to_vec()
}

fn claims() -> Vec<Claim> {
    // Wrong moduli would have no effect, because the body force is computed from them and the motion is unchanged.
    let wrong = || Control::scene("a damping of .3 per second", |scene| scene.global_damping = 0.3);
    let second = |quantity, runs: Vec<Run>| {
        claim(quantity, "1")
            .runs(runs)
            .converges(2.0, SOURCE, |done| order(done, &CELLS))
            .within(asymptotic(2.0))
            .refuses(wrong())
    };
    vec![
        second("order in the cell, uGIMP", in_small_steps(GIMP, POINTS_OF_GIMP).into_iter().map(Run::slow).collect()),
        second(
            "order in the cell, quadratic B-splines",
            in_small_steps(SPLINES, POINTS_OF_SPLINES).into_iter().map(Run::long).collect(),
        ),
        claim("order in the cell, hat functions", "1")
            .runs(runs(HATS, 2))
            .converges_at_most(
                0.5,
                Source::Derived("a point that crosses a cell boundary meets a jump of the gradient (derivation)"),
                |done| order(done, &CELLS),
            )
            .within(exactly("less than half an order, or the error grows"))
            .refuses(Control::solver("uGIMP in their place", GIMP)),
        claim("root mean square error of the displacement, 64 cells, uGIMP", "m")
            .run(Run::new(PLAIN, GIMP, LEVELS[2].resolution))
            .equals(SOURCE, |done| Ok(Measurement::new(error(&done[0])?, 0.0, 0.05)))
            .within(estimated(2e-3, "discretisation; in units of the amplitude"))
            .refuses(wrong()),
    ]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for (label, solver, points) in
        [("uGIMP", GIMP, 2), ("quadratic B-splines", SPLINES, POINTS_OF_SPLINES), ("hat functions", HATS, 2)]
    {
        let mut measured = Vec::new();
        let coarse = Run::new(PLAIN, solver, Resolution::grid(8.0, points));
        let finer = runs(solver, points).into_iter();
        // The splines have many points, so their finest run takes a second.
        let levels = if solver == SPLINES && !runner.is_thorough() { 2 } else { 3 };
        for (run, cells) in std::iter::once(coarse).chain(finer).zip([8.0, 16.0, 32.0]).take(levels) {
            if let Ok(error) = error(&runner.run(&run)?) {
                measured.push((1.0 / cells, error));
            }
        }
        curves.push(Curve::new(label, Stroke::MarkedLine, measured));
    }
    curves.push(Curve::new("slope 2", Stroke::Dashed, vec![(1.0 / 32.0, 4e-5), (1.0 / 8.0, 64e-5)]));
    Ok(vec![Figure::graph(
        "convergence",
        "Error of the displacement over the cell length",
        "Root mean square error over the material points at t = 0.5 s, with three shape functions.",
        [Axis::log("cell length h (m)"), Axis::log("rms error (m)")],
        curves,
    )])
}
