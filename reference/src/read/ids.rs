//! Ids of grains, which must be whole numbers and unique in a snapshot.

use crate::read::read_error::ReadError;
use crate::read::snapshot::DumpSnapshot;

/// Largest id (2⁵³). Up to this number, an f64 represents every whole number.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// Ids of a snapshot with their rows. The memory is reused for later snapshots.
#[derive(Debug, Default)]
pub(crate) struct Ids(Vec<(u64, u32)>);

impl Ids {
    /// Checks that a column of ids has no negative, fractional or repeated number.
    pub(crate) fn check(&mut self, file: &str, snapshot: &DumpSnapshot, column: usize) -> Result<(), ReadError> {
        let fault = |row: u32, expected: String, found: String| {
            ReadError::at(file, snapshot.first_line + u64::from(row), expected, found)
        };
        self.0.clear();
        let mut sorted = true;
        for (row, value) in (0..).zip(snapshot.values(column)) {
            if !(0.0..=LARGEST_WHOLE).contains(&value) || value.fract() != 0.0 {
                let name = &snapshot.columns[column].name;
                return Err(fault(
                    row,
                    format!("a whole number of 0 or more in the column `{name}`"),
                    value.to_string(),
                ));
            }
            let id = value as u64;
            sorted &= self.0.last().is_none_or(|(last, _)| *last < id);
            self.0.push((id, row));
        }
        if sorted {
            return Ok(());
        }
        self.0.sort_unstable();
        let twice = self.0.windows(2).find(|pair| pair[0].0 == pair[1].0);
        match twice {
            Some(pair) => {
                Err(fault(pair[1].1, "each id only once per snapshot".to_owned(), format!("{} again", pair[1].0)))
            }
            None => Ok(()),
        }
    }
}
