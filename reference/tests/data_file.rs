//! Tests with intact and damaged data files.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{BufReader, Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use grainbench_reference::{DataFile, parse_data, read_data_file};

const SOUND: &str = "\
two grains # of one type
3 atom types   # in any order

-0.1 0.1 zlo zhi
2 atoms
-5 5 xlo xhi
-1 1e1 ylo yhi

Masses

1 1.0
2 1.0

Atoms # sphere

7 1 1.0 2.5 -0.5 0 0 1 -2 0   # far away
2 3 0.5 3.0 40 0.25 0

Pair Coeffs # gran/hooke/history

Velocities

2 1 2 3 4 5 6
7 -1 0 0 0 0 1e-3
";

fn read(text: &str) -> DataFile {
    parse_data(text.as_bytes(), "data").unwrap()
}

fn fault(bytes: impl AsRef<[u8]>) -> String {
    let error = parse_data(bytes.as_ref(), "data").unwrap_err();
    let shown = error.to_string();
    assert!(!shown.contains('\n'), "{shown}");
    assert!(error.line().is_some());
    shown
}

/// Returns the error for the intact file in which `from` is replaced by `to`.
fn damaged(from: &str, to: &str) -> String {
    assert!(SOUND.contains(from));
    fault(SOUND.replacen(from, to, 1))
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn reads_what_the_file_says_in_its_order() {
    let data = read(SOUND);
    assert_eq!(data.title, "two grains # of one type");
    assert_eq!(data.bounds, ([-5.0, -1.0, -0.1], [5.0, 10.0, 0.1]));
    assert_eq!(data.atoms.len(), 2);
    let (first, second) = (data.atoms[0], data.atoms[1]);
    assert_eq!((first.id, first.type_, first.diameter, first.density), (7, 1, 1.0, 2.5));
    assert_eq!((first.position, first.image), ([-0.5, 0.0, 0.0], [1, -2, 0]));
    assert_eq!((first.velocity, first.angular_velocity), ([-1.0, 0.0, 0.0], [0.0, 0.0, 1e-3]));
    assert_eq!((second.id, second.type_, second.image), (2, 3, [0; 3]));
    assert_eq!(second.position, [40.0, 0.25, 0.0], "outside of the box is allowed");
    assert_eq!((second.velocity, second.angular_velocity), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]));
}

#[test]
fn the_mass_is_a_spheres() {
    let grain = read(SOUND).atoms[1];
    let expected = std::f64::consts::PI / 6.0 * 0.125 * 3.0;
    assert!((grain.mass() - expected).abs() < 1e-15 * expected);
    assert_eq!(grain.radius(), 0.25);
}

#[test]
fn grains_without_velocities_rest() {
    let text = SOUND.split("Pair Coeffs").next().unwrap();
    assert!(read(text).atoms.iter().all(|grain| grain.velocity == [0.0; 3]));
}

#[test]
fn line_ends_of_other_systems_and_a_missing_last_one_do_not_matter() {
    assert_eq!(read(&SOUND.replace('\n', "\r\n")).atoms, read(SOUND).atoms);
    assert_eq!(read(SOUND.trim_end()), read(SOUND));
}

#[test]
fn gzip_is_recognised_by_its_bytes() {
    let packed = gzip(SOUND.as_bytes());
    assert_eq!(parse_data(&packed[..], "data").unwrap(), read(SOUND));
    let (head, tail) = SOUND.split_at(SOUND.len() / 2);
    let both = [gzip(head.as_bytes()), gzip(tail.as_bytes())].concat();
    assert_eq!(parse_data(&both[..], "data").unwrap(), read(SOUND));
    // Data can arrive one byte at a time, for example from a pipe.
    assert_eq!(parse_data(BufReader::with_capacity(1, &packed[..]), "data").unwrap(), read(SOUND));

    let cut = fault(&packed[..packed.len() / 2]);
    assert!(cut.starts_with("data:") && cut.contains("expected readable data"), "{cut}");
    let mut flipped = packed;
    let middle = flipped.len() / 2;
    flipped[middle] ^= 0x55;
    fault(flipped);
}

#[test]
fn other_compressions_are_named() {
    assert_eq!(
        fault(b"\xfd7zXZ\x00rest"),
        "data:1: expected plain text, gzip or zstd, found a file compressed by xz (unpack it with `xz -dk`)"
    );
}

#[test]
fn an_empty_file() {
    let expected = "data:1: expected a data file, its title first, found an empty file";
    assert_eq!(fault(""), expected);
    assert_eq!(fault(gzip(b"")), expected);
}

#[test]
fn bytes_that_are_no_text() {
    assert_eq!(fault(b"title\n2 at\xffoms\n"), "data:2:5: expected text in UTF-8, found the byte 0xff after `2 at`");
    assert!(fault(b"\x7fELF\x02\x01\x01\x00").starts_with("data:1:1: expected text in UTF-8"));
}

#[test]
fn the_header() {
    assert_eq!(
        fault("only a title\n"),
        "data:1: expected a header line `N atoms` in front of the sections, found none"
    );
    assert_eq!(
        damaged("-5 5 xlo xhi\n", ""),
        "data:8: expected a header line `LOW HIGH xlo xhi` in front of the sections, found none"
    );
    assert_eq!(
        damaged("2 atoms", "two atoms"),
        "data:5:1: expected a number of atoms from 1 on in front of `atoms`, found `two`"
    );
    assert_eq!(
        damaged("2 atoms", "-2 atoms"),
        "data:5:1: expected a number of atoms from 1 on in front of `atoms`, found `-2`"
    );
    assert_eq!(
        damaged("2 atoms", "2 atoms\n2 atoms"),
        "data:6: expected one header line `N atoms`, found a second one"
    );
    assert_eq!(damaged("2 atoms", "2 3 atoms"), "data:5: expected `N atoms`, found `2 3 atoms`");
    assert_eq!(damaged("-5 5 xlo xhi", "5 -5 xlo xhi"), "data:6: expected xlo below xhi, found 5.0 and -5.0");
    assert_eq!(damaged("-5 5 xlo xhi", "-5 nan xlo xhi"), "data:6:4: expected the number xhi, found `nan`");
    assert_eq!(
        damaged("-5 5 xlo xhi", "-5 5 xlo xhi\n0 0 0 xy xz yz"),
        "data:7: expected a box with right angles, found tilt factors `xy xz yz` (a triclinic box is not read)"
    );
    assert_eq!(
        damaged("2 atoms", "2 atoms\n4 bonds"),
        "data:6: expected a header line `N atoms`, `N atom types`, `… xlo xhi`, `… ylo yhi` or `… zlo zhi`, or \
         a section, found `4 bonds`"
    );
}

#[test]
fn the_sections() {
    assert_eq!(
        damaged("Masses", "Bonds"),
        "data:9: expected a section `Atoms`, `Velocities`, `Masses`, `Pair Coeffs` or `PairIJ Coeffs`, found `Bonds`"
    );
    assert_eq!(damaged("# sphere", "# atomic"), "data:14: expected grains, `Atoms # sphere`, found `Atoms # atomic`");
    assert_eq!(
        damaged("Atoms # sphere\n\n", "Atoms\n"),
        "data:15: expected a blank line below the section's keyword, found `7 1 1.0 2.5 -0.5 0 0 1 -2 0`"
    );
    assert_eq!(
        fault(SOUND.split("Atoms").next().unwrap()),
        "data:13: expected a section `Atoms`, found the end of the file"
    );
    assert_eq!(
        damaged("Atoms", "Velocities\n\nAtoms"),
        "data:14: expected the section `Atoms` in front of `Velocities`, found `Velocities`"
    );
    assert_eq!(
        damaged("Pair Coeffs", "Atoms\n\nPair Coeffs"),
        "data:19: expected one section `Atoms`, found a second one"
    );
}

#[test]
fn the_number_of_lines() {
    assert_eq!(
        damaged("2 3 0.5 3.0 40 0.25 0\n", ""),
        "data:18: expected 2 lines in the section `Atoms`, one for each atom of the header, found only 1"
    );
    assert_eq!(
        damaged("2 3 0.5 3.0 40 0.25 0\n", "2 3 0.5 3.0 40 0.25 0\n3 3 0.5 3.0 40 0.25 0\n"),
        "data:18: expected 2 atoms, the number in the header, found one more, `3 3 0.5 3.0 40 0.25 0`"
    );
    assert_eq!(
        damaged("7 -1 0 0 0 0 1e-3\n", ""),
        "data:23: expected 2 lines in the section `Velocities`, one for each atom of the header, found only 1"
    );
}

#[test]
fn a_huge_count_costs_no_memory() {
    assert_eq!(
        damaged("2 atoms", "99999999999 atoms"),
        "data:19: expected 99999999999 lines in the section `Atoms`, one for each atom of the header, found only 2"
    );
    let beyond = "9".repeat(40);
    assert!(damaged("2 atoms", &format!("{beyond} atoms")).starts_with("data:5:1: expected a number of atoms"));
}

#[test]
fn the_fields_of_an_atom() {
    let atom = "7 1 1.0 2.5 -0.5 0 0 1 -2 0 ";
    let with = |line: &str| damaged(atom, line);
    assert_eq!(with("0 1 1 1 0 0 0"), "data:16:1: expected an atom's id, a whole number from 1 on, found `0`");
    assert_eq!(
        with("4294967296 1 1 1 0 0 0"),
        "data:16:1: expected an atom's id, a whole number from 1 on, found `4294967296`"
    );
    assert_eq!(with("7 4 1 1 0 0 0"), "data:16:3: expected an atom's type, a whole number from 1 to 3, found `4`");
    assert_eq!(with("7 1 -1.0 1 0 0 0"), "data:16:5: expected a diameter, a finite number above 0, found `-1.0`");
    assert_eq!(with("7 1 1 inf 0 0 0"), "data:16:7: expected a density, a finite number above 0, found `inf`");
    assert_eq!(with("7 1 1 1 0  NaN 0"), "data:16:12: expected y, a finite number, found `NaN`");
    assert_eq!(with("7 1 1 1 0 1e999 0"), "data:16:11: expected y, a finite number, found `1e999`");
    assert_eq!(with("7 1 1 1 0 0"), "data:16:12: expected z, a finite number, found the end of the line");
    assert_eq!(
        with("7 1 1 1 0 0 0 1"),
        "data:16:16: expected an image count, a whole number, found the end of the line"
    );
    assert_eq!(with("7 1 1 1 0 0 0 1 1 0.5"), "data:16:19: expected an image count, a whole number, found `0.5`");
    assert_eq!(
        with("7 1 1 1 0 0 0 1 1 1 9"),
        "data:16:21: expected id, type, diameter, density, x, y, z and at most three image counts, found one more field, `9`"
    );
    assert_eq!(
        with("7 1 1e200 1 0 0 0"),
        "data:16: expected a grain whose mass a number can hold, found diameter 1e200 and density 1e0"
    );
    assert_eq!(with("2 1 1 1 0 0 0"), "data:17: expected an id that no other atom has, found 2 again");
}

#[test]
fn the_fields_of_a_velocity() {
    let with = |line: &str| damaged("7 -1 0 0 0 0 1e-3", line);
    assert_eq!(with("7 -1 0 0 0 0"), "data:24:13: expected wz, a finite number, found the end of the line");
    assert_eq!(with("7 -1 0 0 0 0 0 0"), "data:24:16: expected id, vx, vy, vz, wx, wy, wz, found one more field, `0`");
    assert_eq!(with("8 -1 0 0 0 0 0"), "data:24: expected the id of an atom of the section `Atoms`, found 8");
    assert_eq!(with("2 -1 0 0 0 0 0"), "data:24: expected one velocity for an atom, found a second one for id 2");
}

#[test]
fn a_line_without_end_is_refused_before_it_fills_the_memory() {
    let expected = "data:2: expected a line of at most 65536 bytes, found a longer one";
    let endless = BufReader::new((&b"title\n"[..]).chain(std::io::repeat(b'7')));
    assert_eq!(parse_data(endless, "data").unwrap_err().to_string(), expected);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(b"title\n").unwrap();
    std::io::copy(&mut std::io::repeat(b' ').take(100_000_000), &mut encoder).unwrap();
    assert_eq!(fault(encoder.finish().unwrap()), expected);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let gone = folder.path().join("gone");
    let error = read_data_file(&gone).unwrap_err();
    assert!(error.to_string().starts_with(&format!("{}: expected a readable file, found ", gone.display())));
    assert_eq!(error.line(), None);
    read_data_file(folder.path()).unwrap_err();
}

#[test]
fn the_stored_packing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/plane-shear/data.relaxed.gz");
    let data = read_data_file(&path).unwrap();
    assert_eq!(data.atoms.len(), 10_000);
    assert_eq!(data.bounds, ([0.0, -0.01, -0.5], [95.793_938_908_5, 94.443_173_986_2, 0.5]));
    let first = data.atoms[0];
    assert_eq!((first.id, first.diameter), (1303, 1.135_394_066_56));
    assert_eq!(first.velocity[..2], [0.001_081_751_859_043_782_7, 3.771_492_326_664_034_4e-5]);
    // The packing was made with mass = d².
    for grain in &data.atoms {
        let expected = grain.diameter * grain.diameter;
        assert!((grain.mass() - expected).abs() < 1e-14 * expected);
    }
}
