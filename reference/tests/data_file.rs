//! Tests of the reader with intact and damaged data files. Further damaged files are in
//! `tests/refusals/data-files.toml`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{BufReader, Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use grainbench_reference::stored::compressed;
use grainbench_reference::{DataFile, parse_data, read_data_file};

const SOUND: &str = include_str!("../../tests/scenes/two-grains.data");

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
    let packed = compressed(SOUND);
    assert_eq!(parse_data(&packed[..], "data").unwrap(), read(SOUND));
    let (head, tail) = SOUND.split_at(SOUND.len() / 2);
    let both = [compressed(head), compressed(tail)].concat();
    assert_eq!(parse_data(&both[..], "data").unwrap(), read(SOUND));
    // Data may arrive one byte at a time, for example from a pipe.
    assert_eq!(parse_data(BufReader::with_capacity(1, &packed[..]), "data").unwrap(), read(SOUND));

    assert_eq!(fault(compressed("")), "data:1: expected a data file that begins with a title, found an empty file");
    let cut = fault(&packed[..packed.len() / 2]);
    assert!(cut.starts_with("data:") && cut.contains("expected readable data"), "{cut}");
    let mut flipped = packed;
    let middle = flipped.len() / 2;
    flipped[middle] ^= 0x55;
    fault(flipped);
}

#[test]
fn a_line_without_end_is_refused_before_it_fills_the_memory() {
    let expected = "data:2: expected a line of at most 65536 bytes, found a longer line";
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
    // In this packing, each mass equals the square of the diameter (in the units of the file).
    for grain in &data.atoms {
        let expected = grain.diameter * grain.diameter;
        assert!((grain.mass() - expected).abs() < 1e-14 * expected);
    }
}
