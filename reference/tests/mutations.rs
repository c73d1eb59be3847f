//! Tests that damaged files never cause a panic of a reader. Every error names its position on one line.

#[path = "common/damage.rs"]
mod damage;

use damage::{DATA, DUMPS, LOGS, TABLE, apply, damages, read_dump, well_said};
use grainbench_reference::{parse_data, parse_log, parse_table};
use proptest::prelude::*;

/// Returns the configuration of the tests. The number of damaged files in each test is `PROPTEST_CASES`. By default it
/// is 50 000 if `GRAINBENCH_LONG` is set, otherwise 500.
fn config() -> ProptestConfig {
    let case_count = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok());
    let usual = if std::env::var_os("GRAINBENCH_LONG").is_some() { 50_000 } else { 500 };
    ProptestConfig { cases: case_count.unwrap_or(usual), failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn of_a_dump(file in 0_usize..5, damages in damages()) {
        match read_dump(&apply(DUMPS[file].as_bytes(), &damages)) {
            Ok(sound) => prop_assert!(sound),
            Err(error) => well_said(&error)?,
        }
    }

    #[test]
    fn of_a_log(file in 0_usize..2, damages in damages()) {
        if let Err(error) = parse_log(&apply(LOGS[file].as_bytes(), &damages)[..], "f") {
            well_said(&error)?;
        }
    }

    #[test]
    fn of_a_table(damages in damages()) {
        match parse_table(&apply(TABLE.as_bytes(), &damages)[..], "f") {
            Ok(table) => prop_assert!(table.rows() > 0),
            Err(error) => well_said(&error)?,
        }
    }

    #[test]
    fn of_a_data_file(damages in damages()) {
        match parse_data(&apply(DATA.as_bytes(), &damages)[..], "f") {
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
