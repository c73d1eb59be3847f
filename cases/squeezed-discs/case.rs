//! Nine elastic discs compressed by four walls: the stiffness of contacts.

use crate::rows::elastic::{PressedDisc, stiffen};
use crate::sources::prototype::squeezed_discs::{LEAST_NODAL_FORCE, MOST_NODAL_FORCE};
use grainbench_harness::prelude::*;
use std::collections::BTreeMap;

const LEVELS: &[Level] = &[cells("R/4", 4.0, 3), cells("R/6", 6.0, 3), cells("R/12", 12.0, 3)];
const WALLS: [&str; 4] = ["left.force_x", "right.force_x", "bottom.force_y", "top.force_y"];
/// Solvers with a grid that is shifted by zero, a quarter and half of a cell.
const PHASES: [&str; 3] = ["mpm", "mpm+phase=0.25", "mpm+phase=0.5"];
/// Solver with contact springs that are twice as stiff.
const STIFF: &str = "mpm+penalty=5.2";
const SOURCE: Source = Source::Derived(
    "Johnson, Contact Mechanics, line contact, with the expansion by the transverse pair of forces (derivation)",
);

pub(crate) static CASE: Case = crate::heads::SQUEEZED_DISCS.with(LEVELS, 1, &claims).drawn_by(figures);

/// Returns the distance by which each wall moves in (m).
fn squeeze(scene: &Scene) -> f64 {
    let phase = &scene.walls[0].motion.phases[0];
    phase.velocity.norm() * phase.stop.seconds(f64::NAN)
}

/// Returns the contact force (N per metre). Opposite walls shorten three diameters by twice the squeeze.
fn exact(scene: &Scene) -> f64 {
    PressedDisc::from_scene(scene, 4).map_or(f64::NAN, |disc| disc.force(2.0 / 3.0 * squeeze(scene)))
}

/// Returns the mean contact force at the walls (N per metre). Each wall is in contact with three discs. The mean is
/// over the last quarter of the run, because material points continue to oscillate by one per cent.
fn mean_force(done: &FinishedRun) -> Result<f64, MissingData> {
    let mut sum = 0.0;
    for wall in WALLS {
        let force = done.column(wall)?;
        let late = &force[force.len() - force.len() / 4..];
        sum += late.iter().map(|force| force.abs()).sum::<f64>() / late.len() as f64;
    }
    Ok(sum / 12.0)
}

/// Returns the number of contacts, and the largest relative deviation of a contact force from the mean. All snapshots
/// except the first are used; they are in the last quarter of the run.
fn spread(done: &FinishedRun) -> Result<(usize, f64), MissingData> {
    let late = done.record.snapshots.iter().filter(|snapshot| snapshot.time > 0.0);
    let mut forces: BTreeMap<(u32, String), f64> = BTreeMap::new();
    for contact in late.flat_map(Snapshot::told_contacts) {
        *forces.entry((contact.grain, format!("{:?}", contact.partner))).or_default() += contact.normal_force;
    }
    if forces.is_empty() {
        return Err("contacts".into());
    }
    let mean = forces.values().sum::<f64>() / forces.len() as f64;
    Ok((forces.len(), forces.values().map(|force| (force / mean - 1.0).abs()).fold(0.0, f64::max)))
}

fn phases(level: Level) -> [Run; 3] {
    PHASES.map(|solver| Run::new(PLAIN, solver, level.resolution))
}

fn claims() -> Vec<Claim> {
    let over_grid_positions = |level: Level, tolerance: Tolerance| {
        claim(format!("contact force, mean over three positions of the grid, {}", level.name), "N/m")
            .runs(phases(level).map(|run| if level.name == "R/12" { run.long() } else { run.slow() }))
            .equals(SOURCE, |done| {
                let forces = done.iter().map(mean_force).collect::<Result<Vec<f64>, _>>()?;
                Ok(Measurement::relative(mean(&forces), exact(&done[0].scene)))
            })
            .within(tolerance)
            .refuses(Control::scene("a tenth softer", |scene| stiffen(scene, 0.9)))
    };
    let soft = "springs are as soft as .4 cells of material, and the contact area is half a cell wide";
    vec![
        claim("largest deviation of the 24 contact forces from their mean", "1")
            .run(Run::new(PLAIN, "mpm", LEVELS[1].resolution).slow())
            .holds("equilibrium and symmetry: all forces are equal (derivation)", |done| match spread(&done[0])? {
                (24, spread) => Ok(Measurement::new(spread, 0.0, 1.0)),
                (count, _) => Err(MissingData(format!("24 contacts, but {count}"))),
            })
            .within(required(5e-3, "remaining vibration, and tracers that represent the surfaces"))
            .refuses(Control::scene("the left wall moves in twice as far", |scene| {
                scene.walls[0].motion.phases[0].velocity *= 2.0;
            })),
        over_grid_positions(LEVELS[1], required(0.1, soft)),
        over_grid_positions(LEVELS[2], judged(0.08, "springs alone reduce the force by 9.1 % (derivation)")),
        claim("contact force over the exact one, R/6", "1")
            .run(Run::new(PLAIN, "mpm:gap", LEVELS[1].resolution).slow())
            .between([LEAST_NODAL_FORCE.value, MOST_NODAL_FORCE.value], MOST_NODAL_FORCE.source(), |done| {
                Ok(mean_force(&done[0])? / exact(&done[0].scene))
            })
            .within(exactly("the band is wide because the force depends on the position of the grid"))
            .refuses(Control::solver("springs at the surface", "mpm")),
        claim("contact force, R/4", "N/m")
            .run(Run::new(PLAIN, "mpm:gap", LEVELS[0].resolution)
                .known("a node in contact stops a whole cell of the surface at once: contacts are about twice as stiff as they \
                        should be")
                .up_to(2.0))
            .equals(SOURCE, |done| {
                Ok(Measurement::relative(mean_force(&done[0])?, exact(&done[0].scene)))
            })
            .within(judged(0.2, "accuracy of springs at the surface for any position of the grid"))
            .refuses(Control::without_the_error("springs at the surface", "mpm", LEVELS[0].resolution)),
    ]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    let solvers = ["mpm", "mpm:gap", STIFF];
    for &solver in if runner.is_thorough() { &solvers[..] } else { &solvers[..2] } {
        let mut points = Vec::new();
        for cells in [2.0, 3.0, 4.0] {
            let done = runner.run(&Run::new(PLAIN, solver, Resolution::grid(cells, 3)))?;
            points.extend(mean_force(&done).ok().map(|force| (cells, force / exact(&done.scene))));
        }
        curves.push(Curve::new(solver, Stroke::MarkedLine, points));
    }
    curves.push(Curve::new("exact", Stroke::Dashed, vec![(2.0, 1.0), (4.0, 1.0)]));
    Ok(vec![Figure::graph(
        "force",
        "Contact force over the exact force",
        "Nodal contact (`mpm:gap`) stops whole cells, so it is too stiff. Springs at the surface (`mpm`) are as soft \
         as 0.4 cells of material.",
        [Axis::linear("cells per radius"), Axis::linear("force / exact force")],
        curves,
    )])
}
