//! Two kinds of spheres in a rotating drum. The large drum starts from the published initial state if the user provides
//! its data file. A small drum starts from our own bed.

mod zones;

use crate::registry::made_of;
use crate::rows::bulk;
use crate::rows::programs::LIGGGHTS;
use crate::sources::literature::dosta_2024 as dosta;
use grainbench_harness::prelude::*;
use grainbench_reference::round_robin::{DRUM, DRUM_SCENE, course, read_start, start_in};
use std::path::Path;
use zones::{COUNTED, ZONES};

const LEVELS: &[Level] = &[time_step("dt=3e-6 s", 3e-6)];

pub(crate) static CASE: Case = crate::heads::DRUM_MIXING.with(LEVELS, 0, &claims).drawn_by(figures);

/// Drum of the paper with the published initial state.
static PUBLISHED: Data = Data {
    name: "published",
    needs: "it starts from the published initial state of Dosta et al. 2024 (doi 10.5281/zenodo.8252892), an `xyz` \
            file of 38,000 grains; `grainbench run drum-mixing --data DIR` reads it from the folder DIR",
    scene: published,
};

/// Time up to which runs with other time steps are compared (s).
const UNTIL: f64 = 0.5;
/// Drum of the paper up to the time [`UNTIL`].
static SHORTER: Data = Data {
    name: "published-half",
    needs: PUBLISHED.needs,
    scene: |folder| Ok(Scene { duration: Duration::Seconds(UNTIL), ..published(folder)? }),
};

/// Returns the scene of the drum with the initial state from a folder.
fn published(folder: &Path) -> Result<Scene, SceneDataError> {
    let start = start_in(folder).map_err(|error| SceneDataError::Wrong(format!("{}: {error}", folder.display())))?;
    let start = start.ok_or_else(|| {
        let expected = "expected the initial state of the drum, a file whose name ends in `.xyz`, found none";
        SceneDataError::Absent(format!("{}: {expected}", folder.display()))
    })?;
    let files = read_start(&start).map_err(|error| SceneDataError::Wrong(error.to_string()))?.files();
    let source = SceneSource::from_text("drum.toml", Path::new("."), DRUM_SCENE);
    made_of(&source, &files).map_err(SceneDataError::Wrong)
}

/// Tolerance up to 0.5 s, required beforehand, and its reason.
const EARLY: (f64, &str) = (0.005, "required in advance: .5 % relative to each code until .5 s");
/// Tolerance from 0.6 s to 1 s, required beforehand, and its reason.
const LATE: (f64, &str) = (0.01, "required in advance: 1 % relative to each code until 1 s");

fn claims() -> Vec<Claim> {
    let backwards = Control::scene("the other sense of rotation", |scene| {
        scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases).for_each(|phase| phase.spin = -phase.spin);
        scene.duration = Duration::Seconds(0.1);
    });
    let slippery = Control::scene("half the friction of the drum", |scene| {
        rub(scene, 0.5);
        scene.duration = Duration::Seconds(0.2);
    });
    let mut claims = vec![
        zone("M1 in zone 2 at .1 s", [0.1, 0.1], EARLY).refuses(backwards),
        zone("M1 in zone 2 at .2 s", [0.2, 0.2], EARLY).refuses(slippery),
        zone("M1 in zone 2 from .3 to .5 s, worst", [0.3, 0.5], EARLY).refuses(beside()),
        zone("M1 in zone 2 from .6 to 1 s, worst", [0.6, 1.0], LATE).refuses(beside()),
        // Rounding errors grow tenfold in about a hundred steps.
        bulk::beginning(
            "position of a grain of the bed over .3 ms, worst",
            LIGGGHTS.map(|solver| Run::new("beginning", solver, LEVELS[0].resolution)),
        ),
    ];
    let steps = [("half the step", 1.5e-6), ("a step longer by a millionth", 3.000_003e-6), ("twice the step", 6e-6)];
    claims.extend(steps.map(|(words, step)| with_step(words, step)));
    for ours in [LIGGGHTS[0], "dem"] {
        let run = |solver| Run::new(PLAIN, solver, LEVELS[0].resolution);
        // Each run takes two seconds, so the additional run of `dem` is in the standard tier.
        let both = || if ours == LIGGGHTS[0] { LIGGGHTS.map(run) } else { [run(ours).slow(), run(LIGGGHTS[1])] };
        // One control run serves both claims.
        let smooth = || Control::ours("no friction of the drum", |scene| rub(scene, 0.0));
        // The bed moves with the drum from 0.03 s on.
        let (turning, along) = (("all.angular_momentum_y", 0.03), ("all.momentum_x", 0.03));
        claims.push(bulk::mean("mean angular momentum from .03 to .06 s", "kg m²/s", turning, both(), smooth()));
        claims.push(bulk::mean("mean momentum along x from .03 to .06 s", "kg m/s", along, both(), smooth()));
    }
    claims
}

fn beside() -> Control {
    Control::misread("counted on the other side, x > 0", zones::on_the_other_side)
}

/// Multiplies the friction of all contacts with the drum (material `steel`).
fn rub(scene: &mut Scene, factor: f64) {
    let Some(steel) = scene.materials.iter().position(|name| name == "steel") else { return };
    let count = scene.materials.len();
    for (place, law) in scene.laws.iter_mut().enumerate() {
        if let Some(law) = law.as_mut().filter(|_| place / count == steel || place % count == steel) {
            law.friction *= factor;
        }
    }
}

fn of_paper() -> Run {
    Run::new(PLAIN, "dem:liggghts", LEVELS[0].resolution).from_data(&PUBLISHED).read_by(ZONES).long().kept()
}

/// Returns the claim on the effect of another time step (s) on the M1 spheres in zone 2. A step longer by a millionth
/// shows the effect of rounding.
fn with_step(words: &str, step: f64) -> Claim {
    let run = Run::new(PLAIN, "dem:liggghts", Resolution::TimeStep(step)).from_data(&SHORTER);
    claim(format!("M1 in zone 2 to .5 s with {words}, worst"), "1")
        .runs([run.read_by(ZONES).long().kept(), of_paper().aside()])
        .agrees(Source::Ourselves("the same with the step of the case"), |done| {
            let times = course(DRUM).into_iter().map(|[time, ..]| time).filter(|&time| time < UNTIL + 1e-9);
            Measurement::worst_read(
                times.map(|time| Ok(Measurement::relative(counted(&done[0], time)?, counted(&done[1], time)?))),
            )
        })
        .within(required(EARLY.0, "tolerance of a count relative to either code until .5 s"))
        .refuses(beside())
}

/// Returns the claim on the M1 spheres in zone 2: the largest relative difference from either code in an interval (s).
fn zone(quantity: &str, [from, to]: [f64; 2], (allowed, because): (f64, &str)) -> ClaimWithTolerance {
    claim(quantity, "1")
        .run(of_paper())
        .equals(Source::Printed(&dosta::WORK, "derived: repeated runs of LIGGGHTS and MUSEN"), move |done| {
            let rows = course(DRUM).into_iter().filter(|[time, ..]| (from - 1e-9..=to + 1e-9).contains(time));
            Measurement::worst_read(rows.map(|[time, mean, half]| {
                let count = counted(&done[0], time)?;
                let code = if count > mean { mean - half } else { mean + half };
                Ok(Measurement::relative(count, code))
            }))
        })
        .within(required(allowed, because))
}

/// Returns the number of M1 spheres in zone 2 at a time (s).
fn counted(done: &FinishedRun, time: f64) -> Result<f64, MissingData> {
    // Snapshots are taken at whole steps, so their times may differ slightly from the compared times.
    let place = done.column_of(zones::NAME, "time")?.iter().position(|at| (at - time).abs() < 1e-5);
    Ok(done.column_of(zones::NAME, COUNTED)?[place.ok_or_else(|| format!("count at {time} s"))?])
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut figures = Vec::new();
    match runner.run(&of_paper()) {
        Ok(done) => figures.push(of_zone(&done)),
        Err(RunError::NotAvailable { .. }) => {}
        Err(error) => return Err(error),
    }
    let mut curves = Vec::new();
    for (solver, stroke) in LIGGGHTS.into_iter().zip([Stroke::Line, Stroke::Dashed]) {
        // A solver has no curve if it is not installed and no run of it is stored.
        if let Ok(done) = runner.run(&Run::new(PLAIN, solver, LEVELS[0].resolution)) {
            let momentum = samples(&done, "all.angular_momentum_y").unwrap_or_default().into_iter();
            let points = momentum.map(|(time, value)| (time * 1e3, -value * 1e6));
            curves.push(Curve::new(solver, stroke, points.collect()));
        }
    }
    figures.push(Figure::graph(
        "taken-along",
        "Angular momentum of the bed in a rotating drum",
        "Angular momentum of the grains about the axis of the small drum, which rotates from the first step on. Our \
         solver is compared with LIGGGHTS.",
        [Axis::linear("time (ms)"), Axis::linear("angular momentum (10⁻⁶ kg m²/s)")],
        curves,
    ));
    Ok(figures)
}

fn of_zone(done: &FinishedRun) -> Figure {
    let zone_values = |name: &str| done.column_of(zones::NAME, name).unwrap_or_default();
    let ours = zone_values("time").iter().copied().zip(zone_values(COUNTED).iter().map(|count| count / 1e3)).collect();
    let codes = course(DRUM).into_iter().map(|[time, mean, _]| (time, mean / 1e3)).collect();
    Figure::graph(
        "zone-2",
        "M1 in zone 2",
        "M1 in zone 2 (x < 0, z < 0) over time, from the published start, and the mean of LIGGGHTS and MUSEN (derived \
         from repeated runs, Dosta et al. 2024), which differ by at most .9 %.",
        [Axis::linear("time (s)"), Axis::linear("M1 in zone 2 (thousands)")],
        vec![
            Curve::new("dem:liggghts", Stroke::MarkedLine, ours),
            Curve::new("LIGGGHTS and MUSEN", Stroke::Markers, codes),
        ],
    )
}
