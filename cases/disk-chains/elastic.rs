//! Arrival of stress in elastic discs.
//!
//! Stress counts as arrived when the difference of the principal stresses at a disc's centre, which fringes show, first
//! exceeds a tenth of ρcv. Times are in transits of a disc, d/c. Arrivals depend on the contact stiffness at first
//! contact. Our contacts are compared with finite elements (derivation). The nodal contact of the papers is compared
//! with a prototype of the same method.

use super::{FASTER, SOONER, WAVE_SPEED, fringes};
use crate::rows::elastic::stiffen;
use crate::sources::literature::bardenhagen_2001::FRINGES_SLOWER;
use crate::sources::prototype::disk_chains::ARRIVAL_IN_DISC_4;
use crate::sources::prototype::disk_chains_nodal_contact::ARRIVAL_AT_40;
use grainbench_harness::prelude::*;
use grainbench_scene::scene::{BodyName, Spot};

const BEST: &str = "mpm";
const STIFF: &str = "mpm+penalty=5.2";
const PAPER: &str = "mpm:2001";
/// Fraction of ρcv that counts as arrival.
const ARRIVED: f64 = 0.1;
/// The paper's second Poisson's ratio, at the same longitudinal modulus.
const NEARLY_INCOMPRESSIBLE: f64 = 0.48;

/// Returns a resolution with `cells` cells per radius. The time step is smaller than usual because of the striker.
pub(super) const fn grid(cells: f64, points: u32) -> Resolution {
    Resolution::Grid { cells, points, courant: 0.3 }
}

/// Returns a run with a probe at the centre of each disc, over a number of transits.
pub(super) fn run(variant: &'static str, solver: &'static str, resolution: Resolution, transits: f64) -> Run {
    Run::new(variant, solver, resolution).adjusted(&format!("elastic, {transits} transits"), move |scene| {
        watch(scene, transits);
        scene.snapshot_times = fringes::times(scene, variant);
        scene.snapshot_times.retain(|&time| time <= transits * 2.0 * scene.grains[0].radius / WAVE_SPEED);
    })
}

fn watch(scene: &mut Scene, transits: f64) {
    let diameter = 2.0 * scene.grains[0].radius;
    scene.duration = Duration::Seconds(transits * diameter / WAVE_SPEED);
    for (place, grain) in scene.grains.iter().enumerate() {
        let target = ProbeTarget::Point(scene.spots.len());
        scene.spots.push(Spot { body: BodyName::Grain(place), at: grain.position });
        scene.probes.push(Probe { name: format!("centre-{}", number(scene, place)), target });
    }
}

/// Returns the number of a disc, counted from the striker. The scene lists discs of odd number first.
fn number(scene: &Scene, place: usize) -> usize {
    let odd = scene.grains.len().div_ceil(2);
    if place < odd { 2 * place + 1 } else { 2 * (place - odd) + 2 }
}

/// Sets another Poisson's ratio at the same longitudinal modulus M: G = M (1 − 2ν)/(2 (1 − ν)), K = M − 4G/3.
fn set_poisson_ratio(scene: &mut Scene, poisson: f64) {
    for material in scene.deformable.iter_mut().flatten() {
        let modulus = material.longitudinal_modulus();
        material.shear_modulus = modulus * (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
        material.bulk_modulus = modulus - 4.0 / 3.0 * material.shear_modulus;
    }
}

/// Returns the run of the line with ν = 0.48, for which waves in discs are slower.
fn slower(solver: &'static str, resolution: Resolution) -> Run {
    Run::new("line", solver, resolution).adjusted("elastic, ν = .48", |scene| {
        watch(scene, 21.0);
        set_poisson_ratio(scene, NEARLY_INCOMPRESSIBLE);
    })
}

/// Returns the difference of the principal stresses at the centre of a disc (Pa), as a function of the sample.
pub(super) fn principal_difference(done: &FinishedRun, disc: usize) -> Result<impl Fn(usize) -> f64, MissingData> {
    let column = |part: &str| done.column(&format!("centre-{disc}.sigma_{part}"));
    let (xx, yy, xy) = (column("xx")?, column("yy")?, column("xy")?);
    Ok(move |at: usize| f64::hypot(xx[at] - yy[at], 2.0 * xy[at]))
}

/// Returns the arrival time of stress at the centre of a disc (d/c).
fn arrival(done: &FinishedRun, disc: usize) -> Result<f64, MissingData> {
    let scene = &done.scene;
    let difference = principal_difference(done, disc)?;
    let volume = PI * scene.grains[0].radius.powi(2);
    let speed = scene.walls[0].motion.phases[0].velocity.norm();
    let threshold = ARRIVED * scene.grains[0].mass / volume * WAVE_SPEED * speed;
    let at = (1..done.series().time.len()).find(|&at| difference(at) > threshold);
    let at = at.ok_or_else(|| format!("stress above .1 ρcv in disc {disc}"))?;
    let time = &done.series().time;
    let share = (threshold - difference(at - 1)) / (difference(at) - difference(at - 1));
    Ok((time[at - 1] + share * (time[at] - time[at - 1])) * WAVE_SPEED / (2.0 * scene.grains[0].radius))
}

/// Returns the mean delay of stress from one disc to the next (d/c), from the second to the fourth disc.
fn delay(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(0.5 * (arrival(done, 4)? - arrival(done, 2)?))
}

pub(super) fn claims() -> Vec<Claim> {
    let soft = "springs as soft as .4 cells of material delay the wave at each of four contacts";
    let too_fast = "nodal contact joins the discs over a region from the start: the wave is too fast, and slows down \
                    with each refinement";
    let arrives = |run: Run, cells: f64, expected: CitedNumber, tolerance, control| {
        claim(format!("arrival of stress in disc 4, {} cells a diameter", 2.0 * cells), "d/c")
            .run(run)
            .equals_cited(expected, 1.0, |done| arrival(&done[0], 4))
            .within(tolerance)
            .refuses(control)
    };
    let softer = || Control::scene("discs a fifth softer", |scene| stiffen(scene, 0.8));
    let line = |solver, cells, points| run("line", solver, grid(cells, points), 8.0);
    let slower_fringes = |solver, points| {
        claim("delay per disc at ν = .48 over that at ν = .22", "1")
            .run(slower(solver, grid(10.0, points)).slow())
            .run(line(solver, 10.0, points))
            .at_least(FRINGES_SLOWER.value, FRINGES_SLOWER.source(), |done| Ok(delay(&done[0])? / delay(&done[1])?))
            .within(exactly("the paper states a bound"))
            .refuses(Control::scene("ν = .3 in both", |scene| set_poisson_ratio(scene, 0.3)))
    };
    let sooner = |variant, words: &str, disc: usize| {
        claim(format!("arrival of stress in disc {disc} of the {words} over that of the slipping zig-zag"), "1")
            .run(run(variant, "mpm", grid(8.0, 2), 15.0))
            .run(run("zig-zag", "mpm", grid(8.0, 2), 15.0))
            .at_most(SOONER, FASTER, move |done| Ok(arrival(&done[0], disc)? / arrival(&done[1], disc)?))
            .within(exactly(
                "the paper states an order of fringes and no ratio; earlier by a hundredth or more is required",
            ))
            .refuses(
                Control::scene("the slipping zig-zag four times as stiff", |scene| {
                    if scene.laws.iter().flatten().any(|law| law.friction == 0.5) {
                        stiffen(scene, 4.0);
                    }
                })
                .coarser(grid(4.0, 2)),
            )
    };
    vec![
        arrives(line(BEST, 20.0, 2).slow(), 20.0, ARRIVAL_IN_DISC_4, judged(0.3, soft), softer()),
        arrives(line(BEST, 40.0, 2).long(), 40.0, ARRIVAL_IN_DISC_4, judged(0.2, soft), softer()),
        arrives(line(PAPER, 20.0, 1).slow(), 20.0, ARRIVAL_AT_40, judged(0.2, too_fast), softer()),
        // On still finer grids, two implementations of nodal contact differ by a fifteenth, and neither approaches the
        // finite-element result.
        arrives(
            line(PAPER, 40.0, 1).known(too_fast).up_to(5.0).long(),
            40.0,
            ARRIVAL_IN_DISC_4,
            judged(0.2, "accuracy of springs at the surface, at this resolution"),
            Control::without_the_error("springs at the surface", BEST, grid(40.0, 2)),
        ),
        slower_fringes(BEST, 2),
        slower_fringes(PAPER, 1),
        sooner("zig-zag-glued", "glued zig-zag", 5),
        sooner("line", "line", 4),
    ]
}

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    let shown = [
        ("line, mpm", run("line", "mpm", grid(8.0, 2), 15.0)),
        ("zig-zag, μ = 0.5, mpm", run("zig-zag", "mpm", grid(8.0, 2), 15.0)),
        ("glued zig-zag, mpm", run("zig-zag-glued", "mpm", grid(8.0, 2), 15.0)),
        ("line, mpm:2001", run("line", PAPER, grid(8.0, 1), 15.0)),
        ("line, springs twice as stiff", run("line", STIFF, grid(8.0, 2), 15.0)),
    ];
    // No claim of the quick tier needs the last two runs.
    let count = if runner.is_thorough() { shown.len() } else { 3 };
    for (label, run) in shown.into_iter().take(count) {
        let done = runner.run(&run)?;
        let discs = 1..=done.scene.grains.len();
        let points = discs.filter_map(|disc| Some((disc as f64, arrival(&done, disc).ok()?))).collect();
        curves.push(Curve::new(label, Stroke::MarkedLine, points));
    }
    Ok(Figure::graph(
        "stress",
        "Arrival times of stress in elastic discs",
        "Time at which the difference of the principal stresses at a disc's centre first exceeds 0.1 ρcv, with 16 \
         cells per diameter. In the zig-zag, shear waves also reach the even discs. Fringes appear late there if \
         contacts are glued.",
        [Axis::linear("number of the disc"), Axis::linear("time of arrival t c/d (1)")],
        curves,
    ))
}
