//! Tests that damaged files never cause a panic of a reader. Every error names its position on one line.

#[path = "common/damage.rs"]
mod damage;

use damage::{DATA, DUMPS, LOGS, TABLE, apply, damages, of_data, of_dump, of_log, of_table, strange_bytes};
use proptest::prelude::*;
use proptest::sample::select;

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
    fn of_a_dump(text in select(&DUMPS[..]), damages in damages()) {
        said(of_dump(&apply(text.as_bytes(), &damages)))?;
    }

    #[test]
    fn of_a_log(text in select(&LOGS[..]), damages in damages()) {
        said(of_log(&apply(text.as_bytes(), &damages)))?;
    }

    #[test]
    fn of_a_table(damages in damages()) {
        said(of_table(&apply(TABLE.as_bytes(), &damages)))?;
    }

    #[test]
    fn of_a_data_file(damages in damages()) {
        said(of_data(&apply(DATA.as_bytes(), &damages)))?;
    }

    #[test]
    fn of_bytes_at_random(bytes in strange_bytes()) {
        said(of_data(&bytes).and_then(|()| of_dump(&bytes)))?;
    }
}

fn said(answer: Result<(), String>) -> Result<(), TestCaseError> {
    answer.map_err(TestCaseError::fail)
}
