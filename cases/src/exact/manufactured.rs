//! Error of a run against its manufactured solution.

use grainbench_harness::prelude::*;
use grainbench_scene::manufactured::Medium;

/// Returns the error of the final displacement (m): the root mean square over the material points, weighted by volume. It
/// fails without material points in the record or manufactured motion in the scene.
pub(crate) fn error(done: &FinishedRun) -> Result<f64, MissingData> {
    let missing = || MissingData("material points at the end".to_owned());
    let (scene, snapshot) = (&done.scene, done.record.snapshots.last().ok_or_else(missing)?);
    let (material, motion) = scene.deformable[0].zip(scene.start.manufactured).ok_or_else(missing)?;
    let medium =
        Medium { density: scene.bodies[0].density, lame: material.lame(), shear_modulus: material.shear_modulus };
    if snapshot.points.is_empty() {
        return Err(missing());
    }
    let (sum, volume) = snapshot.points.iter().fold((0.0, 0.0), |(sum, volume), point| {
        let exact = motion.displacement(&medium, point.position - point.displacement, snapshot.time);
        (sum + (point.displacement - exact).norm_squared() * point.volume, volume + point.volume)
    });
    Ok((sum / volume).sqrt())
}

/// Returns the order of convergence in the cell length, fitted over runs with these numbers of cells per metre.
pub(crate) fn order(done: &[FinishedRun], cells: &[f64]) -> Result<f64, MissingData> {
    let point = |(done, cells): (&FinishedRun, &f64)| Ok((1.0 / cells, error(done)?));
    Ok(slope(&done.iter().zip(cells).map(point).collect::<Result<Vec<_>, MissingData>>()?))
}
