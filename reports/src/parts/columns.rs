//! Conversion of rows to columns and back. Each type of row lists its columns once, for writing and for reading.

pub(super) enum Value<'r> {
    Whole(&'r mut i64),
    /// Number, which may be NaN.
    Number(&'r mut f64),
    /// Number that may be absent.
    Told(&'r mut Option<f64>),
    Flag(&'r mut bool),
    Word(&'r mut String),
}

/// Visitor of the columns of a row, in a fixed order. One implementation reads the values; another one replaces them.
pub(super) trait Columns {
    fn visit(&mut self, name: &'static str, value: Value<'_>);

    /// Visits an integer of any type. A stored value that does not fit the type becomes 0; our own files contain no such value.
    fn whole<T: TryFrom<i64> + TryInto<i64> + Copy + Default>(&mut self, name: &'static str, value: &mut T) {
        let mut number = (*value).try_into().unwrap_or(i64::MAX);
        self.visit(name, Value::Whole(&mut number));
        *value = T::try_from(number).unwrap_or_default();
    }

    fn number(&mut self, name: &'static str, value: &mut f64) {
        self.visit(name, Value::Number(value));
    }

    fn numbers<'v>(&mut self, names: &[&'static str], values: impl IntoIterator<Item = &'v mut f64>) {
        names.iter().zip(values).for_each(|(name, value)| self.number(name, value));
    }

    fn flag(&mut self, name: &'static str, value: &mut bool) {
        self.visit(name, Value::Flag(value));
    }

    fn word(&mut self, name: &'static str, value: &mut String) {
        self.visit(name, Value::Word(value));
    }

    fn told(&mut self, name: &'static str, value: &mut Option<f64>) {
        self.visit(name, Value::Told(value));
    }

    /// Visits several numbers that are either all present or all absent.
    fn told_numbers<T, const N: usize>(&mut self, names: [&'static str; N], value: &mut Option<T>)
    where
        T: AsRef<[f64; N]> + From<[f64; N]>,
    {
        let mut numbers = value.as_ref().map_or([None; N], |value| value.as_ref().map(Some));
        names.into_iter().zip(&mut numbers).for_each(|(name, number)| self.told(name, number));
        *value = numbers.iter().all(Option::is_some).then(|| numbers.map(Option::unwrap_or_default).into());
    }
}

pub(super) trait Row: Default {
    /// File name of the table, without extension.
    const TABLE: &'static str;

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
#[derive(Default)]
struct ColumnBuffer {
    columns: Vec<(&'static str, Values)>,
    /// Index of the next column; none while the first visit creates the columns.
    next: Option<usize>,
}

/// Returns the names and the values of the columns of some rows. Without rows, all columns are empty.
pub(super) fn columns_of<R: Row>(rows: &mut [R]) -> Vec<(&'static str, Values)> {
    let mut buffer = ColumnBuffer::default();
    R::default().visit(&mut buffer);
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
    let mut rows: Vec<R> = std::iter::repeat_with(R::default).take(count).collect();
    rows.iter_mut().enumerate().for_each(|(row, read)| read.visit(&mut RowWriter { columns, row, next: 0 }));
    rows
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
