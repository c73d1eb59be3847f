//! VTK points in HDF5 files.

use crate::read::format::{FileContent, Format, FormatCriterion, IndexedSnapshots, check_grains};
use crate::read::snapshot::Numbering;
use crate::read::vtk;

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    told_by: FormatCriterion::Beginning(|beginning| beginning.bytes.starts_with(vtk::MARK)),
    numbering: Numbering::Files,
    holds: |path| Ok(if vtk::has_steps(path)? { FileContent::Course(None) } else { FileContent::Moment }),
    open: |path, most_rows| {
        let moments = vtk::read_moments(path)?;
        check_grains(moments.name(), moments.grains(), most_rows)?;
        Ok(IndexedSnapshots::boxed(path, move |place| moments.snapshot(place)))
    },
};
