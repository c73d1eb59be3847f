//! Backspin of an elastic grain, computed with the material point method.
//!
//! An elastic grain rolls on a flattened side. Its centre is lower, and it becomes a few per cent faster than a rigid
//! grain. For the sphere, an independent prototype gives the displacement. For the disc there is no reference, but its
//! motion approaches the rigid solution if its moduli are ten or a hundred times larger. The speed is averaged from 0.5
//! s on, because the contact vibrates freely without damping.

use crate::exact::one_grain::course;
use crate::rows::elastic::{PressedDisc, Rest, settle, stiffen};
use crate::rows::elastic_backspin::{excess, rolling, slippery, sphere};
use grainbench_harness::prelude::*;

const SPHERE: Rest = Rest { duration: 0.6, damping: 20.0 };
const DISC: Rest = Rest { duration: 0.3, damping: 100.0 };
const TIME: f64 = 0.8;

const RIGID: Source = Source::Derived("a rigid disc slides, then rolls with Rω₀/3 (derivation)");

fn run(variant: &'static str, solver: &'static str, cells: f64) -> Run {
    stiffened(variant, solver, cells, 1.0)
}

fn stiffened(variant: &'static str, solver: &'static str, cells: f64, factor: f64) -> Run {
    let (rest, points) = if variant == "sphere" { (SPHERE, 2) } else { (DISC, 3) };
    let name = format!("elastic and settled, moduli × {factor}");
    Run::new(variant, solver, Resolution::grid(cells, points)).adjusted(&name, move |scene| {
        settle(scene, rest, TIME);
        stiffen(scene, factor);
    })
}

/// Returns the flattening of the disc at rest: the decrease of the height of its centre, divided by R. The load is the
/// weight W of the disc (N per metre). The flattening includes the compression of the springs at the surface, which
/// depends on the number of cells per radius (`cells`). K = 10 MPa and G = 2.5 MPa, so ν = 5/13; 3000 kg/m³ and R = 0.5
/// m. [`PressedDisc::gives`] returns the displacement u for a small increase of the load F. Since u is a constant less
/// ln F, its integral from 0 to W is W (u + 1)/(πE').
fn flattened(cells: f64) -> f64 {
    let radius = 0.5;
    let rock = Deformable { bulk_modulus: 10e6, shear_modulus: 2.5e6, constitutive: Constitutive::NeoHookean };
    let modulus = rock.plane_modulus();
    let disc = PressedDisc { modulus, poisson: 5.0 / 13.0, radius, sides: 2 };
    let weight = 3000.0 * 9.8 * PI * radius * radius;
    let springs = weight / (2.0 * disc.patch(weight) * radius) / (2.6 * modulus * cells);
    weight * (disc.gives(weight).u + 1.0) / (PI * modulus * radius) + springs
}

pub(super) fn claims() -> Vec<Claim> {
    let mut claims = Vec::new();
    // Cells per radius, and the largest relative error of the displacement that was required before the solver existed.
    for (cells, asked) in [(4.0, 0.03), (8.0, 0.01)] {
        // The run with 8 cells per radius takes a minute.
        let run = run("sphere", "mpm", cells);
        claims.extend(sphere(&format!("R/{cells}"), asked, if cells > 4.0 { run.long() } else { run.slow() }));
    }
    claims.extend(stiff_discs());
    claims.extend([
        claim("mean ΩR over mean v of rolling, R/8", "1")
            .run(run("disc", "mpm", 8.0))
            .equals(Source::Derived("rolling without slip"), |done| {
                let (v, surface) = rolling(&done[0])?;
                Ok(Measurement::relative(surface / v, 1.0))
            })
            .within(computed(
                flattened(8.0),
                "the rolling radius is smaller by at most the flattening of the disc, W (u + 1)/(πE') with u = 2 \
                 ln(2R/a) − 5/4 − n/4, plus the compression of springs of 2.6 E'/h per area under the mean pressure \
                 W/2a; relative to R",
            ))
            .refuses(
                Control::solver("nodal contact that acts at a distance (2000)", "mpm:2000")
                    .coarser(Resolution::grid(4.0, 3)),
            ),
        beside_rigid(
            run("disc", "mpm", 16.0).slow().known(
                "a disc that slides fast on springs becomes noisy at twelve and more cells per radius: its centre rises from \
                 0.494 to 0.504 m, and its displacement is too small. A disc that rotates without contact has no noise",
            ).up_to(0.5),
            "R/16",
            judged(0.02, "elasticity; it amounts to .015 for the sphere of the prototype"),
            Control::without_the_error("nodal contact of surfaces that met", "mpm:gap", Resolution::grid(16.0, 3)),
        ),
        beside_rigid(
            run("disc", "mpm:2000", 4.0).known(
                "nodal contact supports the disc over a region of about √(2Rh): as the disc rotates, it presses new material \
                 into the region, and normal force and friction are several times those of the weight",
            ).up_to(0.2),
            "R/4",
            judged(0.05, "accuracy of a contact that acts at the surface, at this resolution"),
            Control::without_the_error("springs at the surface", "mpm", Resolution::grid(4.0, 3)),
        ),
    ]);
    claims
}

fn beside_rigid(run: Run, words: &str, allowed: Tolerance, control: Control) -> Claim {
    claim(format!("displacement at .8 s over the rigid one, less 1, {words}"), "1")
        .run(run)
        .equals(RIGID, |done| Ok(Measurement::new(excess(&done[0])?, 0.0, 1.0)))
        .within(allowed)
        .refuses(control)
}

/// Returns the claims with larger moduli. The disc is then closer to the rigid solution, which needs no reference.
fn stiff_discs() -> [Claim; 2] {
    [(10.0, 0.01), (100.0, 0.008)].map(|(factor, allowed)| {
        let run = stiffened("disc", "mpm", 8.0, factor);
        let because = "as for the stiffened discs on the slopes: the effect of elasticity decreases with the modulus or its \
                       square root; the discretisation of the contact remains";
        let run = if factor > 10.0 { run.long() } else { run.slow() };
        beside_rigid(run, &format!("moduli × {factor}, R/8"), judged(allowed, because), slippery())
    })
}

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for solver in ["mpm", "mpm:2000"] {
        let done = runner.run(&run("disc", solver, 4.0))?;
        let radius = done.scene.grains[0].radius;
        let states = course(&done).unwrap_or_default();
        curves.push(Curve::new(format!("{solver}: v"), Stroke::Line, states.iter().map(|(t, s)| (*t, s.v)).collect()));
        let surface = states.iter().map(|(t, s)| (*t, s.omega * radius)).collect();
        curves.push(Curve::new(format!("{solver}: ΩR"), Stroke::Line, surface));
    }
    Ok(Figure::graph(
        "elastic",
        "Backspin of an elastic disc, cells of R/4",
        "With `mpm` the disc slides, then rolls with small vibrations. With the contact of the 2000 paper \
         (`mpm:2000`), rotation presses new material into the contact patch. The spin drops at once, by several \
         times the friction of the weight.",
        [Axis::linear("time t (s)"), Axis::linear("velocity v, surface speed ΩR (m/s)")],
        curves,
    ))
}

#[cfg(test)]
mod tests {
    use crate::exact::one_grain::OneGrain;
    use crate::rows::elastic_backspin::ROLLS;

    #[test]
    fn both_variants_roll_by_then() {
        for variant in ["disc", "sphere"] {
            let scene = super::super::CASE.variant(variant).unwrap_or_else(|error| panic!("{error}"));
            let grain = OneGrain::from_scene(&scene);
            assert_eq!(grain.rigid_backspin(ROLLS).v, grain.rigid_backspin(1.0).v);
        }
    }
}
