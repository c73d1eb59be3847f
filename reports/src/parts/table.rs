//! A table in a Parquet file, which is written and read in groups of rows.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::{WriterProperties, WriterPropertiesBuilder};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type};

use super::columns::{Row, Values, columns_of, rows_of};

/// Number of rows that are converted to columns at a time. These rows are in memory twice while they are written.
const GROUP: usize = 1 << 13;

/// Columns with few different values. A dictionary saves space in them.
const REPEATED: [&str; 8] = ["snapshot", "step", "time", "material", "radius", "mass", "partner", "owner"];

/// Column of consecutive numbers. Their differences are small, so that storing differences saves space.
const COUNTED: &str = "id";

/// Table of a part that is being written.
pub(super) struct TableWriter {
    table: GroupedTable<HashedFile>,
    /// Names of the columns that are not written.
    without: Vec<&'static str>,
}

impl TableWriter {
    /// Creates a file for the table of a type of row, without the columns in `without`.
    pub(super) fn new<R: Row>(directory: &Path, without: &[&'static str]) -> io::Result<Self> {
        let file = HashedFile { file: File::create(directory.join(file_name(R::TABLE)))?, hash: blake3::Hasher::new() };
        let mut properties = WriterProperties::builder().set_dictionary_enabled(false);
        for name in REPEATED {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(name), true);
        }
        // Bytes of the same significance are stored together, which compresses well. Leading bytes are similar, and the
        // last bytes of rounded numbers are zero.
        let mut columns = columns_of::<R>(&mut []);
        columns.retain(|(name, _)| !without.contains(name));
        for (name, values) in columns.iter().filter(|(name, _)| !REPEATED.contains(name)) {
            let encoding = match values {
                Values::Number(_) | Values::Told(_) => Encoding::BYTE_STREAM_SPLIT,
                Values::Whole(_) if *name == COUNTED => Encoding::DELTA_BINARY_PACKED,
                _ => continue,
            };
            properties = properties.set_column_encoding(ColumnPath::from(*name), encoding);
        }
        let table = GroupedTable::new(R::TABLE, &columns, properties, file)?;
        Ok(Self { table, without: without.to_vec() })
    }

    /// Adds rows of the type for which the table was created.
    pub(super) fn add<R: Row>(&mut self, mut rows: impl Iterator<Item = R>) -> io::Result<()> {
        loop {
            let mut group: Vec<R> = rows.by_ref().take(GROUP).collect();
            if group.is_empty() {
                return Ok(());
            }
            let mut columns = columns_of(&mut group);
            drop(group);
            columns.retain(|(name, _)| !self.without.contains(name));
            self.table.add(&columns)?;
        }
    }

    /// Returns the number of bytes written so far.
    pub(super) fn bytes(&self) -> usize {
        self.table.file.bytes_written()
    }

    /// Closes the file and returns the hash of its content.
    pub(super) fn close(self) -> io::Result<blake3::Hash> {
        let mut hashed = self.table.file.into_inner().map_err(io_error)?;
        hashed.flush()?;
        hashed.file.sync_all()?;
        Ok(hashed.hash.finalize())
    }
}

/// Reader of a table. It reads one group of rows at a time.
pub(super) struct TableReader<R> {
    /// File of the table; none if the table has no rows.
    file: Option<SerializedFileReader<File>>,
    group: usize,
    /// Rows of the current group that were not returned yet, in reverse order.
    waiting: Vec<R>,
}

impl<R: Row> TableReader<R> {
    pub(super) fn open(directory: &Path) -> io::Result<Self> {
        let file = open_table(directory, R::TABLE)?.map(SerializedFileReader::new).transpose().map_err(io_error)?;
        Ok(Self { file, group: 0, waiting: Vec::new() })
    }

    /// Returns the next row if `wanted` is true for it; none otherwise.
    pub(super) fn next_if(&mut self, wanted: impl Fn(&R) -> bool) -> io::Result<Option<R>> {
        if self.waiting.is_empty() {
            self.waiting = self.read_group()?;
            self.waiting.reverse();
        }
        Ok(if self.waiting.last().is_some_and(wanted) { self.waiting.pop() } else { None })
    }

    fn read_group(&mut self) -> io::Result<Vec<R>> {
        let Some(file) = self.file.as_ref().filter(|file| self.group < file.num_row_groups()) else {
            return Ok(Vec::new());
        };
        let group = file.get_row_group(self.group).map_err(io_error)?;
        self.group += 1;
        let count = group.metadata().num_rows() as usize;
        let shapes = columns_of::<R>(&mut []);
        let names = group.metadata().schema_descr();
        let column = |(name, shape): &(&str, Values)| -> Result<Values, ParquetError> {
            let Some(at) = (0..names.num_columns()).find(|&at| names.column(at).name() == *name) else {
                return absent(name, shape, count);
            };
            let reader = group.get_column_reader(at)?;
            let nothing = |value: &ByteArray| String::from_utf8_lossy(value.data()).into_owned();
            Ok(match shape {
                Values::Whole(_) => Values::Whole(read::<Int64Type>(reader, count)?.0),
                Values::Number(_) => Values::Number(read::<DoubleType>(reader, count)?.0),
                Values::Flag(_) => Values::Flag(read::<BoolType>(reader, count)?.0),
                Values::Word(_) => Values::Word(read::<ByteArrayType>(reader, count)?.0.iter().map(nothing).collect()),
                Values::Told(_) => {
                    let (values, levels) = read::<DoubleType>(reader, count)?;
                    let mut values = values.into_iter();
                    Values::Told(levels.iter().map(|&level| if level > 0 { values.next() } else { None }).collect())
                }
            })
        };
        let columns = shapes.iter().map(column).collect::<Result<Vec<Values>, _>>().map_err(io_error)?;
        Ok(rows_of(&columns, count))
    }
}

/// Returns the values of a column that the file lacks: NaN or null. Only columns of numbers may be missing.
fn absent(name: &str, shape: &Values, count: usize) -> Result<Values, ParquetError> {
    match shape {
        Values::Number(_) => Ok(Values::Number(vec![f64::NAN; count])),
        Values::Told(_) => Ok(Values::Told(vec![None; count])),
        _ => Err(ParquetError::General(format!("expected a column `{name}`, found none"))),
    }
}

pub(super) fn file_name(table: &str) -> String {
    format!("{table}.parquet")
}

/// Opens the file of a table; none if the table has no rows.
pub(super) fn open_table(directory: &Path, table: &str) -> io::Result<Option<File>> {
    match File::open(directory.join(file_name(table))) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        file => file.map(Some),
    }
}

/// A table that is written to a file in groups of rows.
pub(crate) struct GroupedTable<W: Write + Send> {
    file: SerializedFileWriter<W>,
}

impl<W: Write + Send> GroupedTable<W> {
    /// Begins a compressed table with the names and types of the columns in `like`.
    pub(crate) fn new(
        table: &str,
        like: &[(impl AsRef<str>, Values)],
        properties: WriterPropertiesBuilder,
        file: W,
    ) -> io::Result<Self> {
        let properties = properties.set_compression(Compression::SNAPPY).build();
        let fields = like.iter().map(|(name, values)| field(name.as_ref(), values)).collect::<Result<_, _>>();
        let schema = fields.and_then(|fields| Type::group_type_builder(table).with_fields(fields).build());
        let schema = schema.map(Arc::new).map_err(io_error)?;
        Ok(Self { file: SerializedFileWriter::new(file, schema, Arc::new(properties)).map_err(io_error)? })
    }

    /// Adds a group of rows. The columns have equal length and are in the order of the table.
    pub(crate) fn add(&mut self, columns: &[(impl AsRef<str>, Values)]) -> io::Result<()> {
        let mut group = self.file.next_row_group().map_err(io_error)?;
        columns.iter().try_for_each(|(_, values)| write(&mut group, values)).map_err(io_error)?;
        group.close().map(drop).map_err(io_error)
    }

    pub(crate) fn close(self) -> io::Result<()> {
        self.file.close().map(drop).map_err(io_error)
    }
}

fn field(name: &str, values: &Values) -> Result<Arc<Type>, ParquetError> {
    let (physical, repetition) = match values {
        Values::Whole(_) => (Physical::INT64, Repetition::REQUIRED),
        Values::Number(_) => (Physical::DOUBLE, Repetition::REQUIRED),
        Values::Told(_) => (Physical::DOUBLE, Repetition::OPTIONAL),
        Values::Flag(_) => (Physical::BOOLEAN, Repetition::REQUIRED),
        Values::Word(_) => (Physical::BYTE_ARRAY, Repetition::REQUIRED),
    };
    let logical = matches!(values, Values::Word(_)).then_some(LogicalType::String);
    let field = Type::primitive_type_builder(name, physical).with_repetition(repetition).with_logical_type(logical);
    field.build().map(Arc::new)
}

fn write<W: Write + Send>(group: &mut SerializedRowGroupWriter<'_, W>, values: &Values) -> Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("more columns than the schema has".to_owned()));
    };
    match values {
        Values::Whole(values) => column.typed::<Int64Type>().write_batch(values, None, None)?,
        Values::Number(values) => column.typed::<DoubleType>().write_batch(values, None, None)?,
        Values::Flag(values) => column.typed::<BoolType>().write_batch(values, None, None)?,
        Values::Word(values) => {
            let words: Vec<ByteArray> = values.iter().map(|word| ByteArray::from(word.as_str())).collect();
            column.typed::<ByteArrayType>().write_batch(&words, None, None)?
        }
        Values::Told(values) => {
            let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            let known: Vec<f64> = values.iter().copied().flatten().collect();
            column.typed::<DoubleType>().write_batch(&known, Some(&levels), None)?
        }
    };
    column.close()
}

/// Returns the values of a column, and a flag for each row: 1 if it has a value, 0 if not.
fn read<T: DataType>(
    reader: parquet::column::reader::ColumnReader,
    count: usize,
) -> Result<(Vec<T::T>, Vec<i16>), ParquetError> {
    let (mut values, mut levels) = (Vec::with_capacity(count), Vec::new());
    get_typed_column_reader::<T>(reader).read_records(count, Some(&mut levels), None, &mut values)?;
    Ok((values, levels))
}

/// Returns a Parquet error as an I/O error. If its cause is an I/O error, such as a full disk, that error is returned.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => inner.downcast().map_or_else(io::Error::other, |error| *error),
        other => io::Error::other(other),
    }
}

/// A file that computes the hash of all bytes written to it.
struct HashedFile {
    file: File,
    hash: blake3::Hasher,
}

impl Write for HashedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
