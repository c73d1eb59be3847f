//! Figures of any record. Figures of a two-dimensional scene show forces, stress, fringes, plastic strain, rotation,
//! speed, profiles and films. Figures of a three-dimensional scene show lit grains and contact forces. All have the
//! time series of their probes. Several records are shown side by side at equal times.

use crate::solid_figures::{self, not_recorded};
use crate::{distinct, number};
use grainbench_fields::picture::{Shot, film, fringe_constant, pictures};
use grainbench_fields::profile::{Motion, profile};
use grainbench_fields::quantity::Quantity;
use grainbench_harness::figure::{Axis, Curve, Drawing, Figure, Stroke};
use grainbench_harness::force_plot::force_plot;
use grainbench_solver::record::{Record, Series, Snapshot};

/// Number of pixels along the longer side of a picture.
const PIXELS: u32 = 800;
/// Number of pixels along the longer side of a film.
const FILM_PIXELS: u32 = 400;
/// Largest number of frames of a film.
const FRAMES: usize = 60;
/// Largest number of times at which a quantity of a single record is shown.
const PICTURES: usize = 3;
/// Smallest number of snapshots from which a film is made.
const FEWEST: usize = 8;
/// Number of fringes between zero and the 98th percentile of the stress, if the stress f of a fringe is not given.
const FRINGES: f64 = 3.0;
const SLICES: usize = 60;

/// Largest number of curves of a graph. More curves would be hard to distinguish.
const CURVES: usize = 8;

/// Record of a run, with a name that distinguishes it in figures.
pub struct NamedRecord<'a> {
    /// Name, which is the title of its panels.
    pub name: String,
    /// Record of the run.
    pub record: &'a Record,
}

impl NamedRecord<'_> {
    /// Returns the snapshot nearest to a time (s).
    fn at(&self, time: f64) -> Option<&Snapshot> {
        let away = |snapshot: &&Snapshot| (snapshot.time - time).abs();
        self.record.snapshots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }
}

/// Returns true if a record has grains or points and all of them lie in the plane z = 0.
fn is_plane(record: &Record) -> bool {
    let heights = |snapshot: &Snapshot| {
        let grains = snapshot.grains.iter().map(|grain| grain.position.z);
        grains.chain(snapshot.points.iter().map(|point| point.position.z)).collect::<Vec<f64>>()
    };
    // If grains are inserted during a run, its first snapshots may be empty.
    let all: Vec<f64> = record.snapshots.iter().flat_map(heights).collect();
    !all.is_empty() && all.iter().all(|&height| height == 0.0)
}

/// Options of the figures of records.
#[derive(Clone, Copy, Debug, Default)]
pub struct FigureOptions {
    /// Stress f of a photoelastic fringe (Pa). With none, about three fringes are shown.
    pub fringe: Option<f64>,
    /// First and last time of the figures (s). With none, all times are shown.
    pub window: Option<(f64, f64)>,
    /// Largest number of frames of a film. With none, it is 60.
    pub frames: Option<usize>,
}

/// Returns all figures for which the records have data, at times of the first record, and the time series of the
/// probes. Three-dimensional records are shown in one view, obliquely from the front, the right and above.
#[must_use]
pub fn figures(records: &[NamedRecord<'_>], shown: &FigureOptions) -> Vec<Figure> {
    let (from, to) = shown.window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let Some(first) = records.first() else { return Vec::new() };
    let mut all: Vec<&Snapshot> =
        first.record.snapshots.iter().filter(|snapshot| (from..=to).contains(&snapshot.time)).collect();
    // Final snapshots without points and contacts are omitted. They would show nothing, for example after an outflow.
    let shows = |snapshot: &&Snapshot| !snapshot.points.is_empty() || !snapshot.told_contacts().is_empty();
    if let Some(last) = all.iter().rposition(shows) {
        all.truncate(last + 1);
    }
    let mut figures = if records.iter().all(|named| is_plane(named.record)) {
        plane(records, &all, shown)
    } else {
        solid(records, &all, shown)
    };
    figures.extend(probe_figures(records, (from, to)));
    figures
}

/// Returns the snapshots of each record nearest to the given times (s). Records without snapshots are left out.
fn film_of<'a>(records: impl IntoIterator<Item = &'a NamedRecord<'a>>, clock: &[f64]) -> Vec<Shot<'a>> {
    let shot = |named: &'a NamedRecord<'a>| {
        let frames = clock.iter().map(|&time| named.at(time)).collect::<Option<_>>()?;
        Some(Shot { title: named.name.clone(), frames })
    };
    records.into_iter().filter_map(shot).collect()
}

/// Returns the snapshot of each record nearest to a time (s). The title contains the time of the snapshot.
fn pictures_of<'a>(records: impl IntoIterator<Item = &'a NamedRecord<'a>>, time: f64) -> Vec<Shot<'a>> {
    let shot = |named: &'a NamedRecord<'a>| {
        let snapshot = named.at(time)?;
        let time = format!("t = {}", number::seconds(snapshot.time));
        Some(Shot::new(if named.name.is_empty() { time } else { format!("{}, {time}", named.name) }, snapshot))
    };
    records.into_iter().filter_map(shot).collect()
}

/// Returns figures of a three-dimensional scene: grains and contact forces at the end, and a film.
fn solid(records: &[NamedRecord<'_>], all: &[&Snapshot], shown: &FigureOptions) -> Vec<Figure> {
    let Some(last) = all.last() else { return Vec::new() };
    let end = pictures_of(records, last.time);
    let mut figures: Vec<Figure> =
        [solid_figures::grains(&end, &[0.0]), solid_figures::forces(&end)].into_iter().flatten().collect();
    if all.len() >= FEWEST {
        let clock: Vec<f64> = spread(all, shown.frames.unwrap_or(FRAMES)).map(|snapshot| snapshot.time).collect();
        figures.extend(solid_figures::grains(&film_of(records, &clock), &clock));
    }
    figures
}

/// Returns figures of a two-dimensional scene.
fn plane(records: &[NamedRecord<'_>], all: &[&Snapshot], options: &FigureOptions) -> Vec<Figure> {
    let shown: Vec<f64> = spread(all, if records.len() > 1 { 1 } else { PICTURES }).map(|shot| shot.time).collect();
    let mut figures: Vec<Figure> =
        records.iter().filter_map(|named| forces(named, records.len() > 1, all.last()?.time)).collect();
    let Some(end) = all.last().map(|snapshot| snapshot.time) else { return figures };
    for quantity in quantities(records, options.fringe, end) {
        let (name, title, caption) = words(quantity);
        let (telling, mute): (Vec<&NamedRecord<'_>>, Vec<&NamedRecord<'_>>) =
            records.iter().partition(|named| named.at(end).is_some_and(|snapshot| tells(snapshot, quantity)));
        let shots: Vec<Shot<'_>> = shown.iter().flat_map(|&time| pictures_of(telling.iter().copied(), time)).collect();
        let picture = pictures(quantity, &shots, PIXELS, None);
        let range = picture.range;
        let caption = caption + &not_recorded(mute.iter().map(|named| named.name.as_str()));
        figures.push(Figure::field(name, title, &caption, picture));
        if all.len() >= FEWEST && !matches!(quantity, Quantity::Speed) {
            let clock: Vec<f64> = spread(all, options.frames.unwrap_or(FRAMES)).map(|snapshot| snapshot.time).collect();
            let shots = film_of(telling.iter().copied(), &clock);
            // All frames of a film have the range of the pictures, so that a colour means the same value at all times.
            let moving = film(quantity, &shots, ("time t (s)", &clock), FILM_PIXELS, Some(range));
            figures.push(Figure::field(&format!("{name}-film"), &format!("{title}, film"), &caption, moving));
        }
    }
    figures.extend(profiles(records, end));
    figures
}

/// Returns true if a snapshot has data for a quantity. Missing data do not count as zero.
fn tells(snapshot: &Snapshot, quantity: Quantity) -> bool {
    let has_points = !snapshot.points.is_empty();
    match quantity {
        Quantity::StressDifference | Quantity::Fringes(_) => has_points || snapshot.contacts.is_some(),
        Quantity::PlasticStrain => has_points,
        Quantity::Rotation => has_points || snapshot.grains.iter().any(|grain| grain.angle.is_some()),
        Quantity::Speed => true,
    }
}

/// Returns at most `count` evenly spaced snapshots. The last snapshot is always included, and the first only if it is the
/// only snapshot.
fn spread<'a>(snapshots: &'a [&'a Snapshot], count: usize) -> impl Iterator<Item = &'a Snapshot> {
    let last = snapshots.len().saturating_sub(1);
    let count = count.min(last.max(1)).max(1);
    (1..=count).filter_map(move |at| snapshots.get(at * last / count).copied())
}

/// Returns the quantities to plot: speed, stress if known, and plastic strain and rotation if they are not zero.
fn quantities(records: &[NamedRecord<'_>], fringe: Option<f64>, end: f64) -> Vec<Quantity> {
    let ends: Vec<&Snapshot> = records.iter().filter_map(|named| named.at(end)).collect();
    let stressed = ends.iter().any(|snapshot| !snapshot.points.is_empty() || !snapshot.told_contacts().is_empty());
    let constant = || fringe.unwrap_or_else(|| fringe_constant(ends.iter().copied(), FRINGES));
    let mut points = ends.iter().flat_map(|snapshot| &snapshot.points);
    let mut angles = ends.iter().flat_map(|snapshot| &snapshot.grains).filter_map(|grain| grain.angle);
    let quantities = [
        stressed.then_some(Quantity::StressDifference),
        stressed.then(constant).filter(|&constant| constant > 0.0).map(Quantity::Fringes),
        points.any(|point| point.plastic_strain > 0.0).then_some(Quantity::PlasticStrain),
        angles.any(|angle| angle.abs() > 1e-6).then_some(Quantity::Rotation),
        Some(Quantity::Speed),
    ];
    quantities.into_iter().flatten().collect()
}

fn forces(named: &NamedRecord<'_>, several: bool, end: f64) -> Option<Figure> {
    let last = named.at(end).filter(|snapshot| !snapshot.told_contacts().is_empty())?;
    let is_end = named.record.snapshots.last().is_some_and(|snapshot| snapshot.time <= end);
    let when = if is_end { "at the end".to_owned() } else { format!("at t = {}", number::seconds(end)) };
    let name = if several { format!("forces-{}", named.name) } else { "forces".to_owned() };
    Some(Figure::forces(
        &name,
        format!("Contact forces {when} {}", if several { &named.name } else { "" }).trim_end(),
        "Each bar passes through a contact along the force. Its length is the sum of both radii, and its width is \
         proportional to the force (Cundall and Strack 1979). The drawn radii show the rotation of the grains.",
        force_plot(last),
    ))
}

/// Returns profiles of velocity and displacement across the flow, whose direction is the only periodic axis. A profile
/// that no record has is left out.
fn profiles(records: &[NamedRecord<'_>], end: f64) -> Vec<Figure> {
    let Some(last) = records.first().and_then(|named| named.at(end)) else { return Vec::new() };
    let (across, along) = match last.periodic {
        [false, true, _] => (0, 1),
        [true, false, _] => (1, 0),
        _ => return Vec::new(),
    };
    let (from, to) = (["x", "y"][across], ["x", "y"][along]);
    let graph = |(motion, word, unit): (Motion, &str, &str)| {
        let curves = records.iter().filter_map(|named| {
            let until = named.record.snapshots.iter().filter(|snapshot| snapshot.time <= end);
            let points = profile(&until.cloned().collect::<Vec<_>>(), motion, across, along, SLICES);
            (!points.is_empty()).then(|| Curve::new(named.name.clone(), Stroke::Line, points))
        });
        Figure::graph(
            word,
            &format!("Profile of {word} at the end"),
            &format!("Mean {word} of the material along {to}, in slices along {from}."),
            [Axis::linear(&format!("{from} (m)")), Axis::linear(&format!("{word} along {to} ({unit})"))],
            curves.collect(),
        )
    };
    let mut figures =
        Vec::from([(Motion::Displacement, "displacement", "m"), (Motion::Velocity, "velocity", "m/s")].map(graph));
    figures.retain(|figure| matches!(&figure.drawing, Drawing::Graph(graph) if !graph.curves.is_empty()));
    figures
}

/// Returns the file name, the title and the caption of a quantity's figure.
fn words(quantity: Quantity) -> (&'static str, &'static str, String) {
    let (name, title, caption) = match quantity {
        Quantity::StressDifference => (
            "stress",
            "Difference of principal stresses",
            "Difference of the principal stresses. It is the stress of the material points if there are any, and \
             otherwise the elastic solution for each disc under its contact forces.",
        ),
        Quantity::Fringes(constant) => {
            let constant = number::with_unit(constant, "Pa");
            let caption = format!("Photoelastic fringes, bright at zero stress; f = {constant}.");
            return ("fringes", "Photoelastic fringes", caption);
        }
        Quantity::PlasticStrain => {
            ("plastic-strain", "Plastic strain", "Equivalent plastic strain of the material points.")
        }
        Quantity::Rotation => ("rotation", "Rotation", "Rotation since the start, counter-clockwise positive."),
        Quantity::Speed => ("speed", "Speed", "Speed of the material, including the spin of grains."),
    };
    (name, title, caption.to_owned())
}

/// Splits the name of a column into probe and quantity: `disc.vx` is the quantity `vx` of the probe `disc`.
fn parts(name: &str) -> (&str, &str) {
    name.rsplit_once('.').unwrap_or(("", name))
}

/// Returns one graph for each quantity of the probes of all records, within a time window (s). Values that are missing
/// or not finite are not plotted.
fn probe_figures(records: &[NamedRecord<'_>], window: (f64, f64)) -> Vec<Figure> {
    let columns = records.iter().flat_map(|named| &named.record.series.columns);
    let quantities = distinct(columns.map(|column| (parts(&column.name).1, column.unit.as_str())));
    quantities.into_iter().filter_map(|quantity| probe_figure(records, quantity, window)).collect()
}

fn probe_figure(records: &[NamedRecord<'_>], (quantity, unit): (&str, &str), (from, to): (f64, f64)) -> Option<Figure> {
    let mut curves = Vec::new();
    for NamedRecord { name, record } in records {
        let Series { time, columns, values, .. } = &record.series;
        for (column, values) in columns.iter().zip(values) {
            let (probe, part) = parts(&column.name);
            if (part, column.unit.as_str()) != (quantity, unit) {
                continue;
            }
            let points = time.iter().copied().zip(values.iter().copied());
            let points: Vec<_> = points.filter(|(time, _)| (from..=to).contains(time)).collect();
            if points.iter().any(|(_, value)| value.is_finite()) {
                let words = [probe, name].into_iter().filter(|word| !word.is_empty());
                curves.push(Curve::new(words.collect::<Vec<_>>().join(", "), Stroke::Line, points));
            }
        }
    }
    let more = curves.len().saturating_sub(CURVES);
    let left_out = if more > 0 { format!(" The table of probes has {more} more.") } else { String::new() };
    curves.truncate(CURVES);
    let words = quantity.replace('_', " ");
    let label = if unit == "1" { words.clone() } else { format!("{words} ({unit})") };
    (!curves.is_empty()).then(|| {
        Figure::graph(
            &format!("probe-{quantity}"),
            &format!("Probes: {words}"),
            &format!("{words} from the probes of the scene.{left_out}"),
            [Axis::linear("time t (s)"), Axis::linear(&label)],
            curves,
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    fn named<'a>(name: &str, record: &'a Record) -> NamedRecord<'a> {
        NamedRecord { name: name.to_owned(), record }
    }

    #[test]
    fn two_records_stand_beside_one_another() {
        let grains = sample::record();
        let deformable = Record { snapshots: vec![sample::deformable(); 9], ..sample::record() };
        let figures = figures(
            &[named("mpm", &deformable), named("dem", &grains)],
            &FigureOptions { fringe: Some(1e3), ..FigureOptions::default() },
        );
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        for name in ["forces-mpm", "forces-dem", "stress", "fringes", "plastic-strain", "rotation-film", "displacement"]
        {
            assert!(names.contains(&name), "{name}: {names:?}");
        }
        let count =
            |figure: &Figure| if let Drawing::Field(field) = &figure.drawing { Some(field.panels.len()) } else { None };
        let panels = figures.iter().filter_map(count);
        // Only material points have plastic strain.
        assert!(panels.clone().count() > 5 && panels.clone().filter(|count| *count == 2).count() > 4);
        assert!(figures.iter().all(|figure| crate::plot::draw(figure).is_ok()));
    }

    #[test]
    fn what_is_not_flat_is_seen_from_outside() {
        let mut solid = sample::record();
        solid.snapshots[1].grains[0].position.z = 0.5;
        let figures = figures(&[named("", &solid)], &FigureOptions::default());
        assert!(!is_plane(&solid) && figures.iter().any(|figure| figure.name == "grains"));
        let empty = Record { snapshots: Vec::new(), ..sample::record() };
        let figures = super::figures(&[named("", &empty)], &FigureOptions::default());
        assert!(figures.iter().all(|figure| figure.name.starts_with("probe-")));
    }

    /// A dump contains neither contacts nor angles. Its panels are then left out, and the caption states this.
    #[test]
    fn what_nobody_told_is_not_zero() {
        let grains = sample::record();
        let mut dump = sample::record();
        for snapshot in &mut dump.snapshots {
            snapshot.contacts = None;
            snapshot.grains.iter_mut().for_each(|grain| grain.angle = None);
        }
        let figures = figures(&[named("dem", &grains), named("dump", &dump)], &FigureOptions::default());
        for name in ["stress", "rotation"] {
            let figure = figures.iter().find(|figure| figure.name == name).unwrap();
            let Drawing::Field(field) = &figure.drawing else { unreachable!() };
            assert!(field.panels.len() == 1 && figure.caption.contains("Not recorded by dump"), "{name}");
        }
    }

    #[test]
    fn a_window_shows_what_is_in_it() {
        let record = sample::record();
        let none = FigureOptions { window: Some((1e9, 2e9)), ..FigureOptions::default() };
        assert!(figures(&[named("", &record)], &none).is_empty());
    }

    #[test]
    fn every_quantity_has_its_graph_and_nothing_stands_for_zero() {
        let record = sample::record();
        let named = [named("", &record)];
        let figures = probe_figures(&named, (f64::NEG_INFINITY, f64::INFINITY));
        assert!(!figures.is_empty() && figures.iter().all(|figure| crate::plot::draw(figure).is_ok()));
        assert!(probe_figures(&named, (1e9, 2e9)).is_empty(), "a window without samples shows nothing");
    }
}
