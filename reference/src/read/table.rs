//! Files with tables of numbers: text, or Parquet that is uncompressed or compressed by Snappy.

use super::digits::Digits;
use super::lines::opened;
use super::number_table::{MOST_NUMBERS, NumberColumn, Table, parse_table};
use super::read_error::{ReadError, quoted};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::any::Any;
use std::cell::Cell;
use std::fs::File;
use std::io::BufRead;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::Once;

/// First bytes of a Parquet file.
pub(crate) const MARK: &[u8] = b"PAR1";
/// Maximum size of all numbers of a file after decompression (B).
const MOST: i64 = 1 << 30;

/// Reads the table at `path`, which is Parquet, or text that is plain, gzip or zstd. See [`parse_table`].
///
/// # Errors
/// If the file cannot be read or is not a table that [`parse_table`] reads.
pub fn read_table(path: &Path) -> Result<Table, ReadError> {
    let name = path.to_string_lossy();
    let mut file = opened(path)?;
    let beginning = file.fill_buf().map_err(|error| ReadError::reading(&name, 1, error))?;
    if beginning.starts_with(MARK) {
        return read_parquet(file.into_inner(), &name);
    }
    parse_table(file, &name)
}

/// Returns the names of the columns of a Parquet file; none if the file cannot be read.
pub(crate) fn parquet_names(path: &Path) -> Vec<String> {
    let names = || {
        let reader = SerializedFileReader::new(opened(path)?.into_inner()).map_err(|_| damaged("", ""))?;
        Ok(column_names(&reader))
    };
    without_panic("", names).unwrap_or_default()
}

fn column_names(reader: &SerializedFileReader<File>) -> Vec<String> {
    let columns = reader.metadata().file_metadata().schema_descr().columns();
    columns.iter().map(|column| column.name().to_owned()).collect()
}

/// Reads the table of a Parquet file. `name` is the name of the file in error messages.
///
/// # Errors
/// If the file is damaged or too large, a column has a type other than numbers, or a number is missing or not finite.
fn read_parquet(file: File, name: &str) -> Result<Table, ReadError> {
    without_panic(name, || whole(file, name))
}

/// Reads a Parquet file. The `parquet` crate trusts some lengths in a file, so a damaged file can cause a panic, which
/// is converted to an error.
fn without_panic<T>(name: &str, read: impl FnOnce() -> Result<T, ReadError>) -> Result<T, ReadError> {
    static HUSHED: Once = Once::new();
    HUSHED.call_once(|| {
        let previous_hook = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !READING.get() {
                previous_hook(info)
            }
        }));
    });
    READING.set(true);
    let read = panic::catch_unwind(AssertUnwindSafe(read));
    READING.set(false);
    read.unwrap_or_else(|_: Box<dyn Any + Send>| Err(damaged(name, "a truncated or damaged file")))
}

thread_local! {
    /// True while a file is being read. A panic then prints no message, because it is converted to an error.
    static READING: Cell<bool> = const { Cell::new(false) };
}

fn damaged(name: &str, found: &str) -> ReadError {
    ReadError::at(name, 1, "a complete Parquet file, uncompressed or compressed by Snappy", found)
}

fn whole(file: File, name: &str) -> Result<Table, ReadError> {
    let damage = |error: ParquetError| damaged(name, &quoted(&error.to_string()));
    let reader = SerializedFileReader::new(file).map_err(damage)?;
    let about = reader.metadata();
    let columns: Vec<NumberColumn> = column_names(&reader)
        .into_iter()
        .map(|name| NumberColumn { digits: Digits::exact(), ..NumberColumn::new(&name) })
        .collect();
    let rows = usize::try_from(about.file_metadata().num_rows()).unwrap_or(usize::MAX);
    let bytes = about.row_groups().iter().map(|group| group.total_byte_size()).fold(0_i64, i64::saturating_add);
    if rows.saturating_mul(columns.len()) > MOST_NUMBERS || !(0..=MOST).contains(&bytes) {
        return Err(ReadError::at(name, 1, format!("at most {MOST_NUMBERS} numbers in a table"), "more"));
    }
    if rows == 0 || columns.is_empty() {
        return Err(ReadError::at(name, 1, "a row of numbers", "none"));
    }
    let mut values = Vec::new();
    for (at, row) in reader.get_row_iter(None).map_err(damage)?.enumerate() {
        let row = row.map_err(damage)?;
        let before = values.len();
        for (column, field) in row.get_column_iter() {
            let number = number(field).filter(|number| number.is_finite());
            values.push(number.ok_or_else(|| {
                let expected = format!("a finite number in column `{column}`, row {}", at + 1);
                ReadError::at(name, 1, expected, quoted(&field.to_string()))
            })?);
        }
        if values.len() - before != columns.len() || values.len() > MOST_NUMBERS {
            let expected = format!("{} columns of numbers", columns.len());
            return Err(ReadError::at(name, 1, expected, "columns within columns"));
        }
    }
    Ok(Table::new(columns, values))
}

/// Returns the value of a field as a number, or `None` if the field has another type.
fn number(field: &Field) -> Option<f64> {
    Some(match *field {
        Field::Double(number) => number,
        Field::Float(number) => f64::from(number),
        Field::Byte(number) => f64::from(number),
        Field::Short(number) => f64::from(number),
        Field::Int(number) => f64::from(number),
        Field::Long(number) => number as f64,
        Field::UByte(number) => f64::from(number),
        Field::UShort(number) => f64::from(number),
        Field::UInt(number) => f64::from(number),
        Field::ULong(number) => number as f64,
        Field::Bool(is_so) => f64::from(u8::from(is_so)),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::{Key, Options, compare};
    use std::fs;
    use std::path::PathBuf;

    fn data() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/grains_pandas.parquet")
    }

    /// The file contains two grains at three steps. It was written by pandas, with number types of different widths.
    #[test]
    fn a_table_of_pandas_is_read() {
        let table = read_table(&data()).unwrap();
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["step", "id", "x", "y", "vx", "vy", "omegaz"]);
        let column = |name: &str| table.values(table.column(name).unwrap()).collect::<Vec<f64>>();
        assert_eq!(column("step"), [0.0, 0.0, 50.0, 50.0, 100.0, 100.0]);
        assert_eq!(column("id"), [1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
        assert_eq!(column("x")[3], 0.25);
        assert_eq!(column("vx"), [0.25, 0.5, 0.25, 0.5, 0.25, 0.5]);
        assert_eq!(column("omegaz")[5], -1.0);
        // The rows of a step are a snapshot of grains.
        let found = compare(&data(), &data(), &Options::default()).unwrap();
        assert_eq!((found.key, found.compared, found.samples), (Key::Step, 3, [3, 3]));
    }

    /// A file that is truncated or has one changed bit yields a table or an error, but no panic.
    #[test]
    fn a_damaged_file_is_an_error() {
        let whole = fs::read(data()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grains.parquet");
        let mut errors = 0;
        let mut tried = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            match read_table(&path) {
                Ok(table) => assert!(table.rows() > 0),
                Err(error) => {
                    errors += 1;
                    assert!(error.to_string().contains("grains.parquet:1: expected "), "{error}");
                }
            }
        };
        (4..whole.len()).step_by(3).for_each(|end| tried(&whole[..end]));
        for at in 4..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            tried(&bytes);
        }
        assert!(errors > 2000, "{errors}");
    }
}
