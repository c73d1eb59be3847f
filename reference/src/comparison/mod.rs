//! Two outputs against each other, column by column: at the steps or rows that both have, or in time where their steps
//! differ, with the second interpolated between its samples.

mod column;
mod frames;

use std::path::Path;

use crate::observer::Names;
use crate::read::read_error::{ReadError, quoted};
use crate::run_files::kind;
use column::{Column, Printed};
use frames::{Frame, Frames, Place};

pub use column::{Difference, Sample};

/// What is compared of two outputs.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Only these columns, by the names that the first file has; all that both have when empty.
    pub columns: Vec<String>,
    /// What the second file calls columns of the first.
    pub names: Names,
    /// Time steps (s) of both, where files tell steps and no times.
    pub time_steps: [Option<f64>; 2],
    /// Takes the whole frames of a file that is cut off.
    pub partial: bool,
}

/// By what samples of two outputs are matched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// By step.
    Step,
    /// In time, the second interpolated.
    Time,
    /// Row by row.
    Row,
}

impl Key {
    /// What a sample is called.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Time => "time",
            Self::Row => "row",
        }
    }

    fn of(self, place: &Place) -> f64 {
        match self {
            Self::Step => place.step.map_or(f64::NAN, |step| step as f64),
            Self::Time => place.time.unwrap_or(f64::NAN),
            Self::Row => place.number as f64,
        }
    }
}

/// Two outputs, compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Column by column.
    pub differences: Vec<Difference>,
    /// Columns that one of them has and the other has not.
    pub lonely: [Vec<String>; 2],
    /// Where each is cut off, if that was allowed.
    pub cuts: [Option<String>; 2],
    /// By what samples were matched.
    pub key: Key,
    /// How many samples of the first were compared.
    pub compared: u64,
    /// How many of them with a value of the second that was interpolated.
    pub interpolated: u64,
    /// How many samples each has.
    pub samples: [u64; 2],
    /// The last sample of each: its step, time (s) or row.
    pub last: [f64; 2],
    /// The last that was compared.
    pub last_compared: f64,
    /// Mean distance between samples of the one with fewer, in the same unit.
    pub interval: f64,
}

/// Times this near to each other are one, as a part of the larger.
const ONE_TIME: f64 = 1e-6;

/// Compares two dumps or two tables.
///
/// # Errors
/// One of them cannot be read, they are of different kinds, have no column or no sample in common, or another number of
/// rows at a step.
pub fn compare(first: &Path, second: &Path, options: &Options) -> Result<Comparison, ReadError> {
    let name = second.to_string_lossy().into_owned();
    let kinds = [kind(first)?, kind(second)?];
    if kinds[0].is_table() != kinds[1].is_table() {
        let expected = format!("{}, as the other file is", kinds[0].words());
        return Err(ReadError::at(&name, 1, expected, kinds[1].words()));
    }
    let open = |which: usize| Frames::open([first, second][which], !kinds[0].is_table(), which, options);
    let Survey { columns, printed, lonely, places, cuts } = survey([open(0)?, open(1)?], options)?;
    let key = key(&places).ok_or_else(|| {
        let expected = format!("{} rows, as in the other file, or a column `step` or `time`", places[0].len());
        ReadError::at(&name, 1, expected, places[1].len().to_string())
    })?;
    let mut files = [open(0)?, open(1)?];
    files.iter_mut().for_each(|frames| frames.want(&columns));
    let columns: Vec<Column> = columns.iter().zip(printed).map(|(name, printed)| Column::new(name, printed)).collect();
    let mut walk = Walk { key, columns, bends: Vec::new(), compared: 0, interpolated: 0, last: f64::NAN };
    walk.go(&mut files)?;
    if walk.compared == 0 {
        return Err(ReadError::at(&name, 1, format!("a {} that the other file has", key.word()), "none"));
    }
    let ends = [0, 1].map(|which: usize| places[which].last().map_or(f64::NAN, |place| key.of(place)));
    let interval = |which: usize| {
        let first = places[which].first().map_or(f64::NAN, |place| key.of(place));
        (ends[which] - first) / (places[which].len().max(2) - 1) as f64
    };
    let interval = interval(0).max(interval(1));
    let samples = [places[0].len() as u64, places[1].len() as u64];
    let (compared, interpolated, last_compared) = (walk.compared, walk.interpolated, walk.last);
    let differences = walk.finish();
    let last = ends;
    Ok(Comparison { differences, lonely, cuts, key, compared, interpolated, samples, last, last_compared, interval })
}

/// What both files hold.
struct Survey {
    /// The columns that are compared.
    columns: Vec<String>,
    /// With which digits each file prints them.
    printed: Vec<[Printed; 2]>,
    /// Columns that one of them has and the other has not.
    lonely: [Vec<String>; 2],
    /// Where the samples of each stand.
    places: [Vec<Place>; 2],
    cuts: [Option<String>; 2],
}

/// Reads both files to their ends.
fn survey(mut files: [Frames; 2], options: &Options) -> Result<Survey, ReadError> {
    let mut places: [Vec<Place>; 2] = Default::default();
    for (frames, places) in files.iter_mut().zip(&mut places) {
        while let Some(frame) = frames.next()? {
            places.push(frame.place);
        }
    }
    if let (Some(one), Some(other)) = (files[0].units(), files[1].units())
        && one != other
    {
        let expected = format!("the units {} of the other file", quoted(one));
        return Err(ReadError::at(&files[1].file, 1, expected, quoted(other)));
    }
    let [a, b] = [files[0].columns(), files[1].columns()];
    let missing = |of: usize, expected: String| {
        let line = places[of].first().map_or(1, |place| place.line.saturating_sub(1));
        ReadError::at(&files[of].file, line, expected, quoted(&[&a, &b][of].join(" ")))
    };
    for (asked, has) in options.columns.iter().flat_map(|name| [(name, 0), (name, 1)]) {
        if ![&a, &b][has].contains(asked) {
            return Err(missing(has, format!("the column {}", quoted(asked))));
        }
    }
    let is_asked = |name: &String| options.columns.is_empty() || options.columns.contains(name);
    let columns: Vec<String> = a.iter().filter(|name| b.contains(name) && is_asked(name)).cloned().collect();
    if columns.is_empty() {
        return Err(missing(1, format!("a column of {}", quoted(&a.join(" ")))));
    }
    let printed = columns.iter().map(|name| [files[0].printed(name), files[1].printed(name)]).collect();
    let alone = |of: &[String], other: &[String]| -> Vec<String> {
        of.iter().filter(|name| is_asked(name) && !other.contains(name)).cloned().collect()
    };
    let (lonely, cuts) = ([alone(&a, &b), alone(&b, &a)], files.map(|file| file.cut));
    Ok(Survey { columns, printed, lonely, places, cuts })
}

/// By what samples are matched: by steps where the file with fewer has none of its own and they are at the same times,
/// else in time where both tell it; row by row only tables that tell neither.
fn key([a, b]: &[Vec<Place>; 2]) -> Option<Key> {
    let tell_times = a.iter().chain(b).all(|place| place.time.is_some());
    let tell_steps = a.iter().chain(b).all(|place| place.step.is_some());
    let fewest = a.len().min(b.len());
    let (mut shared, mut at_one_time, mut at) = (0, true, 0);
    for place in a {
        while b.get(at).is_some_and(|other| other.step < place.step) {
            at += 1;
        }
        if let Some(other) = b.get(at).filter(|other| other.step == place.step) {
            shared += 1;
            at_one_time &= place.time.zip(other.time).is_none_or(|(one, two)| is_one(one, two));
        }
    }
    if tell_steps && ((shared == fewest && at_one_time) || !tell_times) {
        Some(Key::Step)
    } else if tell_times {
        Some(Key::Time)
    } else {
        (a.len() == b.len()).then_some(Key::Row)
    }
}

fn is_one(one: f64, two: f64) -> bool {
    (one - two).abs() <= ONE_TIME * one.abs().max(two.abs())
}

/// Goes through two outputs together.
struct Walk {
    key: Key,
    columns: Vec<Column>,
    /// The largest second difference of each column of the second output, where it is interpolated.
    bends: Vec<f64>,
    compared: u64,
    interpolated: u64,
    last: f64,
}

impl Walk {
    fn go(&mut self, [first, second]: &mut [Frames; 2]) -> Result<(), ReadError> {
        self.bends = vec![0.0; self.columns.len()];
        let mut recent: Vec<Frame> = Vec::new();
        let mut ahead = second.next()?;
        while let Some(frame) = first.next()? {
            let at = self.key.of(&frame.place);
            let key = self.key;
            let is_there = |other: f64| if key == Key::Time { is_one(other, at) } else { other == at };
            // What lies behind is kept for as long as something may lie between it and what is ahead.
            while let Some(next) = ahead.take() {
                let other = self.key.of(&next.place);
                if other >= at || is_there(other) {
                    ahead = Some(next);
                    break;
                }
                self.bend(&mut recent, next);
                ahead = second.next()?;
            }
            match (recent.last(), &ahead) {
                (_, Some(next)) if is_there(self.key.of(&next.place)) => {
                    matched(&frame, next, &second.file, self.key)?;
                    self.take(at, &frame, &next.values);
                }
                (Some(before), Some(next)) if self.key == Key::Time => {
                    matched(&frame, next, &second.file, self.key)?;
                    matched(&frame, before, &second.file, self.key)?;
                    let [low, high] = [before, next].map(|of| self.key.of(&of.place));
                    let values = between(before, next, (at - low) / (high - low));
                    self.interpolated += 1;
                    self.take(at, &frame, &values);
                }
                _ => {}
            }
        }
        while let Some(next) = ahead {
            self.bend(&mut recent, next);
            ahead = second.next()?;
        }
        Ok(())
    }

    fn take(&mut self, at: f64, frame: &Frame, others: &[Vec<f64>]) {
        for ((column, values), others) in self.columns.iter_mut().zip(&frame.values).zip(others) {
            column.take(at, [values, others]);
        }
        self.compared += 1;
        self.last = at;
    }

    /// Remembers a frame of the second output, and how sharply its columns bend there.
    fn bend(&mut self, recent: &mut Vec<Frame>, next: Frame) {
        if let [first, second] = &recent[..] {
            for (at, bend) in self.bends.iter_mut().enumerate() {
                let rows = first.values[at].iter().zip(&second.values[at]).zip(&next.values[at]);
                let largest = rows.map(|((a, b), c)| (a - 2.0 * b + c).abs()).fold(0.0, f64::max);
                *bend = bend.max(largest);
            }
            recent.remove(0);
        }
        recent.push(next);
    }

    /// Differences with what digits leave open, and an eighth of the second difference where values were interpolated:
    /// the error of a straight line between two samples.
    fn finish(self) -> Vec<Difference> {
        let interpolated = self.interpolated > 0;
        let with_bends = self.columns.into_iter().zip(self.bends);
        with_bends.map(|(column, bend)| column.finish(if interpolated { bend / 8.0 } else { 0.0 })).collect()
    }
}

/// Values between two frames, in a straight line.
fn between(before: &Frame, next: &Frame, share: f64) -> Vec<Vec<f64>> {
    let column = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
    before.values.iter().zip(&next.values).map(column).collect()
}

/// Refuses frames with other rows or other ids.
fn matched(frame: &Frame, other: &Frame, file: &str, key: Key) -> Result<(), ReadError> {
    let rows = |frame: &Frame| frame.values.first().map_or(0, Vec::len);
    let (word, at) = (key.word(), key.of(&frame.place));
    if rows(frame) != rows(other) {
        let expected = format!("{} rows at {word} {at}, as in the other file", rows(frame));
        return Err(ReadError::at(file, other.place.line, expected, rows(other).to_string()));
    }
    if let (Some(a), Some(b)) = (&frame.ids, &other.ids)
        && let Some((expected, found)) = a.iter().zip(b).find(|(a, b)| a != b)
    {
        let expected = format!("the id {expected} at {word} {at}, as in the other file");
        return Err(ReadError::at(file, other.place.line, expected, found.to_string()));
    }
    Ok(())
}
