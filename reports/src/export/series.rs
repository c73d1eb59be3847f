//! Time series as CSV and as Parquet.

use crate::table::{Cell, Column, Format, Table};
use grainbench_solver::record::Series;

/// Returns the table `step`, `time (s)`, `NAME (unit)`, … with one row per sample. A short column has empty cells.
pub(crate) fn table(series: &Series) -> Table<'_> {
    let columns = [Column::new("step", Format::Count), Column::number("time").unit("s")].into_iter();
    let quantities = series.columns.iter().map(|column| Column::number(&column.name).unit(&column.unit));
    let rows = series.step.iter().zip(&series.time).enumerate().map(|(sample, (step, time))| {
        let values = series.values.iter().map(|column| Cell::from(column.get(sample).copied()));
        [Cell::from(*step), Cell::from(*time)].into_iter().chain(values).collect()
    });
    Table::new("series", columns.chain(quantities), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn keeps_every_digit() {
        let mut out = Vec::new();
        table(&sample::series()).csv(&mut out).unwrap();
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "step,time (s),disc.x (m),\"a,b (1)\"\n\
             0,0.0,1.0,-1e-300\n\
             5,0.30000000000000004,0.3333333333333333,2e20\n"
        );
    }

    #[test]
    fn keeps_every_bit() {
        let file = tempfile::tempfile().unwrap();
        table(&sample::series()).parquet(&file).unwrap();
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
