//! What the paper found, over five packings: of grains on springs to the end, of grains that yield on half of the paper's grid as far
//! as minutes go.

use super::chains::chains;
use super::measures::{at, at_the_moving_side, band, end, plastic_strain, shear};
use super::{at_least, grid, to_shear};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_reference::statistics::interval;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Resolution;

const PACKINGS: [&str; 5] = ["seed-1", "seed-2", "seed-3", "seed-4", "seed-5"];
const FIGURE_6: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 6: extensive plastic deformation without slip, fairly little with friction";
const FIGURE_7: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 7: the pattern of chains evolves over 8 % of shear";
const FIGURE_8: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 8: motion is concentrated near the moving boundary";
const CONFINING: &str = "Bardenhagen, Brackbill & Sulsky 2000: the confining force fluctuates dramatically";
const LOWER: &str = "the bound is held by the lower end of the interval (99 %, Student's t) over the packings";

/// Time step of grains on springs.
const STEP: Resolution = Resolution::CriticalFraction(0.05);
/// Width of the band at a quarter of the speed over that at the paper's, of the prototype.
const SLOWER: f64 = 0.78 / 0.31;
/// Part of the shear for which the start is left out of means over time.
const STARTED: f64 = 0.2;

/// The other side moves instead.
fn other_side(scene: &mut Scene) {
    let velocity = scene.driven[1].velocity;
    for (driven, velocity) in scene.driven.iter_mut().zip([velocity, velocity * 0.0]) {
        driven.velocity = velocity;
        driven.grains.iter().for_each(|&grain| scene.grains[grain].velocity = velocity);
    }
}

/// Lower end of the confidence interval of a value over packings.
fn lower(values: &[f64]) -> Result<f64, Missing> {
    let (mean, half) = interval(values).ok_or_else(|| Missing("packings enough for an interval".to_owned()))?;
    Ok(mean - half)
}

/// Standard deviation over mean of the normal force on the side that stands still, in blocks of 1/2 % of shear.
fn fluctuation(done: &Done) -> Result<f64, Missing> {
    let (mut blocks, mut from) = (vec![Vec::new()], STARTED);
    for (&time, force) in done.series().time.iter().zip(done.column("left.force_x")?) {
        let now = shear(done, time);
        if now < STARTED {
            continue;
        }
        if now - from >= 5e-3 {
            blocks.push(Vec::new());
            from = now;
        }
        blocks.last_mut().into_iter().for_each(|block| block.push(*force));
    }
    let means: Vec<f64> = blocks
        .iter()
        .filter(|block| !block.is_empty())
        .map(|block| block.iter().sum::<f64>() / block.len() as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let variance = means.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / (means.len() as f64 - 1.0);
    Ok(variance.sqrt() / mean.abs())
}

/// Part of the links of force chains at 65 % of shear that are gone at 75 %.
fn gone(done: &Done) -> Result<f64, Missing> {
    Ok(1.0 - chains(at(done, 0.65)?).surviving(&chains(at(done, 0.75)?)))
}

/// A value of each packing, and a bound on the lower end of their interval.
fn over_packings(
    (quantity, source): (&str, &'static str),
    runs: Vec<Run>,
    bound: f64,
    control: Control,
    of: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
) -> Gate {
    let each = runs.len() / PACKINGS.len();
    let quantity = format!("{quantity}, 5 packings, {bound} or more");
    Gate::new((quantity, "1"), runs, (Evidence::Paper, source), (0.0, LOWER), control, move |done| {
        let values = done.chunks_exact(each).map(&of).collect::<Result<Vec<f64>, Missing>>()?;
        Ok(at_least(lower(&values)?, bound))
    })
}

pub(super) fn gates() -> Vec<Gate> {
    let springs = || PACKINGS.map(|packing| Run::new(packing, "dem", STEP).slow()).to_vec();
    let yielding = |packing, solver| to_shear(Run::new(packing, solver, grid(75.0)), 0.2, 0).long();
    let pairs = PACKINGS.iter().flat_map(|packing| [yielding(packing, "mpm:no-slip"), yielding(packing, "mpm")]);
    let still = || Control::scene("grains stand still", |scene| crate::effect::Effect::MovingWalls.switch_off(scene));
    vec![
        over_packings(
            ("part of the displacement in the half at the moving side, 50 % shear, grains on springs", FIGURE_8),
            springs(),
            0.6,
            Control::scene("the other side moves", other_side),
            |done| Ok(at_the_moving_side(&done[0], at(&done[0], 0.5)?)),
        ),
        over_packings(
            ("part of the links of force chains that are gone from 65 to 75 % shear, grains on springs", FIGURE_7),
            springs(),
            0.5,
            still(),
            |done| gone(&done[0]),
        ),
        over_packings(
            ("standard deviation over mean of the normal force on the standing side, 20 to 80 % shear, grains on springs", CONFINING),
            springs(),
            0.15,
            still(),
            |done| fluctuation(&done[0]),
        ),
        Gate::new(
            ("width of the band at 25 m/s over that at 100 m/s, 25 % shear, grains on springs", "1"),
            vec![to_shear(Run::new("slow", "dem", STEP), 0.25, 0), to_shear(Run::new("seed-1", "dem", STEP), 0.25, 0)],
            (Evidence::OtherCode, "independent prototype with deformable grains: .78 of the width against .31, for momentum has come further in"),
            (0.4, "packings, and contacts of another kind"),
            Control::scene("grains of a hundredth of the mass", |scene| {
                for grain in &mut scene.grains {
                    (grain.mass, grain.inertia) = (0.01 * grain.mass, 0.01 * grain.inertia);
                }
            }),
            |done| Ok(Measured::new(band(&done[0], end(&done[0])?) / band(&done[1], end(&done[1])?), SLOWER, SLOWER)),
        ),
        over_packings(
            ("plastic strain without slip over that with friction, 20 % shear", FIGURE_6),
            pairs.collect(),
            5.0,
            Control::solver("contacts glued", "mpm:no-slip"),
            |done| {
                let of = |done: &Done| Ok(plastic_strain(done, end(done)?));
                Ok(of(&done[0])? / of(&done[1])?)
            },
        ),
    ]
}
