//! Claims on results of the paper, over five packings up to the end of shear. The grains are on springs, or plastic on
//! a grid with half as many cells per axis as the paper's.

use super::chains::chains;
use super::coarse::MAKES_ENERGY;
use super::measures::{at, at_the_moving_side, band, end, fluctuation, plastic_strain, rotation_deg, shear};
use super::yielding::{over, whole};
use super::{CHAINS, FRAMES, grid, sheared, springs, to_shear};
use crate::sources::literature::bardenhagen_2000::WORK as PAPER;
use crate::sources::prototype::sheared_slab as prototype;
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::interval;

const PACKINGS: [&str; 5] = ["seed-1", "seed-2", "seed-3", "seed-4", "seed-5"];
// The paper states these results in words. The bounds of the claims are our own interpretation.
pub(super) const FIGURE_6: Source = Source::Printed(
    &PAPER,
    "Fig. 6, 75 % shear: extensive plastic deformation and large voids without slip, fairly little plastic \
     deformation with friction",
);
const FIGURE_7: Source =
    Source::Printed(&PAPER, "Fig. 7: the pattern of chains evolves over the 8 % of shear between 63 and 71 %");
const FIGURE_8: Source =
    Source::Printed(&PAPER, "Fig. 8: motion of the grains is concentrated near the moving boundary");

/// Moves the fixed side instead of the moving side, for a negative control.
fn other_side(scene: &mut Scene) {
    let velocity = scene.driven[1].velocity;
    for (driven, velocity) in scene.driven.iter_mut().zip([velocity, velocity * 0.0]) {
        driven.velocity = velocity;
        driven.grains.iter().for_each(|&grain| scene.grains[grain].velocity = velocity);
    }
}

/// Stops the walls and enlarges the grains slightly, for a negative control in which the force chains do not change.
fn swollen(scene: &mut Scene) {
    Effect::MovingWalls.switch_off(scene);
    for grain in scene.grains.iter_mut() {
        grain.radius *= 1.01;
    }
}

/// Returns the lower end of the 99 % confidence interval of the mean over packings.
fn lower(values: &[f64]) -> Result<f64, MissingData> {
    let (mean, half) = interval(values).ok_or("packings enough for an interval")?;
    Ok(mean - half)
}

/// Returns the fraction of force chain links that no longer exist in a later snapshot.
fn gone(first: &Snapshot, second: &Snapshot) -> Result<f64, MissingData> {
    let first = chains(first);
    if first.links.is_empty() {
        return Err("force chains".into());
    }
    Ok(1.0 - first.surviving(&chains(second)))
}

/// Increase of the mean shear after which surviving links are counted.
const LIFE: f64 = 0.075;

/// Returns the fraction of links that disappear over a shear of [`LIFE`], averaged from 20 % of shear on.
fn gone_in_the_mean(done: &FinishedRun) -> Result<f64, MissingData> {
    let snapshots = &done.record.snapshots;
    let started = snapshots.iter().filter(|snapshot| shear(done, snapshot.time) >= 0.2);
    let pairs = started.filter_map(|first| Some((first, at(done, shear(done, first.time) + LIFE).ok()?)));
    let gone = pairs.map(|(first, second)| gone(first, second)).collect::<Result<Vec<f64>, MissingData>>()?;
    Ok(mean(&gone))
}

/// Function that reduces the values of all packings to the compared value, and the reason of the tolerance.
type PackingReduction = (fn(&[f64]) -> Result<f64, MissingData>, &'static str);
const VALUES: PackingReduction = (
    lower,
    "the lower end of the 99 % interval (Student's t) over the packings must meet the bound; the bound is our choice",
);
const EACH: PackingReduction = (
    |values| Ok(values.iter().copied().fold(f64::INFINITY, f64::min)),
    "each packing must meet the bound, which is our choice; permanent chains would lose no link",
);
const RATIOS: PackingReduction = (
    // Logarithms treat a ratio and its inverse alike.
    |ratios| Ok(lower(&ratios.iter().map(|ratio| ratio.ln()).collect::<Vec<f64>>())?.exp()),
    "the lower end of the 99 % interval (Student's t, of logarithms) over the packings must meet the bound; the bound \
     is our choice",
);

/// Returns the claim that the reduced value over all packings is at least `bound`.
fn over_packings(
    (quantity, source): (&str, Source),
    runs: Vec<Run>,
    (held, because): PackingReduction,
    bound: f64,
    control: Control,
    read: impl RunsReader<f64>,
) -> Claim {
    let each = runs.len() / PACKINGS.len();
    claim(format!("{quantity}, 5 packings"), "1")
        .runs(runs)
        .at_least(bound, source, move |done| {
            held(&done.chunks_exact(each).map(&read).collect::<Result<Vec<f64>, MissingData>>()?)
        })
        .within(exactly(because))
        .refuses(control)
}

/// Returns the claims on motion near the moving side and on force chains, for runs with one kind of grains.
fn motion_and_chains(words: &str, runs: &[Run], other_side: Control, staying: Control) -> [Claim; 3] {
    const LINKS: &str = "part of the links of force chains that are gone";
    let quantities = [
        &format!("part of the displacement in the half at the moving side, 50 % shear{words}"),
        &format!("{LINKS} after 7.5 % of shear, mean from 20 to 80 %{words}"),
        &format!("{LINKS} from 63 to 71 % shear{words}, least"),
    ];
    let claim_on = |at: usize, source, reduction, bound, control, read: RunReader| {
        over_packings((quantities[at], source), runs.to_vec(), reduction, bound, control, move |done| read(&done[0]))
    };
    [
        claim_on(0, FIGURE_8, VALUES, 0.6, other_side, |done| Ok(at_the_moving_side(done, at(done, 0.5)?))),
        claim_on(1, FIGURE_7, VALUES, 0.4, staying.clone(), gone_in_the_mean),
        claim_on(2, FIGURE_7, EACH, 0.2, staying, |done| gone(at(done, CHAINS[0])?, at(done, CHAINS[1])?)),
    ]
}

/// Returns the band width at the end of the first run, divided by the band width at the end of the second run.
pub(super) fn bands(done: &[FinishedRun]) -> Result<f64, MissingData> {
    Ok(band(&done[0], end(&done[0])?) / band(&done[1], end(&done[1])?))
}

fn on_springs() -> Vec<Claim> {
    let runs = PACKINGS.map(|packing| springs::to(packing, 0.8, FRAMES).slow());
    let staying =
        Control::scene("grains swollen by a hundredth, so that they press, between sides that stand still", swollen);
    let other = Control::scene("the other side moves", other_side);
    let slower = prototype::BAND_AT_25.value / prototype::BAND_AT_100.value;
    let width = claim("width of the band at 25 m/s over that at 100 m/s, 25 % shear, grains on springs", "1")
        .runs([springs::to("slow", 0.25, 0).slow(), springs::to("seed-1", 0.25, 0).slow()])
        .equals(prototype::BAND_AT_25.source(), move |done| Ok(Measurement::relative(bands(done)?, slower)))
        .within(judged(0.4, "spread between packings, and another kind of contact: the grains of the prototype deform"))
        .refuses(
            Control::scene("grains of three hundredths of the mass", |scene| {
                for grain in scene.grains.iter_mut() {
                    (grain.mass, grain.inertia) = (0.03 * grain.mass, 0.03 * grain.inertia);
                }
            })
            .coarser(Resolution::CriticalFraction(0.1)),
        );
    motion_and_chains(", grains on springs", &runs, other, staying).into_iter().chain([width]).collect()
}

fn yielding() -> Vec<Claim> {
    let beside = |pair: fn(&'static str) -> [Run; 2]| PACKINGS.into_iter().flat_map(pair).collect::<Vec<Run>>();
    let glued_first = |packing| [whole(packing, "mpm:no-slip"), whole(packing, "mpm")];
    let friction_first = |packing| [whole(packing, "mpm"), whole(packing, "mpm:no-slip")];
    let on_approach = |packing| {
        let run = to_shear(Run::new(packing, "mpm:2000", grid(75.0)), 0.2, FRAMES).long();
        // The relative error is −1 if there is no plastic strain without slip.
        [run.known(MAKES_ENERGY).up_to(1.0), whole(packing, "mpm:no-slip").aside()]
    };
    let glued = || Control::solver("contacts glued", "mpm:no-slip");
    let staying = Control::scene(
        "grains swollen by a hundredth, so that they press, at rest between sides that stand still",
        |scene| {
            swollen(scene);
            // Without a strong damping, deformable grains fly apart, because their sides are open.
            scene.global_damping = 1e7;
        },
    );
    let other = Control::scene("the other side moves", |scene| {
        sheared(scene, 0.5, FRAMES);
        other_side(scene);
    });
    let mut claims: Vec<Claim> = [0.5, 0.8]
        .into_iter()
        .map(|shear| {
            let quantity = format!("plastic strain without slip over that with friction, {:.0} % shear", 100.0 * shear);
            let ratio = move |done: &[FinishedRun]| over(done, shear, plastic_strain);
            over_packings((&quantity, FIGURE_6), beside(glued_first), RATIOS, 5.0, glued(), ratio)
        })
        .collect();
    claims.push(over_packings(
        ("plastic strain without slip over that with friction as contact on approach has it, 20 % shear", FIGURE_6),
        beside(on_approach),
        RATIOS,
        3.0,
        Control::without_the_error("springs between surfaces", "mpm", grid(75.0)),
        |done| Ok(1.0 / over(done, 0.2, plastic_strain)?),
    ));
    claims.extend(motion_and_chains("", &PACKINGS.map(|packing| whole(packing, "mpm")), other, staying));
    claims.extend([
        over_packings(
            ("rotation of grains with friction over that without slip, 80 % shear", prototype::ROTATION_RATIO.source()),
            beside(friction_first),
            RATIOS,
            1.3,
            glued(),
            |done| over(done, 0.8, rotation_deg),
        ),
        over_packings(
            (
                "standard deviation over mean of the shear stress, 20 to 80 % shear: with friction over without slip",
                prototype::FLUCTUATION_RATIO.source(),
            ),
            beside(friction_first),
            RATIOS,
            3.0,
            glued(),
            |done| Ok(fluctuation(&done[0], "left.force_y")? / fluctuation(&done[1], "left.force_y")?),
        ),
    ]);
    claims
}

pub(super) fn claims() -> Vec<Claim> {
    [on_springs(), yielding()].concat()
}
