//! VTK points in legacy or XML files.

use crate::read::format::{FileContent, Format, FormatCriterion, IndexedSnapshots, check_grains};
use crate::read::snapshot::Numbering;
use crate::read::vtk::{self, Kind};

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    told_by: FormatCriterion::Beginning(|beginning| vtk::kind(beginning.unpacked) == Some(Kind::Points)),
    numbering: Numbering::Files,
    holds: |_| Ok(FileContent::Moment),
    open: |path, most_rows| {
        let file = path.to_owned();
        Ok(IndexedSnapshots::boxed(path, move |place| {
            if place > 0 {
                return Ok(None);
            }
            let points = vtk::read_points(&file)?;
            check_grains(&file.to_string_lossy(), points.rows(), most_rows)?;
            Ok(Some(points))
        }))
    },
};
