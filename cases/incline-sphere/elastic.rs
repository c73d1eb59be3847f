//! Elastic sphere that is set down on a rigid plane and released, computed with the material point method.
//!
//! As for the disc, elasticity changes the rigid solution. The sphere flattens, its centre is lower, and it deforms
//! before it slips. The expected values are those of an independent prototype (quadratic B-splines, APIC, springs at
//! the surface), extrapolated from cells of R/2, R/4 and R/8.

use crate::exact::one_grain::last;
use crate::rows::elastic::{Rest, excess, excess_claim, settle};
use crate::sources::literature::bardenhagen_2001;
use crate::sources::prototype::elastic_sphere;
use grainbench_harness::prelude::*;

/// One slope with the expected values of the elastic sphere on it.
#[derive(Clone, Copy)]
struct Elastic {
    variant: &'static str,
    /// Displacement after one second, divided by the displacement of a rigid sphere, minus one.
    reference: CitedNumber,
    /// Largest deviations from the reference at cells of R/4 and R/8, required before the solver existed.
    allowed: [f64; 2],
}

const SLOPES: [Elastic; 2] = [
    Elastic { variant: "45deg-mu.495", reference: elastic_sphere::ROLLS_45, allowed: [0.03, 0.01] },
    Elastic { variant: "60deg-mu2_7", reference: elastic_sphere::SLIPS_60, allowed: [0.005, 0.003] },
];
const REST: Rest = Rest { duration: 0.6, damping: 20.0 };
/// Points per cell and axis: 8 points a cell, as in the paper.
const POINTS: u32 = 2;

fn run(slope: Elastic, solver: &'static str, cells: f64) -> Run {
    Run::new(slope.variant, solver, Resolution::grid(cells, POINTS))
        .adjusted("elastic and settled", |scene| settle(scene, REST, 1.0))
}

pub(super) fn claims() -> Vec<Claim> {
    const ASKED: &str = "required at this resolution before the solver existed, and the uncertainty of the reference";
    let against_reference = |slope: Elastic, cells: f64, allowed: f64| {
        let run = run(slope, "mpm", cells);
        // The run with cells of R/8 takes half a minute.
        let run = match (cells > 4.0, slope.variant == SLOPES[0].variant) {
            (true, _) => run.long(),
            (false, true) => run,
            (false, false) => run.slow(),
        };
        let quantity = format!("displacement at 1 s over the rigid one, less 1, R/{cells}");
        let control = Control::contact_law("a tenth of the friction", |law| law.friction *= 0.1);
        excess_claim(quantity, run, slope.reference, required(allowed + slope.reference.uncertainty, ASKED))
            .refuses(control.coarser(Resolution::grid(2.0, POINTS)))
    };
    let of_slope = |slope: Elastic| {
        [against_reference(slope, 4.0, slope.allowed[0]), against_reference(slope, 8.0, slope.allowed[1])]
    };
    let rolls = SLOPES[0];
    let nodal = [
        claim("ΩR/v at 1 s, where a rigid sphere has 1, R/2", "1")
            .run(run(rolls, "mpm:2000", 2.0))
            .equals_cited(bardenhagen_2001::ROLLING_AT_HALF_RADIUS, 1.0, |done| {
                let (_, state) = last(&done[0])?;
                Ok(state.omega * done[0].scene.grains[0].radius / state.v)
            })
            .within(judged(0.02, "the sphere rotates at most by the rocking of its flat side"))
            .refuses(Control::solver("springs at the surface", "mpm")),
        claim("displacement at 1 s over the rigid one, less 1, against the elastic sphere, R/4", "1")
            .run(run(rolls, "mpm:2000", 4.0).known(
                "nodal contact supports the sphere over a region of about √(2Rh), like a flat side: it rolls 25 % too slowly",
            )
            .up_to(0.5))
            .equals_cited(rolls.reference, 1.0, |done| excess(&done[0]))
            .within(required(rolls.allowed[0] + rolls.reference.uncertainty, ASKED))
            .refuses(Control::without_the_error("springs at the surface", "mpm", Resolution::grid(4.0, POINTS))),
    ];
    SLOPES.into_iter().flat_map(of_slope).chain(nodal).collect()
}

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for slope in SLOPES {
        for solver in ["mpm", "mpm:2000"] {
            let mut points = Vec::new();
            // Claims use the finest runs of the first slope, so its figure needs no additional run.
            let levels = if runner.is_thorough() || slope.variant == SLOPES[0].variant { 3 } else { 2 };
            for cells in [1.0, 2.0, 4.0].into_iter().take(levels) {
                if let Ok(excess) = excess(&runner.run(&run(slope, solver, cells))?) {
                    points.push((cells, excess));
                }
            }
            let label = format!("{}, {solver}", crate::rows::label(slope.variant));
            curves.push(Curve::new(label, Stroke::MarkedLine, points));
        }
    }
    Ok(Figure::graph(
        "elastic",
        "An elastic sphere on a rigid plane: deviation from a rigid sphere",
        "The sphere starts in static equilibrium. The converged deviation is −0.2 % if it rolls and +1.4 % if it \
         slips. `mpm` has springs at the surfaces. The contact of the 2000 paper (`mpm:2000`) acts at nodes before \
         the surfaces meet.",
        [Axis::log("cells per radius"), Axis::linear("x / x_rigid − 1 at 1 s")],
        curves,
    ))
}
