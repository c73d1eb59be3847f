//! Records in formats that other programs read.

pub mod dump;
pub mod record_json;
pub mod series_csv;
pub mod vtk;

#[cfg(test)]
mod sample;

use grainbench_scene::record::Record;

use crate::staged::StagedDir;
use crate::write::WriteError;

/// Adds every format to `out`: `series.csv`, `record.json`, `snapshots.dump`, and under `vtk/` one file a snapshot
/// with `grains.pvd` and `contacts.pvd` to open them by.
///
/// # Errors
/// When the disk refuses.
pub fn write_record(record: &Record, out: &mut StagedDir) -> Result<(), WriteError> {
    out.write_with("series.csv", |file| series_csv::write(&record.series, file))?;
    out.write_with("record.json", |file| record_json::write(record, file))?;
    out.write_with("snapshots.dump", |file| dump::write(&record.snapshots, file))?;
    let mut grains = Vec::new();
    let mut contacts = Vec::new();
    for (index, snapshot) in record.snapshots.iter().enumerate() {
        let grain_file = format!("grains-{index:06}.vtp");
        let contact_file = format!("contacts-{index:06}.vtp");
        out.write_with(format!("vtk/{grain_file}"), |file| vtk::write_grains(snapshot, file))?;
        out.write_with(format!("vtk/{contact_file}"), |file| vtk::write_contacts(snapshot, file))?;
        grains.push((snapshot.time, grain_file));
        contacts.push((snapshot.time, contact_file));
    }
    out.write("vtk/grains.pvd", vtk::collection(&grains))?;
    out.write("vtk/contacts.pvd", vtk::collection(&contacts))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writes_every_format() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let mut out = StagedDir::new(&target).unwrap();
        write_record(&sample::record(), &mut out).unwrap();
        out.commit().unwrap();
        for name in [
            "series.csv",
            "record.json",
            "snapshots.dump",
            "vtk/grains.pvd",
            "vtk/contacts.pvd",
            "vtk/grains-000001.vtp",
            "vtk/contacts-000000.vtp",
        ] {
            assert!(target.join(name).is_file(), "{name}");
        }
        // For a look with the programs that these files are for.
        if let Ok(copy) = std::env::var("GRAINBENCH_EXPORT_DIR") {
            let mut out = StagedDir::new(copy).unwrap();
            write_record(&sample::record(), &mut out).unwrap();
            out.commit().unwrap();
        }
    }
}
