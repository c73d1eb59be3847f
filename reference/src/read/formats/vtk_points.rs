//! VTK points in legacy or XML files.

use crate::read::format::{ByPlace, Format, Holds, ToldBy};
use crate::read::snapshot::Numbering;
use crate::read::vtk::{self, Kind};

pub(crate) static FORMAT: Format = Format {
    words: "a file of VTK's",
    told_by: ToldBy::Beginning(|of| vtk::kind(of.unpacked) == Some(Kind::Points)),
    numbering: Numbering::Files,
    holds: |_| Ok(Holds::Moment),
    open: |path, _| {
        let file = path.to_owned();
        Ok(ByPlace::boxed(path, move |place| if place == 0 { vtk::read_points(&file).map(Some) } else { Ok(None) }))
    },
};
