//! Tests with intact and damaged dumps.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufReader;

use common::data;
use grainbench_reference::stored::compressed;
use grainbench_reference::{DumpKind, DumpReader, DumpSnapshot, NonFiniteNumbers, ReadError};

/// Reads all snapshots of a dump.
fn all(bytes: &[u8]) -> Result<Vec<DumpSnapshot>, ReadError> {
    let mut reader = DumpReader::new(bytes, "dump")?;
    let mut snapshot = DumpSnapshot::default();
    let mut all = Vec::new();
    while reader.read(&mut snapshot)? {
        all.push(snapshot.clone());
    }
    Ok(all)
}

fn stored(name: &str) -> Vec<DumpSnapshot> {
    all(&fs::read(data(name)).unwrap()).unwrap()
}

#[test]
fn reads_atoms_of_lammps() {
    let snapshots = stored("lammps-nine.dump");
    let steps: Vec<u64> = snapshots.iter().map(|snapshot| snapshot.step).collect();
    assert_eq!(steps, [0, 1, 2, 3, 4, 5]);
    let last = snapshots.last().unwrap();
    assert_eq!((last.kind, last.rows(), last.units.as_deref()), (DumpKind::Atoms, 9, Some("si")));
    assert_eq!(last.time, Some(0.076_274_269_405_314_08));
    assert_eq!((last.bounds, last.periodic), (([-10.0, -10.0, -0.5], [310.0, 310.0, 0.5]), [false, false, true]));
    let x = last.column("x").unwrap();
    assert_eq!(last.values(x).next(), Some(last.row(0)[x]));
    assert_eq!(last.row(4)[x], 150.0);
    assert_eq!(last.columns[x].digits.significant(), 17);
    let coordinate = last.coordinate(1).unwrap();
    assert_eq!((coordinate.column, coordinate.value(last.row(8)) > 249.0), (2, true));
    assert_eq!(last.coordinate(2), None);
}

#[test]
fn reads_what_liggghts_writes() {
    let atoms = stored("liggghts-nine.dump");
    assert_eq!((atoms.len(), atoms[3].step, atoms[3].rows(), atoms[3].time), (4, 3, 9, None));
    let contacts = stored("liggghts-nine.local");
    assert_eq!((contacts[0].rows(), contacts[3].kind, contacts[3].rows()), (0, DumpKind::Entries, 12));
    assert_eq!(contacts[3].columns.len(), 19);
    assert_eq!(contacts[3].digits().significant(), 6);
    let contacts = stored("lammps-nine.local");
    assert_eq!((contacts.last().unwrap().rows(), contacts.last().unwrap().columns[0].name.as_str()), (12, "index"));
}

#[test]
fn scaled_coordinates_count_from_the_side_of_the_box() {
    let snapshots = stored("lammps-scaled-six-digits.dump");
    let snapshot = &snapshots[3];
    let y = snapshot.coordinate(1).unwrap();
    assert!((y.value(snapshot.row(0)) - 0.499_504).abs() < 1e-9, "{}", y.value(snapshot.row(0)));
    let (_, scale) = y.parts().next().unwrap();
    assert_eq!((scale, snapshot.columns[y.column].name.as_str()), (12.0, "ys"));
    let column = &snapshot.columns[y.column];
    let uncertainty = scale * column.digits.uncertainty(snapshot.row(0)[y.column], &snapshot.digits());
    assert!((uncertainty - 6e-6).abs() < 1e-12, "{uncertainty}");
}

/// The tilts xy and xz are 0.03 and −0.01. The edges of the box from the corner (0, 0, 0) are 0.1, 0.08 and 0.06 long.
/// LAMMPS prints the bounds of the box that encloses the tilted box.
#[test]
fn scaled_coordinates_of_a_tilted_box_follow_its_tilts() {
    let text = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n-0.01 0.13 0.03\n0 0.08 -0.01\n\
                0 0.06 0.0\nITEM: ATOMS id xs ys zs xu\n1 0.125 0.25 0.5 0.02\n";
    let snapshot = &all(text.as_bytes()).unwrap()[0];
    let coordinate = |name: &str, axis| snapshot.coordinate_named(name, axis).unwrap().value(snapshot.row(0));
    assert!((coordinate("xs", 0) - (0.125 * 0.1 + 0.25 * 0.03 - 0.5 * 0.01)).abs() < 1e-15, "{}", coordinate("xs", 0));
    assert!((coordinate("ys", 1) - 0.25 * 0.08).abs() < 1e-15 && (coordinate("zs", 2) - 0.03).abs() < 1e-15);
    assert_eq!(coordinate("xu", 0), 0.02);
    // The coordinate is unknown if another scaled coordinate is missing.
    let text = text.replace("xs ys zs xu", "xs a zs xu");
    assert!(all(text.as_bytes()).unwrap()[0].coordinate_named("xs", 0).is_none());
}

/// The error distinguishes a truncated file from a damaged one.
#[test]
fn a_cut_is_told_from_damage() {
    let sound = sound();
    for cut in 1..sound.len() {
        if let Err(error) = all(&sound.as_bytes()[..cut]) {
            assert!(error.is_cut() || sound.as_bytes()[cut - 1] == b'\n', "{cut}: {error}");
        }
    }
    for damaged in [sound.replace("1e-3", "x"), sound.replace("ITEM: UNITS", "ITEM: UNIT")] {
        assert!(!all(damaged.as_bytes()).unwrap_err().is_cut());
    }
}

#[test]
fn unpacks_gzip_and_zstd_by_their_first_bytes() {
    let plain = fs::read(data("lammps-nine.dump")).unwrap();
    let gzip = compressed(std::str::from_utf8(&plain).unwrap());
    let zstd = ruzstd::encoding::compress_to_vec(&plain[..], ruzstd::encoding::CompressionLevel::Fastest);
    assert_eq!(all(&gzip).unwrap(), all(&plain).unwrap());
    assert_eq!(all(&zstd).unwrap(), all(&plain).unwrap());
    let half = zstd.len() / 2;
    let (first, second) = plain.split_at(plain.len() / 2);
    let parts = [first, second]
        .map(|part| ruzstd::encoding::compress_to_vec(part, ruzstd::encoding::CompressionLevel::Fastest));
    assert_eq!(all(&parts.concat()).unwrap(), all(&plain).unwrap(), "frames in a row are one file");
    assert!(all(&zstd[..half]).is_err());
}

const SOUND: &str = "\
ITEM: UNITS
si
ITEM: TIMESTEP
10
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp ff mm
0 10
-1 1
0 5
ITEM: ATOMS element vx id x
Al 0.5 2 1e-3
Fe nan 1 2.5
";

fn sound() -> String {
    SOUND.replace("nan", "-1.5")
}

#[test]
fn keeps_what_is_not_finite_where_asked_to() {
    let mut reader = DumpReader::new(SOUND.as_bytes(), "dump").unwrap().not_finite(NonFiniteNumbers::Kept);
    let mut snapshot = DumpSnapshot::default();
    assert!(reader.read(&mut snapshot).unwrap());
    assert!(snapshot.row(1)[1].is_nan() && snapshot.row(1)[0].is_nan());
    assert_eq!(snapshot.row(0)[3], 1e-3);
    assert!(!reader.read(&mut snapshot).unwrap());
}

#[test]
fn names_the_place_of_every_fault() {
    let sound = sound();
    assert_eq!(all(sound.as_bytes()).unwrap().len(), 1);
    let twice = |second: &str| format!("{sound}{}", second.replacen("ITEM: UNITS\nsi\n", "", 1));
    let with = |from: &str, to: &str| {
        assert!(sound.contains(from), "{from}");
        sound.replacen(from, to, 1).into_bytes()
    };
    let faults: Vec<(&str, Vec<u8>)> = vec![
        ("empty file", Vec::new()),
        ("only blank lines", b"\n \n".to_vec()),
        ("binary file", b"\x7fELF\x02\x01\x01\0\0\0".to_vec()),
        ("zeros without a line", vec![0; 1 << 20]),
        ("not UTF-8 in a row", with("Fe -1.5", "Fe -1.5\u{e9}").into_iter().filter(|byte| *byte != 0xc3).collect()),
        ("truncated snapshot", sound.as_bytes()[..sound.len() - 16].to_vec()),
        ("cut within the last number", sound.as_bytes()[..sound.len() - 1].to_vec()),
        ("cut within the header", sound.as_bytes()[..50].to_vec()),
        ("more atoms than said", with("ATOMS\n2", "ATOMS\n1")),
        ("fewer atoms than said", twice(&sound).replacen("ATOMS\n2", "ATOMS\n3", 1).into_bytes()),
        ("an absurd number of atoms", with("ATOMS\n2", "ATOMS\n99999999999999")),
        ("NaN", SOUND.as_bytes().to_vec()),
        ("infinity", with("1e-3", "inf")),
        ("no number", with("1e-3", "1e-3x")),
        ("a column short", with("2 1e-3", "2")),
        ("a column too many", with("1e-3", "1e-3 7")),
        ("id twice", with("-1.5 1", "-1.5 2")),
        ("id no whole number", with("-1.5 1", "-1.5 1.5")),
        ("step goes back", twice(&sound.replacen("10\n", "9\n", 1)).into_bytes()),
        ("units change", format!("{sound}{}", sound.replacen("si", "lj", 1)).into_bytes()),
        ("a general triclinic box", with("BOUNDS pp ff mm", "BOUNDS abc origin pp ff mm")),
        ("a tilt short", with("BOUNDS pp ff mm", "BOUNDS xy xz yz pp ff mm")),
        ("an .xyz file", b"1\nAtoms. Timestep: 0\n1 0 0 0.02\n".to_vec()),
        ("a binary dump", b"\xf6\xff\xff\xff\xff\xff\xff\xffDUMPCUSTOM\x01".to_vec()),
        ("a negative id", with("-1.5 1", "-1.5 -1")),
        ("upside down", with("0 10", "10 0")),
        ("odd boundaries", with("pp ff mm", "pp ff")),
        ("no bounds", with("ITEM: BOX BOUNDS pp ff mm\n0 10\n-1 1\n0 5\n", "")),
        ("no step", with("ITEM: TIMESTEP\n10\n", "")),
        ("step no number", with("10\n", "ten\n")),
        ("no columns", with("ATOMS element vx id x", "ATOMS")),
        ("a column twice", with("element vx id x", "x vx id x")),
        ("unknown item", with("ITEM: UNITS", "ITEM: UNIT")),
        ("something else", b"Step Time\n".to_vec()),
        ("a long line", [b"ITEM: ".to_vec(), vec![b'x'; 1 << 17]].concat()),
        ("xz", b"\xfd7zXZ\0\0".to_vec()),
        ("broken gzip", b"\x1f\x8b\x08\0\0\0\0\0\0\0zzzz".to_vec()),
        ("broken zstd", b"\x28\xb5\x2f\xfd\xff\xff\xff\xff".to_vec()),
    ];
    let mut messages = String::new();
    for (name, bytes) in faults {
        let error = all(&bytes).map(|_| ()).unwrap_err().to_string();
        assert!(!error.contains('\n'));
        writeln!(messages, "{name:<27} {error}").unwrap();
    }
    insta::assert_snapshot!(messages);
}

#[test]
fn refuses_two_gigabytes_of_nothing_at_once() {
    let path = tempfile::NamedTempFile::new().unwrap();
    path.as_file().set_len(2 << 30).unwrap();
    let mut reader = DumpReader::open(path.path()).unwrap();
    let error = reader.read(&mut DumpSnapshot::default()).unwrap_err().to_string();
    assert!(error.ends_with(":1:1: expected plain text, found the byte 0x00"), "{error}");
    let mut reader = DumpReader::new(BufReader::new(File::open(path.path()).unwrap()), "zeros").unwrap();
    assert!(reader.read(&mut DumpSnapshot::default()).is_err());
}
