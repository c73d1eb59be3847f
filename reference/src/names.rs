//! Names of the columns of a file, and the columns of a snapshot of grains.

use crate::read::snapshot::{Coordinate, DumpSnapshot};

/// Our names of the coordinates.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Our names of the columns of grains and of contacts, besides forces of walls such as `WALL.force_x`.
pub(crate) const OURS: &str = "id type x y z vx vy vz omegax omegay omegaz angle radius diameter mass density id1 id2 \
                               force_x force_y force_z tangential_x tangential_y tangential_z";

/// Names of columns in a file that differ from those of LAMMPS. Each entry is a pair of our name, such as `x`, `vx` or
/// `omegaz`, and the name in the file.
///
/// For other quantities our names are: `angle` for the rotation angle of a disc (rad), and `WALL.force_x` for the force of
/// the scene's wall `WALL` on a grain.
///
/// In dumps of contacts, our names are `id1`, `id2`, and `force_x` for the force on the first grain. `tangential_x` is
/// the tangential force, if it has separate columns.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names(pub Vec<(String, String)>);

impl Names {
    /// Returns the name of a column in the file.
    #[must_use]
    pub fn in_file<'n>(&'n self, name: &'n str) -> &'n str {
        self.0.iter().find(|(ours, _)| ours == name).map_or(name, |(_, theirs)| theirs)
    }

    /// Returns the coordinate `x`, `y` or `z`, from the column of the given name or from one of the columns of LAMMPS.
    pub(crate) fn coordinate(&self, snapshot: &DumpSnapshot, name: &str) -> Option<Coordinate> {
        let axis = AXES.iter().position(|axis| *axis == name)?;
        match self.in_file(name) {
            theirs if theirs == name => snapshot.coordinate(axis),
            theirs => snapshot.coordinate_named(theirs, axis),
        }
    }
}

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
            position: AXES.map(|axis| names.coordinate(snapshot, axis)),
            velocity: ["vx", "vy", "vz"].map(column),
            spin: ["omegax", "omegay", "omegaz"].map(column),
            angle: column("angle"),
            radius: column("radius").map(|at| (at, 1.0)).or_else(|| column("diameter").map(|at| (at, 0.5))),
            mass: column("mass"),
            density: column("density"),
        }
    }
}
