//! Columns of a snapshot of grains.

use crate::names::Names;
use crate::read::snapshot::{Coordinate, DumpSnapshot};

/// Indices of the columns of a snapshot of grains; `None` for missing columns.
pub(crate) struct GrainColumns {
    pub(crate) id: Option<usize>,
    pub(crate) kind: Option<usize>,
    pub(crate) position: [Option<Coordinate>; 3],
    pub(crate) velocity: [Option<usize>; 3],
    pub(crate) spin: [Option<usize>; 3],
    pub(crate) angle: Option<usize>,
    /// Index of the column of radii or diameters, and factor from its values to radii.
    pub(crate) radius: Option<(usize, f64)>,
    pub(crate) mass: Option<usize>,
    pub(crate) density: Option<usize>,
}

impl GrainColumns {
    pub(crate) fn find(snapshot: &DumpSnapshot, names: &Names) -> Self {
        let column = |name: &str| snapshot.column(names.in_file(name));
        Self {
            id: column("id"),
            kind: column("type"),
            position: [0, 1, 2].map(|axis| names.coordinate(snapshot, axis)),
            velocity: ["vx", "vy", "vz"].map(column),
            spin: ["omegax", "omegay", "omegaz"].map(column),
            angle: column("angle"),
            radius: column("radius").map(|at| (at, 1.0)).or_else(|| column("diameter").map(|at| (at, 0.5))),
            mass: column("mass"),
            density: column("density"),
        }
    }
}
