//! Records in formats that other programs read.

pub mod dump;
pub mod record_json;
pub mod series_csv;
pub mod vtk;

#[cfg(test)]
pub(crate) mod sample;

use grainbench_scene::record::Record;

use crate::staged::StagedDir;
use crate::write::WriteError;

/// Adds every format to `out`: `series.csv`, `record.json`, `snapshots.dump`, and under `vtk/` one file a snapshot
/// with `grains.pvd` and `contacts.pvd` to open them by, and `points.pvd` where bodies have material points.
///
/// # Errors
/// When the disk refuses.
pub fn write_record(record: &Record, out: &mut StagedDir) -> Result<(), WriteError> {
    out.write_with("series.csv", |file| series_csv::write(&record.series, file))?;
    out.write_with(record_json::RECORD_FILE, |file| record_json::write(record, file))?;
    out.write_with("snapshots.dump", |file| dump::write(&record.snapshots, file))?;
    let mut grains = Vec::new();
    let mut contacts = Vec::new();
    let mut points = Vec::new();
    for (index, snapshot) in record.snapshots.iter().enumerate() {
        let grain_file = format!("grains-{index:06}.vtp");
        let contact_file = format!("contacts-{index:06}.vtp");
        out.write_with(format!("vtk/{grain_file}"), |file| vtk::write_grains(snapshot, file))?;
        out.write_with(format!("vtk/{contact_file}"), |file| vtk::write_contacts(snapshot, file))?;
        grains.push((snapshot.time, grain_file));
        contacts.push((snapshot.time, contact_file));
        if !snapshot.points.is_empty() {
            let point_file = format!("points-{index:06}.vtp");
            out.write_with(format!("vtk/{point_file}"), |file| vtk::write_points(snapshot, file))?;
            points.push((snapshot.time, point_file));
        }
    }
    if !points.is_empty() {
        out.write("vtk/points.pvd", vtk::collection(&points))?;
    }
    out.write("vtk/grains.pvd", vtk::collection(&grains))?;
    out.write("vtk/contacts.pvd", vtk::collection(&contacts))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn material_points_have_files_of_their_own() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let mut out = StagedDir::new(&target).unwrap();
        let record = Record { snapshots: vec![sample::snapshot(), sample::deformable()], ..sample::record() };
        write_record(&record, &mut out).unwrap();
        out.commit().unwrap();
        assert!(target.join("vtk/points-000001.vtp").is_file() && target.join("vtk/points.pvd").is_file());
        assert!(!target.join("vtk/points-000000.vtp").exists());
    }

    #[test]
    fn writes_every_format() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let mut out = StagedDir::new(&target).unwrap();
        write_record(&sample::record(), &mut out).unwrap();
        out.commit().unwrap();
        assert!(!target.join("vtk/points.pvd").exists(), "rigid grains have no points");
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
