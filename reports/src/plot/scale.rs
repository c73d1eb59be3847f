//! Scale of an axis: range, ticks and labels.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

use crate::number::{power_of_ten, significant};

/// Scale of a linear or logarithmic axis.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    logarithmic: bool,
    /// Lower end of the axis: the value or, for a logarithmic axis, its decimal logarithm.
    low: f64,
    /// Upper end of the axis: the value or, for a logarithmic axis, its decimal logarithm.
    high: f64,
    /// Approximate number of labelled ticks that fit on the axis.
    room: f64,
    /// Values of the ticks; empty for ticks at round numbers.
    levels: Vec<f64>,
}

/// A tick on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    /// Label; none for minor ticks.
    pub(crate) label: Option<String>,
}

impl Scale {
    /// Returns an axis that contains all `values`. `margin` is a margin at both ends, as a fraction of the range, and
    /// `room` is the approximate number of labels. Values that the axis cannot show are ignored.
    pub(crate) fn fit(values: impl Iterator<Item = f64>, logarithmic: bool, margin: f64, room: u32) -> Self {
        let (low, high, room) = (f64::INFINITY, f64::NEG_INFINITY, f64::from(room.max(2)));
        let mut scale = Self { logarithmic, low, high, room, levels: Vec::new() };
        for value in values {
            if scale.shows(value) {
                let place = scale.place(value);
                (scale.low, scale.high) = (scale.low.min(place), scale.high.max(place));
            }
        }
        if scale.low > scale.high {
            (scale.low, scale.high) = (0.0, 1.0);
        }
        // Each end is halved before the subtraction, because the difference of the ends could overflow.
        let least = if logarithmic { 0.25 } else { 1e-12 * scale.low.abs().max(scale.high.abs()) };
        let half = 0.5 * scale.high - 0.5 * scale.low;
        if half <= least {
            let middle = 0.5 * scale.low + 0.5 * scale.high;
            let spread = if logarithmic {
                0.5
            } else if middle == 0.0 {
                1.0
            } else {
                0.1 * middle.abs()
            };
            scale.low = middle - spread;
            scale.high = middle + spread;
        } else {
            scale.low = (scale.low - 2.0 * margin * half).max(f64::MIN / 4.0);
            scale.high = (scale.high + 2.0 * margin * half).min(f64::MAX / 4.0);
        }
        scale
    }

    /// Sets the values of the labelled ticks. Without values, ticks are at round numbers.
    pub(crate) fn at_levels(self, levels: &[f64]) -> Self {
        Self { levels: levels.iter().copied().filter(|level| self.shows(*level)).collect(), ..self }
    }

    /// Returns true if the axis can show a value: it is finite and, on a logarithmic axis, positive.
    pub(crate) fn shows(&self, value: f64) -> bool {
        value.is_finite() && !(self.logarithmic && value <= 0.0)
    }

    /// Returns the position of a value on the axis, from 0 at the lower end to 1 at the upper end.
    pub(crate) fn position(&self, value: f64) -> f64 {
        (self.place(value) - self.low) / (self.high - self.low)
    }

    /// Returns the ticks in ascending order.
    pub(crate) fn ticks(&self) -> Vec<Tick> {
        if !self.levels.is_empty() {
            let digits = |level: f64| if is_round(level, 5) { 5 } else { 3 };
            let plain: Vec<String> = self.levels.iter().map(|level| significant(*level, digits(*level))).collect();
            // If one label needs a power of ten, all labels have one, which makes them easy to compare.
            let is_plain = !plain.iter().any(|label| label.contains('×'));
            let label = |value: f64, plain: String| if is_plain { plain } else { with_power(value) };
            let tick = |(&value, plain): (&f64, String)| Tick { value, label: Some(label(value, plain)) };
            return self.levels.iter().zip(plain).map(tick).collect();
        }
        if self.logarithmic { self.logarithmic_ticks() } else { self.linear_ticks() }
    }

    fn place(&self, value: f64) -> f64 {
        if self.logarithmic {
            value.log10()
        } else {
            // Limiting the values prevents an overflow of the length of the axis.
            value.clamp(f64::MIN / 4.0, f64::MAX / 4.0)
        }
    }

    fn linear_ticks(&self) -> Vec<Tick> {
        let rough = (self.high - self.low) / self.room;
        let decade = 10_f64.powf(rough.log10().floor());
        let bounds = |step: f64| ((self.low / step).ceil(), (self.high / step).floor());
        let fits = |multiple: f64| multiple * decade >= rough * (1.0 - 1e-9);
        // An axis with too few numbers cannot be read, so the step between them is then reduced.
        let least = self.room.min(3.0);
        let enough = |multiple: f64| {
            let (first, last) = bounds(multiple * decade);
            last - first + 1.0 >= least
        };
        const FINER: [f64; 8] = [10.0, 5.0, 4.0, 2.0, 1.0, 0.5, 0.4, 0.2];
        let widest = [1.0, 2.0, 5.0, 10.0].into_iter().find(|multiple| fits(*multiple)).unwrap_or(10.0);
        let multiple = FINER.into_iter().find(|multiple| *multiple <= widest && enough(*multiple));
        let step = multiple.unwrap_or(widest) * decade;
        let (first, last) = bounds(step);
        let largest = self.low.abs().max(self.high.abs());
        // All labels of an axis have the same exponent, which makes them easy to compare.
        let exponent = if !(1e-2..1e5).contains(&largest) { largest.log10().floor() as i32 } else { 0 };
        let unit = 10_f64.powi(exponent);
        let decimals = (-(step / unit).log10() - 1e-9).ceil().clamp(0.0, 15.0) as usize;
        let tick = |number: f64| {
            let value = number * step;
            let mantissa = format!("{:.decimals$}", value / unit).replace('-', "−");
            let label = if number == 0.0 {
                "0".to_owned()
            } else if exponent == 0 {
                mantissa
            } else {
                format!("{mantissa}×{}", power_of_ten(exponent))
            };
            Tick { value, label: Some(label) }
        };
        let numbers = std::iter::successors(Some(first), |number| Some(number + 1.0));
        numbers.take_while(|number| *number <= last).take(50).map(tick).collect()
    }

    fn logarithmic_ticks(&self) -> Vec<Tick> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let decades = self.high - self.low;
        let stride = (decades / self.room).ceil().max(1.0) as i32;
        let whole = self.high.floor() - self.low.ceil() + 1.0;
        // Number of labels at 1, 2 and 5 times powers of ten within the axis.
        let is_inside = |place: f64| place >= self.low - 1e-9 && place <= self.high + 1e-9;
        let usual = (first..=last)
            .flat_map(|decade| [1.0_f64, 2.0, 5.0].map(|multiple| f64::from(decade) + multiple.log10()))
            .filter(|place| is_inside(*place))
            .count();
        let tick = |(decade, multiple): (i32, i32)| {
            let place = f64::from(decade) + f64::from(multiple).log10();
            let label = match multiple {
                1 if decade.rem_euclid(stride) == 0 => Some(power_of_ten(decade)),
                // An axis with few powers of ten also has labels at 2 and 5, and a very short axis at all multiples.
                2 | 5 if whole < 3.0 => Some(format!("{multiple}×{}", power_of_ten(decade))),
                2..=9 if usual < 2 => Some(format!("{multiple}×{}", power_of_ten(decade))),
                _ => None,
            };
            // With too many ticks, the grid would be a grey area.
            let fine = if multiple == 1 { 40.0 } else { 8.0 };
            let is_drawn = is_inside(place) && (label.is_some() || decades <= fine);
            is_drawn.then(|| Tick { value: 10_f64.powf(place), label })
        };
        let multiples = |decade: i32| (1..10).map(move |multiple| (decade, multiple));
        (first..=last).flat_map(multiples).filter_map(tick).collect()
    }
}

/// Returns true if a value has at most `digits` significant digits.
pub(super) fn is_round(value: f64, digits: usize) -> bool {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse::<f64>();
    rounded.is_ok_and(|rounded| (rounded - value).abs() <= 1e-9 * value.abs())
}

/// Returns a positive value as a mantissa and a power of ten. A mantissa of 1 is omitted.
fn with_power(value: f64) -> String {
    if value <= 0.0 {
        return significant(value, 3);
    }
    let exponent = (value.log10() + 1e-9).floor() as i32;
    let mantissa = significant(value / 10_f64.powi(exponent), 3);
    if mantissa == "1" { power_of_ten(exponent) } else { format!("{mantissa}×{}", power_of_ten(exponent)) }
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let (from, to) = (f64::from(limit.0), f64::from(limit.1));
        (from + self.position(*value) * (to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks().into_iter().map(|tick| tick.value).collect()
    }

    fn range(&self) -> Range<f64> {
        if self.logarithmic { 10_f64.powf(self.low)..10_f64.powf(self.high) } else { self.low..self.high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> Vec<String> {
        scale.ticks().into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        let scale = Scale::fit([0.0, 0.5].into_iter(), false, 0.0, 6);
        assert_eq!(labels(&scale), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        let scale = Scale::fit([-3e-5, 2e-5].into_iter(), false, 0.0, 5);
        assert_eq!(labels(&scale), ["−3×10⁻⁵", "−2×10⁻⁵", "−1×10⁻⁵", "0", "1×10⁻⁵", "2×10⁻⁵"]);
    }

    #[test]
    fn decades_are_powers() {
        let scale = Scale::fit([1e-4, 1e-1, -5.0].into_iter(), true, 0.0, 8);
        assert_eq!(labels(&scale), ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
        let short = Scale::fit([2e-3, 8e-3].into_iter(), true, 0.05, 8);
        assert_eq!(labels(&short), ["2×10⁻³", "5×10⁻³"]);
        let shortest = Scale::fit([2.2e-3, 8.8e-3].into_iter(), true, 0.0, 8);
        assert_eq!(labels(&shortest), ["3×10⁻³", "4×10⁻³", "5×10⁻³", "6×10⁻³", "7×10⁻³", "8×10⁻³"]);
    }

    #[test]
    fn labels_of_levels_are_all_powers_or_none_is() {
        let fit = |levels: &[f64]| labels(&Scale::fit(levels.iter().copied(), true, 0.05, 8).at_levels(levels));
        assert_eq!(fit(&[1e-5, 3e-4, 1e-3]), ["10⁻⁵", "3×10⁻⁴", "10⁻³"]);
        assert_eq!(fit(&[0.025, 0.05, 0.1]), ["0.025", "0.05", "0.1"]);
        assert_eq!(fit(&[0.03125, 0.0625]), ["0.03125", "0.0625"]);
    }

    #[test]
    fn an_axis_has_at_least_three_numbers_if_they_fit() {
        for (low, high) in [(-1.9, 1.9), (-2.2, 1.9), (0.0, 0.19), (-0.049, 0.08), (3.1, 9.9)] {
            let scale = Scale::fit([low, high].into_iter(), false, 0.0, 3);
            assert!((3..=6).contains(&labels(&scale).len()), "{low} {high} {:?}", labels(&scale));
        }
        let narrow = Scale::fit([-1.9, 1.9].into_iter(), false, 0.0, 2);
        assert_eq!(labels(&narrow), ["−1", "0", "1"]);
    }

    #[test]
    fn any_data_have_an_axis() {
        for values in [
            vec![],
            vec![f64::NAN, f64::INFINITY],
            vec![3.0],
            vec![0.0],
            vec![f64::MAX, f64::MIN],
            vec![1e300, 1e-300],
            vec![1.0, 1.0 + f64::EPSILON],
            vec![5e-324, 1e-323],
        ] {
            for logarithmic in [false, true] {
                let scale = Scale::fit(values.iter().copied(), logarithmic, 0.03, 6);
                assert!(scale.ticks().len() < 120, "{values:?} {logarithmic}");
                for value in values.iter().filter(|value| scale.shows(**value)) {
                    let position = scale.position(*value);
                    assert!((-1e-9..=1.0 + 1e-9).contains(&position), "{values:?} {position}");
                }
            }
        }
    }
}
