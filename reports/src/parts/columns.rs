//! Conversion of rows to columns and back. Each type of row lists its columns once, for writing and for reading.

use nalgebra::Vector3;
use std::array;

pub(super) enum Value<'r> {
    Whole(&'r mut i64),
    /// Number, which may be NaN.
    Number(&'r mut f64),
    /// Number that may be absent.
    Told(&'r mut Option<f64>),
    Flag(&'r mut bool),
    Word(&'r mut String),
}

/// Visitor of the columns of a row, in a fixed order. One implementation reads the values; another one replaces them. The
/// methods for the kinds of values return the values after the visit.
pub(super) trait Columns {
    fn visit(&mut self, name: &'static str, value: Value<'_>);

    /// Visits an integer of any type. A stored value that does not fit the type becomes 0; our own files contain no such value.
    fn whole<T: TryFrom<i64> + TryInto<i64> + Default>(&mut self, name: &'static str, value: Option<T>) -> T {
        let mut number = value.map_or(0, |value| value.try_into().unwrap_or(i64::MAX));
        self.visit(name, Value::Whole(&mut number));
        T::try_from(number).unwrap_or_default()
    }

    fn number(&mut self, name: &'static str, value: Option<f64>) -> f64 {
        let mut number = value.unwrap_or_default();
        self.visit(name, Value::Number(&mut number));
        number
    }

    fn told(&mut self, name: &'static str, mut value: Option<f64>) -> Option<f64> {
        self.visit(name, Value::Told(&mut value));
        value
    }

    fn flag(&mut self, name: &'static str, value: Option<bool>) -> bool {
        let mut flag = value.unwrap_or_default();
        self.visit(name, Value::Flag(&mut flag));
        flag
    }

    fn word(&mut self, name: &'static str, value: Option<&str>) -> String {
        let mut word = value.unwrap_or_default().to_owned();
        self.visit(name, Value::Word(&mut word));
        word
    }

    fn numbers<const N: usize>(&mut self, names: [&'static str; N], value: Option<[f64; N]>) -> [f64; N] {
        array::from_fn(|at| self.number(names[at], value.map(|numbers| numbers[at])))
    }

    fn vector(&mut self, names: [&'static str; 3], value: Option<Vector3<f64>>) -> Vector3<f64> {
        self.numbers(names, value.map(Into::into)).into()
    }

    /// Visits several numbers that are either all present or all absent.
    fn told_numbers<const N: usize>(&mut self, names: [&'static str; N], value: Option<[f64; N]>) -> Option<[f64; N]> {
        let numbers: [Option<f64>; N] = array::from_fn(|at| self.told(names[at], value.map(|numbers| numbers[at])));
        numbers.iter().all(Option::is_some).then(|| numbers.map(Option::unwrap_or_default))
    }

    fn told_vector(&mut self, names: [&'static str; 3], value: Option<Vector3<f64>>) -> Option<Vector3<f64>> {
        self.told_numbers(names, value.map(Into::into)).map(Vector3::from)
    }
}

pub(super) trait Row: Sized {
    /// File name of the table, without extension.
    const TABLE: &'static str;

    /// Visits the columns of a row, or of a row with default values. Returns the row with the values after the visits.
    fn visit(row: Option<&Self>, columns: &mut impl Columns) -> Self;
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
#[derive(Default)]
struct ColumnBuffer {
    columns: Vec<(&'static str, Values)>,
    /// Index of the next column; none while the first visit creates the columns.
    next: Option<usize>,
}

/// Returns the names and the values of the columns of some rows. Without rows, all columns are empty.
pub(super) fn columns_of<R: Row>(rows: &[R]) -> Vec<(&'static str, Values)> {
    let mut buffer = ColumnBuffer::default();
    R::visit(None, &mut buffer);
    for row in rows {
        buffer.next = Some(0);
        R::visit(Some(row), &mut buffer);
    }
    buffer.columns
}

impl Columns for ColumnBuffer {
    fn visit(&mut self, name: &'static str, value: Value<'_>) {
        let Some(next) = &mut self.next else {
            let empty = match value {
                Value::Whole(_) => Values::Whole(Vec::new()),
                Value::Number(_) => Values::Number(Vec::new()),
                Value::Told(_) => Values::Told(Vec::new()),
                Value::Flag(_) => Values::Flag(Vec::new()),
                Value::Word(_) => Values::Word(Vec::new()),
            };
            return self.columns.push((name, empty));
        };
        match (&mut self.columns[*next].1, value) {
            (Values::Whole(values), Value::Whole(value)) => values.push(*value),
            (Values::Number(values), Value::Number(value)) => values.push(*value),
            (Values::Told(values), Value::Told(value)) => values.push(*value),
            (Values::Flag(values), Value::Flag(value)) => values.push(*value),
            (Values::Word(values), Value::Word(value)) => values.push(value.clone()),
            _ => {}
        }
        *next += 1;
    }
}

/// Visitor that writes the values of columns to rows. If a column lacks a value, an optional number becomes absent, and any
/// other value keeps its default.
struct RowWriter<'v> {
    columns: &'v [Values],
    row: usize,
    next: usize,
}

/// Returns `count` rows with the values of the columns.
pub(super) fn rows_of<R: Row>(columns: &[Values], count: usize) -> Vec<R> {
    (0..count).map(|row| R::visit(None, &mut RowWriter { columns, row, next: 0 })).collect()
}

impl Columns for RowWriter<'_> {
    fn visit(&mut self, _name: &'static str, value: Value<'_>) {
        fn set<T: Clone>(value: &mut T, stored: Option<&T>) {
            if let Some(stored) = stored {
                value.clone_from(stored);
            }
        }
        match (self.columns.get(self.next), value) {
            (Some(Values::Whole(values)), Value::Whole(value)) => set(value, values.get(self.row)),
            (Some(Values::Number(values)), Value::Number(value)) => set(value, values.get(self.row)),
            (Some(Values::Told(values)), Value::Told(value)) => *value = values.get(self.row).copied().flatten(),
            (Some(Values::Flag(values)), Value::Flag(value)) => set(value, values.get(self.row)),
            (Some(Values::Word(values)), Value::Word(value)) => set(value, values.get(self.row)),
            _ => {}
        }
        self.next += 1;
    }
}
