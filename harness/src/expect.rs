//! Expectations of a quantity: a value, a bound, a band or an order of convergence.

use crate::run::{FinishedRun, MissingData};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Expectation of a result. It is never our own result for the same quantity, except for a regression value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ExpectedValue {
    /// A single value.
    Value(f64),
    /// A bound, a band or an order.
    Bound(Bound),
}

/// An expectation other than a single value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// A lower bound.
    AtLeast(f64),
    /// An upper bound.
    AtMost(f64),
    /// A band, from the first value to the second.
    Between([f64; 2]),
    /// An order of convergence.
    Order(f64),
}

impl ExpectedValue {
    /// Returns the signed distance of a value from the expectation. For a bound or a band, it is the distance beyond
    /// the nearest limit, and 0 for a value within the limits. NaN gives NaN.
    #[must_use]
    pub fn off(self, value: f64) -> f64 {
        let beyond = |low: f64, high: f64| {
            if value < low {
                value - low
            } else if value > high {
                value - high
            } else {
                // 0 for a finite value within the limits; NaN for a value that is not finite.
                value * 0.0
            }
        };
        match self {
            Self::Value(expected) | Self::Bound(Bound::Order(expected)) => value - expected,
            Self::Bound(Bound::AtLeast(low)) => beyond(low, f64::INFINITY),
            Self::Bound(Bound::AtMost(high)) => beyond(f64::NEG_INFINITY, high),
            Self::Bound(Bound::Between([low, high])) => beyond(low, high),
        }
    }

    /// Returns the expected value, the order, or the limit nearest to `value`.
    #[must_use]
    pub fn nearest(self, value: f64) -> f64 {
        match self {
            Self::Value(at) | Self::Bound(Bound::Order(at) | Bound::AtLeast(at) | Bound::AtMost(at)) => at,
            Self::Bound(Bound::Between([low, high])) => {
                if value - low < high - value {
                    low
                } else {
                    high
                }
            }
        }
    }

    /// Returns the expected value; none for a bound, a band or an order.
    #[must_use]
    pub const fn value(self) -> Option<f64> {
        match self {
            Self::Value(value) => Some(value),
            Self::Bound(_) => None,
        }
    }

    /// Returns true if all expected numbers are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        match self {
            Self::Bound(Bound::Between(band)) => band.iter().all(|end| end.is_finite()),
            _ => self.nearest(0.0).is_finite(),
        }
    }

    /// Returns the expectation in words, with numbers formatted by `number`: `1.43`, `≥ 5`, `1.43 to 1.48`, `order 2`.
    #[must_use]
    pub fn words(self, number: impl Fn(f64) -> String) -> String {
        match self {
            Self::Value(value) => number(value),
            Self::Bound(Bound::AtLeast(low)) => format!("≥ {}", number(low)),
            Self::Bound(Bound::AtMost(high)) => format!("≤ {}", number(high)),
            Self::Bound(Bound::Between([low, high])) => format!("{} to {}", number(low), number(high)),
            Self::Bound(Bound::Order(order)) => format!("order {}", number(order)),
        }
    }
}

impl From<f64> for ExpectedValue {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

impl fmt::Display for ExpectedValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.words(|value| value.to_string()))
    }
}

/// A measured value with its expectation and scale.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Measurement {
    /// Measured value.
    pub value: f64,
    /// Expected value, bound, band or order.
    pub expected: ExpectedValue,
    /// Scale by which the error is divided.
    pub scale: f64,
    /// Time (s) and signed error of every sample in a comparison over time; empty for a single value. A failed result reports
    /// the time of the first sample outside the tolerance.
    pub course: Vec<(f64, f64)>,
}

impl Measurement {
    /// Returns a single measured value.
    pub fn new(value: f64, expected: impl Into<ExpectedValue>, scale: f64) -> Self {
        Self { value, expected: expected.into(), scale, course: Vec::new() }
    }

    /// Returns a single measured value whose error is in units of the expected value.
    pub fn relative(value: f64, expected: f64) -> Self {
        Self::new(value, expected, expected)
    }

    /// Returns the worst sample of a time series compared with an exact solution.
    pub fn worst(time: &[f64], values: &[f64], exact: impl Fn(f64) -> f64, scale: f64) -> Self {
        let expected: Vec<f64> = time.iter().map(|&t| exact(t)).collect();
        Self::worst_of(time, values, &expected, scale)
    }

    /// Returns the worst sample of a time series compared with another series. A NaN is worse than any number.
    pub fn worst_of(time: &[f64], values: &[f64], expected: &[f64], scale: f64) -> Self {
        let errors = values.iter().zip(expected).map(|(value, expected)| (value - expected) / scale);
        let course: Vec<(f64, f64)> = time.iter().copied().zip(errors).collect();
        let worst = (0..course.len()).max_by(|&a, &b| weight(course[a].1).total_cmp(&weight(course[b].1))).unwrap_or(0);
        let pick = |list: &[f64]| list.get(worst).copied().unwrap_or(f64::NAN);
        Self { value: pick(values), expected: ExpectedValue::Value(pick(expected)), scale, course }
    }

    /// Returns the largest change since the first sample, for a series that must be constant.
    pub fn drift(time: &[f64], values: &[f64], scale: f64) -> Self {
        let first = values.first().copied().unwrap_or(f64::NAN);
        let changes: Vec<f64> = values.iter().map(|value| value - first).collect();
        Self::worst(time, &changes, |_| 0.0, scale)
    }

    /// Returns the largest change of a column of a run since its first sample, in units of the first value.
    ///
    /// # Errors
    /// When the record lacks the column, or the column is empty.
    pub fn drift_of(done: &FinishedRun, column: &str) -> Result<Self, MissingData> {
        let values = done.column(column)?;
        Ok(Self::drift(&done.series().time, values, values[0]))
    }

    /// Returns the measurement with the largest |error|.
    ///
    /// # Errors
    /// When a measurement lacks data, or there is none.
    pub fn worst_read(all: impl IntoIterator<Item = Result<Self, MissingData>>) -> Result<Self, MissingData> {
        let all = all.into_iter().collect::<Result<Vec<_>, _>>()?;
        Self::worst_among(all).ok_or_else(|| "values to compare".into())
    }

    /// Returns the measurement with the largest |error|; none for an empty list.
    #[must_use]
    pub fn worst_among(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        all.into_iter().reduce(|worst, found| if weight(found.error()) > weight(worst.error()) { found } else { worst })
    }

    /// Returns a text with the time of the first sample that is NaN or outside the allowed error; none without such a sample.
    #[must_use]
    pub fn first_outside(&self, allowed: f64) -> Option<String> {
        let first = self.course.iter().find(|(_, error)| error.is_nan() || error.abs() > allowed);
        first.map(|(time, error)| {
            let how = if error.is_nan() { "not a number (NaN) from" } else { "first outside at" };
            format!("{how} t = {time:.6} s")
        })
    }

    /// Returns the signed error, (value − expected)/scale. For a bound, it is the distance beyond the bound divided by the scale.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.expected.off(self.value) / self.scale
    }
}

/// Returns the magnitude of an error, or infinity for NaN.
pub(crate) fn weight(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error.abs() }
}

/// Returns the larger of two errors, or NaN if one is NaN; `f64::max` would ignore it.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_off_by_how_far_it_is_passed() {
        let bound = |bound| ExpectedValue::Bound(bound);
        assert_eq!(bound(Bound::AtLeast(5.0)).off(8.2), 0.0);
        assert_eq!(bound(Bound::AtLeast(5.0)).off(4.0), -1.0);
        assert_eq!(bound(Bound::AtMost(1.0)).off(1.5), 0.5);
        assert_eq!(bound(Bound::Between([1.0, 2.0])).off(1.5), 0.0);
        assert_eq!(bound(Bound::Between([1.0, 2.0])).off(0.5), -0.5);
        assert_eq!(bound(Bound::Order(2.0)).off(1.75), -0.25);
        assert!(bound(Bound::Between([1.0, 2.0])).off(f64::NAN).is_nan());
        assert!(bound(Bound::AtLeast(1.0)).off(f64::INFINITY).is_nan(), "what is not finite is never within a bound");
    }

    #[test]
    fn what_is_not_a_number_is_the_worst() {
        let measurement = |value| Measurement::new(value, 0.0, 1.0);
        let worst = Measurement::worst_among([measurement(1.0), measurement(f64::NAN), measurement(3.0)]);
        assert!(worst.is_some_and(|worst| worst.value.is_nan()));
        assert!(Measurement::worst_of(&[0.0, 1.0], &[f64::NAN, 9.0], &[0.0, 0.0], 1.0).value.is_nan());
        // The sign of NaN is arbitrary.
        for nothing in [f64::NAN, -f64::NAN] {
            let worst = Measurement::worst_of(&[0.0, 1.0, 2.0], &[1.0, nothing, 9.0], &[0.0; 3], 1.0);
            assert!(worst.value.is_nan() && worst.first_outside(10.0).is_some_and(|words| words.contains("NaN")));
            for order in [[1.0, nothing, 3.0], [nothing, 1.0, 3.0], [1.0, 3.0, nothing]] {
                assert!(Measurement::worst_among(order.map(measurement)).is_some_and(|worst| worst.value.is_nan()));
                assert!(order.into_iter().fold(0.0, larger).is_nan());
            }
        }
    }

    #[test]
    fn an_expectation_is_written_as_what_it_is() {
        let json = |expected: ExpectedValue| serde_json::to_string(&expected).unwrap_or_default();
        assert_eq!(json(ExpectedValue::Value(1.5)), "1.5");
        assert_eq!(json(ExpectedValue::Bound(Bound::AtLeast(5.0))), r#"{"at_least":5.0}"#);
        assert_eq!(json(ExpectedValue::Bound(Bound::Between([1.0, 2.0]))), r#"{"between":[1.0,2.0]}"#);
        let back: Result<ExpectedValue, _> = serde_json::from_str(r#"{"order":2.0}"#);
        assert!(back.is_ok_and(|back| back == ExpectedValue::Bound(Bound::Order(2.0))));
    }
}
