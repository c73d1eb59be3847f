//! Comparison of the first sample of the output with the initial state of the scene.

use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::{Origin, Outputs};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::nalgebra::Vector3;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::record::Series;

/// Accepted deviation from the initial state in addition to the printed digits. It is a fraction of the radius for
/// positions, and of the largest surface speed for velocities.
const START: f64 = 1e-9;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Largest distance from the position that follows from a changed radius at which the position of the file is used, as a
/// fraction of the radius. The overlap at rest depends on the stiffness.
const ADOPTED: f64 = 0.05;

/// Moves grains whose positions follow a changed radius to their positions in the first snapshot, if these are near.
pub(super) fn adopt(scene: &mut Scene, moved: &[usize], observed: &DumpRecord) {
    let printed = observed.snapshots.first().map_or(&[][..], |first| &first.grains);
    for found in printed {
        let place = found.id as usize - 1;
        let axes = scene.dimension.count();
        let Some(grain) = scene.grains.get_mut(place).filter(|_| moved.contains(&place)) else { continue };
        let near = ADOPTED * grain.radius;
        if (0..axes).all(|axis| (found.position[axis] - grain.position[axis]).abs() <= near) {
            (0..axes).for_each(|axis| grain.position[axis] = found.position[axis]);
        }
    }
}

/// A quantity of a grain in the first sample.
struct Start {
    name: String,
    unit: &'static str,
    /// Value in the initial state of the scene.
    expected: f64,
    /// Difference of the sample from the scene. Along a periodic axis, whole periods are removed.
    off: f64,
    /// Uncertainty of the sample due to its printed digits.
    open: f64,
    /// Scale: the radius for positions (m), the largest surface speed for velocities (m/s), and this speed divided by
    /// the radius for spins (rad/s).
    scale: f64,
}

impl Start {
    /// Returns true if the sample differs from the scene by more than the uncertainty of its digits and a rounding error.
    fn is_off(&self) -> bool {
        self.off.abs() > self.open + START * self.scale
    }
}

/// Returns the coordinates of probed grains in the first sample.
fn probed<'o>(scene: &'o Scene, observed: &'o DumpRecord) -> impl Iterator<Item = Start> + 'o {
    observed.series.columns.iter().enumerate().filter_map(|(at, column)| {
        let (probe, quantity) = column.name.rsplit_once('.')?;
        let probe = scene.probes.iter().find(|other| other.name == probe)?;
        let axis = AXES.iter().position(|axis| *axis == quantity)?;
        let ProbeTarget::Grain(grain) = probe.target else { return None };
        let (expected, radius) = (scene.grains[grain].position[axis], scene.grains[grain].radius);
        let (found, open) = (*observed.series.values[at].first()?, *observed.uncertainty[at].first()?);
        let off = to_nearest_image(scene, axis, found - expected);
        Some(Start { name: column.name.clone(), unit: "m", expected, off, open, scale: radius })
    })
}

/// Returns the positions, velocities and spins of all grains in the first snapshot, if the files have them. `step` is
/// the time step (s). Components perpendicular to a planar scene are left out.
fn of_snapshot<'o>(scene: &'o Scene, step: Option<f64>, observed: &'o DumpRecord) -> impl Iterator<Item = Start> + 'o {
    let axes = if scene.dimension == Dimension::Two { (0..2, 2..3) } else { (0..3, 0..3) };
    let rim = scene.grains.iter().map(|grain| grain.velocity.norm() + grain.radius * grain.spin.norm());
    let fastest = rim.fold(0.0, f64::max);
    // Some programs store velocities half a step before or after the positions, so a velocity may differ by gravity
    // times the time step.
    let fall = scene.gravity.norm() * step.unwrap_or_default();
    let groups = scene.driven_group_of_grains();
    let printed = observed.snapshots.first().map_or(&[][..], |first| &first.grains);
    let shifted = observed.shifted_start.as_ref().map_or(printed, |first| &first.grains);
    printed.iter().zip(shifted).flat_map(move |(found, shifted)| {
        let place = found.id as usize - 1;
        let grain = &scene.grains[place];
        let start = move |name: &str, unit, axis: usize, [expected, found, shifted]: [Vector3<f64>; 3], scale| {
            let name = format!("{name}{} of grain {}", AXES[axis], place + 1);
            let (expected, off) = (expected[axis], found[axis] - expected[axis]);
            Start { name, unit, expected, off, open: (shifted[axis] - found[axis]).abs(), scale }
        };
        let (linear, turning) = axes.clone();
        let places = linear.clone().map(move |axis| {
            let start = start("", "m", axis, [grain.position, found.position, shifted.position], grain.radius);
            Start { off: to_nearest_image(scene, axis, start.off), ..start }
        });
        let speeds = linear.map(move |axis| {
            let start = start("v", "m/s", axis, [grain.velocity, found.velocity, shifted.velocity], fastest);
            Start { open: start.open + fall, ..start }
        });
        let spins = turning.map(move |axis| {
            start("omega", "rad/s", axis, [grain.spin, found.spin, shifted.spin], fastest / grain.radius)
        });
        // Programs print different velocities for a grain with prescribed motion, so these velocities are not compared.
        let is_free = groups[place].is_none();
        places.chain(speeds.chain(spins).filter(move |_| is_free))
    })
}

/// Returns a difference of coordinates (m), reduced by whole periods along a periodic axis.
pub(super) fn to_nearest_image(scene: &Scene, axis: usize, off: f64) -> f64 {
    match scene.domain.filter(|domain| domain.periodic[axis]) {
        Some(domain) => off - (off / (domain.high - domain.low)[axis]).round() * (domain.high - domain.low)[axis],
        None => off,
    }
}

/// Removes the jumps by whole periods from the positions of grains along periodic axes, from the start of the scene on. Programs
/// wrap grains into the box at different times, or not at all.
pub(super) fn continuous(scene: &Scene, mut series: Series) -> Series {
    let Some(domain) = &scene.domain else { return series };
    for (probe, axis) in scene.probes.iter().flat_map(|probe| [0, 1, 2].map(|axis| (probe, axis))) {
        let ProbeTarget::Grain(grain) = probe.target else { continue };
        let name = format!("{}.{}", probe.name, AXES[axis]);
        let column = series.columns.iter().position(|column| column.name == name);
        let (Some(column), true) = (column, domain.periodic[axis]) else { continue };
        let (period, mut before) = ((domain.high - domain.low)[axis], scene.grains[grain].position[axis]);
        for value in &mut series.values[column] {
            let periods = ((*value - before) / period).round();
            // A value without a jump keeps its bits. NaN is the value of a grain that has left the scene.
            if periods != 0.0 && periods.is_finite() {
                *value -= periods * period;
            }
            before = if value.is_nan() { before } else { *value };
        }
    }
    series
}

/// Returns the largest deviation of a coordinate from the initial state of a scene, in grain radii.
pub(super) fn distance(scene: &Scene, observed: &DumpRecord) -> f64 {
    let starts = probed(scene, observed).chain(of_snapshot(scene, None, observed)).filter(|start| start.unit == "m");
    starts.map(|start| start.off.abs() / start.scale).fold(0.0, f64::max)
}

/// Returns the expected and the found value of the first quantity that differs from the initial state; `None` if all agree.
pub(super) fn misplaced(scene: &Scene, outputs: &Outputs, observed: &DumpRecord) -> Option<(String, String)> {
    let late = outputs.origin().map(|origin| format!("a first sample at {}", at(origin)));
    let mut is_placed = false;
    for start in probed(scene, observed).chain(of_snapshot(scene, outputs.time_step(), observed)) {
        if start.is_off() {
            let late = late.map(|late| format!(" in {late}")).unwrap_or_default();
            let Start { name, unit, expected, off, .. } = start;
            return Some((format!("{name} = {expected:?} {unit}"), format!("{:?} {unit}{late}", expected + off)));
        }
        is_placed = true;
    }
    // A later first sample counts as time 0 only if it can be compared with the initial state.
    late.filter(|_| !is_placed).map(|late| ("at time 0".to_owned(), late))
}

/// Returns the step and, if known, the time of a first sample in words.
pub(super) fn at(origin: Origin) -> String {
    let time = origin.time.map(|time| format!(" (t = {time} s)")).unwrap_or_default();
    format!("step {}{time}", origin.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::record::Column;

    /// A disc flies across the side of a box of 1 m. One program wraps it at once, one later, and one never.
    #[test]
    fn positions_across_a_periodic_side_are_one_path() {
        let text = "title = 'a disc'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
            domain = { low = [0.0, 0.0], high = [1.0, 1.0], periodic = [true, false] }\n\
            grains.a = { material = 'm', radius = 0.1, position = [0.75, 0.5] }\nprobes.a.grain = 'a'\n";
        let scene = Scene::from_text("a", text).unwrap();
        let path = |values: [f64; 4]| {
            let columns = ["a.x", "a.y"].map(|name| Column { name: name.to_owned(), unit: "m".to_owned() });
            let series = Series { columns: columns.into(), values: vec![values.to_vec(); 2], ..Series::default() };
            continuous(&scene, series).values
        };
        let whole = vec![0.75, 1.0, 1.25, 1.5];
        for printed in [[0.75, 0.0, 0.25, 0.5], [0.75, 1.0, 0.25, 0.5], [0.75, 1.0, 1.25, 1.5], [-0.25, 0.0, 0.25, 0.5]]
        {
            assert_eq!(path(printed), [whole.clone(), printed.to_vec()], "{printed:?}");
        }
    }
}
