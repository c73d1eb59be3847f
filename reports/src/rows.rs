//! Results of a report as a table: `rows.csv` and, if requested, Parquet.

use crate::report::Report;
use crate::row;
use crate::table::{Column, Table};
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::Verdict;

/// Returns an expectation as number and as bound. For a bound, a band or an order, the number is absent, and the text
/// contains the expectation in words.
pub(crate) fn expectation(expected: Option<ExpectedValue>) -> (Option<f64>, String) {
    let bound = expected.filter(|expected| matches!(expected, ExpectedValue::Bound(_)));
    (expected.and_then(ExpectedValue::value), bound.map_or_else(String::new, |bound| bound.to_string()))
}

pub(crate) fn table(report: &Report) -> Table<'_> {
    let [text, number] = [Column::text, Column::number] as [fn(&'static str) -> Column; 2];
    let names = ["case", "variant", "solver", "resolution", "quantity", "unit"].map(text).into_iter();
    let columns = names.chain(["value", "expected"].map(number)).chain([text("bound")]);
    let columns = columns.chain(["scale", "error", "allowed"].map(number));
    let columns = columns.chain(["tolerance", "because", "evidence", "source", "verdict", "detail"].map(text));
    let row = |row: &Verdict| {
        let Verdict { case, variant, solver, resolution, quantity, unit, value, expected, .. } = row;
        let Verdict { scale, error, allowed, tolerance, because, evidence, source, outcome, detail, .. } = row;
        let ((expected, bound), detail) = (expectation(*expected), detail.as_deref().unwrap_or_default());
        let [tolerance, evidence, outcome] = [tolerance.word(), evidence.word(), outcome.word()];
        row![
            case, variant, solver, resolution, quantity, unit, *value, expected, bound, *scale, *error, *allowed,
            tolerance, because, evidence, source, outcome, detail
        ]
    };
    Table::new("rows", columns, report.verdicts().map(row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    /// Both tables contain every result of the report, row by row.
    #[test]
    fn a_table_has_every_row() {
        let report = sample::report();
        let rows: Vec<&Verdict> = report.verdicts().collect();
        let mut text = Vec::new();
        super::table(&report).csv(&mut text).unwrap();
        let mut table = csv::Reader::from_reader(&*text);
        let lines: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        let file = tempfile::tempfile().unwrap();
        super::table(&report).parquet(&file).unwrap();
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
