//! What the paper found, over five packings to the end: of grains on springs, and of grains that yield on half of the paper's grid.

use super::chains::chains;
use super::coarse::MAKES_ENERGY;
use super::measures::{at, at_the_moving_side, band, end, fluctuation, plastic_strain, rotation_deg, shear};
use super::yielding::{over, whole};
use super::{CHAINS, FRAMES, at_least, grid, sheared, springs, to_shear};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_reference::statistics::interval;
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::Scene;

const PACKINGS: [&str; 5] = ["seed-1", "seed-2", "seed-3", "seed-4", "seed-5"];
pub(super) const FIGURE_6: (Evidence, &str) = (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000, Fig. 6: extensive plastic deformation without slip, fairly little with friction");
pub(super) const FIGURE_7: (Evidence, &str) = (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000, Fig. 7: the pattern of chains evolves over 8 % of shear");
const FIGURE_8: (Evidence, &str) = (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000, Fig. 8: motion is concentrated near the moving boundary");
const CONFINING: (Evidence, &str) = (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000: the confining force fluctuates dramatically");
const ROLLING: (Evidence, &str) = (Evidence::OtherCode, "independent prototype on a grid of 150²: 67° against 39°, for grains roll");
const FLUCTUATING: (Evidence, &str) =
    (Evidence::OtherCode, "independent prototype on a grid of 150²: .35 against .05, for chains of grains come and go");

/// Width of the band at a quarter of the speed over that at the paper's, of the prototype.
const SLOWER: f64 = 0.78 / 0.31;
/// The other side moves instead.
fn other_side(scene: &mut Scene) {
    let velocity = scene.driven[1].velocity;
    for (driven, velocity) in scene.driven.iter_mut().zip([velocity, velocity * 0.0]) {
        driven.velocity = velocity;
        driven.grains.iter().for_each(|&grain| scene.grains[grain].velocity = velocity);
    }
}

/// Chains that stay: nothing moves but what swells.
fn swollen(scene: &mut Scene) {
    crate::effect::Effect::MovingWalls.switch_off(scene);
    for grain in &mut scene.grains {
        grain.radius *= 1.01;
    }
}

/// Deformable grains, whose sides are open, fly apart when they swell, unless that comes to rest, within a hundredth of the time.
fn at_rest(scene: &mut Scene) {
    swollen(scene);
    scene.global_damping = 1e7;
}

/// Lower end of the confidence interval of a value over packings.
fn lower(values: &[f64]) -> Result<f64, Missing> {
    let (mean, half) = interval(values).ok_or_else(|| Missing("packings enough for an interval".to_owned()))?;
    Ok(mean - half)
}

/// The same of a ratio: of its logarithm, for it is positive, and one over it is as good.
fn lower_of_ratios(ratios: &[f64]) -> Result<f64, Missing> {
    Ok(lower(&ratios.iter().map(|ratio| ratio.ln()).collect::<Vec<f64>>())?.exp())
}

/// The least of the values.
fn least(values: &[f64]) -> Result<f64, Missing> {
    Ok(values.iter().copied().fold(f64::INFINITY, f64::min))
}

/// Part of the links of some force chains that are gone later.
fn gone(first: &Snapshot, second: &Snapshot) -> Result<f64, Missing> {
    let first = chains(first);
    if first.links.is_empty() {
        return Err(Missing("force chains".to_owned()));
    }
    Ok(1.0 - first.surviving(&chains(second)))
}

/// Between the moments that the paper shows.
fn gone_in_the_paper(done: &Done) -> Result<f64, Missing> {
    gone(at(done, CHAINS[0])?, at(done, CHAINS[1])?)
}

/// After this much shear.
const LIFE: f64 = 0.075;

/// After that much shear, mean over all times from 20 % of shear on.
fn gone_in_the_mean(done: &Done) -> Result<f64, Missing> {
    let snapshots = &done.record.snapshots;
    let started = snapshots.iter().filter(|snapshot| shear(done, snapshot.time) >= 0.2);
    let pairs = started.filter_map(|first| Some((first, at(done, shear(done, first.time) + LIFE).ok()?)));
    let gone = pairs.map(|(first, second)| gone(first, second)).collect::<Result<Vec<f64>, Missing>>()?;
    Ok(gone.iter().sum::<f64>() / gone.len() as f64)
}

/// What is held against the bound, of the values of all packings, and why.
type Held = (fn(&[f64]) -> Result<f64, Missing>, &'static str);
const VALUES: Held = (lower, "the bound is held by the lower end of the interval (99 %, Student's t) over the packings");
const EACH: Held = (least, "each packing holds the bound, for the paper shows one; chains that stay would lose none");
const RATIOS: Held =
    (lower_of_ratios, "the bound is held by the lower end of the interval (99 %, Student's t, of logarithms) over the packings");

/// A value of each packing, and a bound on what is held against it.
fn over_packings(
    (quantity, source): (&str, (Evidence, &'static str)),
    runs: Vec<Run>,
    (held, because): Held,
    bound: f64,
    control: Control,
    of: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
) -> Gate {
    let each = runs.len() / PACKINGS.len();
    let quantity = format!("{quantity}, 5 packings, {bound} or more");
    Gate::new((quantity, "1"), runs, source, (0.0, because), control, move |done| {
        let values = done.chunks_exact(each).map(&of).collect::<Result<Vec<f64>, Missing>>()?;
        Ok(at_least(held(&values)?, bound))
    })
}

/// Force chains come and go.
fn chains_go_on(runs: Vec<Run>, of: &str, control: Control) -> Gate {
    let quantity = format!("part of the links of force chains that are gone after 7.5 % of shear, mean from 20 to 80 %{of}");
    over_packings((&quantity, FIGURE_7), runs, VALUES, 0.4, control, |done| gone_in_the_mean(&done[0]))
}

/// Force chains at the paper's moments are others.
fn chains_of_the_paper(runs: Vec<Run>, of: &str, control: Control) -> Gate {
    let quantity = format!("part of the links of force chains that are gone from 63 to 71 % shear{of}, least");
    over_packings((&quantity, FIGURE_7), runs, EACH, 0.2, control, |done| gone_in_the_paper(&done[0]))
}

/// Grains on springs.
fn on_springs() -> Vec<Gate> {
    let runs = || PACKINGS.map(|packing| springs::to(packing, 0.8, FRAMES).slow()).to_vec();
    let staying = || Control::scene("grains swollen by a hundredth, so that they press, between sides that stand still", swollen);
    vec![
        over_packings(
            ("part of the displacement in the half at the moving side, 50 % shear, grains on springs", FIGURE_8),
            runs(),
            VALUES,
            0.6,
            Control::scene("the other side moves", other_side),
            |done| Ok(at_the_moving_side(&done[0], at(&done[0], 0.5)?)),
        ),
        chains_go_on(runs(), ", grains on springs", staying()),
        chains_of_the_paper(runs(), ", grains on springs", staying()),
        over_packings(
            ("standard deviation over mean of the normal force on the standing side, 20 to 80 % shear, grains on springs", CONFINING),
            runs(),
            VALUES,
            0.15,
            Control::scene("grains stand still", |scene| crate::effect::Effect::MovingWalls.switch_off(scene)),
            |done| fluctuation(&done[0], "left.force_x"),
        ),
        Gate::new(
            ("width of the band at 25 m/s over that at 100 m/s, 25 % shear, grains on springs", "1"),
            vec![springs::to("slow", 0.25, 0), springs::to("seed-1", 0.25, 0)],
            (Evidence::OtherCode, "independent prototype with deformable grains: .78 of the width against .31, for momentum has come further in"),
            (0.4, "packings, and contacts of another kind"),
            Control::scene("grains of a hundredth of the mass", |scene| {
                for grain in &mut scene.grains {
                    (grain.mass, grain.inertia) = (0.01 * grain.mass, 0.01 * grain.inertia);
                }
            }),
            |done| Ok(Measured::new(band(&done[0], end(&done[0])?) / band(&done[1], end(&done[1])?), SLOWER, SLOWER)),
        ),
    ]
}

/// Grains that yield.
fn yielding() -> Vec<Gate> {
    let runs = || PACKINGS.map(|packing| whole(packing, "mpm")).to_vec();
    let beside = |of: fn(&'static str) -> [Run; 2]| PACKINGS.into_iter().flat_map(of).collect::<Vec<Run>>();
    let glued_first = |packing| [whole(packing, "mpm:no-slip"), whole(packing, "mpm")];
    let friction_first = |packing| [whole(packing, "mpm"), whole(packing, "mpm:no-slip")];
    let on_approach = |packing| {
        let run = to_shear(Run::new(packing, "mpm:2000", grid(75.0)), 0.2, FRAMES).long();
        [run.known(MAKES_ENERGY), whole(packing, "mpm:no-slip").aside()]
    };
    let glued = || Control::solver("contacts glued", "mpm:no-slip");
    let staying =
        || Control::scene("grains swollen by a hundredth, so that they press, at rest between sides that stand still", at_rest);
    let mut gates: Vec<Gate> = [0.5, 0.8]
        .into_iter()
        .map(|shear| {
            let quantity = format!("plastic strain without slip over that with friction, {:.0} % shear", 100.0 * shear);
            let ratio = move |done: &[Done]| over(done, shear, plastic_strain);
            over_packings((&quantity, FIGURE_6), beside(glued_first), RATIOS, 5.0, glued(), ratio)
        })
        .collect();
    gates.extend([
        over_packings(
            ("plastic strain without slip over that with friction as contact on approach has it, 20 % shear", FIGURE_6),
            beside(on_approach),
            RATIOS,
            3.0,
            Control::without_the_error("springs between surfaces", "mpm", grid(75.0)),
            |done| Ok(1.0 / over(done, 0.2, plastic_strain)?),
        ),
        over_packings(
            ("part of the displacement in the half at the moving side, 50 % shear", FIGURE_8),
            runs(),
            VALUES,
            0.6,
            Control::scene("the other side moves", |scene| {
                sheared(scene, 0.5, FRAMES);
                other_side(scene);
            }),
            |done| Ok(at_the_moving_side(&done[0], at(&done[0], 0.5)?)),
        ),
        chains_go_on(runs(), "", staying()),
        chains_of_the_paper(runs(), "", staying()),
        over_packings(
            ("rotation of grains with friction over that without slip, 80 % shear", ROLLING),
            beside(friction_first),
            RATIOS,
            1.3,
            glued(),
            |done| over(done, 0.8, rotation_deg),
        ),
        over_packings(
            ("standard deviation over mean of the shear stress, 20 to 80 % shear: with friction over without slip", FLUCTUATING),
            beside(friction_first),
            RATIOS,
            3.0,
            glued(),
            |done| Ok(fluctuation(&done[0], "left.force_y")? / fluctuation(&done[1], "left.force_y")?),
        ),
    ]);
    gates
}

pub(super) fn gates() -> Vec<Gate> {
    [on_springs(), yielding()].concat()
}
