//! VTK points in legacy or XML files.

use crate::read::format::{ByPlace, Format, Holds, ToldBy, check_grains};
use crate::read::snapshot::Numbering;
use crate::read::vtk::{self, Kind};

pub(crate) static FORMAT: Format = Format {
    words: "a file of VTK's",
    told_by: ToldBy::Beginning(|beginning| vtk::kind(beginning.unpacked) == Some(Kind::Points)),
    numbering: Numbering::Files,
    holds: |_| Ok(Holds::Moment),
    open: |path, most_rows| {
        let file = path.to_owned();
        Ok(ByPlace::boxed(path, move |place| {
            if place > 0 {
                return Ok(None);
            }
            let points = vtk::read_points(&file)?;
            check_grains(&file.to_string_lossy(), points.rows(), most_rows)?;
            Ok(Some(points))
        }))
    },
};
