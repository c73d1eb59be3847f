//! Profiles: means over slices of a two-dimensional scene, as used for experiments on shear bands.

use crate::grid::{image_shifts, inside, nearest_image};
use crate::overlap::disc_in_box;
use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Quantity of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Displacement since the first snapshot (m).
    Displacement,
    /// Velocity (m/s).
    Velocity,
}

/// Returns the mean of one component of displacement or velocity in slices perpendicular to `axis`, weighted by the
/// area of material. Along a periodic `axis`, the part of a disc beyond a side belongs to the slices at the other side.
///
/// The result refers to the last of `snapshots`. It contains the centre (m) and the mean (m or m/s) of each slice with
/// material. The displacement of a disc is that of its centre, summed from snapshot to snapshot across periodic sides.
/// The profile of the displacement is empty if a disc could have moved by half the period between two snapshots.
#[must_use]
pub fn profile(
    snapshots: &[Snapshot],
    motion: Motion,
    axis: usize,
    component: usize,
    slices: usize,
) -> Vec<(f64, f64)> {
    let (Some(last), true) = (snapshots.last(), axis < 2 && component < 3) else { return Vec::new() };
    let (low, high) = (last.bounds.0[axis], last.bounds.1[axis]);
    let width = (high - low) / slices.max(1) as f64;
    let mut sums = vec![(0.0, 0.0); slices];
    if last.points.is_empty() {
        let moved = match motion {
            Motion::Displacement => displacements(snapshots, component).unwrap_or_default(),
            Motion::Velocity => last.grains.iter().map(|grain| grain.velocity).collect(),
        };
        let shifts = image_shifts(last, axis..axis + 1);
        let moved_grains = last.grains.iter().zip(moved);
        for ((grain, moved), shift) in moved_grains.flat_map(|both| shifts.iter().map(move |shift| (both, shift))) {
            let centre = inside(last, grain.position)[axis] + shift[axis];
            for (slice, sum) in sums.iter_mut().enumerate() {
                let from = low + width * slice as f64 - centre;
                if from.abs().min((from + width).abs()) > grain.radius && from * (from + width) > 0.0 {
                    continue;
                }
                let far = 2.0 * grain.radius;
                let area = disc_in_box(grain.radius, [from, -far], [from + width, far]);
                *sum = (sum.0 + area, sum.1 + area * moved[component]);
            }
        }
    } else {
        for point in &last.points {
            let place = (inside(last, point.position)[axis] - low) / width;
            let moved = match motion {
                Motion::Displacement => point.displacement,
                Motion::Velocity => point.velocity,
            };
            if let Some(sum) = (place >= 0.0).then(|| sums.get_mut(place as usize)).flatten() {
                *sum = (sum.0 + point.volume, sum.1 + point.volume * moved[component]);
            }
        }
    }
    let middle = |slice: usize| low + width * (slice as f64 + 0.5);
    sums.iter().enumerate().filter(|(_, sum)| sum.0 > 0.0).map(|(slice, sum)| (middle(slice), sum.1 / sum.0)).collect()
}

/// Returns the displacement of each grain of the last snapshot since the first snapshot that contains it (m); `None` if
/// the speed times the interval between two snapshots is half the period or more. The nearest image may then be wrong.
fn displacements(snapshots: &[Snapshot], component: usize) -> Option<Vec<Vector3<f64>>> {
    let mut moved: BTreeMap<u32, Vector3<f64>> = BTreeMap::new();
    for pair in snapshots.windows(2) {
        for after in &pair[1].grains {
            let Some(before) = pair[0].grain(after.id) else { continue };
            let speed = before.velocity[component].abs().max(after.velocity[component].abs());
            let (low, high) = (pair[1].bounds.0[component], pair[1].bounds.1[component]);
            if pair[1].periodic[component] && speed * (pair[1].time - pair[0].time) >= 0.5 * (high - low) {
                return None;
            }
            *moved.entry(after.id).or_default() += nearest_image(&pair[1], after.position - before.position);
        }
    }
    let last = snapshots.last().map_or(&[][..], |last| &last.grains);
    Some(last.iter().map(|grain| moved.get(&grain.id).copied().unwrap_or_default()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::scene::Grain;
    use grainbench_solver::record::GrainState;

    fn snapshot(time: f64) -> Snapshot {
        let grain = |id: u32| {
            let x = f64::from(id) - 0.5;
            let (position, velocity) =
                (Vector3::new(x, (3.0 + x * time).rem_euclid(4.0), 0.0), Vector3::new(0.0, x, 0.0));
            let grain = Grain { radius: 0.5, mass: 1.0, inertia: 0.125, position, velocity, ..Grain::default() };
            GrainState::start(id, &grain)
        };
        Snapshot {
            time,
            bounds: (Vector3::zeros(), Vector3::new(4.0, 4.0, 0.0)),
            periodic: [false, true, false],
            grains: (1..=4).map(grain).collect(),
            ..Snapshot::default()
        }
    }

    /// Half of the first disc, whose image is at x = 0, is in each outer slice. The second disc is in the last slice. The
    /// mean velocity there is (½ · 1 + 1 · 3)/(½ + 1) = 7/3 m/s.
    #[test]
    fn a_disc_across_a_periodic_side_is_in_both_outer_slices() {
        let mut shot = Snapshot { periodic: [true, false, false], ..snapshot(0.0) };
        shot.grains.truncate(2);
        for (grain, (x, velocity)) in shot.grains.iter_mut().zip([(8.0, 1.0), (3.5, 3.0)]) {
            (grain.position.x, grain.velocity.y) = (x, velocity);
        }
        let means = profile(&[shot], Motion::Velocity, 0, 1, 4);
        assert!(means.len() == 2 && means[0] == (0.5, 1.0) && means[1].0 == 3.5, "{means:?}");
        assert!((means[1].1 - 7.0 / 3.0).abs() < 1e-12, "{means:?}");
    }

    #[test]
    fn a_sheared_row_of_discs_has_a_straight_profile_around_the_domain() {
        let snapshots: Vec<Snapshot> = (0..=8).map(|step| snapshot(0.5 * f64::from(step))).collect();
        for (x, moved) in profile(&snapshots, Motion::Displacement, 0, 1, 4) {
            assert!((moved - 4.0 * x).abs() < 1e-12, "{x} {moved}");
        }
        for (x, velocity) in profile(&snapshots, Motion::Velocity, 0, 1, 8) {
            // Each slice covers half of one disc and has the velocity of this disc.
            assert!((velocity - (x.floor() + 0.5)).abs() < 1e-12, "{x} {velocity}");
        }
        // A grain that leaves during the series does not change the means of the remaining slices.
        let mut fewer = snapshots.clone();
        for snapshot in &mut fewer[5..] {
            snapshot.grains.remove(0);
        }
        let all = profile(&snapshots, Motion::Displacement, 0, 1, 4);
        assert_eq!(profile(&fewer, Motion::Displacement, 0, 1, 4), all[1..]);
        // The fastest disc moves by 0.6 of the period. Its nearest image would be at −0.4 of the period.
        let rare = [snapshots[0].clone(), snapshot(0.6 * 4.0 / 3.5)];
        assert!(profile(&rare, Motion::Displacement, 0, 1, 4).is_empty());
        assert!(!profile(&rare, Motion::Velocity, 0, 1, 4).is_empty());
    }
}
