//! Random damage to files, and the demands on the readers of the damaged files.

// Each test file uses only a part of this module.
#![allow(dead_code, unreachable_pub)]

use grainbench_reference::{DumpReader, DumpSnapshot, ReadError, parse_data, parse_log, parse_table};
use proptest::prelude::*;

/// Data file in the format that LAMMPS writes.
pub(crate) const DATA: &str = "\
LAMMPS data file via write_data, version 29 Sep 2021, timestep = 30000

3 atoms
1 atom types

0 95.7939389085 xlo xhi
-0.01 94.4431739862 ylo yhi
-0.5 0.5 zlo zhi

Atoms # sphere

1303 1 1.13539406656 1.682111412550541 0.27079758352385713 0.5531865960784434 0 0 0 0
3340 1 1.1697765125 1.6326702551251169 1.414023013762274 0.5452540128895765 0 0 0 0
9746 1 0.847738383721 2.2528876287513953 2.407577985774929 0.41452861000282043 0 0 -1 0

Velocities

1303 0.0010817518590437827 3.7714923266640344e-05 0 0 0 0
9746 0.001075180042523461 -3.95411785492108e-05 0 0 0 0
3340 0.0010298775089176225 6.716749444959259e-05 0 0 0 0.5
";

/// Texts with a meaning for a reader or for the functions that it calls.
pub(crate) const PIECES: [&str; 32] = [
    "ITEM: ",
    "ITEM: TIMESTEP\n",
    "ITEM: NUMBER OF ENTRIES\n99999999\n",
    "ITEM: BOX BOUNDS xy xz yz\n",
    "Step Time\n",
    "Loop time of 1 on 1 procs for 1 steps with 1 atoms\n",
    "\t",
    "\"",
    "\n",
    "\n\n",
    " ",
    "#",
    "\r",
    ",",
    "-",
    "nan",
    "inf",
    "-inf",
    "1e999",
    "99999999999 atoms\n",
    "0 0 0 xy xz yz\n",
    "Atoms\n\n",
    "Velocities\n\n",
    "Masses\n\n",
    "Bonds\n\n",
    "é",
    "\u{2028}",
    "\u{feff}",
    "18446744073709551616",
    "\0",
    "xlo xhi",
    "-1 ",
];

/// Damage at one position of a file.
#[derive(Debug, Clone)]
pub(crate) enum Damage {
    Cut,
    Remove(usize),
    Insert(&'static str),
    Byte(u8),
    Repeat(usize),
}

/// Returns a strategy for random damages. The position of each is a fraction of the length of the file.
pub(crate) fn damages() -> impl Strategy<Value = Vec<(f64, Damage)>> {
    let one = prop_oneof![
        1 => Just(Damage::Cut),
        3 => (1_usize..40).prop_map(Damage::Remove),
        6 => prop::sample::select(&PIECES[..]).prop_map(Damage::Insert),
        4 => any::<u8>().prop_map(Damage::Byte),
        2 => (1_usize..120).prop_map(Damage::Repeat),
    ];
    prop::collection::vec((0.0..1.0, one), 1..5)
}

/// Returns a strategy for random bytes, some with the beginning of a compressed file.
pub(crate) fn strange_bytes() -> impl Strategy<Value = Vec<u8>> {
    let head = prop::sample::select(vec![&b""[..], &[0x1f, 0x8b, 8, 0], &[0x28, 0xb5, 0x2f, 0xfd]]);
    (head, prop::collection::vec(any::<u8>(), 0..200)).prop_map(|(head, bytes)| [head, &bytes].concat())
}

/// Applies damages to a text, one after the other.
pub(crate) fn apply(text: &[u8], damages: &[(f64, Damage)]) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for (part, damage) in damages {
        let place = (part * bytes.len() as f64) as usize;
        match damage {
            Damage::Cut => bytes.truncate(place),
            Damage::Remove(length) => {
                let end = (place + length).min(bytes.len());
                bytes.drain(place..end);
            }
            Damage::Insert(piece) => {
                bytes.splice(place..place, piece.bytes());
            }
            Damage::Byte(value) => {
                if let Some(byte) = bytes.get_mut(place) {
                    *byte = *value;
                }
            }
            Damage::Repeat(length) => {
                let end = (place + length).min(bytes.len());
                let piece = bytes.get(place..end).unwrap_or_default().to_vec();
                bytes.splice(place..place, piece);
            }
        }
    }
    bytes
}

/// Dumps written by LAMMPS and LIGGGHTS.
pub(crate) const DUMPS: [&str; 5] = [
    include_str!("../data/lammps-nine.dump"),
    include_str!("../data/lammps-nine.local"),
    include_str!("../data/lammps-scaled-six-digits.dump"),
    include_str!("../data/liggghts-nine.dump"),
    include_str!("../data/liggghts-nine.local"),
];
/// Logs written by LAMMPS and LIGGGHTS.
pub(crate) const LOGS: [&str; 2] = [include_str!("../data/lammps-two-runs.log"), include_str!("../data/liggghts.log")];
/// Table of a stored run.
pub(crate) const TABLE: &str = include_str!("../data/series.csv");

/// Describes an error message that is not one line with the position, the expected and the actual content.
pub(crate) fn names_place(error: &ReadError) -> Result<(), String> {
    let shown = error.to_string();
    let placed = error.line().is_some_and(|line| shown.starts_with(&format!("{}:{line}:", error.file())));
    let complete = placed && shown.contains(": expected ") && shown.contains(", found ");
    expect(complete && !shown.chars().any(char::is_control), &format!("badly said: {shown:?}"))
}

pub(crate) fn expect(holds: bool, what: &str) -> Result<(), String> {
    if holds { Ok(()) } else { Err(what.to_owned()) }
}

/// Reads a dump to the end. Returns true if all numbers are finite and all rows are complete.
fn read_dump(bytes: &[u8]) -> Result<bool, ReadError> {
    let mut reader = DumpReader::new(bytes, "f")?;
    let mut snapshot = DumpSnapshot::default();
    let mut sound = true;
    while reader.read(&mut snapshot)? {
        for row in 0..snapshot.rows() {
            let row = snapshot.row(row);
            let mut numbers = row.iter().zip(&snapshot.columns).filter(|(_, column)| !column.is_text);
            sound &= row.len() == snapshot.columns.len() && numbers.all(|(value, _)| value.is_finite());
        }
    }
    Ok(sound)
}

pub(crate) fn of_dump(bytes: &[u8]) -> Result<(), String> {
    read_dump(bytes).map_or_else(|error| names_place(&error), |sound| expect(sound, "a number of a dump is none"))
}

pub(crate) fn of_log(bytes: &[u8]) -> Result<(), String> {
    parse_log(bytes, "f").map_or_else(|error| names_place(&error), |_| Ok(()))
}

/// Reads a table, which must have rows.
pub(crate) fn of_table(bytes: &[u8]) -> Result<(), String> {
    let read = parse_table(bytes, "f");
    read.map_or_else(|error| names_place(&error), |table| expect(table.rows() > 0, "a table without rows"))
}

/// Reads a data file. Its masses must be positive and all its numbers finite.
pub(crate) fn of_data(bytes: &[u8]) -> Result<(), String> {
    match parse_data(bytes, "f") {
        Ok(data) => expect(
            data.atoms.iter().all(|grain| {
                let numbers = grain.position.iter().chain(&grain.velocity).all(|value| value.is_finite());
                numbers && grain.mass() > 0.0 && grain.mass().is_finite()
            }),
            "a number of a grain is none",
        ),
        Err(error) => names_place(&error),
    }
}
