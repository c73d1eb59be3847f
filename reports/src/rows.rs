//! Results of a report as a table: `rows.csv` and, if requested, Parquet.

use std::io;

use crate::export::series_csv::harmless;
use crate::parts::{Values, whole};
use crate::report::Report;
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::Verdict;

/// File name of the table as Parquet.
pub const ROWS_PARQUET: &str = "rows.parquet";

/// Returns the columns of the table with their names. Absent values are null. For a bound, a band or an order,
/// `expected` is null, and `bound` contains the expectation in words.
fn columns(report: &Report) -> Vec<(String, Values)> {
    let rows: Vec<&Verdict> = report.sections.iter().flat_map(|section| &section.verdicts).collect();
    let words = |value: &dyn Fn(&Verdict) -> String| Values::Word(rows.iter().map(|row| value(row)).collect());
    let optional = |value: &dyn Fn(&Verdict) -> Option<f64>| Values::Told(rows.iter().map(|row| value(row)).collect());
    let bound = |row: &Verdict| match row.expected {
        Some(bound @ ExpectedValue::Bound(_)) => bound.to_string(),
        Some(ExpectedValue::Value(_)) | None => String::new(),
    };
    let columns: [(&str, Values); 18] = [
        ("case", words(&|row| row.case.clone())),
        ("variant", words(&|row| row.variant.clone())),
        ("solver", words(&|row| row.solver.clone())),
        ("resolution", words(&|row| row.resolution.clone())),
        ("quantity", words(&|row| row.quantity.clone())),
        ("unit", words(&|row| row.unit.clone())),
        ("value", optional(&|row| row.value)),
        ("expected", optional(&|row| row.expected.and_then(ExpectedValue::value))),
        ("bound", words(&bound)),
        ("scale", optional(&|row| row.scale)),
        ("error", optional(&|row| row.error)),
        ("allowed", optional(&|row| Some(row.allowed))),
        ("tolerance", words(&|row| row.tolerance.word().to_owned())),
        ("because", words(&|row| row.because.clone())),
        ("evidence", words(&|row| row.evidence.word().to_owned())),
        ("source", words(&|row| row.source.clone())),
        ("verdict", words(&|row| row.outcome.word().to_owned())),
        ("detail", words(&|row| row.detail.clone().unwrap_or_default())),
    ];
    columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect()
}

/// Returns `rows.csv` with a header and one line per result. Each number is the shortest text that reads back to the
/// same bits.
///
/// # Errors
/// When a line cannot be encoded. This does not occur in reports of this project.
pub fn rows_csv(report: &Report) -> Result<Vec<u8>, csv::Error> {
    csv(&columns(report))
}

/// Returns columns of texts and optional numbers as CSV. Cells of columns of other types are empty.
pub(crate) fn csv(columns: &[(String, Values)]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(columns.iter().map(|(name, _)| harmless(name.clone())))?;
    let cell = |values: &Values, row: usize| match values {
        Values::Word(words) => words.get(row).cloned().map(harmless),
        Values::Told(numbers) => numbers.get(row).copied().flatten().map(|value| format!("{value:?}")),
        Values::Whole(_) | Values::Number(_) | Values::Flag(_) => None,
    };
    let rows = columns.iter().map(|(_, values)| match values {
        Values::Word(words) => words.len(),
        Values::Told(numbers) => numbers.len(),
        Values::Whole(_) | Values::Number(_) | Values::Flag(_) => 0,
    });
    for row in 0..rows.max().unwrap_or_default() {
        table.write_record(columns.iter().map(|(_, values)| cell(values, row).unwrap_or_default()))?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

/// Returns the table as Parquet.
///
/// # Errors
/// When the table cannot be encoded.
pub fn rows_parquet(report: &Report) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    whole("rows", &columns(report), &mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    use std::io::Write;

    /// Both tables contain every result of the report, row by row.
    #[test]
    fn a_table_has_every_row() {
        let report = sample::report();
        let rows: Vec<&Verdict> = report.sections.iter().flat_map(|section| &section.verdicts).collect();
        let text = rows_csv(&report).unwrap();
        let mut table = csv::Reader::from_reader(&*text);
        let lines: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&rows_parquet(&report).unwrap()).unwrap();
        let file = SerializedFileReader::new(file).unwrap();
        let packed: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert!(!rows.is_empty() && lines.len() == rows.len() && packed.len() == rows.len());
        for ((row, line), packed) in rows.iter().zip(&lines).zip(&packed) {
            assert_eq!([&line[0], &line[16]], [row.case.as_str(), row.outcome.word()]);
            assert_eq!(line[6].parse().ok(), row.value);
            assert_eq!((packed.get_string(0).ok(), packed.get_double(6).ok()), (Some(&row.case), row.value));
            assert_eq!(line[7].is_empty(), row.expected.and_then(ExpectedValue::value).is_none());
        }
    }
}
