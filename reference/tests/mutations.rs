//! No damage to a file makes its reader panic, and every refusal names its place on one line.

#![allow(clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use grainbench_reference::{DumpReader, DumpSnapshot, ReadError, parse_data, parse_log, parse_table};
use proptest::prelude::*;

const DATA: &str = "\
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

/// Pieces that mean something to a reader, or to the functions it calls.
const PIECES: [&str; 32] = [
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

/// One damage: a place, as a part of the length, and what happens there.
#[derive(Debug, Clone)]
enum Damage {
    Cut,
    Remove(usize),
    Insert(&'static str),
    Byte(u8),
    Repeat(usize),
}

fn damages() -> impl Strategy<Value = Vec<(f64, Damage)>> {
    let one = prop_oneof![
        1 => Just(Damage::Cut),
        3 => (1_usize..40).prop_map(Damage::Remove),
        6 => prop::sample::select(&PIECES[..]).prop_map(Damage::Insert),
        4 => any::<u8>().prop_map(Damage::Byte),
        2 => (1_usize..120).prop_map(Damage::Repeat),
    ];
    prop::collection::vec((0.0..1.0, one), 1..5)
}

fn apply(text: &str, damages: &[(f64, Damage)]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
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

fn well_said(error: &grainbench_reference::ReadError) -> Result<(), TestCaseError> {
    let shown = error.to_string();
    prop_assert!(!shown.contains(|character: char| character.is_control()), "{shown:?}");
    prop_assert!(error.line().is_some_and(|line| shown.starts_with(&format!("f:{line}:"))), "{shown}");
    prop_assert!(shown.contains(": expected ") && shown.contains(", found "), "{shown}");
    Ok(())
}

/// How many files of each kind: a few hundred, more with `GRAINBENCH_LONG`, or as many as `PROPTEST_CASES` says.
fn config() -> ProptestConfig {
    let said = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok());
    let usual = if std::env::var_os("GRAINBENCH_LONG").is_some() { 50_000 } else { 500 };
    ProptestConfig { cases: said.unwrap_or(usual), failure_persistence: None, ..ProptestConfig::default() }
}

/// Files that the programs wrote, or that were stored from what they wrote.
fn stored(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Reads a dump to its end; the numbers it has shown are finite, and each row is whole.
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

proptest! {
    #![proptest_config(config())]

    #[test]
    fn of_a_dump(file in 0_usize..5, damages in damages()) {
        let names = ["lammps-nine.dump", "lammps-nine.local", "lammps-scaled-six-digits.dump",
            "liggghts-nine.dump", "liggghts-nine.local"];
        static TEXTS: OnceLock<Vec<String>> = OnceLock::new();
        let texts = TEXTS.get_or_init(|| names.iter().map(|name| stored(&format!("tests/data/{name}"))).collect());
        match read_dump(&apply(&texts[file], &damages)) {
            Ok(sound) => prop_assert!(sound),
            Err(error) => well_said(&error)?,
        }
    }

    #[test]
    fn of_a_log(file in 0_usize..2, damages in damages()) {
        static TEXTS: OnceLock<[String; 2]> = OnceLock::new();
        let texts = TEXTS.get_or_init(|| ["lammps-two-runs", "liggghts"].map(|name| stored(&format!("tests/data/{name}.log"))));
        if let Err(error) = parse_log(&apply(&texts[file], &damages)[..], "f") {
            well_said(&error)?;
        }
    }

    #[test]
    fn of_a_table(damages in damages()) {
        static TEXT: OnceLock<String> = OnceLock::new();
        let text = TEXT.get_or_init(|| stored("tests/data/series.csv"));
        match parse_table(&apply(text, &damages)[..], "f") {
            Ok(table) => prop_assert!(table.rows() > 0),
            Err(error) => well_said(&error)?,
        }
    }

    #[test]
    fn of_a_data_file(damages in damages()) {
        match parse_data(&apply(DATA, &damages)[..], "f") {
            Ok(data) => {
                for grain in &data.atoms {
                    prop_assert!(grain.mass() > 0.0 && grain.mass().is_finite());
                    prop_assert!(grain.position.iter().chain(&grain.velocity).all(|value| value.is_finite()));
                }
            }
            Err(error) => well_said(&error)?,
        }
    }

    #[test]
    fn of_bytes_at_random(bytes in prop::collection::vec(any::<u8>(), 0..200), head in 0_usize..3) {
        let head = [&b""[..], &[0x1f, 0x8b, 8, 0], &[0x28, 0xb5, 0x2f, 0xfd]][head];
        let bytes = [head, &bytes].concat();
        if let Err(error) = parse_data(&bytes[..], "f") {
            well_said(&error)?;
        }
        if let Err(error) = read_dump(&bytes) {
            well_said(&error)?;
        }
    }
}
