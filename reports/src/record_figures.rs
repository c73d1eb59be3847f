//! Pictures of any record of a plane scene: forces, stress, fringes, plastic strain, rotation, speed, profiles, films.
//! Several records stand beside one another at equal times.

use crate::number;
use grainbench_fields::picture::{Shot, film, fringe_constant, pictures};
use grainbench_fields::profile::{Motion, profile};
use grainbench_fields::quantity::Quantity;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::force_plot::force_plot;
use grainbench_scene::record::{Record, Snapshot};

/// Pixels along the longer side of a picture, and of a film.
const PIXELS: u32 = 800;
const FILM_PIXELS: u32 = 400;
/// A film has at most this many frames, and a page shows at most this many pictures of a quantity.
const FRAMES: usize = 60;
const PICTURES: usize = 3;
/// Fewer snapshots than this are no film.
const FEWEST: usize = 8;
/// Fringes between no stress and the stress that a fiftieth of the material is above, unless c is given.
const FRINGES: f64 = 3.0;
const SLICES: usize = 60;

/// A record and what it is called.
pub struct Named<'a> {
    /// What stands above its panels.
    pub name: String,
    /// The record.
    pub record: &'a Record,
}

impl Named<'_> {
    /// The snapshot nearest to a time (s).
    fn at(&self, time: f64) -> Option<&Snapshot> {
        let away = |snapshot: &&Snapshot| (snapshot.time - time).abs();
        self.record.snapshots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }
}

/// Whether all of a record lies in the plane z = 0 and has something to be seen.
#[must_use]
pub fn is_plane(record: &Record) -> bool {
    let heights = |snapshot: &Snapshot| {
        let grains = snapshot.grains.iter().map(|grain| grain.position.z);
        grains.chain(snapshot.points.iter().map(|point| point.position.z)).collect::<Vec<f64>>()
    };
    // Where grains are poured there may be none at first.
    let all: Vec<f64> = record.snapshots.iter().flat_map(heights).collect();
    !all.is_empty() && all.iter().all(|&height| height == 0.0)
}

/// Every picture that the records have the data for, at times of the first one. `fringe` is the constant c of fringes
/// (Pa).
#[must_use]
pub fn figures(records: &[Named<'_>], fringe: Option<f64>) -> Vec<Figure> {
    let Some(first) = records.first().filter(|_| records.iter().all(|named| is_plane(named.record))) else {
        return Vec::new();
    };
    let all = &first.record.snapshots;
    let shown: Vec<f64> = spread(all, if records.len() > 1 { 1 } else { PICTURES }).map(|shot| shot.time).collect();
    let mut figures: Vec<Figure> = records.iter().filter_map(|named| forces(named, records.len() > 1)).collect();
    for quantity in quantities(records, fringe) {
        let (name, title) = words(quantity);
        let shots: Vec<Shot<'_>> = shown
            .iter()
            .flat_map(|&time| {
                records.iter().filter_map(move |named| {
                    let snapshot = named.at(time)?;
                    let time = format!("t = {}", number::seconds(snapshot.time));
                    let title = if named.name.is_empty() { time } else { format!("{}, {time}", named.name) };
                    Some(Shot::new(title, snapshot))
                })
            })
            .collect();
        let picture = pictures(quantity, &shots, PIXELS, None);
        let range = picture.range;
        figures.push(Figure::field(name, title, &caption(quantity), picture));
        if all.len() >= FEWEST && !matches!(quantity, Quantity::Speed) {
            let frames: Vec<&Snapshot> = spread(all, FRAMES).collect();
            let clock: Vec<f64> = frames.iter().map(|snapshot| snapshot.time).collect();
            let shots: Vec<Shot<'_>> = records
                .iter()
                .map(|named| Shot {
                    title: named.name.clone(),
                    frames: clock.iter().filter_map(|&time| named.at(time)).collect(),
                })
                .collect();
            // Colours of a film must not change on the way.
            let moving = film(quantity, &shots, ("time t (s)", &clock), FILM_PIXELS, Some(range));
            figures.push(Figure::field(&format!("{name}-film"), &format!("{title}, film"), &caption(quantity), moving));
        }
    }
    figures.extend(profiles(records));
    figures
}

/// About `count` snapshots spread evenly, the last one among them; the first only in a film.
fn spread(snapshots: &[Snapshot], count: usize) -> impl Iterator<Item = &Snapshot> {
    let last = snapshots.len().saturating_sub(1);
    let count = count.min(last.max(1));
    (1..=count).filter_map(move |at| snapshots.get(at * last / count))
}

/// What there is to see: stress where contacts or points carry it, plastic strain and rotation where there is some.
fn quantities(records: &[Named<'_>], fringe: Option<f64>) -> Vec<Quantity> {
    let ends: Vec<&Snapshot> = records.iter().filter_map(|named| named.record.snapshots.last()).collect();
    let mut quantities = Vec::new();
    let stressed = ends.iter().any(|snapshot| !snapshot.points.is_empty() || !snapshot.told_contacts().is_empty());
    if stressed {
        quantities.push(Quantity::StressDifference);
        let own = fringe_constant(ends.iter().copied(), FRINGES);
        quantities.extend(Some(fringe.unwrap_or(own)).filter(|&constant| constant > 0.0).map(Quantity::Fringes));
    }
    if ends.iter().any(|snapshot| snapshot.points.iter().any(|point| point.plastic_strain > 0.0)) {
        quantities.push(Quantity::PlasticStrain);
    }
    let turned =
        |snapshot: &&Snapshot| snapshot.grains.iter().any(|grain| grain.angle.is_some_and(|angle| angle.abs() > 1e-6));
    if ends.iter().any(turned) {
        quantities.push(Quantity::Rotation);
    }
    quantities.push(Quantity::Speed);
    quantities
}

fn forces(named: &Named<'_>, several: bool) -> Option<Figure> {
    let last = named.record.snapshots.last().filter(|snapshot| !snapshot.told_contacts().is_empty())?;
    let name = if several { format!("forces-{}", named.name) } else { "forces".to_owned() };
    Some(Figure::forces(
        &name,
        format!("Contact forces at the end {}", if several { &named.name } else { "" }).trim_end(),
        "Bars through the contacts with the orientation of the force, as long as the radii together and as wide as the force is \
         strong (Cundall and Strack 1979); radii show how far grains have turned.",
        force_plot(last),
    ))
}

/// Velocity and displacement across a domain that is periodic along one axis, which is the direction of flow.
fn profiles(records: &[Named<'_>]) -> Vec<Figure> {
    let Some(last) = records.first().and_then(|named| named.record.snapshots.last()) else { return Vec::new() };
    let (across, along) = match last.periodic {
        [false, true, _] => (0, 1),
        [true, false, _] => (1, 0),
        _ => return Vec::new(),
    };
    let (from, to) = (["x", "y"][across], ["x", "y"][along]);
    [(Motion::Displacement, "displacement", "m"), (Motion::Velocity, "velocity", "m/s")]
        .into_iter()
        .map(|(motion, word, unit)| {
            let curves = records.iter().map(|named| {
                let points = profile(&named.record.snapshots, motion, across, along, SLICES);
                Curve::new(named.name.clone(), Stroke::Line, points)
            });
            Figure::graph(
                word,
                &format!("Profile of {word} at the end"),
                &format!("Mean {word} along {to} of the material in slices across {from}."),
                [Axis::linear(&format!("{from} (m)")), Axis::linear(&format!("{word} along {to} ({unit})"))],
                curves.collect(),
            )
        })
        .collect()
}

/// Name of the file and title.
const fn words(quantity: Quantity) -> (&'static str, &'static str) {
    match quantity {
        Quantity::StressDifference => ("stress", "Difference of principal stresses"),
        Quantity::Fringes(_) => ("fringes", "Photoelastic fringes"),
        Quantity::PlasticStrain => ("plastic-strain", "Plastic strain"),
        Quantity::Rotation => ("rotation", "Rotation"),
        Quantity::Speed => ("speed", "Speed"),
    }
}

fn caption(quantity: Quantity) -> String {
    match quantity {
        Quantity::StressDifference => {
            "Difference of the principal stresses: of material points where there are some, else by the \
            elastic solution of every disc under its contact forces."
                .to_owned()
        }
        Quantity::Fringes(constant) => {
            format!("Photoelastic fringes, bright where there is no stress; c = {constant:.3e} Pa.")
        }
        Quantity::PlasticStrain => "Equivalent plastic strain of the material points.".to_owned(),
        Quantity::Rotation => "Rotation since the start, counter-clockwise positive.".to_owned(),
        Quantity::Speed => "Speed of the material, spin included.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;
    use grainbench_harness::figure::Drawing;

    fn named<'a>(name: &str, record: &'a Record) -> Named<'a> {
        Named { name: name.to_owned(), record }
    }

    #[test]
    fn two_records_stand_beside_one_another() {
        let grains = sample::record();
        let deformable = Record { snapshots: vec![sample::deformable(); 9], ..sample::record() };
        let figures = figures(&[named("mpm", &deformable), named("dem", &grains)], Some(1e3));
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        for name in ["forces-mpm", "forces-dem", "stress", "fringes", "plastic-strain", "rotation-film", "displacement"]
        {
            assert!(names.contains(&name), "{name}: {names:?}");
        }
        let panels = figures.iter().filter_map(|figure| match &figure.drawing {
            Drawing::Field(field) => Some(field.panels.len()),
            Drawing::Graph(_) | Drawing::Forces(_) => None,
        });
        assert!(panels.clone().count() > 5 && panels.clone().all(|count| count == 2));
        assert!(figures.iter().all(|figure| crate::plot::draw(figure).is_ok()));
    }

    #[test]
    fn what_is_not_flat_is_not_drawn() {
        let mut solid = sample::record();
        solid.snapshots[1].grains[0].position.z = 0.5;
        let empty = Record { snapshots: Vec::new(), ..sample::record() };
        for record in [&solid, &empty] {
            assert!(!is_plane(record) && figures(&[named("", record)], None).is_empty());
        }
    }
}
