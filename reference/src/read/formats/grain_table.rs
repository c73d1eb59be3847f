//! Tables of grains from ParaView, pandas or any other program. Each row is one grain at one moment.

use crate::read::format::{FileContent, Format, FormatCriterion, IndexedSnapshots, check_grains};
use crate::read::grain_table::{is_of_grains, read_moments};
use crate::read::snapshot::Numbering;

pub(crate) static FORMAT: Format = Format {
    words: "a table of grains",
    told_by: FormatCriterion::Names(is_of_grains),
    numbering: Numbering::Frames,
    holds: |path| {
        let moments = read_moments(path)?;
        let begins = moments.first().map(|first| first.step);
        Ok(if moments.iter().all(|moment| moment.is_keyed) { FileContent::Course(begins) } else { FileContent::Moment })
    },
    open: |path, most_rows| {
        let moments = read_moments(path)?;
        let most = moments.iter().map(|moment| moment.snapshot.rows()).max().unwrap_or_default();
        check_grains(&path.to_string_lossy(), most, most_rows)?;
        Ok(IndexedSnapshots::boxed(path, move |place| Ok(moments.get(place).map(|moment| moment.snapshot.clone()))))
    },
};
