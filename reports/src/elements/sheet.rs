//! Tables that are created row by row and written as CSV or Parquet. A table is never in memory as a whole.

use crate::parts::{GroupedTable, Values};
use std::io::{self, Write};

/// Content of a table cell.
pub(super) enum Cell {
    /// A whole number.
    Whole(u64),
    /// A number; none if it is unknown.
    Number(Option<f64>),
    /// A text without line breaks.
    Word(String),
}

/// A table: name, column headings and rows.
pub(super) struct Sheet<'a> {
    pub(super) name: &'static str,
    pub(super) heads: Vec<String>,
    pub(super) rows: Box<dyn Iterator<Item = Vec<Cell>> + 'a>,
}

/// Number of rows that are in memory at the same time when Parquet is written.
const GROUP: usize = 1 << 14;

impl Sheet<'_> {
    /// Writes the table as CSV, one line per row. Each number is the shortest text that reads back to the same bits; a
    /// missing number is an empty cell.
    pub(super) fn csv(self, out: impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(&self.heads)?;
        for row in self.rows {
            table.write_record(row.into_iter().map(|cell| match cell {
                Cell::Whole(number) => number.to_string(),
                Cell::Number(number) => finite(number).map_or_else(String::new, |number| format!("{number:?}")),
                Cell::Word(word) => word,
            }))?;
        }
        table.flush()
    }

    /// Writes the table as Parquet. A missing number is null.
    pub(super) fn parquet(mut self, out: impl Write + Send) -> io::Result<()> {
        let mut group: Vec<Vec<Cell>> = self.rows.by_ref().take(GROUP).collect();
        let mut columns = self.columns(&group);
        let mut file = GroupedTable::new(self.name, &columns, out)?;
        while !group.is_empty() {
            file.add(&columns)?;
            group = self.rows.by_ref().take(GROUP).collect();
            columns = self.columns(&group);
        }
        file.close()
    }

    fn columns(&self, rows: &[Vec<Cell>]) -> Vec<(String, Values)> {
        let column = |(at, head): (usize, &String)| {
            let cells = rows.iter().map(|row| &row[at]);
            let values = match rows.first().map(|row| &row[at]) {
                Some(Cell::Whole(_)) => {
                    Values::Whole(cells.map(|cell| i64::try_from(whole(cell)).unwrap_or(i64::MAX)).collect())
                }
                Some(Cell::Word(_)) => Values::Word(cells.map(word).collect()),
                Some(Cell::Number(_)) | None => Values::Told(cells.map(number).collect()),
            };
            (head.clone(), values)
        };
        self.heads.iter().enumerate().map(column).collect()
    }
}

fn finite(number: Option<f64>) -> Option<f64> {
    number.filter(|number| number.is_finite())
}

const fn whole(cell: &Cell) -> u64 {
    if let Cell::Whole(number) = cell { *number } else { 0 }
}

fn word(cell: &Cell) -> String {
    if let Cell::Word(word) = cell { word.clone() } else { String::new() }
}

fn number(cell: &Cell) -> Option<f64> {
    if let Cell::Number(number) = cell { finite(*number) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    fn sheet() -> Sheet<'static> {
        let rows = (0..GROUP as u64 + 3).map(|at| {
            let number = (at % 3 > 0).then_some(at as f64 / 3.0).filter(|_| at != 4);
            let untold = if at == 5 { Some(f64::NAN) } else { number };
            vec![Cell::Whole(at), Cell::Number(untold), Cell::Word(format!("w{at}"))]
        });
        let heads = ["at", "third (m)", "word"].map(str::to_owned).to_vec();
        Sheet { name: "sheet", heads, rows: Box::new(rows) }
    }

    #[test]
    fn parquet_says_what_the_lines_say() {
        let (mut text, file) = (Vec::new(), tempfile::tempfile().unwrap());
        sheet().csv(&mut text).unwrap();
        sheet().parquet(&file).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let mut lines = csv::Reader::from_reader(&text[..]);
        let heads: Vec<String> = lines.headers().unwrap().iter().map(str::to_owned).collect();
        let mut lines = lines.records();
        let mut nulls = 0;
        for row in reader.get_row_iter(None).unwrap().map(Result::unwrap) {
            let line = lines.next().unwrap().unwrap();
            for ((name, field), (head, cell)) in row.get_column_iter().zip(heads.iter().zip(&line)) {
                assert_eq!(name, head);
                match field {
                    Field::Null => {
                        assert_eq!(cell, "");
                        nulls += 1;
                    }
                    Field::Long(number) => assert_eq!(cell, number.to_string()),
                    Field::Double(number) => assert_eq!(cell.parse::<f64>().unwrap().to_bits(), number.to_bits()),
                    Field::Str(word) => assert_eq!(cell, word),
                    other => panic!("{other:?}"),
                }
            }
        }
        assert!(lines.next().is_none() && nulls > GROUP / 3, "{nulls}");
    }

    #[test]
    fn a_table_without_rows_has_its_columns() {
        let file = tempfile::tempfile().unwrap();
        Sheet { rows: Box::new(std::iter::empty()), ..sheet() }.parquet(&file).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        assert_eq!(reader.metadata().file_metadata().schema_descr().num_columns(), 3);
    }
}
