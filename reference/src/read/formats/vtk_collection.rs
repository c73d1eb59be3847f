//! Collections (`.pvd`) of VTK files with their times.

use crate::read::format::{FileContent, Format, FormatCriterion};
use crate::read::read_error::ReadError;
use crate::read::snapshot::Numbering;
use crate::read::vtk::{self, Kind};

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    told_by: FormatCriterion::Beginning(|beginning| vtk::kind(beginning.unpacked) == Some(Kind::Collection)),
    numbering: Numbering::Files,
    holds: |path| vtk::read_collection(path).map(FileContent::List),
    open: |path, _| {
        Err(ReadError::at(&path.to_string_lossy(), 1, "grains", "a list of files that contains another list"))
    },
};
