//! A steel ball falls into a bed: the impact of the round robin of bulk processes, on five beds of our own.

mod ladders;
mod larger;
mod programs;
mod published;

use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;
use grainbench_reference::round_robin::Spread;
use published::{BEDS, PUBLISHED};

const LEVELS: &[Level] = &[time_step("dt=2e-6 s", 2e-6), time_step("dt=5e-7 s", 5e-7)];

/// Derivation, followed by the inconsistencies in the published data.
const DERIVATION: &str = concat!(
    include_str!("derivation.md"),
    "\n",
    include_str!(concat!(env!("GRAINBENCH_REFERENCES"), "/literature/dosta-2024/consistency.md"))
);

pub(crate) static CASE: Case =
    Case { derivation: DERIVATION, ..crate::heads::IMPACT_BED }.with(LEVELS, 0, &claims).drawn_by(figures);

/// Time step of most claims.
const STEP: Resolution = LEVELS[0].resolution;
/// Time step of the paper.
const FINE: Resolution = LEVELS[1].resolution;
/// Variants with our five beds.
const OWN: [&str; 5] = [PLAIN, "bed-2", "bed-3", "bed-4", "bed-5"];
/// Times between which the mean velocity of the rebound is measured (s after the release of the ball).
const REBOUND: [f64; 2] = [0.038, 0.050];
/// Time at which heights of the ball are compared (s after the release of the ball).
const DEEP: f64 = 0.030;

/// Interval of the comparison of paths (ms). Before it, beds differ mainly in the height of their surface.
const SURE: (f64, f64) = (24.999, 50.001);

/// Reason for the tolerance of one bed.
const BECAUSE: &str = "our packing is one more random sample: 2 √(s_code² + s_bed² (1/m + 1/n)), with m = 1 of our beds and \
     n = 10 published beds";
/// Reason for the tolerance of the mean of five beds.
const BECAUSE_FIVE: &str = "our packings are five more random samples: 2 √(s_code² + s_bed² (1/m + 1/n)), with m = 5 of our \
     beds and n = 10 published beds";

/// Returns the tolerance for the difference of two beds of one code at 30 ms (mm).
fn of_two_beds() -> Tolerance {
    computed(
        2.0 * std::f64::consts::SQRT_2 * dosta::HEIGHT_30_BED.value,
        "difference of two random beds, 2 √2 s_bed: only a larger change can be distinguished from another bed",
    )
}

fn on(variant: &'static str) -> Run {
    Run::new(variant, "dem:liggghts", LEVELS[0].resolution).long().kept()
}

fn on_all() -> [Run; 5] {
    OWN.map(on)
}

/// Returns the height of the ball at a time (mm).
fn height(done: &FinishedRun, time: f64) -> Result<f64, MissingData> {
    let heights = done.column("ball.z")?;
    let place = done.series().time.iter().position(|sampled| (sampled - time).abs() < 1e-9);
    place.map(|place| heights[place] * 1e3).ok_or_else(|| MissingData(format!("sample at {time} s")))
}

/// Returns the height of the ball (mm) over time (ms).
fn course(done: &FinishedRun) -> Vec<(f64, f64)> {
    let heights = samples(done, "ball.z").unwrap_or_default().into_iter();
    heights.map(|(time, height)| (time * 1e3, height * 1e3)).collect()
}

fn deepest(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(done.column("ball.z")?.iter().copied().fold(f64::INFINITY, f64::min) * 1e3)
}

/// Returns the mean velocity of the rebound (m/s).
fn rebound(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok((height(done, REBOUND[1])? - height(done, REBOUND[0])?) * 1e-3 / (REBOUND[1] - REBOUND[0]))
}

fn all(done: &[FinishedRun], read: impl Fn(&FinishedRun) -> Result<f64, MissingData>) -> Result<Vec<f64>, MissingData> {
    done.iter().map(read).collect()
}

/// Returns the value with the largest difference from an expected value.
fn farthest(values: &[f64], expected: f64) -> f64 {
    values.iter().copied().max_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs())).unwrap_or(f64::NAN)
}

/// Returns the mean of a published quantity with its standard deviations between codes and between beds.
fn spread(mean: CitedNumber, code: CitedNumber, bed: CitedNumber) -> Spread {
    Spread { mean: mean.value, code: code.value, bed: bed.value }
}

/// Published height of the ball at 30 ms (mm).
fn depth() -> Spread {
    spread(dosta::HEIGHT_30, dosta::HEIGHT_30_CODE, dosta::HEIGHT_30_BED)
}

fn claims() -> Vec<Claim> {
    let depth = depth();
    let lowest = spread(dosta::DEEPEST, dosta::DEEPEST_CODE, dosta::DEEPEST_BED);
    let speed = spread(dosta::REBOUND, dosta::REBOUND_CODE, dosta::REBOUND_BED);
    let at_30_ms = ("height of the ball at 30 ms, mean of five beds", "mm");
    let farthest_point = ("deepest point, farthest of five beds", "mm");
    let mean_speed = ("mean velocity from 38 to 50 ms, mean of five beds", "m/s");
    let farthest_speed = ("mean velocity from 38 to 50 ms, farthest of five beds", "m/s");
    let own = vec![
        of_beds(on_all(), at_30_ms, MEAN, dosta::HEIGHT_30, depth, |done| height(done, DEEP)).refuses(pair_of_m1()),
        claim("beds of five on which it is within the spread of one bed at 30 ms", "1")
            .runs(on_all())
            .at_least(4.0, dosta::HEIGHT_30.source(), move |done| {
                let heights = all(done, |done| height(done, DEEP))?;
                let within = |height: &&f64| (*height - depth.mean).abs() <= depth.allowed(1, PUBLISHED);
                Ok(heights.iter().filter(within).count() as f64)
            })
            .within(exactly("required in advance: two deviations contain nineteen of twenty random samples"))
            .refuses(half_the_density()),
        of_beds(on_all(), farthest_point, EACH, dosta::DEEPEST, lowest, deepest).refuses(smooth()),
        of_beds(on_all(), mean_speed, MEAN, dosta::REBOUND, speed, rebound).refuses(released_at_rest()),
        of_beds(on_all(), farthest_speed, EACH, dosta::REBOUND, speed, rebound).refuses(released_at_rest()),
        claim("deviations that the mean of five beds is off the codes' mean, largest from 25 to 50 ms", "1")
            .runs(on_all())
            .at_most(2.0, dosta::HEIGHT_30.source(), |done| {
                let within = |(time, _): &(f64, f64)| (SURE.0..SURE.1).contains(time);
                let scores = published::scores(done, &BEDS)?;
                Ok(scores.iter().filter(|score| within(score)).map(|(_, score)| score.abs()).fold(0.0, f64::max))
            })
            .within(exactly(
                "deviations √(s_code² + s_bed² (1/5 + 1/10)) at every millisecond; two deviations contain nineteen of \
                 twenty random samples",
            ))
            .refuses(half_the_density()),
        early("late", "dem:liggghts"),
        early("down", "dem").solver_independent_springs(),
    ];
    [own, programs::claims(), ladders::claims(), larger::claims()].concat()
}

/// Functions that combine the values of several beds and the expected value, and that return the tolerance.
type BedCombination = (fn(&[f64], f64) -> f64, fn(Spread) -> Tolerance);

/// Mean of five beds, with the tolerance of a mean over five beds.
const MEAN: BedCombination =
    (|values, _| mean(values), |spread| computed(spread.allowed(OWN.len(), PUBLISHED), BECAUSE_FIVE));
/// Value of the bed farthest from the codes, with the tolerance of one bed.
const EACH: BedCombination = (farthest, |spread| computed(spread.allowed(1, PUBLISHED), BECAUSE));

fn of_beds(
    runs: [Run; 5],
    (quantity, unit): (&str, &'static str),
    (together, tolerance): BedCombination,
    cited: CitedNumber,
    spread: Spread,
    read: RunReader,
) -> ClaimWithTolerance {
    claim(quantity, unit)
        .runs(runs)
        .equals_cited(cited, 1.0, move |done| Ok(together(&all(done, read)?, cited.value)))
        .within(tolerance(spread))
}

/// Start time of the runs on one bed (s after the release of the ball), before the ball hits the bed.
const MET: f64 = 0.020;

/// Returns the claim on one bed from 20 ms on, in the standard tier. The run ends at 50 ms in the convention of
/// LIGGGHTS, and at 30 ms in our convention and for external solvers.
fn early(variant: &'static str, solver: &'static str) -> Claim {
    claim("height of the ball at 30 ms, one bed, from 20 ms on", "mm")
        .run(Run::new(variant, solver, STEP).slow())
        .equals_cited(dosta::HEIGHT_30, 1.0, |done| height(&done[0], DEEP - MET))
        .within(computed(depth().allowed(1, PUBLISHED), BECAUSE))
        .refuses(half_the_density())
}

fn half_the_density() -> Control {
    Control::scene("half the density of the ball", lighten)
}

/// Halves the mass and the moment of inertia of the ball.
fn lighten(scene: &mut Scene) {
    let (mass, inertia) = (0.5 * scene.grains[0].mass, 0.5 * scene.grains[0].inertia);
    (scene.grains[0].mass, scene.grains[0].inertia) = (mass, inertia);
}

fn released_at_rest() -> Control {
    Control::scene("the ball released at rest", |scene| scene.grains[0].velocity *= 0.0)
}

fn smooth() -> Control {
    Control::contact_law("no friction", |law| law.friction = 0.0)
}

/// Returns a negative control in which contacts with ball and walls have the contact law of the grains.
fn pair_of_m1() -> Control {
    Control::scene("the pair of M1 for steel", |scene| {
        let place = |name: &str| scene.materials.iter().position(|known| known == name);
        let (Some(m1), Some(steel)) = (place("m1"), place("steel")) else { return };
        let count = scene.materials.len();
        let law = scene.laws[m1 * count + m1];
        (scene.laws[m1 * count + steel], scene.laws[steel * count + m1]) = (law, law);
    })
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let done: Vec<FinishedRun> = OWN.iter().map(|variant| runner.run(&on(variant))).collect::<Result<_, _>>()?;
    let mut figures = published::figures(&done, &BEDS);
    figures.extend(ladders::figures(runner)?);
    figures.push(larger::figure(runner)?);
    Ok(figures)
}
