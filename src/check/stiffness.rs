//! Overlaps of the contacts at the start and at the end of a run. They show if the stiffness of the scene is that of the
//! output.

use super::covered::CheckedOutput;
use super::start::to_nearest_image;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reports::number;
use grainbench_scene::nalgebra::Vector3;
use grainbench_scene::scene::{Scene, WallShape};
use grainbench_solver::record::Snapshot;

/// Smallest ratio of two mean overlaps that is reported.
const RATIO: f64 = 1.5;
/// Largest number of grains whose pairs are searched.
const MOST_GRAINS: usize = 3000;

/// Returns the mean overlap of the contacts at plane walls and between grains, as a fraction of the smaller radius;
/// `None` without contacts.
fn mean_overlap(scene: &Scene, positions: &[(usize, Vector3<f64>)]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u32);
    let mut add = |overlap: f64, radius: f64| {
        if overlap > 0.0 {
            sum += overlap / radius;
            count += 1;
        }
    };
    for (place, &(grain, position)) in positions.iter().enumerate() {
        let radius = scene.grains[grain].radius;
        for wall in scene.walls.iter().filter(|wall| !wall.motion.is_moving() && wall.piston.is_none()) {
            if let WallShape::Plane { point, normal } = &wall.shape {
                add(radius - normal.dot(&(position - point)), radius);
            }
        }
        for &(other, second) in positions.iter().take(if positions.len() > MOST_GRAINS { 0 } else { place }) {
            let mut apart = position - second;
            (0..3).for_each(|axis| apart[axis] = to_nearest_image(scene, axis, apart[axis]));
            let second = scene.grains[other].radius;
            add(radius + second - apart.norm(), radius.min(second));
        }
    }
    (count > 0).then(|| sum / f64::from(count))
}

fn of_snapshot(scene: &Scene, snapshot: &Snapshot) -> Option<f64> {
    let flat = scene.dimension.count() == 2;
    let place = |position: Vector3<f64>| if flat { Vector3::new(position.x, position.y, 0.0) } else { position };
    let grains = snapshot.grains.iter().map(|grain| (grain.id as usize - 1, place(grain.position)));
    mean_overlap(scene, &grains.filter(|(grain, _)| *grain < scene.grains.len()).collect::<Vec<_>>())
}

/// Returns the question about the stiffness for two mean overlaps, if they differ enough.
fn question(of_file: f64, of_scene: f64) -> Option<String> {
    if ((1.0 / RATIO)..=RATIO).contains(&(of_file / of_scene)) {
        return None;
    }
    let [file, scene] = [of_file, of_scene].map(|overlap| number::significant(overlap, 2));
    Some(format!("the mean overlap is {file} R in the file and {scene} R in the scene: is the stiffness yours?"))
}

/// Returns the question about the stiffness for the first sample, in brackets; empty if the overlaps are similar.
pub(super) fn at_start(scene: &Scene, observed: &DumpRecord) -> String {
    let start: Vec<_> = scene.grains.iter().map(|grain| grain.position).enumerate().collect();
    let of_file = observed.snapshots.first().and_then(|first| of_snapshot(scene, first));
    let words = of_file.zip(mean_overlap(scene, &start)).and_then(|(file, scene)| question(file, scene));
    words.map(|words| format!(" ({words})")).unwrap_or_default()
}

/// Returns an amber result with the question about the stiffness for the last sample; `None` if the overlaps are similar.
pub(super) fn at_end(output: &CheckedOutput<'_>, ours: &Snapshot) -> Option<Verdict> {
    let scene = &output.candidate.scene;
    let of_file = output.observed.snapshots.last().and_then(|last| of_snapshot(scene, last))?;
    let words = question(of_file, of_snapshot(scene, ours)?)?;
    let row = Verdict {
        because: "the overlap at rest depends on the stiffness".to_owned(),
        source: "our run to the last sample".to_owned(),
        ..output.row("mean overlap of the contacts at the end, over the radius", "1")
    };
    Some(row.left(Outcome::NoReference, words))
}
