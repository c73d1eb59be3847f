//! Pictures of the grains: plastic grains next to grains on springs, at equal shear.

use super::measures::at;
use super::{CHAINS, FRAMES, springs, yielding};
use grainbench_fields::element_picture;
use grainbench_fields::picture::{Shot, film, pictures};
use grainbench_fields::quantity::Quantity;
use grainbench_harness::prelude::*;
use grainbench_solver::record::Owner;

/// Mean shears at which the paper shows displacement profiles.
pub(super) const PROFILES: [f64; 3] = [0.25, 0.5, 0.75];
const PIXELS: u32 = 400;
const FILM_PIXELS: u32 = 300;
/// Range of rotations in the colour scale (rad).
const TURNED: (f64, f64) = (-2.0, 2.0);

/// Size of the averaging cells (m).
const CELL: f64 = 2e-4;
/// Colour range of pressure (Pa).
const PRESSURES: (f64, f64) = (0.0, 1e8);
/// Colour range of the shear rate (1/s).
const SHEAR_RATES: (f64, f64) = (0.0, 2e5);

/// A slab with a description of its grains.
pub(super) type Slab = (&'static str, FinishedRun);

/// Returns the slab of grains on springs, after slabs of plastic grains with and without slip in the long tier.
pub(super) fn slabs(runner: &Runner) -> Result<Vec<Slab>, RunError> {
    let mut slabs = Vec::new();
    if runner.is_thorough() {
        slabs.push(("yielding, μ = 0.3", runner.run(&yielding::whole("seed-1", "mpm"))?));
        slabs.push(("yielding, no slip", runner.run(&yielding::whole("seed-1", "mpm:no-slip"))?));
    }
    slabs.push(("on springs, μ = 0.3", runner.run(&springs::slab())?));
    Ok(slabs)
}

/// Returns a row of panels for each slab, with one panel for each mean shear.
fn shots<'a>(slabs: &[&'a Slab], shears: &[f64]) -> Vec<Shot<'a>> {
    let shot = |slab: &&'a Slab, shear: f64| {
        let (words, done) = *slab;
        Some(Shot::new(format!("{words}, {:.0} % shear", 100.0 * shear), at(done, shear).ok()?))
    };
    slabs.iter().flat_map(|slab| shears.iter().filter_map(move |&shear| shot(slab, shear))).collect()
}

/// Returns snapshots at equal steps of shear, with their mean shear.
fn frames(done: &FinishedRun) -> Vec<(f64, &Snapshot)> {
    let shears = (0..=FRAMES + 1).map(|frame| 0.8 * f64::from(frame) / f64::from(FRAMES + 1));
    shears.filter_map(|shear| Some((shear, at(done, shear).ok()?))).collect()
}

/// Returns true if grains of a slab can slip.
pub(super) fn has_friction((words, _): &Slab) -> bool {
    !words.contains("no slip")
}

/// Returns a copy of the slab without the grains that have been pushed out between the cut grains at its sides.
fn within((words, done): &Slab) -> Slab {
    let mut record = Record::clone(&done.record);
    let [low, high] = done.scene.domain.map_or([0.0; 2], |domain| [domain.low.x, domain.high.x]);
    for snapshot in &mut record.snapshots {
        let is_out = |grain: &GrainState| {
            let reach = 0.5 * grain.radius;
            grain.position.x < low - reach || grain.position.x > high + reach
        };
        let out: Vec<bool> = snapshot.grains.iter().map(is_out).collect();
        for (grain, _) in snapshot.grains.iter_mut().zip(&out).filter(|(_, out)| **out) {
            grain.position.x = f64::NAN;
        }
        snapshot.points.retain(|point| !matches!(point.owner, Owner::Grain(id) if out[id as usize - 1]));
    }
    (*words, FinishedRun::new(Arc::clone(&done.scene), Arc::new(record)))
}

pub(super) fn figures(all: &[Slab]) -> Vec<Figure> {
    let slabs: Vec<Slab> = all.iter().map(within).collect();
    let with_friction: Vec<&Slab> = slabs.iter().filter(|slab| has_friction(slab)).collect();
    let deformable: Vec<&Slab> = slabs.iter().filter(|(_, done)| has_points(done)).collect();
    let mut figures = vec![Figure::field(
        "rotation",
        "Rotation of each grain at three shears",
        "Rotation since the start. Grains of the two sides do not rotate. In the band at the moving side, neighbours \
         rotate in opposite directions like gears, because of friction. Grains pushed out through a side are not \
         shown. Rotations beyond 2 rad have the colours of 2 rad.",
        pictures(Quantity::Rotation, &shots(&with_friction, &PROFILES), PIXELS, Some(TURNED)),
    )];
    if !deformable.is_empty() {
        figures.push(Figure::field(
            "plastic-strain",
            "Plastic strain, with friction and without slip",
            "Fig. 6 of the paper: with friction, grains roll and slide and yield slightly at contacts; without slip \
             they are stretched and leave large voids. Both have the same scale.",
            pictures(Quantity::PlasticStrain, &shots(&deformable, &PROFILES), PIXELS, Some((0.0, 0.5))),
        ));
    }
    for slab in &with_friction {
        let name = if has_points(&slab.1) { "chains-yielding" } else { "chains-springs" };
        figures.push(Figure::field(
            name,
            &format!("Force chains at 63 and 71 % shear, grains {}", slab.0),
            "Difference of the principal stresses, as in Fig. 7 of the paper. Few grains carry the load. After a \
             further 8 % of shear, other grains carry it.",
            pictures(Quantity::StressDifference, &shots(&[slab], &CHAINS), PIXELS, None),
        ));
    }
    for slab in all.iter().filter(|slab| has_friction(slab)) {
        for shear in CHAINS {
            let Ok(snapshot) = at(&slab.1, shear) else { continue };
            let method = if has_points(&slab.1) { "yielding" } else { "springs" };
            figures.push(Figure::forces(
                &format!("forces-{method}-{:.0}", 100.0 * shear),
                &format!("Contact forces at {:.0} % shear, grains {}", 100.0 * shear, slab.0),
                "Each bar is along the force of a contact, and its width is proportional to the force.",
                force_plot(snapshot),
            ));
        }
    }
    figures.extend(coarse(all));
    figures.push(moving(&with_friction));
    figures
}

/// Returns figures of averages over cells at a shear of 0.5, defined equally for points and for grains.
fn coarse(slabs: &[Slab]) -> Vec<Figure> {
    const SHEAR: f64 = 0.5;
    let shots: Vec<element_picture::Shot<'_>> = slabs
        .iter()
        .filter_map(|(words, done)| Some(((*words).to_owned(), at(done, SHEAR).ok()?, done.scene.as_ref())))
        .collect();
    let figure = |name: &str, title: &str, caption: &str, quantity: &str, range: (f64, f64)| {
        let caption = format!(
            "{caption} Averages over squares of 200 µm at 50 % shear, over material points or over grains and their \
             contacts. Squares with too few of them are white. Values beyond the colour bar have the colour of its end."
        );
        Figure::field(name, title, &caption, element_picture::pictures(quantity, &shots, CELL, range))
    };
    vec![
        figure(
            "coarse-pressure",
            "Pressure",
            "Force chains carry the pressure from side to side.",
            "pressure",
            PRESSURES,
        ),
        figure("coarse-shear", "Rate of shear", "The slab flows where the rate is large.", "shear_rate", SHEAR_RATES),
        figure(
            "coarse-packing",
            "Packing fraction",
            "The slab has dilated where the packing fraction is small.",
            "packing_fraction",
            (0.7, 0.95),
        ),
    ]
}

/// Returns an animation with grains coloured by rotation.
fn moving(slabs: &[&Slab]) -> Figure {
    let clock: Vec<f64> = frames(&slabs[0].1).into_iter().map(|(shear, _)| shear).collect();
    let shots: Vec<Shot<'_>> = slabs
        .iter()
        .map(|(words, done)| Shot {
            title: (*words).to_owned(),
            frames: frames(done).into_iter().map(|(_, snapshot)| snapshot).collect(),
        })
        .collect();
    Figure::field(
        "film",
        "Rotation of the grains during shear",
        "Animation of the grains, coloured by rotation. The right side moves up. Grains that leave at the top enter \
         at the bottom.",
        film(Quantity::Rotation, &shots, ("mean shear", &clock), FILM_PIXELS, Some(TURNED)),
    )
}

fn has_points(done: &FinishedRun) -> bool {
    done.record.snapshots.iter().any(|snapshot| !snapshot.points.is_empty())
}
