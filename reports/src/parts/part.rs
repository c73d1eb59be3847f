//! A part of the stored snapshots: consecutive snapshots, with one Parquet file per kind of row. A closed part does not
//! change.

use std::fs;
use std::io;
use std::iter;
use std::path::{Path, PathBuf};

use grainbench_solver::record::{BodyState, ContactState, GrainState, PointState, Snapshot, WallState};
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use super::columns::Row;
use super::rows::{Frame, SnapshotRow};
use super::table::{TableReader, TableWriter, file_name, open_table};
use grainbench_store::temporary_in;

/// All tables of a part, in a fixed order.
const TABLES: [&str; 6] =
    [Frame::TABLE, GrainState::TABLE, ContactState::TABLE, WallState::TABLE, BodyState::TABLE, PointState::TABLE];

/// Name, hash and number of rows of a closed part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Seal {
    pub(super) name: String,
    /// Hash of all files of the part.
    hash: [u8; 32],
    /// Number of rows of grains, contacts and points in the part.
    pub(super) rows: u64,
}

impl Seal {
    /// Returns true if the part in a folder still has the files that were written when it was closed.
    pub(super) fn fits(&self, folder: &Path) -> bool {
        let hash = |table: &str| -> io::Result<Option<blake3::Hash>> {
            let Some(file) = open_table(folder, table)? else { return Ok(None) };
            Ok(Some(blake3::Hasher::new().update_reader(file)?.finalize()))
        };
        let hashes: io::Result<Vec<_>> = TABLES.into_iter().map(hash).collect();
        hashes.is_ok_and(|hashes| *together(&hashes).as_bytes() == self.hash)
    }
}

fn together(hashes: &[Option<blake3::Hash>]) -> blake3::Hash {
    let mut all = blake3::Hasher::new();
    for (table, hash) in TABLES.iter().zip(hashes) {
        if let Some(hash) = hash {
            all.update(table.as_bytes());
            all.update(hash.as_bytes());
        }
    }
    all.finalize()
}

/// Returns the name and the path of each existing file of a part.
pub(super) fn files(folder: &Path) -> Vec<(String, PathBuf)> {
    let named = TABLES.map(|table| (file_name(table), folder.join(file_name(table))));
    named.into_iter().filter(|(_, path)| path.is_file()).collect()
}

/// Adds rows to a table. The file of the table is created when the first row is added.
fn add<R: Row>(
    writer: &mut Option<TableWriter>,
    directory: &Path,
    without: &[&'static str],
    rows: impl Iterator<Item = R>,
) -> io::Result<()> {
    let mut rows = rows.peekable();
    if rows.peek().is_none() {
        return Ok(());
    }
    let writer = match writer {
        Some(writer) => writer,
        none => none.insert(TableWriter::new::<R>(directory, without)?),
    };
    writer.add(rows)
}

/// A part that is being written to a hidden folder.
pub(super) struct OpenPart {
    directory: TempDir,
    /// Writers in the order of [`TABLES`]; none for a table without rows.
    writers: [Option<TableWriter>; TABLES.len()],
    rows: u64,
    /// Columns of the grains table that are not written.
    without: Vec<&'static str>,
}

impl OpenPart {
    /// Begins a part that will be moved to a folder when it is closed.
    pub(super) fn begin(folder: &Path, without: &[&'static str]) -> io::Result<Self> {
        let directory = temporary_in(folder)?;
        fs::create_dir(directory.path().join("part"))?;
        Ok(Self { directory, writers: Default::default(), rows: 0, without: without.to_vec() })
    }

    /// Adds snapshots. `first` is the index of the first of them in the run.
    pub(super) fn add(&mut self, first: u64, snapshots: &[Snapshot]) -> io::Result<()> {
        fn rows<'s, R, I: Iterator<Item = R> + 's>(
            first: u64,
            snapshots: &'s [Snapshot],
            rows_of: impl Fn(&'s Snapshot) -> I + 's,
        ) -> impl Iterator<Item = SnapshotRow<R>> + 's {
            (first..).zip(snapshots).flat_map(move |(number, snapshot)| {
                let (step, time) = (snapshot.step, snapshot.time);
                rows_of(snapshot).map(move |row| SnapshotRow { snapshot: number, step, time, row })
            })
        }
        let directory = self.directory.path().join("part");
        let [frames, grains, contacts, walls, bodies, points] = &mut self.writers;
        let frame = |&Snapshot { bounds, periodic, ref contacts, .. }: &Snapshot| {
            iter::once(Frame { bounds, periodic, has_contacts: contacts.is_some() })
        };
        add(frames, &directory, &[], rows(first, snapshots, frame))?;
        add(grains, &directory, &self.without, rows(first, snapshots, |snapshot| snapshot.grains.iter().cloned()))?;
        add(contacts, &directory, &[], rows(first, snapshots, |snapshot| snapshot.told_contacts().iter().copied()))?;
        add(walls, &directory, &[], rows(first, snapshots, |snapshot| snapshot.walls.iter().cloned()))?;
        add(bodies, &directory, &[], rows(first, snapshots, |snapshot| snapshot.bodies.iter().cloned()))?;
        add(points, &directory, &[], rows(first, snapshots, |snapshot| snapshot.points.iter().copied()))?;
        self.rows += snapshots.iter().map(rows_of).sum::<u64>();
        Ok(())
    }

    /// Returns the number of bytes written so far.
    pub(super) fn bytes(&self) -> usize {
        self.writers.iter().flatten().map(TableWriter::bytes).sum()
    }

    /// Closes the part and moves it to the folder. `number` is the number of the part.
    pub(super) fn close(self, folder: &Path, number: usize) -> io::Result<Seal> {
        let Self { directory, writers, rows, .. } = self;
        let hashes = writers.into_iter().map(|writer| writer.map(TableWriter::close).transpose());
        let hash = together(&hashes.collect::<io::Result<Vec<_>>>()?);
        // The name contains the hash, so that a part never replaces a different part.
        let name = format!("{number:06}-{}", &hash.to_hex()[..8]);
        let place = folder.join(&name);
        if place.exists() {
            fs::remove_dir_all(&place)?;
        }
        fs::rename(directory.path().join("part"), place)?;
        Ok(Seal { name, hash: *hash.as_bytes(), rows })
    }
}

/// Returns the number of rows of grains, contacts and points of a snapshot.
pub(crate) fn rows_of(snapshot: &Snapshot) -> u64 {
    (snapshot.grains.len() + snapshot.told_contacts().len() + snapshot.points.len()) as u64
}

/// Returns the snapshots of a closed part, one after another.
pub(crate) fn snapshots(folder: &Path) -> io::Result<impl Iterator<Item = io::Result<Snapshot>>> {
    fn all<R: Row>(table: &mut TableReader<SnapshotRow<R>>, number: u64) -> io::Result<Vec<R>> {
        let rows = iter::from_fn(|| table.next_if(|row| row.snapshot == number).transpose());
        rows.map(|row| Ok(row?.row)).collect()
    }
    let mut frames = TableReader::open(folder)?;
    let (mut grains, mut contacts) = (TableReader::open(folder)?, TableReader::open(folder)?);
    let (mut walls, mut bodies) = (TableReader::open(folder)?, TableReader::open(folder)?);
    let mut points = TableReader::open(folder)?;
    let mut next = move || -> io::Result<Option<Snapshot>> {
        let Some(SnapshotRow::<Frame> { snapshot: number, step, time, row: frame }) = frames.next_if(|_| true)? else {
            return Ok(None);
        };
        let contacts = all(&mut contacts, number)?;
        Ok(Some(Snapshot {
            step,
            time,
            grains: all(&mut grains, number)?,
            contacts: frame.has_contacts.then_some(contacts),
            walls: all(&mut walls, number)?,
            bodies: all(&mut bodies, number)?,
            points: all(&mut points, number)?,
            bounds: frame.bounds,
            periodic: frame.periodic,
        }))
    };
    Ok(iter::from_fn(move || next().transpose()))
}
