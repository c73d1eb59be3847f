//! Discharge of a silo through two orifices, compared with the rates of the round robin of bulk processes.

use crate::rows::bulk;
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;
use grainbench_reference::round_robin::{EARLY, SILO, STEADY, course};

const LEVELS: &[Level] = &[time_step("dt=6e-6 s", 6e-6), time_step("dt=3e-6 s", 3e-6)];

pub(crate) static CASE: Case = crate::heads::SILO_DISCHARGE.with(LEVELS, 0, &claims).drawn_by(figures);

/// Variant with the small orifice.
const SMALL: &str = "small";
/// Variant with a lower filling, for the effect of the time step.
const LOW: &str = "low";
/// Variants with the lower filling, from five random seeds.
const FILLINGS: [&str; 5] = [LOW, "low-2", "low-3", "low-4", "low-5"];
/// Time at which discharged grains are counted (s of flow).
const COUNTED: f64 = 2.0;
/// Times between which both orifices are compared (s of flow).
const BOTH: [f64; 2] = [0.5, 2.0];
/// Largest relative error of rates.
const ALLOWED: f64 = 0.05;
const BECAUSE: &str = "required in advance: 5 %, the difference between codes that the paper states";

fn of_paper(variant: &'static str) -> Run {
    Run::new(variant, "dem:liggghts", LEVELS[0].resolution).paper_size().kept()
}

fn of_filling(variant: &'static str) -> Run {
    Run::new(variant, "dem:liggghts", LEVELS[0].resolution).long().kept()
}

/// Returns the time at which the plug is removed and the flow begins (s).
fn begins(scene: &Scene) -> Option<f64> {
    scene.walls.iter().find_map(|wall| wall.until)
}

/// Largest time by which a sample may precede the requested time (s): more than one step, negligible in rates.
const SLACK: f64 = 1e-5;

/// Returns the number of remaining grains at a time since the plug was removed (s), interpolated between samples.
fn left(done: &FinishedRun, time: f64) -> Result<f64, MissingData> {
    let begun = begins(&done.scene).ok_or("plug")?;
    let (times, counts) = (&done.series().time, done.column("grains.present")?);
    let after = times.partition_point(|sampled| sampled - begun < time - SLACK);
    if after == 0 || after == times.len() {
        return Err(MissingData(format!("count at {time} s of flow")));
    }
    let part = (time + begun - times[after - 1]) / (times[after] - times[after - 1]);
    Ok(counts[after - 1] + part * (counts[after] - counts[after - 1]))
}

/// Returns the discharge rate in thousands of grains per second, between two times of flow.
fn rate(done: &FinishedRun, [from, to]: [f64; 2]) -> Result<f64, MissingData> {
    Ok((left(done, from)? - left(done, to)?) / (to - from) / 1e3)
}

/// Returns the discharge rate of steady flow in thousands of grains per second. If the run ends before the end of this
/// interval, the rate is evaluated up to the end of the run.
fn steady(done: &FinishedRun) -> Result<f64, MissingData> {
    let end = done.series().time.last().copied().unwrap_or_default() - begins(&done.scene).unwrap_or_default();
    rate(done, [STEADY[0], STEADY[1].min(end)])
}

fn claims() -> Vec<Claim> {
    let other = || Control::variant("the other orifice", SMALL);
    let mut claims = vec![
        near(
            claim("rate from .5 to 3.5 s, large orifice", "1000/s").run(of_paper(PLAIN)),
            dosta::SILO_LARGE_RATE,
            |done| steady(&done[0]),
        )
        .refuses(other()),
        near(claim("grains out in 2 s, large orifice", "1000").run(of_paper(PLAIN)), dosta::SILO_LARGE_OUT_2, |done| {
            Ok((done[0].column("grains.present")?[0] - left(&done[0], COUNTED)?) / 1e3)
        })
        .refuses(other()),
        near(
            claim("rate from .5 to 2 s, small orifice", "1000/s").run(of_paper(SMALL)),
            dosta::SILO_SMALL_RATE,
            |done| steady(&done[0]),
        )
        .refuses(Control::variant("the other orifice", PLAIN)),
        claim("rate of the large orifice over that of the small one, .5 to 2 s", "1")
            .runs([of_paper(PLAIN), of_paper(SMALL)])
            .equals_cited(dosta::SILO_QUOTED_RATIO, 1.0, |done| Ok(rate(&done[0], BOTH)? / rate(&done[1], BOTH)?))
            .within(required(0.1, "required in advance"))
            .refuses(Control::variant("the large orifice for both", PLAIN)),
        near(
            claim("rate from .2 to .8 s, 40,000 spheres", "1000/s").run(of_filling(LOW)),
            dosta::SILO_LARGE_EARLY,
            |done| rate(&done[0], EARLY),
        )
        .refuses(smooth()),
        bulk::of_packings(
            ("rate from .2 to .8 s, mean of five fillings of 40,000 spheres".to_owned(), "1000/s"),
            FILLINGS.map(of_filling).to_vec(),
            (dosta::SILO_LARGE_EARLY, dosta::SILO_LARGE_EARLY_HALF),
            |done| rate(done, EARLY),
            "in units of 2 √(s_code² + s_fill² (1/5 + 1)), with s_code from two codes on one filling and s_fill \
             between our fillings; fixed before the second run",
        )
        .refuses(smooth()),
        claim("rate from .2 to .8 s, 40,000 spheres, with a step of 6e-6 s for 3e-6 s", "1000/s")
            .runs([of_filling(LOW), of_filling(LOW).at(LEVELS[1].resolution).aside()])
            .agrees(Source::Ourselves("half the time step"), |done| {
                let fine = rate(&done[1], EARLY)?;
                Ok(Measurement::relative(rate(&done[0], EARLY)?, fine))
            })
            .within(judged(0.01, "a fifth of the tolerance of the rates"))
            .refuses(smooth()),
    ];
    let beginning = "position of a grain of a small silo over .6 ms, worst";
    claims.push(bulk::beginning(beginning, in_the_funnel("funnel-beginning", "dem:liggghts")));
    claims.extend(["dem:liggghts", "dem"].map(|ours| {
        let control = Control::our_contact_law("no friction in ours", |law| law.friction = 0.0);
        let runs = in_the_funnel("funnel", ours).map(Run::slow);
        let momentum = ("all.momentum_z", 0.03);
        bulk::mean("mean momentum of a small silo from .03 to .12 s", "kg m/s", momentum, runs, control)
    }));
    claims
}

fn in_the_funnel(variant: &'static str, ours: &'static str) -> [Run; 2] {
    [ours, "liggghts"].map(|solver| Run::new(variant, solver, LEVELS[0].resolution))
}

/// Returns the expectation that a quantity equals a published value within [`ALLOWED`].
fn near(
    quantity: grainbench_harness::claim::Quantity,
    cited: CitedNumber,
    value: impl RunsReader<f64>,
) -> ClaimWithTolerance {
    quantity.equals_cited(cited, cited.value, value).within(required(ALLOWED, BECAUSE))
}

/// Returns a negative control without friction between grains, with unchanged friction on steel.
fn smooth() -> Control {
    Control::scene("no friction between grains", |scene| {
        let Some(m1) = scene.materials.iter().position(|name| name == "m1") else { return };
        let place = m1 * scene.materials.len() + m1;
        if let Some(law) = &mut scene.laws[place] {
            law.friction = 0.0;
        }
    })
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let published = course(SILO).into_iter().map(|[time, mean, _]| (time, mean / 1e3)).collect();
    let small = |time: f64| (time, FILLED - dosta::SILO_SMALL_RATE.value * time);
    let mut curves = vec![
        Curve::new("large, LIGGGHTS and MUSEN", Stroke::Markers, published),
        Curve::new("small, rate of MUSEN", Stroke::Dashed, vec![small(0.0), small(2.0)]),
    ];
    let runs =
        [("large orifice", of_paper(PLAIN)), ("small orifice", of_paper(SMALL)), ("40,000 spheres", of_filling(LOW))];
    for (label, run) in runs {
        let done = runner.run(&run)?;
        let begun = begins(&done.scene).unwrap_or_default();
        let times = done.series().time.iter().map(|time| time - begun);
        let missing = FILLED - done.scene.grains.len() as f64 / 1e3;
        let counts = done.column("grains.present").unwrap_or_default().iter().map(|count| count / 1e3 + missing);
        let points = times.zip(counts).filter(|(time, _)| *time > -1e-9).collect();
        curves.push(Curve::new(label, Stroke::Line, points));
    }
    Ok(vec![Figure::graph(
        "left",
        "Number of grains in the silo",
        "Number of grains in the silo since the plug was removed. For the large orifice, markers are the mean of \
         LIGGGHTS and MUSEN (derived from repeated runs of Dosta et al. 2024). For the small orifice, the dashed \
         line has the rate of MUSEN from 0.5 to 2 s. The curve of 40,000 spheres is shifted up by 60,000.",
        [Axis::linear("time of flow (s)"), Axis::linear("grains left (thousands)")],
        curves,
    )])
}

/// Filling of the paper's silo, in thousands of grains.
const FILLED: f64 = 100.0;
