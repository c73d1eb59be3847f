//! Archive of the data, which `grainbench reference fetch` unpacks.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_reference::data::unpack;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const SOUND: [&str; 2] = ["cases/silo-wide/start.state", "reference/lammps/backspin/series.csv.gz"];

fn archive(folder: &Path, names: &[&str]) -> PathBuf {
    let path = folder.join("data.zip");
    let mut writer = ZipWriter::new(fs::File::create(&path).unwrap());
    for name in names {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(name.as_bytes()).unwrap();
    }
    writer.finish().unwrap();
    path
}

#[test]
fn files_of_the_data_are_unpacked() {
    let folder = tempfile::tempdir().unwrap();
    let mut found = Vec::new();
    let count = unpack(&archive(folder.path(), &SOUND), |name, bytes| {
        assert_eq!(name.as_bytes(), bytes);
        found.push(name.to_owned());
        Ok(())
    });
    assert_eq!((count.unwrap(), found), (2, SOUND.map(str::to_owned).to_vec()));
}

#[test]
fn other_archives_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |names: &[&str]| {
        let path = archive(folder.path(), names);
        let mut taken = 0;
        let count = |_: &str, _: &[u8]| {
            taken += 1;
            Ok(())
        };
        let error = unpack(&path, count).unwrap_err().to_string();
        (error.replace(&*path.to_string_lossy(), "FILE"), taken)
    };
    let none = "FILE: expected an archive with a folder `reference/lammps`, found none".to_owned();
    assert_eq!(refused(&SOUND[..1]), (none, 0));
    for name in ["../elsewhere", "/absolute", "cases/../../elsewhere", "cases\\elsewhere", "C:/elsewhere"] {
        let (error, taken) = refused(&[name, SOUND[0], SOUND[1]]);
        assert!(error.starts_with("FILE: expected paths inside the archive, found"), "{name}: {error}");
        assert_eq!(taken, 0);
    }
    let path = archive(folder.path(), &SOUND);
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let error = unpack(&path, |_, _| Ok(())).unwrap_err().to_string();
    assert!(error.contains("expected a complete ZIP archive"), "{error}");
    let error = unpack(&folder.path().join("none.zip"), |_, _| Ok(())).unwrap_err().to_string();
    assert!(error.contains("expected a readable file"), "{error}");
}
