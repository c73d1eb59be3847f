//! Spread of a quantity over random packings, from a table with one row per packing and one column per quantity.

use grainbench_harness::statistics::{mean, spread};

/// Returns the half-width of the 99 % interval of the difference between the values of two further packings. Returns
/// zero if the table lacks the quantity, so that the claim fails.
pub(crate) fn apart(table: &str, quantity: &str) -> f64 {
    spread(&draws_of(table, quantity)).unwrap_or(0.0)
}

/// Returns the absolute value of the mean of a quantity over packings. Returns NaN if the table lacks the quantity.
pub(crate) fn mean_of(table: &str, quantity: &str) -> f64 {
    mean(&draws_of(table, quantity)).abs()
}

/// Returns the value of a quantity for each packing.
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
