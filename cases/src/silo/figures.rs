//! Figures of a silo, like those of the paper, from the tables of its run.

use super::axes;
use super::ensemble::{STRAIN, courses, over_inertia, over_strain, strained};
use super::flow::{ELEMENT, INERTIA, STEADY, rows};
use grainbench_fields::element_picture::{Sheet, Units};
use grainbench_fields::grid::Grid;
use grainbench_harness::prelude::*;

/// Largest number of frames of the animation.
const FRAMES: usize = 24;
/// Largest number of points in a scatter plot; more points overlap.
const CLOUD: usize = 600;

/// Inertial number below which an element is at rest. Rounding errors give fixed grains a value above zero.
const STILL: f64 = 1e-5;

/// Returns all figures of a silo: the animation, axes of stress and strain rate, contact forces, φ against |I₀| with
/// the prototype's bins, sin φ against φ along tracers, φ against strain.
pub(crate) fn all(done: &FinishedRun, bins: &[CitedNumber]) -> Vec<Figure> {
    let axes = axes::all(done).into_iter();
    let graphs = [over_rate(done, bins), along_tracers(done), over_hencky(done)].into_iter().flatten();
    film(done).into_iter().chain(axes).chain(graphs).collect()
}

/// Returns an animation of speed, sin φ, φ and |D₀| (figures 2 and 3 of the paper).
fn film(done: &FinishedRun) -> Option<Figure> {
    let domain = done.scene.domain.as_ref()?;
    let mut times: Vec<f64> = done.column_of("elements", "time").ok()?.to_vec();
    times.dedup();
    let times = thinned(times, FRAMES);
    let top = done.column_of("elements", "z").ok()?.iter().copied().fold(0.0, f64::max) + 0.5 * ELEMENT;
    let corners = (Vector3::new(domain.low.x, 0.0, 0.0), Vector3::new(domain.high.x, ELEMENT, top));
    let grid = Grid::filling(corners, Vector3::repeat(ELEMENT));
    let names = ["sine_of_friction", "packing_fraction", "shear_rate"];
    let mut shown: Vec<(&'static str, Vec<Vec<f64>>)> = std::iter::once("speed")
        .chain(names)
        .map(|name| (name, vec![vec![f64::NAN; grid.cells()]; times.len()]))
        .collect();
    let place = |time: f64, x: f64, z: f64| {
        let frame = times.iter().position(|known| *known == time)?;
        Some((frame, grid.find(Vector3::new(x, 0.5 * ELEMENT, z))?))
    };
    let velocities = rows(done, "elements", ["time", "x", "z", "surface", "velocity_x", "velocity_z"]).ok()?;
    for [time, x, z, surface, along, up] in velocities {
        if let Some((frame, cell)) = place(time, x, z).filter(|_| surface == 0.0) {
            shown[0].1[frame][cell] = along.hypot(up);
        }
    }
    for (number, name) in (1..).zip(names) {
        for [time, x, z, surface, value] in rows(done, "elements", ["time", "x", "z", "surface", name]).ok()? {
            if let Some((frame, cell)) = place(time, x, z).filter(|_| surface == 0.0) {
                shown[number].1[frame][cell] = value;
            }
        }
    }
    let field =
        Sheet { grid, units: Units { length: "d", time: "τ" }, clock: "time t (τ)".to_owned(), times, shown }.film()?;
    let caption = "Speed, sine of the friction angle, packing fraction and rate of shear of elements of 2.5 d. Values \
                   beyond a colour bar have the colour of its end. Elements at the surface and elements with fewer \
                   than eight grains are blank. The paper finds a funnel over the slit, a plug with little shear \
                   above it, and sines between 0.2 and 0.6.";
    Some(Figure::field("elements", "Granular elements of the flow", caption, field))
}

/// Returns |I₀| and φ of elements in steady flow, away from sides and surface and without fixed grains.
pub(super) fn flowing(done: &FinishedRun) -> Vec<(f64, f64)> {
    let all = rows(done, "elements", ["time", "side", "surface", "inertial_number", "packing_fraction"]);
    let flows = |row: &[f64; 5]| row[0] >= STEADY - 1e-9 && row[1] + row[2] == 0.0 && row[3] >= STILL;
    all.unwrap_or_default().into_iter().filter(flows).map(|row| (row[3], row[4])).collect()
}

/// Returns the figure of φ against |I₀| (figure 6).
fn over_rate(done: &FinishedRun, bins: &[CitedNumber]) -> Option<Figure> {
    let cloud = flowing(done);
    let middle = |bin: usize| (INERTIA[bin][0] * INERTIA[bin][1]).sqrt();
    let ours = over_inertia(done, f64::INFINITY).ok()?;
    let ours = ours.iter().enumerate().filter_map(|(bin, packing)| Some((middle(bin), (*packing)?))).collect();
    let theirs = bins.iter().enumerate().map(|(bin, cited)| (middle(bin), cited.value)).collect();
    // The fit is a straight line on linear axes, and a curve against the logarithm of |I₀|.
    let line = (0..=40).map(|at| 5e-4 * 24_f64.powf(f64::from(at) / 40.0)).map(|rate| (rate, 0.635 - rate / 0.123));
    let caption = "Each small circle is an element at one time of the steady flow. The mean packing fraction of bins \
                   of |I₀| is compared with a prototype. The dashed curve is the paper's fit |I₀| = 0.123 (0.635 − φ), \
                   which applies to slow elements only.";
    Some(Figure::graph(
        "inertia",
        "Packing fraction over the inertial number",
        caption,
        [Axis::log("inertial number |I₀| (1)"), Axis::linear("packing fraction φ (1)")],
        vec![
            Curve::new("mean of bins", Stroke::MarkedLine, ours),
            Curve::new("elements", Stroke::Beside, thinned(cloud, CLOUD)),
            Curve::new("prototype, mean of bins", Stroke::Markers, theirs),
            Curve::new("fit of the paper", Stroke::Dashed, line.collect()),
        ],
    ))
}

/// Returns the figure of sin φ against φ along tracers (figure 7).
fn along_tracers(done: &FinishedRun) -> Option<Figure> {
    let courses = courses(done, ["packing_fraction", "sine_of_friction"]).ok()?;
    let points = |some: &mut dyn Iterator<Item = &[f64; 2]>| some.map(|&[packing, sine]| (packing, sine)).collect();
    let starts = points(&mut courses.iter().filter_map(|course| course.first()));
    let last = points(&mut courses.iter().filter_map(|course| course.last()));
    let cloud = points(&mut courses.iter().flatten());
    let caption = "Tracers start at a large packing fraction. Their sine of the friction angle is largest before they \
                   dilate and move to the left. The paper finds a largest sine of 0.6 before dilation. At a tenth of its \
                   size it is 0.5 to 0.6.";
    Some(Figure::graph(
        "tracers",
        "Sine of the friction angle over the packing fraction of tracer elements",
        caption,
        [Axis::linear("packing fraction φ (1)"), Axis::linear("sine of the friction angle (1)")],
        vec![
            Curve::new("start", Stroke::Markers, starts),
            Curve::new("in between", Stroke::Beside, thinned(cloud, CLOUD)),
            Curve::new("end", Stroke::Markers, last),
        ],
    ))
}

/// Returns the figure of φ against |E| (figure 8).
fn over_hencky(done: &FinishedRun) -> Option<Figure> {
    let cloud = strained(done).ok()?.into_iter().map(|[strain, packing]| (strain, packing)).collect();
    let means = over_strain(done).ok()?;
    let means =
        STRAIN.iter().zip(means).filter_map(|(bin, packing)| Some((0.5 * (bin[0] + bin[1]), packing?))).collect();
    let caption = "Packing fraction of tracer elements of 5 d over their Hencky strain |E|. In the paper, the \
                   packing fraction of all flows reaches one plateau at about |E| = 0.4.";
    Some(Figure::graph(
        "strain",
        "Packing fraction over strain",
        caption,
        [Axis::linear("Hencky strain |E| (1)"), Axis::linear("packing fraction φ (1)")],
        vec![
            Curve::new("mean of bins", Stroke::MarkedLine, means),
            Curve::new("tracers", Stroke::Beside, thinned(cloud, CLOUD)),
        ],
    ))
}
