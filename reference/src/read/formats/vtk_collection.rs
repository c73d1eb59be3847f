//! Collections (`.pvd`) of VTK files with their times.

use crate::read::format::{FileContent, Format};
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::Numbering;
use crate::read::vtk::{self, Bytes};
use quick_xml::events::Event;
use quick_xml::reader::Reader;
use std::path::{Component, Path, PathBuf};

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    is_it: |beginning| vtk::is_collection(beginning.unpacked) == Some(true),
    numbering: Numbering::Files,
    holds: |path| read_collection(path).map(FileContent::List),
    open: |path, _| {
        Err(ReadError::at(&path.to_string_lossy(), 1, "grains", "a list of files that contains another list"))
    },
};

/// Reads the files of a collection with their times (s), in the order of the collection.
///
/// # Errors
/// If the collection cannot be read or lists no files, if an entry has no time or no file name, or if a file does not
/// exist or is outside the folder of the collection.
fn read_collection(path: &Path) -> Result<Vec<(f64, PathBuf)>, ReadError> {
    let name = path.to_string_lossy();
    let all = vtk::whole(path)?;
    let bytes = Bytes::new(&name, &all);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut reader = Reader::from_reader(&all[..]);
    let mut files = Vec::new();
    loop {
        let at = reader.buffer_position() as usize;
        match reader.read_event() {
            Ok(Event::Start(tag) | Event::Empty(tag)) if tag.name().as_ref() == b"DataSet" => {
                let value = |key: &str| {
                    let found = tag.try_get_attribute(key).ok().flatten()?;
                    found.normalized_value(quick_xml::XmlVersion::Implicit1_0).ok().map(|value| value.into_owned())
                };
                let time = value("timestep").unwrap_or_default();
                let seconds = time.parse::<f64>().ok().filter(|seconds| seconds.is_finite());
                let seconds = seconds.ok_or_else(|| bytes.error_at(at, "a time in `timestep`", quoted(&time)))?;
                let file = value("file").filter(|file| !file.is_empty());
                let file = file.ok_or_else(|| bytes.error_at(at, "a name in `file`", "none"))?;
                let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
                if !Path::new(&file).components().all(is_inside) {
                    let expected = "a path inside the folder of the collection in `file`";
                    return Err(bytes.error_at(at, expected, quoted(&file)));
                }
                let path = folder.join(&file);
                if !path.exists() {
                    return Err(bytes.error_at(at, "the name of a file that exists in `file`", quoted(&file)));
                }
                files.push((seconds, path));
            }
            Ok(Event::Eof) => break,
            Ok(_) => {}
            Err(error) => return Err(bytes.error_at(at, "a VTK collection", quoted(&error.to_string()))),
        }
    }
    if files.is_empty() { Err(bytes.error_at(0, "at least one file", "none")) } else { Ok(files) }
}
