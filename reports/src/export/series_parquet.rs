//! Time series as Parquet, with the same column names as `series.csv`.

use std::io::{self, Write};

use grainbench_solver::record::Series;

use crate::parts::{Values, whole};

/// Writes `step`, `time (s)` and all columns. Cells after the end of a short column are null.
///
/// # Errors
/// When `out` cannot be written.
pub fn write(series: &Series, out: impl Write + Send) -> io::Result<()> {
    let rows = series.step.len();
    let steps = series.step.iter().map(|&step| i64::try_from(step).unwrap_or(i64::MAX)).collect();
    let mut columns =
        vec![("step".to_owned(), Values::Whole(steps)), ("time (s)".to_owned(), Values::Number(series.time.clone()))];
    columns.extend(series.columns.iter().zip(&series.values).map(|(column, values)| {
        let cells = (0..rows).map(|row| values.get(row).copied()).collect();
        (format!("{} ({})", column.name, column.unit), Values::Told(cells))
    }));
    whole("series", &columns, out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn keeps_every_bit() {
        let file = tempfile::tempfile().unwrap();
        write(&sample::series(), &file).unwrap();
        let file = SerializedFileReader::new(file).unwrap();
        let rows: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(
            rows[0].get_column_iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
            ["step", "time (s)", "disc.x (m)", "a,b (1)"]
        );
        assert_eq!(rows[1].get_long(0).unwrap(), 5);
        assert_eq!(rows[1].get_double(1).unwrap(), 0.300_000_000_000_000_04);
        assert_eq!(rows[0].get_double(3).unwrap(), -1e-300);
    }
}
