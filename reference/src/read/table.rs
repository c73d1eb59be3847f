//! Tables of numbers with column names, as CSV or Parquet.

use std::io::BufRead;
use std::path::Path;

use crate::read::lines::{Lines, opened};
pub use crate::read::number_table::Table;
use crate::read::number_table::{MOST_NUMBERS, NumberColumn, RowForm};
use crate::read::parquet;
use crate::read::read_error::{ReadError, quoted};

/// Reads the table at `path`, which is Parquet, or text that is plain, gzip or zstd. See [`parse_table`].
///
/// # Errors
/// If the file cannot be read or is not a table that [`parse_table`] reads.
pub fn read_table(path: &Path) -> Result<Table, ReadError> {
    let name = path.to_string_lossy();
    let mut file = opened(path)?;
    let beginning = file.fill_buf().map_err(|error| ReadError::reading(&name, 1, error))?;
    if beginning.starts_with(parquet::MARK) {
        return parquet::read(file.into_inner(), &name);
    }
    parse_table(file, &name)
}

/// Returns the separator in a line of column names, and the names.
pub(crate) fn header(line: &str) -> (u8, Vec<&str>) {
    let separator = [b',', b';', b'\t'].into_iter().find(|byte| line.contains(char::from(*byte))).unwrap_or(b',');
    let fields = line.trim_end().split(char::from(separator));
    (separator, fields.map(|field| field.trim().trim_matches('"')).collect())
}

/// Reads a table with a line of column names, followed by one line of numbers per row. `name` is the name of the table
/// in error messages.
///
/// The separator is a comma, a semicolon or a tab: the first of these that the line of names contains. Empty lines and
/// lines that begin with `#` are skipped.
///
/// # Errors
/// If the input cannot be read, has no names, a repeated name or no row, or if a row has a missing or additional field,
/// or a number that is not finite.
pub fn parse_table(reader: impl BufRead, name: &str) -> Result<Table, ReadError> {
    let mut lines = Lines::new(reader, name)?;
    let mut form = RowForm::default();
    let mut table = Table::default();
    while let Some(line) = lines.next_line()? {
        let first = line.bytes.iter().find(|byte| !byte.is_ascii_whitespace());
        if matches!(first, None | Some(b'#')) {
            line.text()?;
            continue;
        }
        if !table.columns.is_empty() {
            if table.values.len() > MOST_NUMBERS {
                let line = line.text()?;
                return Err(line.error(format!("at most {MOST_NUMBERS} numbers in a table"), "more"));
            }
            form.read(line, &mut table)?;
            continue;
        }
        let line = line.text()?;
        let (separator, names) = header(line.text);
        form.separator = Some(separator);
        for field in names {
            if field.is_empty() || field.parse::<f64>().is_ok() {
                return Err(line.error("a line with the names of the columns", quoted(line.text)));
            }
            if table.columns.iter().any(|column| column.name == field) {
                return Err(
                    line.error("columns with different names", format!("two columns with the name {}", quoted(field)))
                );
            }
            table.columns.push(NumberColumn::new(field));
        }
    }
    if table.columns.is_empty() {
        return Err(lines.error("a line with the names of the columns", "an empty file"));
    }
    if table.rows() == 0 {
        return Err(lines.error("at least one row below the names", "none"));
    }
    Ok(table)
}
