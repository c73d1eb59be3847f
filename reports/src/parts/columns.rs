//! Conversion of rows to columns and back. Each type of row lists its columns once, for writing and for reading.

use nalgebra::Vector3;

pub(super) enum Value<'r> {
    Whole(&'r mut i64),
    /// Number, which may be NaN.
    Number(&'r mut f64),
    /// Number that may be absent.
    Told(&'r mut Option<f64>),
    Flag(&'r mut bool),
    Word(&'r mut String),
}

/// Visitor of the columns of a row, in a fixed order. One implementation reads values from the row; another one writes
/// values to it.
pub(super) trait Columns {
    fn visit(&mut self, name: &'static str, value: Value<'_>);

    /// Visits several numbers, such as the components of a vector.
    fn numbers<'r, const N: usize>(&mut self, names: [&'static str; N], values: impl IntoIterator<Item = &'r mut f64>) {
        for (name, value) in names.into_iter().zip(values) {
            self.visit(name, Value::Number(value));
        }
    }

    /// Visits several numbers that are either all present or all absent.
    fn told_numbers<const N: usize>(&mut self, names: [&'static str; N], value: &mut Option<[f64; N]>) {
        let mut all = true;
        let mut numbers = value.unwrap_or([0.0; N]);
        for (name, number) in names.into_iter().zip(&mut numbers) {
            let mut component = value.is_some().then_some(*number);
            self.visit(name, Value::Told(&mut component));
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

pub(super) trait Row: Sized {
    /// File name of the table, without extension.
    const TABLE: &'static str;

    /// Returns a row with default values.
    fn blank() -> Self;

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
#[derive(Default)]
struct ColumnBuffer {
    columns: Vec<(&'static str, Values)>,
    /// Index of the next column; none while the first visit creates the columns.
    next: Option<usize>,
}

/// Returns the names and the values of the columns of some rows. Without rows, all columns are empty.
pub(super) fn columns_of<R: Row>(rows: &mut [R]) -> Vec<(&'static str, Values)> {
    let mut buffer = ColumnBuffer::default();
    R::blank().visit(&mut buffer);
    for row in rows {
        buffer.next = Some(0);
        row.visit(&mut buffer);
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
    let row = |row: usize| {
        let mut filled = R::blank();
        filled.visit(&mut RowWriter { columns, row, next: 0 });
        filled
    };
    (0..count).map(row).collect()
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
