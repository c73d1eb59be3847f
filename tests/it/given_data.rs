//! Claims with an initial state from third-party data: with the data, without the data, and with wrong data.

use crate::common::{Directory, temporary, temporary_with};
use serde_json::Value;
use std::path::Path;

/// Command for the claims that use the published initial state of the drum.
const ROWS: &str = "run drum-mixing --filter 'quantity=zone 2'";
/// Command for the claims that use the shared beds of the impact.
const BEDS: &str = "run impact-bed --filter 'quantity=the shared bed' --levels all";

/// Returns the outcome and the text of each result of a report.
fn rows(directory: &Path) -> Vec<(String, String)> {
    let results = directory.json("grainbench-out/results.json");
    let word = |row: &Value, key: &str| row[key].as_str().unwrap_or_default().to_owned();
    results["verdicts"].as_array().unwrap().iter().map(|row| (word(row, "verdict"), row.to_string())).collect()
}

#[test]
fn without_it_rows_say_where_it_is_to_be_had() {
    let directory = temporary();
    let answer = directory.run(ROWS);
    // Without the data, no claim is judged.
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    let rows = rows(&directory);
    assert_eq!(rows.len(), 7);
    for (outcome, row) in rows {
        assert_eq!(outcome, "not-available");
        assert!(row.contains("10.5281/zenodo.8252892") && row.contains("--data DIR"), "{row}");
    }
}

/// The stored result belongs to the published initial state, and is not used for another initial state.
#[test]
fn another_start_differs_from_the_published_one() {
    let path = temporary_with("data/start.xyz", "2\nbox\n0 0.102 0.032 0.05\n1 0.122 0.032 0.05\n");
    let answer = path.run(format!("{ROWS} --data data"));
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    let rows = rows(&path);
    assert!(rows.len() == 7 && rows.iter().all(|(outcome, _)| outcome == "stale"), "{rows:?}");
}

/// Without the beds, nothing is run. The figures of the case, which take minutes, are not run either.
#[test]
fn without_the_shared_beds_rows_say_where_they_are_to_be_had() {
    let directory = temporary();
    let answer = directory.run(BEDS);
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    let rows = rows(&directory);
    let is_announced = |(outcome, row): &(String, String)| outcome == "not-available" && row.contains("KParticles.txt");
    assert!(rows.len() == 3 && rows.iter().all(is_announced), "{rows:?}");
}

/// If only one initial state is given, claims with another initial state are not available, and their controls do not run.
#[test]
fn rows_of_one_start_do_not_ask_for_another() {
    let path = temporary_with("data/start.xyz", "2\nbox\n0 0.102 0.032 0.05\n1 0.122 0.032 0.05\n");
    let answer = path.run(format!("{BEDS} drum-mixing --filter 'quantity=zone 2 at .1 s' --data data"));
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    let outcomes: Vec<String> = rows(&path).into_iter().map(|(outcome, _)| outcome).collect();
    // The file has two grains instead of thirty thousand.
    assert_eq!(outcomes, ["fail", "not-available", "not-available", "not-available"]);
    let results = path.json("grainbench-out/results.json");
    let controls = results["controls"].as_array().unwrap();
    assert!(controls.len() == 1 && controls[0]["case"] == "drum-mixing", "{controls:?}");
}
