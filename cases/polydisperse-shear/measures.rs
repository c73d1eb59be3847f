//! Measurements on a sheared slab. Most measurements use only grains, so they apply to all methods. Voids and plastic
//! strain also use material points.

use grainbench_fields::overlap::disc_in_box;
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::mean_and_variance;
use grainbench_solver::record::PointState;
use std::collections::HashMap;

/// Number of columns over which displacements are averaged.
const COLUMNS: usize = 20;

/// Returns the width of the slab (m).
pub(crate) fn width(done: &FinishedRun) -> f64 {
    done.scene.domain.map_or(f64::NAN, |domain| domain.high.x - domain.low.x)
}

/// Returns the length of the slab's period (m).
fn period(done: &FinishedRun) -> f64 {
    done.scene.domain.map_or(f64::NAN, |domain| domain.high.y - domain.low.y)
}

/// Returns the speed of the moving side (m/s).
pub(crate) fn speed(done: &FinishedRun) -> f64 {
    done.scene.driven.iter().map(|driven| driven.velocity.y).fold(0.0, f64::max)
}

/// Returns the mean shear at a time (s).
pub(crate) fn shear(done: &FinishedRun, time: f64) -> f64 {
    speed(done) * time / width(done)
}

/// Returns the snapshot nearest to a mean shear; an error if it differs by 0.005 or more.
pub(crate) fn at(done: &FinishedRun, wanted: f64) -> Result<&Snapshot, MissingData> {
    let off = |snapshot: &Snapshot| (shear(done, snapshot.time) - wanted).abs();
    let nearest = done.record.snapshots.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest
        .filter(|snapshot| off(snapshot) < 5e-3)
        .ok_or_else(|| MissingData(format!("snapshot at a shear of {wanted}")))
}

/// Returns the snapshot at the end.
pub(crate) fn end(done: &FinishedRun) -> Result<&Snapshot, MissingData> {
    done.record.snapshots.last().ok_or_else(|| "snapshot".into())
}

/// Returns the grains without prescribed motion.
pub(crate) fn free<'a>(done: &FinishedRun, snapshot: &'a Snapshot) -> Vec<&'a GrainState> {
    let groups = done.scene.driven_group_of_grains();
    snapshot.grains.iter().zip(groups).filter(|(_, group)| group.is_none()).map(|(grain, _)| grain).collect()
}

/// Returns the plastic strain, averaged over the mass of free grains.
pub(crate) fn plastic_strain(done: &FinishedRun, snapshot: &Snapshot) -> f64 {
    let grains = free(done, snapshot);
    let mass: f64 = grains.iter().map(|grain| grain.mass).sum();
    grains.iter().map(|grain| grain.plastic_strain * grain.mass).sum::<f64>() / mass
}

/// Returns the area (m²) of the part of a disc, centred at `x`, between two lines of constant x (`edges`).
fn between(edges: [f64; 2], x: f64, radius: f64) -> f64 {
    disc_in_box(radius, [edges[0] - x, -radius], [edges[1] - x, radius])
}

/// Returns a pair for each column: its middle over the width, and the mean displacement of grains over that of the
/// moving side. The mean is weighted by the area of grains in the column.
pub(crate) fn profile(done: &FinishedRun, snapshot: &Snapshot) -> Vec<(f64, f64)> {
    let (moved, period, width) = (speed(done) * snapshot.time, period(done), width(done));
    let displacements: Vec<f64> = (snapshot.grains.iter().zip(&done.scene.grains))
        .map(|(now, start)| {
            // The periodic image is the one whose displacement is nearest to half of the displacement of the side,
            // because no grain moves farther than the side.
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

/// Returns the width of the shear band divided by the width of the slab: twice the mean of the profile. It is 1 for
/// uniform shear, and b for a profile that rises linearly over a fraction b of the width at the moving side.
pub(crate) fn band(done: &FinishedRun, snapshot: &Snapshot) -> f64 {
    let profile = profile(done, snapshot);
    2.0 * profile.iter().map(|(_, displacement)| displacement).sum::<f64>() / profile.len() as f64
}

/// Returns the fraction of the displacement that occurs in the half of the slab at the moving side.
pub(crate) fn at_the_moving_side(done: &FinishedRun, snapshot: &Snapshot) -> f64 {
    let profile = profile(done, snapshot);
    profile[COLUMNS - 1].1 - 0.5 * (profile[COLUMNS / 2 - 1].1 + profile[COLUMNS / 2].1)
}

/// Returns the root mean square rotation of free grains since the start (degrees).
pub(crate) fn rotation_deg(done: &FinishedRun, snapshot: &Snapshot) -> f64 {
    let grains = free(done, snapshot);
    (grains.iter().map(|grain| grain.angle.unwrap_or(f64::NAN).powi(2)).sum::<f64>() / grains.len() as f64)
        .sqrt()
        .to_degrees()
}

/// Number of cells of the paper's grid across the slab.
const CELLS: usize = 150;
/// Number of cells across a large void.
const VOID: usize = 5;

/// Returns the number of large voids. A large void is an empty square of five by five cells (40 µm) of the paper's
/// grid, at any position of this grid within the slab. If the snapshot has material points, a cell is empty if no point
/// is in it; otherwise, if no disc covers its centre. Squares may overlap.
pub(crate) fn large_voids(done: &FinishedRun, snapshot: &Snapshot) -> usize {
    let empty = empty_cells(done, snapshot);
    let is_void =
        |column: usize, row: usize| (0..VOID).all(|i| (0..VOID).all(|j| empty[(row + j) % CELLS * CELLS + column + i]));
    (0..CELLS).map(|row| (0..=CELLS - VOID).filter(|&column| is_void(column, row)).count()).sum()
}

/// Returns a list of the cells of the paper's grid, row by row along the slab: true for an empty cell.
fn empty_cells(done: &FinishedRun, snapshot: &Snapshot) -> Vec<bool> {
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
        // Range of cells whose centres are at most `half` from `middle`.
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

/// Mean shear from which time averages are taken.
const STARTED: f64 = 0.2;

/// Returns the standard deviation of a force divided by its mean, for means over blocks of 0.5 % of shear.
pub(crate) fn fluctuation(done: &FinishedRun, force: &str) -> Result<f64, MissingData> {
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
    let means: Vec<f64> = blocks.iter().filter(|block| !block.is_empty()).map(|block| mean(block)).collect();
    let (mean, variance) = mean_and_variance(&means);
    Ok(variance.sqrt() / mean.abs())
}

/// Returns the mean normal stress of a point (Pa), tension positive.
pub(crate) fn mean_stress(point: &PointState) -> f64 {
    (point.stress[0] + point.stress[1] + point.stress[2]) / 3.0
}

/// Returns the squared norm of a point's stress deviator, s:s (Pa²).
pub(crate) fn deviator_squared(point: &PointState) -> f64 {
    let mean = mean_stress(point);
    let [xx, yy, zz, xy, yz, zx] = point.stress;
    [xx, yy, zz].iter().map(|stress| (stress - mean).powi(2)).sum::<f64>() + 2.0 * (xy * xy + yz * yz + zx * zx)
}

/// Returns the points of a snapshot with their initial states, matched by their initial positions.
pub(crate) fn with_their_start<'a>(
    done: &'a FinishedRun,
    snapshot: &'a Snapshot,
) -> Result<Vec<(&'a PointState, &'a PointState)>, MissingData> {
    // Initial positions are exact to rounding. The pitch of the keys is a thousandth of the distance of points.
    let pitch = 1e-6 * width(done);
    let key = |point: &PointState| {
        let start = (point.position - point.displacement) / pitch;
        (format!("{:?}", point.owner), start.x.round() as i64, start.y.round() as i64)
    };
    let first = done.record.snapshots.first().ok_or("snapshot")?;
    let at_start: HashMap<_, _> = first.points.iter().map(|point| (key(point), point)).collect();
    let found: Vec<_> = snapshot.points.iter().filter_map(|point| Some((point, *at_start.get(&key(point))?))).collect();
    // Because of rounding, a few points may have a neighbouring key.
    if found.len() * 100 < snapshot.points.len() * 99 || found.is_empty() {
        return Err("material points of the start".into());
    }
    Ok(found)
}
