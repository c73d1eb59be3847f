//! What draws differ by, from a table that holds a row a draw and a column a quantity.

use grainbench_harness::statistics::spread;

/// How far two draws are apart in a quantity, with 99 %; nothing where the table does not have it, so that the row is red.
#[must_use]
pub fn apart(table: &str, quantity: &str) -> f64 {
    spread(&draws_of(table, quantity)).unwrap_or(0.0)
}

/// The mean of what draws have of a quantity, without its sign; not a number where the table does not have it.
#[must_use]
pub fn mean_of(table: &str, quantity: &str) -> f64 {
    let draws = draws_of(table, quantity);
    (draws.iter().sum::<f64>() / draws.len() as f64).abs()
}

/// What each draw has of a quantity.
fn draws_of(table: &str, quantity: &str) -> Vec<f64> {
    let mut table = csv::Reader::from_reader(table.as_bytes());
    let place = table.headers().ok().and_then(|names| names.iter().position(|name| name == quantity));
    let value = |row: csv::StringRecord| row.get(place?)?.parse().ok();
    table.records().flatten().filter_map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_that_is_not_there_allows_nothing() {
        let table = "seed,\"a, b\"\n1,1.0\n2,2.0\n3,3.0\n";
        assert!(apart(table, "a, b") > 2.0);
        assert_eq!(apart(table, "a"), 0.0);
        assert_eq!(apart("", "a"), 0.0);
        assert_eq!(mean_of("seed,a\n1,-1.0\n2,-2.0\n", "a"), 1.5);
        assert!(mean_of("", "a").is_nan());
    }
}
