//! LIGGGHTS on the same beds as ours, and ours in a convention of its own.

use super::{LEVELS, half_the_density, height};
use crate::rows::programs::row;
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::compare::pointwise::together;
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::of_two_draws;

use super::published::Spread;

/// 30 ms in runs that begin at 20 ms (s).
pub(super) const DEEP: f64 = 0.010;

pub(super) fn claims() -> Vec<Claim> {
    vec![beside(), after(), on_one_bed(), within("liggghts"), within("dem")]
}

/// LIGGGHTS on a thousand grains, until what it keeps of contacts that open and close again is felt: the ball meets the bed at
/// .24 ms.
fn beside() -> Claim {
    const UNTIL: f64 = 2.5e-4;
    let runs = ["dem:liggghts", "liggghts"].map(|solver| Run::new("thousand", solver, LEVELS[1].resolution));
    let allowed = judged(1e-11, "the same cycle: order of sums; in units of its radius");
    let control = Control::ours("E* × 1.00001 in ours", |scene| scene.change_laws(|law| law.scale_normal(1.00001)));
    row("height of the ball on a thousand grains until .25 ms, worst", "m", allowed, runs, control, |done| {
        let (ours, theirs) = together(&done[0], &done[1], "ball.z")?;
        let until = done[1].series().time.partition_point(|time| *time < UNTIL + 1e-9);
        let radius = done[0].scene.grains[0].radius;
        Ok(Measured::worst_of(&done[1].series().time[..until], &ours[..until], &theirs[..until], radius))
    })
}

/// When courses are compared past the horizon (s): while the ball pushes grains aside, and after it has bounced.
const AFTER: [f64; 4] = [1e-3, 2e-3, 3e-3, 6e-3];
/// How far grains of a twin are moved by lot, at most (m): a thousandth of the overlaps at the floor.
const MOVED: f64 = 1e-10;
const TWINS: [&str; 8] = ["twin 1", "twin 2", "twin 3", "twin 4", "twin 5", "twin 6", "twin 7", "twin 8"];

/// LIGGGHTS on a thousand grains past that: within what twins of ours, every grain moved by lot, differ by.
fn after() -> Claim {
    let run = |solver| Run::new("thousand-long", solver, LEVELS[1].resolution);
    let twin = |(seed, name): (usize, &&str)| {
        run("dem:liggghts").adjusted(name, move |scene| moved(scene, seed as u64)).aside()
    };
    let runs = ["dem:liggghts", "liggghts"].map(run).into_iter().chain(TWINS.iter().enumerate().map(twin));
    claim("height of the ball on a thousand grains at 1, 2, 3 and 6 ms, worst, against liggghts", "m")
        .of_all(runs)
        .agrees(Source::Program, |done| {
            let at = |done: &Done, time: f64| Ok::<f64, Missing>(height(done, time)? * 1e-3);
            let of = |time: f64| {
                let twins: Vec<f64> = done[2..].iter().map(|twin| at(twin, time)).collect::<Result<_, _>>()?;
                let half = of_two_draws(&twins).ok_or_else(|| Missing("twins".to_owned()))?;
                Ok(Measured::new(at(&done[0], time)?, at(&done[1], time)?, half))
            };
            let found: Vec<Measured> = AFTER.into_iter().map(of).collect::<Result<_, Missing>>()?;
            Measured::worst_among(found).ok_or_else(|| Missing("samples".to_owned()))
        })
        .within(one_interval(
            "in units of half the 99 % confidence interval of the difference of two draws, from eight twins of ours whose grains \
             are moved by up to 10⁻¹⁰ m",
        ))
        .refuses(Control::ours("friction × 1.1 in ours", |scene| scene.change_laws(|law| law.friction *= 1.1)))
}

/// Every grain of the bed by up to [`MOVED`].
fn moved(scene: &mut Scene, seed: u64) {
    let dimension = scene.dimension;
    let mut places: Vec<_> = scene.grains[1..].iter().map(|grain| grain.position).collect();
    grainbench_scene::generate::perturb(&mut places, MOVED, seed, dimension);
    scene.grains[1..].iter_mut().zip(places).for_each(|(grain, place)| grain.position = place);
}

/// One bed of ours from 20 ms to the deepest point.
fn short(solver: &'static str) -> Run {
    Run::new("short-1", solver, LEVELS[0].resolution).long().kept()
}

/// Ours and LIGGGHTS on one bed of 25,000.
fn on_one_bed() -> Claim {
    let codes = 2.0 * std::f64::consts::SQRT_2 * dosta::HEIGHT_30_CODE.value;
    claim("height of the ball at 30 ms on one bed, against liggghts", "mm")
        .of_all(["dem:liggghts", "liggghts"].map(short))
        .agrees(Source::Program, |done| Ok(Measured::new(height(&done[0], DEEP)?, height(&done[1], DEEP)?, 1.0)))
        .within(computed(codes, "two codes on one bed: 2 √2 s_code of the seven published"))
        .refuses(Control::ours("half the density of the ball in ours", |scene| {
            let (mass, inertia) = (0.5 * scene.grains[0].mass, 0.5 * scene.grains[0].inertia);
            (scene.grains[0].mass, scene.grains[0].inertia) = (mass, inertia);
        }))
}

/// LIGGGHTS that is installed, and our solver in its own convention, on one bed of ours beside the seven codes.
fn within(solver: &'static str) -> Claim {
    let spread = Spread::of(dosta::HEIGHT_30, dosta::HEIGHT_30_CODE, dosta::HEIGHT_30_BED);
    claim("height of the ball at 30 ms on one bed of ours, from 20 ms on", "mm")
        .of(short(solver))
        .equals_cited(dosta::HEIGHT_30, 1.0, |done| height(&done[0], DEEP))
        .within(computed(spread.allowed(1), super::BECAUSE))
        .refuses(half_the_density())
}
