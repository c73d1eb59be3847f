//! VTK points in legacy or XML files.

use crate::read::format::{FileContent, Format, check_grains, indexed};
use crate::read::snapshot::Numbering;
use crate::read::vtk;

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    is_it: |beginning| vtk::is_collection(beginning.unpacked) == Some(false),
    numbering: Numbering::Files,
    holds: |_| Ok(FileContent::Moment),
    open: |path, most_rows| {
        let file = path.to_owned();
        Ok(indexed(path, move |place| {
            if place > 0 {
                return Ok(None);
            }
            let points = vtk::read_points(&file)?;
            check_grains(&file.to_string_lossy(), points.rows(), most_rows)?;
            Ok(Some(points))
        }))
    },
};
