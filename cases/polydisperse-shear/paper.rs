//! What the paper found, over five packings: of grains on springs to the end, of grains that yield on half of the paper's grid as far
//! as minutes go.

use super::chains::chains;
use super::coarse::MAKES_ENERGY;
use super::measures::{at, at_the_moving_side, band, end, fluctuation, plastic_strain};
use super::{CHAINS, FRAMES, at_least, grid, springs, to_shear};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_reference::statistics::interval;
use grainbench_scene::scene::Scene;

const PACKINGS: [&str; 5] = ["seed-1", "seed-2", "seed-3", "seed-4", "seed-5"];
pub(super) const FIGURE_6: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 6: extensive plastic deformation without slip, fairly little with friction";
pub(super) const FIGURE_7: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 7: the pattern of chains evolves over 8 % of shear";
const FIGURE_8: &str = "Bardenhagen, Brackbill & Sulsky 2000, Fig. 8: motion is concentrated near the moving boundary";
const CONFINING: &str = "Bardenhagen, Brackbill & Sulsky 2000: the confining force fluctuates dramatically";
const LOWER: &str = "the bound is held by the lower end of the interval (99 %, Student's t) over the packings";

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

/// Lower end of the confidence interval of a value over packings.
fn lower(values: &[f64]) -> Result<f64, Missing> {
    let (mean, half) = interval(values).ok_or_else(|| Missing("packings enough for an interval".to_owned()))?;
    Ok(mean - half)
}

/// Part of the links of force chains at the first of the paper's moments that are gone at the second.
pub(super) fn gone(done: &Done) -> Result<f64, Missing> {
    Ok(1.0 - chains(at(done, CHAINS[0])?).surviving(&chains(at(done, CHAINS[1])?)))
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
    let on_springs = || PACKINGS.map(|packing| springs::to(packing, 0.8, FRAMES).slow()).to_vec();
    let yielding = |packing, solver| to_shear(Run::new(packing, solver, grid(75.0)), 0.2, 0).long();
    let pairs = PACKINGS.iter().flat_map(|packing| [yielding(packing, "mpm:no-slip"), yielding(packing, "mpm")]);
    let on_approach = PACKINGS.iter().flat_map(|packing| {
        [yielding(packing, "mpm:2000").known(MAKES_ENERGY), yielding(packing, "mpm:no-slip").aside()]
    });
    let still = Control::scene("grains stand still", |scene| crate::effect::Effect::MovingWalls.switch_off(scene));
    vec![
        over_packings(
            ("part of the displacement in the half at the moving side, 50 % shear, grains on springs", FIGURE_8),
            on_springs(),
            0.6,
            Control::scene("the other side moves", other_side),
            |done| Ok(at_the_moving_side(&done[0], at(&done[0], 0.5)?)),
        ),
        over_packings(
            ("part of the links of force chains that are gone from 63 to 71 % shear, grains on springs", FIGURE_7),
            on_springs(),
            0.4,
            still.clone(),
            |done| gone(&done[0]),
        ),
        over_packings(
            ("standard deviation over mean of the normal force on the standing side, 20 to 80 % shear, grains on springs", CONFINING),
            on_springs(),
            0.15,
            still,
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
        over_packings(
            ("plastic strain without slip over that with friction, 20 % shear", FIGURE_6),
            pairs.collect(),
            3.0,
            Control::solver("contacts glued", "mpm:no-slip"),
            |done| {
                let of = |done: &Done| Ok(plastic_strain(done, end(done)?));
                Ok(of(&done[0])? / of(&done[1])?)
            },
        ),
        over_packings(
            ("plastic strain without slip over that with friction as contact on approach has it, 20 % shear", FIGURE_6),
            on_approach.collect(),
            3.0,
            Control::without_the_error("springs between surfaces", "mpm", grid(75.0)),
            |done| {
                let of = |done: &Done| Ok(plastic_strain(done, end(done)?));
                Ok(of(&done[1])? / of(&done[0])?)
            },
        ),
        over_packings(
            ("part of the displacement in the half at the moving side, 20 % shear", FIGURE_8),
            PACKINGS.map(|packing| yielding(packing, "mpm")).to_vec(),
            0.6,
            Control::scene("the other side moves", other_side),
            |done| Ok(at_the_moving_side(&done[0], end(&done[0])?)),
        ),
    ]
}
