//! A sphere rolls and slips down a deformable plane. The case tests contact between deformable bodies in three
//! dimensions.

use crate::exact::one_grain::OneGrain;
use crate::rows::elastic::excess_claim;
use crate::rows::elastic_backspin::{excess, sphere};
use crate::sources::prototype::{elastic_sphere, nodal_contact_2000, nodal_contact_2001};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("R/2", 2.0, 2), cells("R/4", 4.0, 2), cells("R/8", 8.0, 2)];
/// Largest relative error of nodal contact: the displacement has the error −1 if the sphere does not move.
const AT_REST: f64 = 1.0;

const FLAT: &str = "nodal contact acts before surfaces touch and supports the sphere over a width of about √(2Rh), along each \
                    body's own normal";

pub(crate) static CASE: Case = crate::heads::SPHERE_ON_BLOCK.with(LEVELS, 1, &claims).drawn_by(figures);

/// One slope with its references.
#[derive(Clone, Copy)]
struct Slope {
    variant: &'static str,
    /// Displacement after 1 s of the converged elastic sphere on a rigid plane over the rigid sphere's, minus one.
    reference: CitedNumber,
    /// Largest deviations at cells of R/4 and R/8.
    allowed: [f64; 2],
    /// Results at R/4 with the contacts of Bardenhagen et al. (2000, 2001), for a sphere that starts in contact.
    papers: [(&'static str, CitedNumber); 2],
}

const SLOPES: [Slope; 2] = [
    Slope {
        variant: "45deg-mu.495",
        reference: elastic_sphere::ROLLS_45,
        allowed: [0.035, 0.01],
        papers: [("mpm:2000", nodal_contact_2000::SPHERE_ROLLS_45), ("mpm:2001", nodal_contact_2001::SPHERE_ROLLS_45)],
    },
    Slope {
        variant: "60deg-mu2_7",
        reference: elastic_sphere::SLIPS_60,
        allowed: [0.01, 0.005],
        papers: [("mpm:2000", nodal_contact_2000::SPHERE_SLIPS_60), ("mpm:2001", nodal_contact_2001::SPHERE_SLIPS_60)],
    },
];

/// Returns the run without relaxation. As in Bardenhagen et al. (2001), the sphere starts in contact and is released.
fn set_down(variant: &'static str, solver: &'static str) -> Run {
    Run::new(variant, solver, LEVELS[1].resolution).adjusted("set down", |scene| scene.start.settle = None)
}

/// Sets the tier of a run: standard if `quick`, otherwise long.
fn in_set(run: Run, quick: bool) -> Run {
    if quick { run.slow() } else { run.long() }
}

fn claims() -> Vec<Claim> {
    SLOPES.into_iter().flat_map(of_slope).chain(backspin()).collect()
}

fn of_slope(slope: Slope) -> Vec<Claim> {
    let rolls = slope.variant == SLOPES[0].variant;
    let against_reference = LEVELS[1..].iter().zip(slope.allowed).map(|(level, allowed)| {
        let run = Run::new(slope.variant, "mpm", level.resolution);
        let allowed = judged(
            allowed + slope.reference.uncertainty,
            "discretisation at this resolution, deformation of the plane, and the uncertainty of the reference",
        );
        let quantity = format!("displacement at 1 s over the rigid one, less 1, {}", level.name);
        excess_claim(quantity, in_set(run, rolls && *level == LEVELS[1]), slope.reference, allowed)
            .refuses(Control::contact_law("half the friction", |law| law.friction *= 0.5))
    });
    let nodal = slope.papers.into_iter().flat_map(|(solver, cited)| {
        let settled = Run::new(slope.variant, solver, LEVELS[1].resolution).known(FLAT).up_to(AT_REST);
        let touching = in_set(set_down(slope.variant, solver), rolls && solver == "mpm:2000");
        let two_programs =
            judged(0.07, "two implementations of one method at the same resolution, with different material points");
        let at_surface = judged(
            slope.allowed[0] + slope.reference.uncertainty,
            "accuracy of a contact that acts at the surface, at this resolution",
        );
        let quantity = |words: &str| format!("displacement at 1 s over the rigid one, less 1, {words}, R/4");
        [
            excess_claim(quantity("touching at the start"), touching, cited, two_programs)
                .refuses(Control::solver("springs at the surface", "mpm")),
            excess_claim(quantity("against the elastic sphere"), settled.long(), slope.reference, at_surface)
                .refuses(Control::without_the_error("springs at the surface", "mpm", LEVELS[1].resolution)),
        ]
    });
    against_reference.chain(nodal).collect()
}

/// Returns the claims on a sphere with backspin: it slides, loses its spin, and rolls.
fn backspin() -> Vec<Claim> {
    // Largest relative errors of the displacement at cells of R/4 and R/8, required before the solver existed.
    let against_reference = LEVELS[1..]
        .iter()
        .zip([0.03, 0.01])
        .flat_map(|(level, asked)| sphere(level.name, asked, Run::new("backspin", "mpm", level.resolution).long()));
    let nodal = ["mpm:2000", "mpm:2001"].map(|solver| {
        claim("displacement at .8 s over the rigid one, less 1, touching at the start, R/4", "1")
            .run(set_down("backspin", solver).long().known(FLAT).up_to(AT_REST))
            .equals(Source::Derived("a rigid sphere slides, then rolls (derivation of backspin)"), |done| {
                Ok(Measurement::new(excess(&done[0])?, 0.0, 1.0))
            })
            .within(judged(0.035, "accuracy of a contact that acts at the surface, at this resolution"))
            .refuses(Control::without_the_error("springs at the surface", "mpm", LEVELS[1].resolution))
    });
    against_reference.chain(nodal).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for solver in ["mpm", "mpm:2000"] {
        let done = runner.run(&Run::new(SLOPES[0].variant, solver, LEVELS[0].resolution))?;
        let rigid = OneGrain::from_scene(&done.scene);
        let x = samples(&done, "grain.x").unwrap_or_default().into_iter();
        let points = x.map(|(t, x)| (t, x - rigid.rigid_incline(t).x)).collect();
        curves.push(Curve::new(solver, Stroke::Line, points));
    }
    Ok(vec![Figure::graph(
        "way",
        "A sphere on a deformable plane at 45°: displacement minus that of a rigid sphere",
        "At two cells per radius, `mpm` is slow by a few per cent. With the contact of the 2000 paper (`mpm:2000`), \
         the sphere hardly rolls. The final displacement is 2.5 m.",
        [Axis::linear("time t (s)"), Axis::linear("x − x_rigid (m)")],
        curves,
    )])
}
