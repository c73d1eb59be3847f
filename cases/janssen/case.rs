//! Janssen's silo: floor and side wall each carry a part of the weight of a column of spheres.

mod column;

use crate::rows::bulk;
use crate::rows::draws::apart;
use crate::rows::programs::row;
use column::{COLUMN, STEADY, side};
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::{BLOCKS, difference};

const LEVELS: &[Level] = &[time_step("dt=6e-4 s", 6e-4), time_step("dt=3e-4 s", 3e-4)];

pub(crate) static CASE: Case = crate::heads::JANSSEN.with(LEVELS, 0, &claims).drawn_by(figures);

const JANSSEN: Source =
    Source::Derived("dσ/dx = w/A − (4/D) μ K σ, with μ K from the middle of the column (derivation)");

/// Table of results for fillings with other random seeds, computed by `examples/seeds.rs`.
const PACKINGS: &str = include_str!("packings.csv");

/// Variants, each with the friction coefficient of its side wall.
const SIDES: [(&str, &str); 2] = [(PLAIN, ".5"), ("half", ".25")];

fn run(variant: &'static str, solver: &'static str) -> Run {
    Run::new(variant, solver, LEVELS[0].resolution).read_by(COLUMN).long().kept()
}

/// Sets the friction coefficient of the side wall.
fn side_friction(scene: &mut Scene, friction: f64) {
    let count = scene.materials.len();
    if let Some(place) = scene.materials.iter().position(|name| name == "side") {
        let at_side = |at: &usize| at / count == place || at % count == place;
        for at in (0..count * count).filter(at_side) {
            if let Some(law) = &mut scene.laws[at] {
                law.friction = friction;
            }
        }
    }
}

/// Returns the friction coefficient of the side wall.
fn friction(scene: &Scene) -> f64 {
    let place = |name: &str| scene.materials.iter().position(|known| known == name).map(|place| place as u16);
    let law = place("side").zip(place("grain")).and_then(|(side, grain)| scene.law(side, grain));
    law.map_or(f64::NAN, |law| law.friction)
}

fn weight(scene: &Scene) -> f64 {
    scene.grains.iter().map(|grain| grain.mass).sum::<f64>() * scene.gravity.norm()
}

/// Returns the samples of a column during the steady descent.
fn descending(done: &FinishedRun, name: &str) -> Result<Vec<f64>, MissingData> {
    let values = samples(done, name)?.into_iter().filter(|(time, _)| *time >= STEADY);
    let values: Vec<f64> = values.map(|(_, value)| value).collect();
    if values.is_empty() { Err(MissingData(format!("samples of `{name}`"))) } else { Ok(values) }
}

/// Returns the mean of a column during the steady descent.
fn steady(done: &FinishedRun, name: &str) -> Result<f64, MissingData> {
    Ok(mean(&descending(done, name)?))
}

/// Returns the fraction of the weight that the floor carries, averaged over the steady descent.
fn on_floor(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(-steady(done, "floor.force_z")? / weight(&done.scene))
}

/// Returns the height of the filling (d), from the middle heights of the slices and the weight per height in each
/// slice. The height is the total weight divided by the largest weight per height.
fn top(heights: &[f64], weights: &[f64]) -> f64 {
    let slice = 2.0 * heights.first().copied().unwrap_or(f64::NAN);
    weights.iter().sum::<f64>() * slice / weights.iter().copied().fold(0.0, f64::max)
}

/// Means of stresses and of the weight per height over the slices in the middle of the column.
struct MiddleMeans {
    vertical: f64,
    normal: f64,
    shear: f64,
    weight: f64,
}

impl MiddleMeans {
    /// Averages over the slices between a quarter and three quarters of the height of the filling.
    fn from_run(done: &FinishedRun) -> Result<Self, MissingData> {
        let column = |name: &str| done.column_of("slices", name);
        let (heights, weights) = (column("height")?, column("weight")?);
        let top = top(heights, weights);
        let inside = |height: &f64| (0.25 * top..0.75 * top).contains(height);
        let over = |name: &str| -> Result<f64, MissingData> {
            let values = heights.iter().zip(column(name)?).filter(|(height, _)| inside(height));
            let values: Vec<f64> = values.map(|(_, value)| *value).collect();
            if values.is_empty() { Err("slices in the middle".into()) } else { Ok(mean(&values)) }
        };
        Ok(Self {
            vertical: over("vertical")?,
            normal: over("normal")?,
            shear: over("shear")?,
            weight: over("weight")?,
        })
    }

    /// Returns the fraction of the weight that the floor carries if the shear stress on the side is `ratio` times the
    /// vertical stress: (λ/H)(1 − e^(−H/λ)) with the height H of the filling, the diameter D and λ = D/(4 ratio).
    fn left_over(&self, scene: &Scene, ratio: f64) -> f64 {
        let (_, _, radius) = side(scene);
        let (length, height) = (2.0 * radius / (4.0 * ratio), weight(scene) / self.weight);
        length / height * (1.0 - (-height / length).exp())
    }
}

fn claims() -> Vec<Claim> {
    let mut all = vec![balance(), smooth(), mobilised()];
    for (variant, friction) in SIDES {
        all.push(law(variant, friction));
        all.push(beside(variant, friction));
    }
    all.push(saturates());
    let runs = ["dem:lammps", "lammps"].map(|solver| Run::new("beginning", solver, LEVELS[0].resolution));
    all.push(bulk::beginning("position of a grain of the column over .12 √(d/g), worst", runs));
    all
}

/// Returns the tolerance of a mean over the steady descent.
fn known() -> Tolerance {
    one_interval("in units of half the 99 % confidence interval of the mean, from the means over 8 blocks of time")
}

/// Compares a sum of forces with the weight. The sum is divided by the weight and averaged over the steady descent, so
/// the expected value is 1. The error is in units of half the confidence interval of the mean.
fn all_borne(done: &FinishedRun, columns: &[&str]) -> Result<Measurement, MissingData> {
    let weight = weight(&done.scene);
    let mut borne = Vec::new();
    for name in columns {
        let forces = descending(done, name)?;
        borne.resize(forces.len(), 0.0);
        borne.iter_mut().zip(forces).for_each(|(borne, force)| *borne -= force / weight);
    }
    let estimate = difference(&vec![1.0; borne.len()], &borne, BLOCKS);
    let estimate = estimate.ok_or_else(|| format!("{BLOCKS} samples of {columns:?}"))?;
    Ok(Measurement::new(estimate.second, estimate.first, estimate.half_width))
}

fn balance() -> Claim {
    claim("weight that floor and side bear, over the weight", "1")
        .run(run(PLAIN, "dem"))
        .holds("momentum of the column, which descends at one speed", |done| {
            all_borne(&done[0], &["floor.force_z", "side.force_z"])
        })
        .within(known())
        .refuses(Control::scene("gravity 1 % larger", |scene| scene.gravity *= 1.01))
}

fn smooth() -> Claim {
    claim("part of the weight on the floor, smooth side", "1")
        .run(run("smooth", "dem"))
        .equals(Source::Derived("a side without friction carries no load"), |done| {
            all_borne(&done[0], &["floor.force_z"])
        })
        .within(known())
        .refuses(Control::scene("a friction of .02 at the side", |scene| side_friction(scene, 0.02)))
}

fn mobilised() -> Claim {
    claim("part of the friction of the side that is at work half-way up, friction .25", "1")
        .run(run("half", "dem"))
        .at_most(
            1.0,
            Source::Derived("Coulomb: sliding grains transfer μ times the normal force, rolling grains less"),
            |done| {
                let middle = MiddleMeans::from_run(&done[0])?;
                Ok(middle.shear / (friction(&done[0].scene) * middle.normal))
            },
        )
        .within(exactly("the limit itself"))
        .refuses(twice())
}

fn twice() -> Control {
    Control::misread("the friction of the side counted twice", |tables| {
        for table in tables {
            if let Some(place) = table.columns.iter().position(|column| column == "shear") {
                table.values[place].iter_mut().for_each(|shear| *shear *= 2.0);
            }
        }
    })
}

/// Returns the claim that the load on the floor follows Janssen's law with the measured mobilised friction. The
/// friction is measured, because grains not only slide but also roll along the side wall.
fn law(variant: &'static str, about: &str) -> Claim {
    claim(format!("part of the weight on the floor, friction {about} at the side"), "1")
        .run(run(variant, "dem"))
        .equals(JANSSEN, |done| {
            let middle = MiddleMeans::from_run(&done[0])?;
            let expected = middle.left_over(&done[0].scene, middle.shear / middle.vertical);
            Ok(Measurement::relative(on_floor(&done[0])?, expected))
        })
        .within(required(0.1, "required in advance: K is constant in the law but differs at the ends of the column"))
        .refuses(twice())
}

fn saturates() -> Claim {
    claim("vertical stress a quarter up over that half-way up", "1")
        .run(run(PLAIN, "dem"))
        .at_most(
            1.35,
            Source::Derived(
                "(1 − e^(−3H/4λ))/(1 − e^(−H/2λ)) < 1.35 for H > λ; 1.5 if it is proportional to the depth",
            ),
            |done| {
                let column = |name: &str| done[0].column_of("slices", name);
                let (heights, stress, weights) = (column("height")?, column("vertical")?, column("weight")?);
                let top = top(heights, weights);
                let at = |part: f64| {
                    let near = |(_, height): &(usize, &f64)| (*height - part * top).abs();
                    let place =
                        heights.iter().enumerate().min_by(|a, b| near(a).total_cmp(&near(b))).map(|(place, _)| place);
                    place.map_or(f64::NAN, |place| stress[place])
                };
                Ok(at(0.25) / at(0.5))
            },
        )
        .within(exactly("the law gives 1.341 at H = λ, and less in a deeper column"))
        .refuses(Control::scene("a smooth side", |scene| side_friction(scene, 0.0)))
}

fn beside(variant: &'static str, about: &str) -> Claim {
    let quantity = format!("part of the weight on the floor, friction {about} at the side");
    let because = "a filling is a random sample: 99 % interval of the difference of two fillings, from five seeds";
    let allowed = computed(apart(PACKINGS, &quantity), because);
    let control = Control::ours("a smooth side in ours", |scene| side_friction(scene, 0.0));
    let run = |solver| Run::new(variant, solver, LEVELS[0].resolution).long().kept();
    row(&quantity, "1", allowed, [run("dem:lammps"), run("lammps")], control, |done| {
        Ok(Measurement::new(on_floor(&done[0])?, on_floor(&done[1])?, 1.0))
    })
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let done = runner.run(&run(PLAIN, "dem"))?;
    Ok(profile(&done).into_iter().collect())
}

fn profile(done: &FinishedRun) -> Option<Figure> {
    let middle = MiddleMeans::from_run(done).ok()?;
    let column = |name: &str| done.column_of("slices", name).ok();
    let (heights, vertical) = (column("height")?, column("vertical")?);
    let (_, _, radius) = side(&done.scene);
    let (area, height) = (PI * radius * radius, weight(&done.scene) / middle.weight);
    let length = 2.0 * radius / (4.0 * middle.shear / middle.vertical);
    let law = |up: f64| middle.weight / area * length * (1.0 - (-(height - up) / length).exp());
    let weighs = |up: f64| middle.weight / area * (height - up);
    let measured = heights.iter().zip(vertical).filter(|(up, _)| **up < height).map(|(&up, &stress)| (up, stress));
    let caption = "Vertical stress in the descending column, averaged over its cross-section and time (markers). \
                   Janssen's law (dashes) uses the wall friction and the stress ratio measured at half the height. \
                   The solid line is the weight of the column above.";
    Some(Figure::graph(
        "profile",
        "Vertical stress over the height",
        caption,
        [Axis::linear("height over the floor (d)"), Axis::linear("vertical stress (m g/d²)")],
        vec![
            Curve::new("dem", Stroke::Markers, measured.collect()),
            Curve::new("Janssen", Stroke::Dashed, heights_of(height).map(|up| (up, law(up))).collect()),
            Curve::new("weight above", Stroke::Line, heights_of(height).map(|up| (up, weighs(up))).collect()),
        ],
    ))
}

/// Returns 101 equally spaced heights from the floor to the top.
fn heights_of(top: f64) -> impl Iterator<Item = f64> {
    (0..=100).map(move |part| top * f64::from(part) / 100.0)
}
