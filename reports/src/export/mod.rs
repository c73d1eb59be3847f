//! Export of records to file formats of other programs.

mod dump;
pub mod record_json;
pub(crate) mod vtk;

#[cfg(test)]
pub(crate) mod sample;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use grainbench_solver::record::{Record, Series, Snapshot};

use crate::parts::{READABLE, SnapshotStore};
use crate::table::{Cell, Column, Format, Table};
use grainbench_store::{StagedDir, WriteError};

/// Format of snapshots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SnapshotFormat {
    /// One LAMMPS text dump of all grains: `snapshots.dump`.
    Dump,
    /// In `vtk/`, one file per snapshot for grains, contacts and material points, and one collection of files for each.
    Vtk,
    /// In `snapshots/`, parts with one Parquet file per kind of row (see [`crate::parts`]). The time series is also
    /// written as `series.parquet`.
    Parquet,
}

impl SnapshotFormat {
    /// Names on the command line: those of the formats, and `none`.
    pub const NAMES: [&str; 4] = ["dump", "vtk", "parquet", "none"];

    /// Returns the format with a name; none for `none`.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        match name {
            "dump" => Some(Self::Dump),
            "vtk" => Some(Self::Vtk),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    /// Returns the default formats: LAMMPS dump and VTK for a run with at most [`READABLE`] rows. For a larger run, it is
    /// Parquet, or no format if snapshots were omitted from the store.
    #[must_use]
    pub fn usual(snapshots: &SnapshotStore) -> BTreeSet<Self> {
        match (snapshots.rows() <= READABLE, snapshots.has_left_out()) {
            (true, _) => [Self::Dump, Self::Vtk].into(),
            (false, false) => [Self::Parquet].into(),
            (false, true) => BTreeSet::new(),
        }
    }
}

/// Writes a run to `out`: `series.csv`, `record.json` and the snapshots.
///
/// # Errors
/// When a file cannot be written.
pub fn write_run(
    record: &Record,
    snapshots: &mut SnapshotStore,
    formats: &BTreeSet<SnapshotFormat>,
    out: &mut StagedDir,
) -> Result<(), WriteError> {
    snapshots.settle()?;
    out.write_with(record_json::RECORD_FILE, |file| record_json::write(record, snapshots, file))?;
    write_series(&record.series, snapshots, formats, out)
}

/// Names of the files of a run outside its folders, with the page of `report`.
pub const FILES: [&str; 6] =
    [record_json::RECORD_FILE, BROKEN_FILE, "series.csv", "series.parquet", "snapshots.dump", "index.html"];
/// Name of the file that describes a crashed run.
pub const BROKEN_FILE: &str = "broken.json";

/// Writes the output of a crashed run: `broken.json` instead of a record, the time series up to the crash, and the
/// snapshots. The last snapshot is the state at the crash. `broken.json` contains the error message of the solver, and the
/// step and the time (s) of this snapshot.
///
/// # Errors
/// When a file cannot be written.
pub fn write_remains(
    error: &str,
    series: &Series,
    snapshots: &mut SnapshotStore,
    formats: &BTreeSet<SnapshotFormat>,
    out: &mut StagedDir,
) -> Result<(), WriteError> {
    snapshots.settle()?;
    let (step, time) = snapshots.end().map_or((0, 0.0), |end| (end.step, end.time));
    let state = serde_json::json!({ "error": error, "step": step, "time": time });
    out.write(BROKEN_FILE, format!("{state:#}\n"))?;
    write_series(series, snapshots, formats, out)
}

fn write_series(
    series: &Series,
    snapshots: &mut SnapshotStore,
    formats: &BTreeSet<SnapshotFormat>,
    out: &mut StagedDir,
) -> Result<(), WriteError> {
    out.write_with("series.csv", |file| series_table(series).csv(file))?;
    if formats.contains(&SnapshotFormat::Parquet) {
        out.write_with("series.parquet", |file| series_table(series).parquet(file))?;
    }
    if formats.contains(&SnapshotFormat::Dump) {
        out.write_with("snapshots.dump", |file| {
            file.write_all(dump::HEAD.as_bytes())?;
            snapshots.each(std::convert::identity, |snapshot| dump::add(snapshot, file))
        })?;
    }
    if formats.contains(&SnapshotFormat::Vtk) {
        write_vtk(snapshots, out)?;
    }
    if formats.contains(&SnapshotFormat::Parquet) {
        for (path, name) in snapshots.files()? {
            out.link(PathBuf::from("snapshots").join(name), &path)?;
        }
    }
    Ok(())
}

/// Returns the table `step`, `time (s)`, `NAME (unit)`, … with one row per sample. A short column has empty cells.
fn series_table(series: &Series) -> Table<'_> {
    let columns = [Column::new("step", Format::Count), Column::number("time").unit("s")].into_iter();
    let quantities = series.columns.iter().map(|column| Column::number(&column.name).unit(&column.unit));
    let rows = series.step.iter().zip(&series.time).enumerate().map(|(sample, (step, time))| {
        let values = series.values.iter().map(|column| Cell::from(column.get(sample).copied()));
        [Cell::from(*step), Cell::from(*time)].into_iter().chain(values).collect()
    });
    Table::new("series", columns.chain(quantities), rows)
}

fn write_vtk(snapshots: &SnapshotStore, out: &mut StagedDir) -> Result<(), WriteError> {
    /// Name, writer and condition of a kind of files.
    type Kind = (&'static str, fn(&Snapshot, &mut BufWriter<File>) -> io::Result<()>, fn(&Snapshot) -> bool);
    const KINDS: [Kind; 3] = [
        ("grains", vtk::write_grains, |_| true),
        ("contacts", vtk::write_contacts, |snapshot| snapshot.contacts.is_some()),
        ("points", vtk::write_points, |snapshot| !snapshot.points.is_empty()),
    ];
    let mut files = [const { Vec::new() }; KINDS.len()];
    let target = out.target().to_path_buf();
    let mut number = 0;
    let unreadable = |source| WriteError::new(&target, source);
    snapshots.each(unreadable, |snapshot| {
        for ((kind, write, is_there), files) in KINDS.iter().zip(&mut files) {
            if is_there(snapshot) {
                let name = format!("{kind}-{number:06}.vtp");
                out.write_with(format!("vtk/{name}"), |file| write(snapshot, file))?;
                files.push((snapshot.time, name));
            }
        }
        number += 1;
        Ok(())
    })?;
    for ((kind, ..), files) in KINDS.iter().zip(&files).filter(|(_, files)| !files.is_empty()) {
        out.write(format!("vtk/{kind}.pvd"), vtk::collection(files))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    /// Writes a run to a temporary directory. Returns its guard and the output directory.
    fn written(snapshots: &[Snapshot], formats: &[SnapshotFormat]) -> (tempfile::TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let mut store = SnapshotStore::for_output(&target);
        snapshots.iter().for_each(|snapshot| store.add(snapshot.clone()).unwrap());
        let mut out = StagedDir::new(&target).unwrap();
        write_run(&sample::record(), &mut store, &formats.iter().copied().collect(), &mut out).unwrap();
        out.commit().unwrap();
        (dir, target)
    }

    #[test]
    fn points_and_contacts_have_files_if_they_are_known() {
        let (_dir, target) = written(&[sample::snapshot(), sample::deformable()], &[SnapshotFormat::Vtk]);
        assert!(target.join("vtk/points-000001.vtp").is_file() && target.join("vtk/points.pvd").is_file());
        assert!(!target.join("vtk/points-000000.vtp").exists() && !target.join("snapshots.dump").exists());
        let untold = Snapshot { contacts: None, ..sample::snapshot() };
        let (_dir, target) = written(&[untold, sample::snapshot()], &[SnapshotFormat::Vtk]);
        assert!(!target.join("vtk/contacts-000000.vtp").exists() && target.join("vtk/contacts-000001.vtp").is_file());
    }

    #[test]
    fn writes_every_format() {
        let all = [SnapshotFormat::Dump, SnapshotFormat::Vtk, SnapshotFormat::Parquet];
        let (_dir, target) = written(&sample::record().snapshots, &all);
        assert!(!target.join("vtk/points.pvd").exists(), "rigid grains have no points");
        let names = "series.csv record.json snapshots.dump vtk/grains.pvd vtk/contacts.pvd vtk/grains-000001.vtp \
                     vtk/contacts-000000.vtp";
        for name in names.split(' ') {
            assert!(target.join(name).is_file(), "{name}");
        }
        let parts: Vec<_> = std::fs::read_dir(target.join("snapshots")).unwrap().flatten().collect();
        assert_eq!(parts.len(), 1);
        for name in ["snapshots.parquet", "grains.parquet", "contacts.parquet", "walls.parquet"] {
            assert!(parts[0].path().join(name).is_file(), "{name}");
        }
    }

    #[test]
    fn keeps_every_digit() {
        assert_eq!(
            series_table(&sample::series()).csv_text(),
            "step,time (s),disc.x (m),\"a,b (1)\"\n\
             0,0.0,1.0,-1e-300\n\
             5,0.30000000000000004,0.3333333333333333,2e20\n"
        );
    }

    #[test]
    fn keeps_every_bit() {
        let file = tempfile::tempfile().unwrap();
        series_table(&sample::series()).parquet(&file).unwrap();
        let file = SerializedFileReader::new(file).unwrap();
        let rows: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(
            rows[0].get_column_iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
            ["step", "time (s)", "disc.x (m)", "a,b (1)"]
        );
        assert_eq!(rows[1].get_long(0).unwrap(), 5);
        assert_eq!(rows[1].get_double(1).unwrap(), 0.300_000_000_000_000_04);
        assert_eq!(rows[0].get_double(3).unwrap(), -1e-300);
    }
}
