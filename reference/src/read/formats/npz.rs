//! Arrays of NumPy.

use crate::read::format::{FileContent, Format, FormatCriterion, IndexedSnapshots, check_grains};
use crate::read::npz::{MARK, read_course};
use crate::read::snapshot::Numbering;

pub(crate) static FORMAT: Format = Format {
    words: "NumPy arrays",
    // ZIP archives with other endings are read as text and then refused.
    told_by: FormatCriterion::Beginning(|beginning| {
        beginning.bytes.starts_with(MARK)
            && beginning.path.extension().is_some_and(|end| end.eq_ignore_ascii_case("npz"))
    }),
    numbering: Numbering::Steps,
    holds: |_| Ok(FileContent::Course(None)),
    open: |path, most_rows| {
        let course = read_course(path)?;
        check_grains(course.name(), course.grains(), most_rows)?;
        Ok(IndexedSnapshots::boxed(path, move |place| Ok(course.snapshot(place))))
    },
};
