//! What a longer step and a softer wall cost: heights of the ball at 30 ms on three beds.

use super::programs::DEEP;
use super::{all, farthest, half_the_density, height};
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;

const BEDS: [&str; 3] = ["short-1", "short-2", "short-3"];
/// The step of the paper and longer ones (s): 6, 12 and 24 % of Rayleigh's. One of 47 % breaks (derivation).
const STEPS: [f64; 3] = [5e-7, 1e-6, 2e-6];
/// The step at which walls are made softer (s).
const AT: f64 = 2e-6;
/// Young's moduli that the steel of walls and ball is given (GPa), for its 210.
const SOFTER: [(&str, f64); 2] = [("steel of 21 GPa", 21.0), ("steel of 2.1 GPa", 2.1)];
const STEEL: f64 = 210.0;
const M1: f64 = 1.0;

fn at(step: f64) -> [Run; 3] {
    BEDS.map(|bed| Run::new(bed, "dem:liggghts", Resolution::TimeStep(step)).long().kept())
}

fn with_steel((name, young): (&str, f64)) -> [Run; 3] {
    at(AT).map(|run| run.adjusted(name, move |scene| soften(scene, young)))
}

/// Steel with this Young's modulus (GPa). Its Poisson's ratio is that of M1, so that E* and G* go with 1/(1/E + 1/E').
fn soften(scene: &mut Scene, young: f64) {
    let place = |name: &str| scene.materials.iter().position(|known| known == name);
    let (Some(m1), Some(steel)) = (place("m1"), place("steel")) else { return };
    let (count, of) = (scene.materials.len(), |steel: f64| 1.0 / (1.0 / M1 + 1.0 / steel));
    let softer = of(young) / of(STEEL);
    for pair in [m1 * count + steel, steel * count + m1] {
        if let Some(law) = &mut scene.laws[pair] {
            law.scale_normal(softer);
            law.scale_tangential(softer);
        }
    }
}

pub(super) fn claims() -> Vec<Claim> {
    let mut all = vec![
        less("step of 2·10⁻⁶ s", at(STEPS[2]), at(STEPS[0])),
        less("step of 1·10⁻⁶ s", at(STEPS[1]), at(STEPS[0])),
    ];
    all.extend(SOFTER.map(|softer| less(softer.0, with_steel(softer), at(AT))));
    all
}

/// What something changes beside runs without it: harmless where it is less than what two beds differ by.
fn less(what: &str, runs: [Run; 3], beside: [Run; 3]) -> Claim {
    claim(format!("height of the ball at 30 ms, {what}, less that without, farthest of three beds"), "mm")
        .of_all(runs)
        .of_all(beside.map(Run::aside))
        .agrees(
            Source::Ourselves(
                "the same beds with the step of the paper, 5·10⁻⁷ s; of softer steel with that of 210 GPa",
            ),
            |done| {
                let heights = all(done, |done| height(done, DEEP))?;
                let (with, without) = heights.split_at(BEDS.len());
                let changes: Vec<f64> = with.iter().zip(without).map(|(with, without)| with - without).collect();
                Ok(Measured::new(farthest(&changes, 0.0), 0.0, 1.0))
            },
        )
        .within(computed(
            2.0 * dosta::HEIGHT_30_BED.value,
            "less than what beds differ by: 2 s_bed of the published ones",
        ))
        .refuses(half_the_density())
}

/// Heights over the step and over the stiffness of steel, less the codes' mean.
pub(super) fn figure(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let off = |run: &Run| -> Result<Option<f64>, RunError> {
        Ok(height(&runner.run(run)?, DEEP).ok().map(|height| height - dosta::HEIGHT_30.value))
    };
    let mut curves = Vec::new();
    for (bed, name) in ["bed 1", "bed 2", "bed 3"].into_iter().enumerate() {
        let mut points = Vec::new();
        for step in STEPS {
            points.extend(off(&at(step)[bed])?.map(|off| (step, off)));
        }
        curves.push(Curve::new(name, Stroke::MarkedLine, points));
    }
    let allowed = 2.0 * dosta::HEIGHT_30_CODE.value.hypot(dosta::HEIGHT_30_BED.value * 1.1_f64.sqrt());
    let bound = |at: f64| {
        Curve::new(
            format!("{at:+.2} mm, one bed of one more code"),
            Stroke::Dashed,
            STEPS.map(|step| (step, at)).to_vec(),
        )
    };
    curves.extend([bound(allowed), bound(-allowed)]);
    let steps = Figure::graph(
        "steps",
        "What a longer step costs",
        "Height of the ball at 30 ms less the mean of seven codes, over the time step, on three beds of ours; the paper ran at \
         5·10⁻⁷ s.",
        [Axis::log("time step (s)"), Axis::linear("height less the codes' mean (mm)")],
        curves,
    );
    let mut curves = Vec::new();
    for (bed, name) in ["bed 1", "bed 2", "bed 3"].into_iter().enumerate() {
        let mut points = Vec::new();
        for softer in SOFTER {
            points.extend(off(&with_steel(softer)[bed])?.map(|off| (softer.1, off)));
        }
        points.extend(off(&at(AT)[bed])?.map(|off| (STEEL, off)));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        curves.push(Curve::new(name, Stroke::MarkedLine, points));
    }
    let steel = Figure::graph(
        "steel",
        "What a softer steel costs",
        "Height of the ball at 30 ms less the mean of seven codes, over Young's modulus of the steel of ball and walls, at a \
         step of 2·10⁻⁶ s; the paper has 210 GPa.",
        [Axis::log("Young's modulus of steel (GPa)"), Axis::linear("height less the codes' mean (mm)")],
        curves,
    );
    Ok(vec![steps, steel])
}
