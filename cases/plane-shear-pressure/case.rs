//! Plane shear of discs under a lid with a prescribed pressure. The claims are about friction and packing fraction
//! against the inertial number.

mod bulk;

use crate::rows;
use crate::rows::draws::{apart, mean_of};
use crate::rows::programs::row;
use bulk::BULK;
use grainbench_harness::prelude::*;
use grainbench_scene::columns::{Chosen, Columns};
use grainbench_scene::scene::Piston;

const LEVELS: &[Level] = &[time_step("dt=2e-3 s", 2e-3), time_step("dt=1e-3 s", 1e-3)];

pub(crate) static CASE: Case = crate::heads::PLANE_SHEAR_PRESSURE.with(LEVELS, 0, &claims).drawn_by(figures);

/// Variants, each with its approximate inertial number.
const RATES: [(&str, &str); 5] =
    [("i-.003", ".003"), ("i-.01", ".01"), ("i-.03", ".03"), ("i-.1", ".1"), ("i-.3", ".3")];

/// Table of results for packings with other random seeds, computed by `examples/seeds.rs`.
const PACKINGS: &str = include_str!("packings.csv");

/// Reason for the tolerances.
const BECAUSE: &str =
    "a sheared packing is a random sample: 99 % interval of the difference of two packings, from four seeds";

/// Fraction of the run after which the flow is steady in the middle of the layer (derivation).
const STEADY: f64 = 0.25;

/// Factor by which the pressure of the lid is increased in the comparison runs. The wall speed is larger by the square
/// root of this factor, so that the inertial number is unchanged.
const PRESSED: f64 = 4.0;

fn run(variant: &'static str, solver: &'static str) -> Run {
    Run::new(variant, solver, LEVELS[0].resolution).read_by(BULK).long().kept()
}

/// Returns our run, which records the grains' stress averaged over the time between snapshots.
fn ours(variant: &'static str) -> Run {
    run(variant, "dem").adjusted("mean stress", average)
}

fn average(scene: &mut Scene) {
    scene.columns = Columns { chosen: vec![Chosen::Contacts, Chosen::MeanVirial], digits: None, mean_every: 10 };
}

fn pressed(variant: &'static str) -> Run {
    run(variant, "dem").adjusted("four times the pressure, twice the speed", |scene| {
        average(scene);
        press(scene, PRESSED);
        hasten(scene, PRESSED.sqrt());
        // The quantities come from snapshots, so the scene needs no probes.
        scene.probes.clear();
        if let Duration::Seconds(time) = &mut scene.duration {
            *time /= PRESSED.sqrt();
        }
        if let Sampling::Seconds(every) = &mut scene.sampling {
            *every /= PRESSED.sqrt();
        }
    })
}

fn pistons(scene: &mut Scene) -> impl Iterator<Item = &mut Piston> {
    scene.walls.iter_mut().filter_map(|wall| wall.piston.as_mut())
}

fn press(scene: &mut Scene, times: f64) {
    pistons(scene).for_each(|piston| piston.force *= times);
}

fn hasten(scene: &mut Scene, times: f64) {
    scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases).for_each(|phase| phase.velocity *= times);
}

/// Returns the pressure of the lid (N/m).
fn pressure(scene: &Scene) -> f64 {
    let force: f64 = scene.walls.iter().filter_map(|wall| wall.piston).map(|piston| piston.force).sum();
    force / width(scene)
}

fn width(scene: &Scene) -> f64 {
    scene.domain.map_or(f64::NAN, |domain| domain.high.x - domain.low.x)
}

/// Returns the mean of a bulk quantity over the steady flow.
fn bulk(done: &FinishedRun, name: &str) -> Result<f64, MissingData> {
    let (times, values) = (done.column_of("bulk", "time")?, done.column_of("bulk", name)?);
    let from = STEADY * times.last().copied().unwrap_or(0.0);
    Ok(mean(times, values, from).ok_or_else(|| format!("column `{name}` of the bulk"))?)
}

/// Returns the mean of a column of the series over the steady flow.
fn series(done: &FinishedRun, name: &str) -> Result<f64, MissingData> {
    let times = &done.series().time;
    let from = STEADY * times.last().copied().unwrap_or(0.0);
    Ok(mean(times, done.column(name)?, from).ok_or_else(|| format!("samples of `{name}`"))?)
}

/// Returns the mean of the finite values from the time `from` (s) on. A value is not finite if a program outputs no
/// contacts at this step. `None` if less than 98 % of the values are finite.
fn mean(times: &[f64], values: &[f64], from: f64) -> Option<f64> {
    let steady: Vec<f64> =
        times.iter().zip(values).filter(|(time, _)| **time >= from).map(|(_, value)| *value).collect();
    let finite: Vec<f64> = steady.iter().copied().filter(|value| value.is_finite()).collect();
    let enough = !finite.is_empty() && 50 * finite.len() >= 49 * steady.len();
    enough.then(|| finite.iter().sum::<f64>() / finite.len() as f64)
}

/// Returns the ratio of shear to normal stress in the bulk, averaged over the steady flow.
fn friction(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(bulk(done, "shear")? / bulk(done, "normal")?)
}

fn packing(done: &FinishedRun) -> Result<f64, MissingData> {
    bulk(done, "packing")
}

/// Returns I = γ̇ √(m/P) of the bulk, with the mass of the disc of mean diameter, which is 1.
fn inertia(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(bulk(done, "rate")? / pressure(&done.scene).sqrt())
}

/// Returns the mean shear stress on both walls (N/m).
fn of_walls(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(0.5 * (series(done, "on-bottom.force_x")? - series(done, "on-lid.force_x")?) / width(&done.scene))
}

/// Name of a quantity and the function that reads it from a run.
type Quantity = (&'static str, RunReader);

const FRICTION: Quantity = ("friction σ_xy/σ_yy", friction);
const PACKING: Quantity = ("packing fraction", packing);
const INERTIA: Quantity = ("inertial number", inertia);

fn claims() -> Vec<Claim> {
    let mut all = Vec::new();
    for (variant, about) in RATES {
        all.push(normal(variant, about));
        all.push(shear(variant, about));
        all.extend([FRICTION, PACKING, INERTIA].map(|quantity| scales(variant, about, quantity)));
        all.extend([FRICTION, PACKING].map(|quantity| beside(variant, about, quantity)));
    }
    let runs = ["dem:lammps", "lammps"].map(|solver| Run::new("beginning", solver, LEVELS[0].resolution));
    all.push(rows::bulk::beginning("position of a disc over .4 √(m/P), worst", runs));
    all
}

fn normal(variant: &'static str, about: &str) -> Claim {
    let quantity = format!("normal stress of the bulk over the pressure of the lid, I ≈ {about}");
    let allowed = apart(PACKINGS, &quantity);
    claim(quantity, "1")
        .run(ours(variant))
        .holds("momentum across the layer: the mean of σ_yy, with its momentum flux, is that of the lid", |done| {
            Ok(Measurement::relative(bulk(&done[0], "normal")? / pressure(&done[0].scene), 1.0))
        })
        .within(computed(allowed, BECAUSE))
        .refuses(Control::scene("a lid that is pressed by an eighth less", |scene| press(scene, 0.875)))
}

fn shear(variant: &'static str, about: &str) -> Claim {
    // Reverses the part of the shear stress that comes from tangential forces, for a negative control. In fast flow,
    // its omission would change the result only by the difference of two packings. The reversal changes the result by
    // twice as much.
    fn turned(tables: &mut [Table]) {
        for table in tables {
            let part = |name: &str| table.column(name).map(<[f64]>::to_vec);
            let (Some(bare), Some(instant), Some(shear)) = (part("frictionless"), part("instant"), part("shear"))
            else {
                return;
            };
            let sum = |values: &[f64]| values.iter().filter(|value| value.is_finite()).sum::<f64>();
            let share = 2.0 * sum(&bare) / sum(&instant) - 1.0;
            if let Some(place) = table.columns.iter().position(|column| column == "shear") {
                table.values[place] = shear.iter().map(|shear| shear * share).collect();
            }
        }
    }
    let quantity = format!("shear stress of the bulk over that of the walls, I ≈ {about}");
    let allowed = apart(PACKINGS, &quantity);
    claim(quantity, "1")
        .run(ours(variant))
        .holds("momentum along the layer: the mean of σ_xy, with its momentum flux, is that of the walls", |done| {
            Ok(Measurement::relative(bulk(&done[0], "shear")? / of_walls(&done[0])?, 1.0))
        })
        .within(computed(allowed, BECAUSE))
        .refuses(Control::misread("tangential forces with the wrong sign in the stress", turned))
}

fn scales(variant: &'static str, about: &str, (name, read): Quantity) -> Claim {
    const LAW: &str =
        "the run at four times the pressure and twice the speed: rigid grains depend on I alone (derivation)";
    let quantity = format!("{name}, I ≈ {about}");
    let (allowed, scale) = of_draws(&quantity);
    claim(quantity, "1")
        .runs([ours(variant).aside(), pressed(variant)])
        .agrees(Source::Ourselves(LAW), move |done| Ok(Measurement::new(read(&done[0])?, read(&done[1])?, scale)))
        .within(allowed)
        .refuses(wrongly_pressed(about.starts_with(".0"), name == INERTIA.0))
}

/// Returns a negative control of [`scales`], which changes only the run at four times the pressure. In fast flow, the
/// wall speed of this run is not increased. In slow flow, friction and packing fraction hardly depend on the inertial
/// number, so this run has no friction between grains. The inertial number of slow flow has a spread over packings of
/// half its value, so its control has four times this number, by a higher wall speed.
fn wrongly_pressed(is_slow: bool, is_inertia: bool) -> Control {
    let is_pressed = |scene: &mut Scene| pistons(scene).any(|piston| piston.force > 40.0);
    if is_slow && is_inertia {
        return Control::scene("four times the pressure at eight times the speed", move |scene| {
            if is_pressed(scene) {
                hasten(scene, 8.0 / PRESSED.sqrt());
            }
        });
    }
    if is_slow {
        return Control::scene("friction 0 where the pressure is four times", move |scene| {
            if is_pressed(scene) {
                scene.change_laws(|law| law.friction = if law.friction > 1.0 { law.friction } else { 0.0 });
            }
        });
    }
    Control::scene("four times the pressure at the same speed", move |scene| {
        if is_pressed(scene) {
            hasten(scene, 1.0 / PRESSED.sqrt());
        }
    })
}

fn beside(variant: &'static str, about: &str, (name, read): Quantity) -> Claim {
    let quantity = format!("{name}, I ≈ {about}");
    let (allowed, scale) = of_draws(&quantity);
    let control = Control::our_contact_law("friction 0 between grains in ours", |law| {
        law.friction = if law.friction > 1.0 { law.friction } else { 0.0 }
    });
    row(&quantity, "1", allowed, [run(variant, "dem:lammps"), run(variant, "lammps")], control, move |done| {
        Ok(Measurement::new(read(&done[0])?, read(&done[1])?, scale))
    })
}

/// Returns mean and tolerance of a quantity from several packings. The tolerance is in units of the mean.
fn of_draws(quantity: &str) -> (Tolerance, f64) {
    let mean = mean_of(PACKINGS, quantity);
    (computed(apart(PACKINGS, quantity) / mean, format!("{BECAUSE}; in units of the mean of the packings")), mean)
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves: [Vec<Curve>; 2] = [Vec::new(), Vec::new()];
    for (solver, stroke) in [("dem", Stroke::MarkedLine), ("lammps", Stroke::Markers)] {
        let solver_run = |variant| if solver == "dem" { ours(variant) } else { run(variant, solver) };
        let mut points: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
        for (variant, _) in RATES {
            let done = match runner.run(&solver_run(variant)) {
                Ok(done) => done,
                Err(RunError::NotAvailable { .. }) => continue,
                Err(error) => return Err(error),
            };
            for (points, solver_run) in points.iter_mut().zip([friction, packing]) {
                if let (Ok(rate), Ok(value)) = (inertia(&done), solver_run(&done)) {
                    points.push((rate, value));
                }
            }
        }
        for (curves, points) in curves.iter_mut().zip(points) {
            curves.push(Curve::new(solver, stroke, points));
        }
    }
    let [of_friction, of_packing] = curves;
    let x = || Axis::log("inertial number I (1)");
    let caption = "Averages over the last three quarters of each run, under a lid with a given pressure. Our solver \
                   and LAMMPS have the same initial state.";
    Ok(vec![
        Figure::graph(
            "friction",
            "Friction over the inertial number",
            caption,
            [x(), Axis::linear("friction σ_xy/σ_yy (1)")],
            of_friction,
        ),
        Figure::graph(
            "packing",
            "Packing fraction over the inertial number",
            caption,
            [x(), Axis::linear("packing fraction φ (1)")],
            of_packing,
        ),
    ])
}
