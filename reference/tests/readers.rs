//! Tests of the readers with intact and damaged dumps, logs, tables and data files. Further damaged data files are in
//! `tests/refusals/data-files.toml`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use grainbench_reference::grain_dump::{DumpOptions, GrainDump};
use grainbench_reference::stored::compressed;
use grainbench_reference::{DataFile, DumpKind, DumpReader, DumpSnapshot, ReadError};
use grainbench_reference::{parse_data, parse_log, parse_table, read_data_file};
use grainbench_solver::record::Partner;

/// Returns the path of a file in `tests/data`.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

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

/// Three grains of radius 1 m at x = 0, 1.5 m and 3.6 m. Overlaps are 2 m minus the distances. The pair 1–2 overlaps by
/// 0.5 m without a force. The pair 2–3 has a gap of 0.1 m and a cohesive force of 7 N. The pair 1–3 is not in contact.
#[test]
fn pairs_without_force_and_overlap_are_no_contacts() {
    let folder = tempfile::tempdir().unwrap();
    let frame = |what: &str, columns: &str, rows: &str| {
        let (path, bounds) = (folder.path().join(what), "ITEM: BOX BOUNDS ff ff ff\n-1 9\n-1 9\n-1 9\n");
        let head = format!("ITEM: TIMESTEP\n0\nITEM: NUMBER OF {what}\n3\n{bounds}");
        fs::write(&path, format!("{head}ITEM: {what} {columns}\n{rows}")).unwrap();
        path
    };
    let grains = frame("ATOMS", "id x y z radius", "1 0 0 0 1\n2 1.5 0 0 1\n3 3.6 0 0 1\n");
    let pairs = frame("ENTRIES", "id1 id2 force_x force_y", "1 2 0 0\n2 3 7 0\n1 3 0 0\n");
    let mut dump = GrainDump::open(&grains, Some(&pairs), DumpOptions::default()).unwrap();
    let contacts = dump.read().unwrap().unwrap().contacts.unwrap();
    let found: Vec<_> = contacts.iter().map(|contact| (contact.grain, contact.partner, contact.normal_force)).collect();
    assert_eq!(found, [(1, Partner::Grain(2), 0.0), (2, Partner::Grain(3), -7.0)]);
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
fn a_truncated_file_differs_from_a_damaged_one() {
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
    let mut reader = DumpReader::new(SOUND.as_bytes(), "dump").unwrap().keep_non_finite();
    let mut snapshot = DumpSnapshot::default();
    assert!(reader.read(&mut snapshot).unwrap());
    assert!(snapshot.row(1)[1].is_nan() && snapshot.row(1)[0].is_nan());
    assert_eq!(snapshot.row(0)[3], 1e-3);
    assert!(!reader.read(&mut snapshot).unwrap());
}

#[test]
fn names_the_place_of_every_fault_of_a_dump() {
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

#[test]
fn reads_two_runs_of_lammps() {
    let log = parse_log(&fs::read(data("lammps-two-runs.log")).unwrap()[..], "log").unwrap();
    assert_eq!((log.units.as_deref(), log.time_step), (Some("si"), Some(0.015_254_853_881_062_817)));
    let rows: Vec<usize> = log.runs.iter().map(|run| run.thermo.rows()).collect();
    assert_eq!(rows, [4, 3]);
    let (first, second) = (&log.runs[0], &log.runs[1]);
    assert_eq!((first.end.unwrap().steps, first.end.unwrap().atoms, first.end.unwrap().processes), (3, 9, 1));
    let step = second.thermo.column("Step").unwrap();
    assert_eq!(second.thermo.values(step).collect::<Vec<f64>>(), [3.0, 4.0, 5.0]);
    assert!(second.thermo.column("KinEng").is_some());
}

#[test]
fn reads_a_log_of_liggghts() {
    let log = parse_log(&fs::read(data("liggghts.log")).unwrap()[..], "log").unwrap();
    assert_eq!((log.runs.len(), log.units.as_deref()), (1, Some("si")));
    let thermo = &log.runs[0].thermo;
    assert_eq!((thermo.rows(), thermo.column("Atoms")), (4, Some(3)));
    assert_eq!(log.runs[0].end.unwrap().steps, 3);
}

/// The log has the alignment of a 2025 release, a warning between rows, a printed NaN, and no end.
#[test]
fn reads_another_alignment_and_a_log_that_breaks_off() {
    let text = "LAMMPS (22 Jul 2025)\nPer MPI rank memory allocation (min/avg/max) = 5 | 5 | 5 Mbytes\n\
                \x20  Step          Time          \
                KinEng    \n         0   0              0            \nWARNING: Fix moved\n\
                \x20      100   0.01           -nan         \n";
    let log = parse_log(text.as_bytes(), "log").unwrap();
    let thermo = &log.runs[0].thermo;
    assert_eq!((thermo.rows(), log.runs[0].end), (2, None));
    assert!(thermo.values(2).last().unwrap().is_nan());
}

#[test]
fn reads_tables_of_any_separator() {
    for text in ["# made by hand\nt, x\n0,1.5\n\n0.25, 2\n", "t;x\n0;1.5\n0.25;2\n", "\"t\"\tx\n0\t1.5\n0.25\t2"] {
        let table = parse_table(text.as_bytes(), "csv").unwrap();
        let columns: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(columns, ["t", "x"]);
        assert_eq!(table.values(0).collect::<Vec<f64>>(), [0.0, 0.25]);
        assert_eq!(table.values(1).collect::<Vec<f64>>(), [1.5, 2.0]);
    }
}

#[test]
fn names_the_place_of_every_fault_of_logs_and_tables() {
    let mut messages = String::new();
    let mut say = |name: &str, error: String| writeln!(messages, "{name:<22} {error}").unwrap();
    for (name, text) in [
        ("empty", ""),
        ("no run", "units si\n"),
        ("several lines a step", "Per MPI rank memory allocation\n------------ Step 0 ----- CPU = 0 (sec) -----\n"),
        ("a number too few", "Step Time\n0 0\n1\n"),
        ("a number too many", "Step Time\n0 0 0\n"),
        ("no number", "Step Time\n0 0.1.2\n"),
        ("an odd end", "Step Time\n0 0\nLoop time of x\n"),
    ] {
        say(name, parse_log(text.as_bytes(), "log").unwrap_err().to_string());
    }
    for (name, text) in [
        ("empty table", ""),
        ("no names", "0,1\n"),
        ("a name twice", "t,t\n0,1\n"),
        ("no row", "t,x\n"),
        ("a field too few", "t,x\n0,1\n2\n"),
        ("a field too many", "t,x\n0,1,2\n"),
        ("an empty field", "t,x\n0,\n"),
        ("NaN", "t,x\n0,NaN\n"),
        ("zero byte", "t,x\n0,\0\n"),
    ] {
        say(name, parse_table(text.as_bytes(), "csv").unwrap_err().to_string());
    }
    insta::assert_snapshot!(messages);
}

const TWO_GRAINS: &str = include_str!("../../tests/scenes/two-grains.data");

fn data_file(text: &str) -> DataFile {
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
fn reads_columns_in_the_order_of_the_file() {
    let data = data_file(TWO_GRAINS);
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
    let grain = data_file(TWO_GRAINS).atoms[1];
    let expected = std::f64::consts::PI / 6.0 * 0.125 * 3.0;
    assert!((grain.mass() - expected).abs() < 1e-15 * expected);
    assert_eq!(grain.radius(), 0.25);
}

#[test]
fn grains_without_velocities_rest() {
    let text = TWO_GRAINS.split("Pair Coeffs").next().unwrap();
    assert!(data_file(text).atoms.iter().all(|grain| grain.velocity == [0.0; 3]));
}

#[test]
fn line_ends_of_other_systems_and_a_missing_last_one_do_not_matter() {
    assert_eq!(data_file(&TWO_GRAINS.replace('\n', "\r\n")).atoms, data_file(TWO_GRAINS).atoms);
    assert_eq!(data_file(TWO_GRAINS.trim_end()), data_file(TWO_GRAINS));
}

#[test]
fn gzip_is_recognised_by_its_bytes() {
    let packed = compressed(TWO_GRAINS);
    assert_eq!(parse_data(&packed[..], "data").unwrap(), data_file(TWO_GRAINS));
    let (head, tail) = TWO_GRAINS.split_at(TWO_GRAINS.len() / 2);
    let both = [compressed(head), compressed(tail)].concat();
    assert_eq!(parse_data(&both[..], "data").unwrap(), data_file(TWO_GRAINS));
    // Data may arrive one byte at a time, for example from a pipe.
    assert_eq!(parse_data(BufReader::with_capacity(1, &packed[..]), "data").unwrap(), data_file(TWO_GRAINS));

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
