//! Tables: named columns with units and formats, and rows of cells. The same table is written as text for the terminal,
//! CSV, Parquet, Markdown or HTML.
//!
//! CSV and Parquet contain all digits of a number. The other forms show it in the format of its column.

use crate::number::{self, TimeUnit};
use crate::parts::{GroupedTable, Values};
use maud::{Markup, html};
use parquet::file::properties::WriterProperties;
use std::io::{self, Write};

/// Number of rows that are in memory at the same time when Parquet is written.
const GROUP: usize = 1 << 14;

/// Format of the cells of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text.
    Text,
    /// Text that identifies the row.
    Heading,
    /// Whole number.
    Count,
    /// Number with a number of significant digits.
    Digits(usize),
    /// Time in seconds, shown in one unit for the whole column.
    Seconds,
    /// Fraction, shown in per cent or as a power of ten.
    Fraction,
    /// Signed fraction.
    Error,
}

/// Column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    name: String,
    /// Unit; empty for a column without a unit.
    unit: String,
    format: Format,
    /// CSS class of the cells.
    class: &'static str,
    /// Least width (characters) in a narrow terminal; `None` if the column keeps its width.
    least: Option<usize>,
}

impl Column {
    /// Returns a column without a unit.
    #[must_use]
    pub fn new(name: impl Into<String>, format: Format) -> Self {
        let class = if matches!(format, Format::Text | Format::Heading) { "" } else { "n" };
        Self { name: name.into(), unit: String::new(), format, class, least: None }
    }

    /// Returns a column of texts.
    #[must_use]
    pub fn text(name: impl Into<String>) -> Self {
        Self::new(name, Format::Text)
    }

    /// Returns a column of texts that identify the rows.
    #[must_use]
    pub fn heading(name: impl Into<String>) -> Self {
        Self::new(name, Format::Heading)
    }

    /// Returns a column of numbers that pages show with three significant digits.
    pub(crate) fn number(name: impl Into<String>) -> Self {
        Self::new(name, Format::Digits(3))
    }

    pub(crate) fn unit(self, unit: impl Into<String>) -> Self {
        Self { unit: unit.into(), ..self }
    }

    pub(crate) const fn class(mut self, class: &'static str) -> Self {
        self.class = class;
        self
    }

    /// Returns the column with a least width (characters) in a narrow terminal, where longer cells end with `…`.
    pub(crate) const fn shrinks_to(mut self, least: usize) -> Self {
        self.least = Some(least);
        self
    }

    fn title(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} ({})", self.name, self.unit) }
    }

    /// Returns a cell as text in the format of the column; a dash if the cell is empty. `unit` is the unit of durations.
    fn words(&self, cell: &Cell, unit: TimeUnit) -> String {
        match (cell, self.format) {
            (Cell::Missing, _) => "—".to_owned(),
            (Cell::Text(text), _) => text.clone(),
            (Cell::Page(page, _), _) => page.0.clone(),
            (Cell::Whole(count), _) => number::count(*count),
            (Cell::Number(value), Format::Seconds) if value.is_finite() => unit.with_symbol(*value),
            (Cell::Number(value), Format::Fraction) => number::fraction(*value),
            (Cell::Number(value), Format::Error) => number::error(Some(*value)),
            (Cell::Number(value), Format::Digits(digits)) => number::significant(*value, digits),
            (Cell::Number(value), _) => number::value(*value),
        }
    }
}

/// Cell of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Empty cell.
    Missing,
    /// Whole number.
    Whole(u64),
    /// Number.
    Number(f64),
    /// Text without line breaks.
    Text(String),
    /// Part of a page, with the value by which the rows are sorted.
    Page(Markup, Option<String>),
}

impl Cell {
    /// Returns a number; an empty cell if the number is not finite.
    pub(crate) fn finite(value: Option<f64>) -> Self {
        value.filter(|value| value.is_finite()).into()
    }

    /// Returns the cell of a CSV file. Numbers are the shortest texts that read back to the same bits.
    fn csv(&self) -> String {
        match self {
            Self::Missing => String::new(),
            Self::Whole(count) => count.to_string(),
            Self::Number(value) => format!("{value:?}"),
            Self::Text(text) => harmless(text.clone()),
            Self::Page(page, _) => page.0.clone(),
        }
    }

    fn text(&self) -> String {
        if let Self::Text(text) = self { text.clone() } else { String::new() }
    }

    fn whole(&self) -> i64 {
        if let Self::Whole(count) = self { i64::try_from(*count).unwrap_or(i64::MAX) } else { 0 }
    }

    const fn value(&self) -> Option<f64> {
        if let Self::Number(value) = self { Some(*value) } else { None }
    }

    fn sort_key(&self) -> Option<String> {
        match self {
            Self::Whole(count) => Some(count.to_string()),
            Self::Number(value) => Some(value.to_string()),
            Self::Page(_, key) => key.clone(),
            Self::Missing | Self::Text(_) => None,
        }
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Into::into)
    }
}

macro_rules! cells {
    ($($type:ty: $value:ident => $cell:expr,)+) => {$(
        impl From<$type> for Cell {
            fn from($value: $type) -> Self {
                $cell
            }
        }
    )+};
}

cells! {
    u64: count => Self::Whole(count),
    usize: count => Self::Whole(count as u64),
    f64: value => Self::Number(value),
    String: text => Self::Text(text),
    &str: text => Self::Text(text.to_owned()),
    &String: text => Self::Text(text.clone()),
    Markup: page => Self::Page(page, None),
}

/// Row of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// CSS class; empty for none.
    class: &'static str,
    cells: Vec<Cell>,
}

impl Row {
    pub(crate) const fn class(mut self, class: &'static str) -> Self {
        self.class = class;
        self
    }
}

impl FromIterator<Cell> for Row {
    fn from_iter<T: IntoIterator<Item = Cell>>(cells: T) -> Self {
        Self { class: "", cells: cells.into_iter().collect() }
    }
}

/// Returns a row whose cells are converted to [`Cell`].
#[macro_export]
macro_rules! row {
    ($($cell:expr),+ $(,)?) => {
        [$($crate::table::Cell::from($cell)),+].into_iter().collect::<$crate::table::Row>()
    };
}

/// Table whose rows are made one by one. Only as text is it in memory as a whole.
pub struct Table<'a> {
    /// Name of the table in Parquet files, and its description on pages; empty for none.
    pub name: &'a str,
    columns: Vec<Column>,
    rows: Box<dyn Iterator<Item = Row> + 'a>,
}

/// Columns of a table, each with the function that returns its cell in a row.
pub(crate) struct Columns<'a, R> {
    columns: Vec<Column>,
    cells: Vec<Box<dyn Fn(R) -> Cell + 'a>>,
}

impl<'a, R: Copy + 'a> Columns<'a, R> {
    /// Returns the first column.
    pub(crate) fn new<C: Into<Cell>>(column: Column, cell: impl Fn(R) -> C + 'a) -> Self {
        Self { columns: Vec::new(), cells: Vec::new() }.and(column, cell)
    }

    /// Adds a column.
    pub(crate) fn and<C: Into<Cell>>(mut self, column: Column, cell: impl Fn(R) -> C + 'a) -> Self {
        self.columns.push(column);
        self.cells.push(Box::new(move |row| cell(row).into()));
        self
    }

    /// Adds a column of texts for each name, such as the name of a solver.
    pub(crate) fn and_each<C: Into<Cell>>(
        self,
        names: impl IntoIterator<Item = &'a str>,
        cell: impl Fn(R, &'a str) -> C + Copy + 'a,
    ) -> Self {
        names.into_iter().fold(self, |columns, name| columns.and(Column::text(name), move |row| cell(row, name)))
    }

    /// Returns the table of rows, each with a CSS class; empty for none.
    pub(crate) fn table(
        self,
        name: &'a str,
        rows: impl IntoIterator<Item = R, IntoIter: 'a>,
        class: impl Fn(R) -> &'static str + 'a,
    ) -> Table<'a> {
        let Self { columns, cells } = self;
        let row = move |row| cells.iter().map(|cell| cell(row)).collect::<Row>().class(class(row));
        Table::new(name, columns, rows.into_iter().map(row))
    }
}

impl<'a> Table<'a> {
    /// Returns a table. Each row has one cell for each column.
    pub fn new(
        name: &'a str,
        columns: impl IntoIterator<Item = Column>,
        rows: impl IntoIterator<Item = Row, IntoIter: 'a>,
    ) -> Self {
        Self { name, columns: columns.into_iter().collect(), rows: Box::new(rows.into_iter()) }
    }

    /// Writes the table as CSV with a header and one line per row.
    ///
    /// # Errors
    /// When `out` cannot be written.
    pub fn csv(self, out: impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(self.columns.iter().map(|column| harmless(column.title())))?;
        for row in self.rows {
            table.write_record(row.cells.iter().map(Cell::csv))?;
        }
        table.flush()
    }

    #[cfg(test)]
    pub(crate) fn csv_text(self) -> String {
        let mut text = Vec::new();
        self.csv(&mut text).unwrap();
        String::from_utf8(text).unwrap()
    }

    /// Writes the table as Parquet. Empty cells of numbers are null.
    ///
    /// # Errors
    /// When `out` cannot be written.
    pub fn parquet(mut self, out: impl Write + Send) -> io::Result<()> {
        let mut group: Vec<Row> = self.rows.by_ref().take(GROUP).collect();
        let mut values = self.values(&group);
        let mut file = GroupedTable::new(self.name, &values, WriterProperties::builder(), out)?;
        while !group.is_empty() {
            file.add(&values)?;
            group = self.rows.by_ref().take(GROUP).collect();
            values = self.values(&group);
        }
        file.close()
    }

    fn values(&self, rows: &[Row]) -> Vec<(String, Values)> {
        let column = |(at, column): (usize, &Column)| {
            let cells = rows.iter().map(|row| &row.cells[at]);
            let values = match column.format {
                Format::Text | Format::Heading => Values::Word(cells.map(Cell::text).collect()),
                Format::Count => Values::Whole(cells.map(Cell::whole).collect()),
                _ => Values::Told(cells.map(Cell::value).collect()),
            };
            (column.title(), values)
        };
        self.columns.iter().enumerate().map(column).collect()
    }

    /// Returns the headings and the cells as texts in the formats of the columns.
    fn texts(self) -> Vec<Vec<String>> {
        let Self { columns, rows, .. } = self;
        let rows: Vec<Row> = rows.collect();
        let units = time_units(&columns, &rows);
        let words = |((column, cell), unit): ((&Column, &Cell), &TimeUnit)| column.words(cell, *unit);
        let row = |row: &Row| columns.iter().zip(&row.cells).zip(&units).map(words).collect();
        std::iter::once(columns.iter().map(Column::title).collect()).chain(rows.iter().map(row)).collect()
    }

    /// Returns the table for a terminal, with a line under the headings. Numbers end at the same column.
    #[must_use]
    pub fn text(self) -> String {
        self.text_within(usize::MAX)
    }

    /// Returns the table for a terminal of a width (characters). The last columns shrink first, down to their least widths.
    pub(crate) fn text_within(self, most: usize) -> String {
        let is_number: Vec<bool> = self.columns.iter().map(|column| column.class == "n").collect();
        let least: Vec<Option<usize>> = self.columns.iter().map(|column| column.least).collect();
        let mut rows = self.texts();
        let width = |at: usize| rows.iter().map(|row| row[at].chars().count()).max().unwrap_or(0);
        let mut widths: Vec<usize> = (0..is_number.len()).map(width).collect();
        for (column, least) in least.iter().enumerate().rev() {
            let line = widths.iter().sum::<usize>() + 2 * (widths.len() - 1);
            let spare = widths[column].saturating_sub(least.unwrap_or(usize::MAX));
            widths[column] -= line.saturating_sub(most).min(spare);
        }
        // The line below the last heading is not longer than the heading, because texts in the last column may be long.
        let mut lines = widths.clone();
        if let (Some(line), Some(head), Some(false)) = (lines.last_mut(), rows[0].last(), is_number.last()) {
            *line = head.chars().count().min(*line);
        }
        rows.insert(1, lines.iter().map(|width| "─".repeat(*width)).collect());
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).zip(&is_number).map(|((cell, &width), is_number)| {
                let cell = cut(cell, width);
                if *is_number { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        rows.iter().map(line).collect()
    }

    /// Returns the table as Markdown.
    #[must_use]
    pub fn markdown(self) -> String {
        let mut rows = self.texts();
        for cell in rows.iter_mut().flatten() {
            *cell = escaped(cell);
        }
        rows.insert(1, vec!["---".to_owned(); rows[0].len()]);
        rows.into_iter().map(|row| format!("| {} |\n", row.join(" | "))).collect()
    }

    /// Returns the table as a part of a page with a CSS class. A table with a name scrolls if the screen is narrower.
    pub(crate) fn page(self, class: &str) -> Markup {
        let Self { name, columns, rows } = self;
        let rows: Vec<Row> = rows.collect();
        let units = time_units(&columns, &rows);
        let sorts = class.split(' ').any(|class| class == "sorts");
        let class = Some(class).filter(|class| !class.is_empty());
        let table = html! {
            table class=[class] {
                (head(&columns))
                tbody {
                    @for row in &rows {
                        tr class=[Some(row.class).filter(|class| !class.is_empty())] {
                            @for ((column, cell), unit) in columns.iter().zip(&row.cells).zip(&units) {
                                (page_cell(column, cell, *unit, sorts))
                            }
                        }
                    }
                }
            }
        };
        if name.is_empty() { table } else { scrolling(name, &table) }
    }
}

/// Returns the unit of durations for each column.
fn time_units(columns: &[Column], rows: &[Row]) -> Vec<TimeUnit> {
    let cells = |at: usize| rows.iter().filter_map(move |row| row.cells.get(at)?.value());
    let unit = |(at, column): (usize, &Column)| TimeUnit::of(cells(at).filter(|_| column.format == Format::Seconds));
    columns.iter().enumerate().map(unit).collect()
}

/// Returns the first `width` characters of a text. The last of them is `…` if the text is longer.
fn cut(text: &str, width: usize) -> String {
    match text.char_indices().nth(width) {
        Some(_) => text.chars().take(width.saturating_sub(1)).chain(['…']).collect(),
        None => text.to_owned(),
    }
}

fn page_cell(column: &Column, cell: &Cell, unit: TimeUnit, sorts: bool) -> Markup {
    let content = match cell {
        Cell::Page(page, _) => page.clone(),
        other => html! { (column.words(other, unit)) },
    };
    let key = cell.sort_key().filter(|_| sorts);
    let class = Some(column.class).filter(|class| !class.is_empty());
    html! {
        @if column.format == Format::Heading { th class=[class] scope="row" { (content) } }
        @else { td class=[class] data-v=[key] { (content) } }
    }
}

/// Returns the headings of a table as a part of a page.
pub(crate) fn head(columns: &[Column]) -> Markup {
    html! {
        thead {
            tr {
                @for column in columns {
                    th class=[Some(column.class).filter(|class| ["n", "name"].contains(class))] scope="col" { (column.title()) }
                }
            }
        }
    }
}

/// Returns a table in a box that scrolls, also by keyboard, if the screen is narrower than the table.
pub(crate) fn scrolling(label: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(label) tabindex="0" { (table) } }
}

/// Returns a text that no spreadsheet interprets as a formula. Names come from scene files.
fn harmless(text: String) -> String {
    if text.starts_with(['=', '+', '-', '@']) { format!("'{text}") } else { text }
}

/// Returns a text with its Markdown characters escaped and its line breaks replaced by spaces.
pub(crate) fn escaped(text: &str) -> String {
    let pair = |character| match character {
        '\n' | '\r' => [None, Some(' ')],
        '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '!' => [Some('\\'), Some(character)],
        _ => [None, Some(character)],
    };
    text.chars().flat_map(pair).flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    fn table() -> Table<'static> {
        let rows = (0..GROUP as u64 + 3).map(|at| {
            let number = (at % 3 > 0).then_some(at as f64 / 3.0).filter(|_| at != 4);
            let untold = if at == 5 { Some(f64::NAN) } else { number };
            row![at, Cell::finite(untold), format!("w{at}")]
        });
        let columns = [Column::new("at", Format::Count), Column::number("third").unit("m"), Column::text("word")];
        Table::new("table", columns, rows)
    }

    #[test]
    fn parquet_says_what_the_lines_say() {
        let (text, file) = (table().csv_text(), tempfile::tempfile().unwrap());
        table().parquet(&file).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let mut lines = csv::Reader::from_reader(text.as_bytes());
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
        Table { rows: Box::new(std::iter::empty()), ..table() }.parquet(&file).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        assert_eq!(reader.metadata().file_metadata().schema_descr().num_columns(), 3);
    }

    /// The expected texts follow from the formats of the columns.
    #[test]
    fn every_form_shows_the_same_cells() {
        let columns = || {
            let time = Column::new("time", Format::Seconds);
            [Column::heading("solver"), time, Column::new("steps", Format::Count), Column::number("mass").unit("kg")]
        };
        let rows = || [row!["dem|a", 0.25, 12_000_usize, 1.0 / 3.0], row!["=b", 0.5, 7_u64, Cell::Missing]];
        let table = || Table::new("", columns(), rows());
        assert_eq!(
            table().csv_text(),
            "solver,time,steps,mass (kg)\ndem|a,0.25,12000,0.3333333333333333\n'=b,0.5,7,\n"
        );
        let plain = |text: String| text.replace('\u{202f}', " ");
        let text = plain(table().text());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!([lines[0], lines[2]], ["solver    time   steps  mass (kg)", "dem|a   250 ms  12 000      0.333"]);
        assert!(lines[1].starts_with("──────  ") && lines[3].ends_with("—"), "{text}");
        let text = Table::new("", [Column::text("why")], [row!["a long reason"]]).text();
        assert_eq!(text, "why\n───\na long reason\n");
        let text = plain(table().markdown());
        assert!(text.starts_with("| solver | time | steps | mass (kg) |\n| --- | --- | --- | --- |\n"), "{text}");
        assert!(text.contains("\n| dem\\|a | 250 ms | 12 000 | 0.333 |\n"), "{text}");
        let page = plain(Table::new("solvers", columns(), rows()).page("sorts").into_string());
        for part in ["<th class=\"n\" scope=\"col\">mass (kg)</th>", "<th scope=\"row\">dem|a</th>"] {
            assert!(page.contains(part) && page.contains("aria-label=\"solvers\""), "{page}");
        }
        assert!(page.contains("<td class=\"n\" data-v=\"0.25\">250 ms</td>"), "{page}");
    }
}
