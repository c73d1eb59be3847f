//! Observations in the published data, all computed from the data.

use super::impact::{Course, GRAVITY, Impact, RELEASED};
use super::spread::mean;
use super::tables::{Drum, Kind, PublishedTable};
use std::fmt;

/// Observation in the data with its expectation, a row of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct DataFinding {
    /// Name of the table, or empty until it is known.
    pub table: String,
    /// Object of the observation.
    pub about: String,
    /// Observed quantity.
    pub quantity: String,
    /// Observed value.
    pub found: String,
    /// Expected value.
    pub expected: String,
}

impl DataFinding {
    fn new(about: impl Into<String>, quantity: impl Into<String>, found: String, expected: impl Into<String>) -> Self {
        Self { table: String::new(), about: about.into(), quantity: quantity.into(), found, expected: expected.into() }
    }
}

impl fmt::Display for DataFinding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for part in [&self.table, &self.about].into_iter().filter(|part| !part.is_empty()) {
            write!(formatter, "{part}: ")?;
        }
        write!(formatter, "{}: {}; expected {}", self.quantity, self.found, self.expected)
    }
}

/// Tolerance of the initial velocity (m/s). A larger difference is a different release.
const OTHER_RELEASE: f64 = 0.1;
/// Number of standard deviations from which on a bed or code is an outlier. Eighty realizations do not reach it by
/// chance.
const STANDS_OUT: f64 = 4.0;
/// Time when the ball has just reached the bed (s). Beds are identified at this time, before chaos has grown.
const MET: f64 = 0.022;
/// Time at which depths are compared (s).
const DEEP: f64 = 0.030;
/// Tolerance of the height above free flight between codes on the same bed (m).
const SAME_BED: f64 = 1.2e-5;

/// Returns the observations in all tables. Each table is checked separately, and each drum is compared with the first
/// one.
#[must_use]
pub fn of_all(tables: &[PublishedTable]) -> Vec<DataFinding> {
    let mut all = Vec::new();
    let mut first: Option<(&str, &Drum)> = None;
    for PublishedTable { name, kind } in tables {
        let findings = match kind {
            Kind::Impact(impact) => of_impact(impact),
            Kind::Drum(drum) => {
                let beside = first.map(|first| of_drums(drum, first)).unwrap_or_default();
                first = first.or(Some((name, drum)));
                [of_drum(drum), beside].concat()
            }
            Kind::Silo(_) => Vec::new(),
        };
        all.extend(findings.into_iter().map(|finding| {
            // A time series that is alone in its file has the same name as the file.
            let about = if finding.about == *name { String::new() } else { finding.about };
            DataFinding { table: name.clone(), about, ..finding }
        }));
    }
    all
}

/// Returns the observations as a heading and a table in Markdown.
#[must_use]
pub fn table_of(rows: &[DataFinding]) -> String {
    let mut text =
        "## Consistency of the published data\n\nComputed by `grainbench reference import dosta-2024 DIR` from \
                    the tables in DIR. Where these are copies: to be confirmed against the source.\n\n\
                    | table | of | quantity | found | expected |\n|---|---|---|---|---|\n"
            .to_owned();
    for DataFinding { table, about, quantity, found, expected } in rows {
        text += &format!("| {table} | {about} | {quantity} | {found} | {expected} |\n");
    }
    text
}

/// Returns the observations in time series of the ball.
#[must_use]
pub fn of_impact(impact: &Impact) -> Vec<DataFinding> {
    let mut all = Vec::new();
    if impact.repeated > 0 {
        all.push(DataFinding::new("clock", "rows with the time of the row before", impact.repeated.to_string(), "0"));
    }
    for course in &impact.courses {
        all.extend(released(impact, course));
    }
    let flown: Vec<&Course> = impact.courses.iter().filter(|course| released(impact, course).is_none()).collect();
    all.extend(clocks(impact, &flown));
    if impact.courses.len() > 1 {
        all.extend(numbers(impact, &flown));
        all.extend(outside(impact, &flown));
    }
    all
}

fn name(course: &Course) -> String {
    format!("{}, bed {}", course.code, course.bed)
}

/// Returns an observation if the ball was not released at −5 m/s. The velocity is measured between 1 ms and 2 ms,
/// when the bed hardly decelerates the ball.
///
/// The first sample is not used, because a clock error in this sample alone is not a different release.
fn released(impact: &Impact, course: &Course) -> Option<DataFinding> {
    const FLIGHT: [f64; 2] = [0.001, 0.002];
    let speed = impact.velocity(course, FLIGHT)? + GRAVITY * 0.5 * (FLIGHT[0] + FLIGHT[1]);
    let finding = || {
        DataFinding::new(name(course), "velocity at the start", format!("{speed:.2} m/s"), format!("{RELEASED} m/s"))
    };
    ((speed - RELEASED).abs() > OTHER_RELEASE).then(finding)
}

/// Returns the clock errors. They follow from the height in the first sample, and are compared with the next sample.
fn clocks(impact: &Impact, flown: &[&Course]) -> Vec<DataFinding> {
    let relative_height = |code: &str, time: f64| -> Option<f64> {
        let heights: Option<Vec<f64>> =
            flown.iter().filter(|course| course.code == code).map(|course| impact.held_up(course, time)).collect();
        heights.filter(|heights| !heights.is_empty()).map(|heights| mean(&heights) / RELEASED)
    };
    let (Some(&first), Some(&later)) = (impact.times.first(), impact.times.get(1)) else { return Vec::new() };
    let mut all = Vec::new();
    for code in codes(flown) {
        let (Some(ahead), Some(later)) = (relative_height(code, first), relative_height(code, later)) else { continue };
        if ahead.abs() > 1e-5 || later.abs() > 1e-5 {
            let found = format!("{ahead:.2e} s, and {later:.1e} s at the next");
            all.push(DataFinding::new(code, "clock ahead at its first sample", found, "0 s"));
        }
    }
    all
}

fn codes<'a>(courses: &[&'a Course]) -> Vec<&'a str> {
    let mut codes: Vec<&str> = Vec::new();
    for course in courses {
        if !codes.contains(&course.code.as_str()) {
            codes.push(&course.code);
        }
    }
    codes
}

/// Returns the height of the ball above free flight (m) at the first contact with each bed, by code and number of the
/// bed.
fn prints<'a>(impact: &Impact, flown: &[&'a Course]) -> Vec<(&'a str, Vec<(usize, f64)>)> {
    let heights_of_code = |code: &'a str| {
        let beds = flown.iter().filter(|course| course.code == code);
        (code, beds.filter_map(|course| Some((course.bed, impact.held_up(course, MET)?))).collect())
    };
    codes(flown).into_iter().map(heights_of_code).collect()
}

/// Returns the beds that have different numbers in different codes. The initial height above free flight is a
/// fingerprint of a bed, because all codes agree on it.
fn numbers(impact: &Impact, flown: &[&Course]) -> Vec<DataFinding> {
    let prints = prints(impact, flown);
    // Median over the codes for each number.
    let usual = |bed: usize| {
        let mut heights: Vec<f64> = prints
            .iter()
            .flat_map(|(_, heights)| heights.iter().filter(|(number, _)| *number == bed).map(|(_, up)| *up))
            .collect();
        heights.sort_by(f64::total_cmp);
        heights.get(heights.len() / 2).copied()
    };
    let mut all = Vec::new();
    for (code, heights) in &prints {
        let off = |shift: usize| -> Vec<f64> {
            heights.iter().filter_map(|&(bed, up)| Some(up - usual(bed.checked_sub(shift)?)?)).collect()
        };
        let size = |off: &[f64]| (off.iter().map(|off| off * off).sum::<f64>() / off.len() as f64).sqrt();
        let (as_said, shifted) = (off(0), off(1));
        if heights.len() < 3 || size(&as_said) < SAME_BED || size(&shifted) > SAME_BED {
            continue;
        }
        let others: Vec<String> = heights
            .iter()
            .filter(|(_, up)| {
                prints
                    .iter()
                    .flat_map(|(_, heights)| heights)
                    .filter(|(_, other)| (up - other).abs() < SAME_BED)
                    .count()
                    < 2
            })
            .map(|(bed, up)| format!("; its bed {bed} (held up by {:.0} µm) is none of the others'", up * 1e6))
            .collect();
        let found = format!(
            "within {:.0} µm, and within {:.1} µm of those one number lower: its beds are the others' under numbers one higher{}",
            size(&as_said) * 1e6,
            size(&shifted) * 1e6,
            others.concat()
        );
        let quantity = "how far its beds hold the ball up at 22 ms, beside beds of the same number";
        all.push(DataFinding::new(*code, quantity, found, format!("within {:.0} µm", SAME_BED * 1e6)));
    }
    all
}

/// Returns beds and codes that are outliers at 30 ms.
fn outside(impact: &Impact, flown: &[&Course]) -> Vec<DataFinding> {
    let depth = |course: &Course| impact.height(course, DEEP).map(|height| height * 1e3);
    let depths_of_code = |code: &str, but: Option<usize>| -> Vec<f64> {
        let courses = flown.iter().filter(|course| course.code == code && Some(course.bed) != but);
        courses.filter_map(|course| depth(course)).collect()
    };
    let deviation = |values: &[f64]| {
        (values.iter().map(|value| (value - mean(values)).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0)).sqrt()
    };
    let mut all = Vec::new();
    let mut left_out = Vec::new();
    for course in flown {
        let (rest, Some(depth)) = (depths_of_code(&course.code, Some(course.bed)), depth(course)) else { continue };
        let off = depth - mean(&rest);
        if rest.len() > 2 && off.abs() > 2.0 * STANDS_OUT * deviation(&rest) {
            let found = format!(
                "{depth:.2} mm, {:.1} mm {} the mean of its code's other beds, {:.0} of their deviations",
                off.abs(),
                if off < 0.0 { "below" } else { "above" },
                off.abs() / deviation(&rest)
            );
            let expected = format!("within {:.0} deviations", 2.0 * STANDS_OUT);
            all.push(DataFinding::new(name(course), "height at 30 ms", found, expected));
            left_out.push((course.code.clone(), course.bed));
        }
    }
    let known: Vec<&&Course> =
        flown.iter().filter(|course| !left_out.contains(&(course.code.clone(), course.bed))).collect();
    let means: Vec<(&str, f64)> = codes(flown)
        .into_iter()
        .map(|code| {
            let depths: Vec<f64> =
                known.iter().filter(|course| course.code == code).filter_map(|course| depth(course)).collect();
            (code, mean(&depths))
        })
        .collect();
    for (code, depth) in &means {
        let rest: Vec<f64> = means.iter().filter(|(other, _)| other != code).map(|(_, mean)| *mean).collect();
        let off = depth - mean(&rest);
        if rest.len() > 2 && off.abs() > STANDS_OUT * deviation(&rest) {
            let found = format!(
                "{depth:.2} mm, {:.1} deviations between the other codes {} their mean",
                off.abs() / deviation(&rest),
                if off < 0.0 { "below" } else { "above" }
            );
            all.push(DataFinding::new(
                *code,
                "height at 30 ms, mean of its beds",
                found,
                format!("within {STANDS_OUT:.0} deviations"),
            ));
        }
    }
    all
}

/// Returns the frames of a drum that were counted twice.
#[must_use]
pub fn of_drum(drum: &Drum) -> Vec<DataFinding> {
    let total = |row: usize| drum.zones.iter().map(|zone| zone[row]).sum::<f64>();
    let even = |row: usize| drum.zones.iter().all(|zone| zone[row] % 2.0 == 0.0);
    let twice = |row: &usize| even(*row) && total(*row) > 1.6 * total(row - 1);
    let rows = (2..drum.times.len()).filter(twice);
    let finding = |row: usize| {
        let times = total(row) / total(row - 1);
        let found = format!("{times:.2} times those of a sample before, and all four numbers even: counted twice");
        DataFinding::new(format!("t = {} s", drum.times[row]), "grains in both zones", found, "about as many")
    };
    rows.map(finding).collect()
}

/// Tolerance of the number of grains M1 in zone 2 between two runs of the drum. LIGGGHTS and MUSEN, rerun from the
/// shared initial state, differ by less. Their difference is 6.6 % at 2 s.
const SAME_DRUM: f64 = 0.1;

/// Returns the differences of M1 in zone 2 between a run of the drum and another one.
#[must_use]
pub fn of_drums(drum: &Drum, (name, other): (&str, &Drum)) -> Vec<DataFinding> {
    let at = |time: f64| {
        let (fraction, against) = (drum.in_zone_2(time)?, other.in_zone_2(time)?);
        let off = fraction / against - 1.0;
        let found = format!("{fraction}, {:+.1} % of {name}'s {against}", 100.0 * off);
        let finding = DataFinding::new(
            format!("t = {time} s"),
            "M1 in zone 2",
            found,
            format!("within {:.0} %", 100.0 * SAME_DRUM),
        );
        (off.abs() > SAME_DRUM).then_some(finding)
    };
    [0.5, 1.0, 2.0].into_iter().filter_map(at).collect()
}
