//! Names of the columns of a file.

use crate::read::snapshot::{Coordinate, DumpSnapshot};

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

    /// Returns the coordinate along an axis, from the column of the given name or from one of the columns of LAMMPS.
    pub(crate) fn coordinate(&self, snapshot: &DumpSnapshot, axis: usize) -> Option<Coordinate> {
        let name = ["x", "y", "z"][axis];
        match self.in_file(name) {
            theirs if theirs == name => snapshot.coordinate(axis),
            theirs => snapshot.coordinate_named(theirs, axis),
        }
    }
}
