//! Conversion of rows to columns and back. Each type of row lists its columns once, for writing and for reading.

use nalgebra::Vector3;

/// Visitor of the columns of a row, in a fixed order. One implementation reads values from the row; another one writes
/// values to it.
pub(super) trait Columns {
    /// Visits an integer.
    fn whole(&mut self, name: &'static str, value: &mut i64);
    /// Visits a number, which may be NaN.
    fn number(&mut self, name: &'static str, value: &mut f64);
    /// Visits a number that may be absent.
    fn optional(&mut self, name: &'static str, value: &mut Option<f64>);
    /// Visits a Boolean value.
    fn flag(&mut self, name: &'static str, value: &mut bool);
    /// Visits a text.
    fn word(&mut self, name: &'static str, value: &mut String);

    /// Visits the components of a vector.
    fn vector(&mut self, names: [&'static str; 3], value: &mut Vector3<f64>) {
        for (name, value) in names.into_iter().zip(value.iter_mut()) {
            self.number(name, value);
        }
    }

    /// Visits several numbers that are either all present or all absent.
    fn told_numbers<const N: usize>(&mut self, names: [&'static str; N], value: &mut Option<[f64; N]>) {
        let mut all = true;
        let mut numbers = value.unwrap_or([0.0; N]);
        for (name, number) in names.into_iter().zip(&mut numbers) {
            let mut component = value.is_some().then_some(*number);
            self.optional(name, &mut component);
            all &= component.is_some();
            *number = component.unwrap_or(*number);
        }
        *value = all.then_some(numbers);
    }

    /// Visits several boxed numbers that are either all present or all absent.
    fn told_apart<const N: usize>(&mut self, names: [&'static str; N], value: &mut Option<Box<[f64; N]>>) {
        let mut numbers = value.as_deref().copied();
        self.told_numbers(names, &mut numbers);
        *value = numbers.map(Box::new);
    }

    /// Visits the components of a vector that may be absent.
    fn told_vector(&mut self, names: [&'static str; 3], value: &mut Option<Vector3<f64>>) {
        let mut components = value.map(Into::into);
        self.told_numbers(names, &mut components);
        *value = components.map(Vector3::from);
    }
}

/// Type of a table row.
pub(super) trait Row: Sized {
    /// File name of the table, without extension.
    const TABLE: &'static str;

    /// Returns a row with default values.
    fn blank() -> Self;

    /// Visits the columns of the row.
    fn visit(&mut self, columns: &mut impl Columns);
}

/// Values of one column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    Whole(Vec<i64>),
    Number(Vec<f64>),
    Told(Vec<Option<f64>>),
    Flag(Vec<bool>),
    Word(Vec<String>),
}

/// Buffer of columns that is filled row by row.
#[derive(Debug, Default)]
pub(super) struct ColumnBuffer {
    pub(super) columns: Vec<(&'static str, Values)>,
    at: usize,
}

impl ColumnBuffer {
    /// Returns the columns of some rows. Without rows, all columns are empty.
    pub(super) fn from_rows<R: Row>(rows: &mut [R]) -> Self {
        let mut gathered = Self::default();
        R::blank().visit(&mut gathered);
        for (_, values) in &mut gathered.columns {
            match values {
                Values::Whole(values) => values.clear(),
                Values::Number(values) => values.clear(),
                Values::Told(values) => values.clear(),
                Values::Flag(values) => values.clear(),
                Values::Word(values) => values.clear(),
            }
        }
        for row in rows {
            gathered.at = 0;
            row.visit(&mut gathered);
        }
        gathered
    }

    fn column(&mut self, name: &'static str, empty: Values) -> &mut Values {
        if self.at == self.columns.len() {
            self.columns.push((name, empty));
        }
        self.at += 1;
        &mut self.columns[self.at - 1].1
    }
}

impl Columns for ColumnBuffer {
    fn whole(&mut self, name: &'static str, value: &mut i64) {
        if let Values::Whole(values) = self.column(name, Values::Whole(Vec::new())) {
            values.push(*value);
        }
    }

    fn number(&mut self, name: &'static str, value: &mut f64) {
        if let Values::Number(values) = self.column(name, Values::Number(Vec::new())) {
            values.push(*value);
        }
    }

    fn optional(&mut self, name: &'static str, value: &mut Option<f64>) {
        if let Values::Told(values) = self.column(name, Values::Told(Vec::new())) {
            values.push(*value);
        }
    }

    fn flag(&mut self, name: &'static str, value: &mut bool) {
        if let Values::Flag(values) = self.column(name, Values::Flag(Vec::new())) {
            values.push(*value);
        }
    }

    fn word(&mut self, name: &'static str, value: &mut String) {
        if let Values::Word(values) = self.column(name, Values::Word(Vec::new())) {
            values.push(value.clone());
        }
    }
}

/// Visitor that writes the values of columns to rows. If a column lacks a value, an optional number becomes absent, and any
/// other value keeps its default.
pub(super) struct RowWriter<'v> {
    columns: &'v [Values],
    row: usize,
    at: usize,
}

impl<'v> RowWriter<'v> {
    /// Returns `count` rows with the values of the columns.
    pub(super) fn rows<R: Row>(columns: &'v [Values], count: usize) -> Vec<R> {
        let row = |row: usize| {
            let mut filled = R::blank();
            filled.visit(&mut Self { columns, row, at: 0 });
            filled
        };
        (0..count).map(row).collect()
    }

    fn next(&mut self) -> Option<&'v Values> {
        self.at += 1;
        self.columns.get(self.at - 1)
    }
}

impl Columns for RowWriter<'_> {
    fn whole(&mut self, _name: &'static str, value: &mut i64) {
        if let Some(Values::Whole(values)) = self.next() {
            *value = values.get(self.row).copied().unwrap_or(*value);
        }
    }

    fn number(&mut self, _name: &'static str, value: &mut f64) {
        if let Some(Values::Number(values)) = self.next() {
            *value = values.get(self.row).copied().unwrap_or(*value);
        }
    }

    fn optional(&mut self, _name: &'static str, value: &mut Option<f64>) {
        if let Some(Values::Told(values)) = self.next() {
            *value = values.get(self.row).copied().flatten();
        }
    }

    fn flag(&mut self, _name: &'static str, value: &mut bool) {
        if let Some(Values::Flag(values)) = self.next() {
            *value = values.get(self.row).copied().unwrap_or(*value);
        }
    }

    fn word(&mut self, _name: &'static str, value: &mut String) {
        if let Some(Values::Word(values)) = self.next()
            && let Some(word) = values.get(self.row)
        {
            value.clone_from(word);
        }
    }
}
