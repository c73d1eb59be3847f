//! What is measured of a sheared slab, of grains alone so that it is one measure for all methods, but for voids and
//! yield.

use grainbench_fields::overlap::disc_in_box;
use grainbench_harness::prelude::{Done, Missing};
use grainbench_scene::record::{GrainState, PointState, Snapshot};
use std::collections::HashMap;

/// Columns that displacements are averaged over.
const COLUMNS: usize = 20;

/// Width of the slab (m).
pub(crate) fn width(done: &Done) -> f64 {
    done.scene.domain.map_or(f64::NAN, |domain| domain.high.x - domain.low.x)
}

/// Height of its period (m).
fn period(done: &Done) -> f64 {
    done.scene.domain.map_or(f64::NAN, |domain| domain.high.y - domain.low.y)
}

/// Speed of the moving side (m/s).
pub(crate) fn speed(done: &Done) -> f64 {
    done.scene.driven.iter().map(|driven| driven.velocity.y).fold(0.0, f64::max)
}

/// The mean shear at a time.
pub(crate) fn shear(done: &Done, time: f64) -> f64 {
    speed(done) * time / width(done)
}

/// The snapshot at a mean shear.
pub(crate) fn at(done: &Done, wanted: f64) -> Result<&Snapshot, Missing> {
    let off = |snapshot: &Snapshot| (shear(done, snapshot.time) - wanted).abs();
    let nearest = done.record.snapshots.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.filter(|snapshot| off(snapshot) < 5e-3).ok_or_else(|| Missing(format!("snapshot at a shear of {wanted}")))
}

/// The snapshot at the end.
pub(crate) fn end(done: &Done) -> Result<&Snapshot, Missing> {
    done.record.snapshots.last().ok_or_else(|| Missing("snapshot".to_owned()))
}

/// The grains that are not driven.
pub(crate) fn free<'a>(done: &Done, snapshot: &'a Snapshot) -> Vec<&'a GrainState> {
    let groups = done.scene.driven_group_of_grains();
    snapshot.grains.iter().zip(groups).filter(|(_, group)| group.is_none()).map(|(grain, _)| grain).collect()
}

/// Plastic strain, mean over the mass of free grains.
pub(crate) fn plastic_strain(done: &Done, snapshot: &Snapshot) -> f64 {
    let grains = free(done, snapshot);
    let mass: f64 = grains.iter().map(|grain| grain.mass).sum();
    grains.iter().map(|grain| grain.plastic_strain * grain.mass).sum::<f64>() / mass
}

/// Area of a disc about `x` between two lines across the slab (m²).
fn between(edges: [f64; 2], x: f64, radius: f64) -> f64 {
    disc_in_box(radius, [edges[0] - x, -radius], [edges[1] - x, radius])
}

/// Displacement of grains along the slab, averaged over columns by the area of grains in each, as a fraction of that of
/// the moving side: (middle of the column over the width, displacement).
pub(crate) fn profile(done: &Done, snapshot: &Snapshot) -> Vec<(f64, f64)> {
    let (moved, period, width) = (speed(done) * snapshot.time, period(done), width(done));
    let displacements: Vec<f64> = (snapshot.grains.iter().zip(&done.scene.grains))
        .map(|(now, start)| {
            // Of the images, the one whose displacement is nearest to half of the side's: grains go nowhere else.
            let way = now.position.y - start.position.y;
            way - period * ((way - 0.5 * moved) / period).round()
        })
        .collect();
    (0..COLUMNS)
        .map(|column| {
            let edges = [column, column + 1].map(|edge| width * edge as f64 / COLUMNS as f64);
            let (mut area, mut sum) = (0.0, 0.0);
            for (grain, displacement) in snapshot.grains.iter().zip(&displacements) {
                let inside = between(edges, grain.position.x, grain.radius);
                area += inside;
                sum += inside * displacement;
            }
            ((column as f64 + 0.5) / COLUMNS as f64, sum / (area * moved))
        })
        .collect()
}

/// Width of the band in which displacement goes from nothing to all, over that of the slab: twice the mean of the
/// profile, which is 1 for uniform shear and b for a profile that rises linearly over the part b at the moving side.
pub(crate) fn band(done: &Done, snapshot: &Snapshot) -> f64 {
    let profile = profile(done, snapshot);
    2.0 * profile.iter().map(|(_, displacement)| displacement).sum::<f64>() / profile.len() as f64
}

/// How much of the displacement has happened in the half of the slab at the moving side.
pub(crate) fn at_the_moving_side(done: &Done, snapshot: &Snapshot) -> f64 {
    let profile = profile(done, snapshot);
    profile[COLUMNS - 1].1 - 0.5 * (profile[COLUMNS / 2 - 1].1 + profile[COLUMNS / 2].1)
}

/// Rotation of free grains since the start, root of the mean square (degrees).
pub(crate) fn rotation_deg(done: &Done, snapshot: &Snapshot) -> f64 {
    let grains = free(done, snapshot);
    (grains.iter().map(|grain| grain.angle.unwrap_or(f64::NAN).powi(2)).sum::<f64>() / grains.len() as f64)
        .sqrt()
        .to_degrees()
}

/// Cells of the paper's grid across the slab.
const CELLS: usize = 150;
/// Cells across a large void.
const VOID: usize = 5;

/// Large voids: squares of five cells of the paper's grid, 40 µm, at any place of that grid within the slab, in which
/// there is nothing; no material point lies in them, or no disc covers the centre of one of their cells. Squares may
/// overlap.
pub(crate) fn large_voids(done: &Done, snapshot: &Snapshot) -> usize {
    let empty = empty_cells(done, snapshot);
    let is_void =
        |column: usize, row: usize| (0..VOID).all(|i| (0..VOID).all(|j| empty[(row + j) % CELLS * CELLS + column + i]));
    (0..CELLS).map(|row| (0..=CELLS - VOID).filter(|&column| is_void(column, row)).count()).sum()
}

/// Which cells of the paper's grid are empty, row by row along the slab.
fn empty_cells(done: &Done, snapshot: &Snapshot) -> Vec<bool> {
    let low = done.scene.domain.map_or([0.0; 2], |domain| [domain.low.x, domain.low.y]);
    let cells = [width(done), period(done)].map(|length| length / CELLS as f64);
    let mut empty = vec![true; CELLS * CELLS];
    let mut fill = |column: i64, row: i64| {
        if (0..CELLS as i64).contains(&column) {
            empty[row.rem_euclid(CELLS as i64) as usize * CELLS + column as usize] = false;
        }
    };
    for point in &snapshot.points {
        let [column, row] = [0, 1].map(|axis| ((point.position[axis] - low[axis]) / cells[axis]).floor() as i64);
        fill(column, row);
    }
    if !snapshot.points.is_empty() {
        return empty;
    }
    for grain in &snapshot.grains {
        // Centres of cells between two lines through the disc.
        let between = |axis: usize, middle: f64, half: f64| {
            let at = |place: f64| (place - low[axis]) / cells[axis] - 0.5;
            at(middle - half).ceil() as i64..=at(middle + half).floor() as i64
        };
        for column in between(0, grain.position.x, grain.radius) {
            let away = low[0] + (column as f64 + 0.5) * cells[0] - grain.position.x;
            let half = (grain.radius.powi(2) - away.powi(2)).max(0.0).sqrt();
            between(1, grain.position.y, half).for_each(|row| fill(column, row));
        }
    }
    empty
}

/// Part of the shear for which the start is left out of means over time.
const STARTED: f64 = 0.2;

/// Standard deviation over mean of a force, such as that on the side that stands still, in blocks of 1/2 % of shear.
pub(crate) fn fluctuation(done: &Done, force: &str) -> Result<f64, Missing> {
    let (mut blocks, mut from) = (vec![Vec::new()], STARTED);
    for (&time, force) in done.series().time.iter().zip(done.column(force)?) {
        let now = shear(done, time);
        if now < STARTED {
            continue;
        }
        if now - from >= 5e-3 {
            blocks.push(Vec::new());
            from = now;
        }
        blocks.last_mut().into_iter().for_each(|block| block.push(*force));
    }
    let means: Vec<f64> = blocks
        .iter()
        .filter(|block| !block.is_empty())
        .map(|block| block.iter().sum::<f64>() / block.len() as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let variance = means.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / (means.len() as f64 - 1.0);
    Ok(variance.sqrt() / mean.abs())
}

/// Mean normal stress of a point (Pa), tension positive.
pub(crate) fn mean_stress(point: &PointState) -> f64 {
    (point.stress[0] + point.stress[1] + point.stress[2]) / 3.0
}

/// Squared norm of the deviator of the stress of a point, s:s (Pa²).
pub(crate) fn deviator_squared(point: &PointState) -> f64 {
    let mean = mean_stress(point);
    let [xx, yy, zz, xy, yz, zx] = point.stress;
    [xx, yy, zz].iter().map(|stress| (stress - mean).powi(2)).sum::<f64>() + 2.0 * (xy * xy + yz * yz + zx * zx)
}

/// Points of a snapshot with those of the start, which are found by where they were.
pub(crate) fn with_their_start<'a>(
    done: &'a Done,
    snapshot: &'a Snapshot,
) -> Result<Vec<(&'a PointState, &'a PointState)>, Missing> {
    // Places at the start are exact to rounding, and points lie a thousand times this apart.
    let pitch = 1e-6 * width(done);
    let key = |point: &PointState| {
        let start = (point.position - point.displacement) / pitch;
        (format!("{:?}", point.owner), start.x.round() as i64, start.y.round() as i64)
    };
    let first = done.record.snapshots.first().ok_or_else(|| Missing("snapshot".to_owned()))?;
    let at_start: HashMap<_, _> = first.points.iter().map(|point| (key(point), point)).collect();
    let found: Vec<_> = snapshot.points.iter().filter_map(|point| Some((point, *at_start.get(&key(point))?))).collect();
    // Rounding may move a few to the next key.
    if found.len() * 100 < snapshot.points.len() * 99 || found.is_empty() {
        return Err(Missing("material points of the start".to_owned()));
    }
    Ok(found)
}
