//! Numbers as text: few digits, `×10ⁿ` for very large or small values, and a true minus sign.

/// Narrow non-breaking space between a number and its unit, and between groups of digits.
pub(crate) const THIN: char = '\u{202f}';

/// Returns `value` with at most `digits` significant digits. A value below 10⁴ keeps all digits before the decimal point.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    trim(&fixed(value, digits))
}

/// Returns a measured or expected value with at most six significant digits.
#[must_use]
pub fn value(value: f64) -> String {
    significant(value, 6)
}

/// Returns a value with its unit. The unit `1` of a pure number is left out.
pub(crate) fn with_unit(number: f64, unit: &str) -> String {
    append_unit(value(number), unit)
}

/// Returns an error or a tolerance with two significant digits. A magnitude from 9.95e-4 to 100 is written in percent;
/// from 100 % on, all digits before the decimal point are kept.
#[must_use]
pub fn fraction(size: f64) -> String {
    let magnitude = size.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if (9.95e-4..100.0).contains(&magnitude) {
        format!("{}{THIN}%", significant(100.0 * size, 2))
    } else {
        fixed(size, 2)
    }
}

/// Returns a signed error in the form of [`fraction`], or a dash if there is none.
pub(crate) fn error(error: Option<f64>) -> String {
    match error {
        Some(error) if error > 0.0 => format!("+{}", fraction(error)),
        Some(error) => fraction(error),
        None => "—".to_owned(),
    }
}

/// Returns an integer in groups of three digits.
#[must_use]
pub fn count(count: u64) -> String {
    let digits = count.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(&THIN.to_string())
}

/// Returns a number of things, such as `1 task` or `2 tasks`.
#[must_use]
pub fn counted(number: usize, noun: &str) -> String {
    format!("{} {noun}{}", count(number as u64), if number == 1 { "" } else { "s" })
}

/// Returns a duration (s) with an SI prefix and at most three significant digits.
#[must_use]
pub fn seconds(seconds: f64) -> String {
    TimeUnit::of([seconds]).with_symbol(seconds)
}

/// Unit of a group of durations, so that a reader compares their numbers: that of the largest duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeUnit {
    scale: f64,
    symbol: &'static str,
}

impl TimeUnit {
    /// Returns the unit in which the largest duration (s) has one to three digits before the decimal point. Durations that
    /// are not finite are ignored.
    pub(crate) fn of(seconds: impl IntoIterator<Item = f64>) -> Self {
        let largest = seconds.into_iter().filter(|seconds| seconds.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()));
        let (scale, symbol) = match largest {
            size if size == 0.0 || size >= 1.0 => (1.0, "s"),
            size if size >= 1e-3 => (1e3, "ms"),
            size if size >= 1e-6 => (1e6, "µs"),
            _ => (1e9, "ns"),
        };
        Self { scale, symbol }
    }

    /// Returns a duration (s) in this unit, with its symbol and at most three significant digits.
    pub(crate) fn with_symbol(self, seconds: f64) -> String {
        append_unit(significant(seconds * self.scale, 3), self.symbol)
    }
}

/// Returns `10ⁿ` with a superscript exponent.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |letter: char| letter.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// Returns a value with `digits` significant digits, including trailing zeros. A value below 10⁴ keeps all digits before
/// the decimal point.
fn fixed(value: f64, digits: usize) -> String {
    match value {
        _ if value.is_nan() => return "not a number".to_owned(),
        f64::INFINITY => return "∞".to_owned(),
        f64::NEG_INFINITY => return "−∞".to_owned(),
        0.0 => return "0".to_owned(),
        _ => {}
    }
    let places = i32::try_from(digits).unwrap_or(i32::MAX).saturating_sub(1);
    // The exponent is that of the rounded value.
    let scientific = format!("{:.*e}", digits.saturating_sub(1), value);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent = exponent.parse().unwrap_or(0);
    let text = if (-3..=places.max(3)).contains(&exponent) {
        let decimals = usize::try_from(places - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{mantissa}×{}", power_of_ten(exponent))
    };
    text.replacen('-', "−", 1)
}

/// Removes trailing zeros after the decimal point.
fn trim(text: &str) -> String {
    let (mantissa, power) = text.split_at(text.find('×').unwrap_or(text.len()));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}{power}")
}

fn append_unit(number: String, unit: &str) -> String {
    if unit == "1" || unit.is_empty() { number } else { format!("{number}{THIN}{unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Durations of a group have the unit of the largest, so that `166 ms` is not beside `174 µs`.
    #[test]
    fn durations_of_a_group_have_one_unit() {
        let unit = TimeUnit::of([174e-6, 0.166, f64::NAN]);
        assert_eq!([174e-6, 0.166].map(|seconds| unit.with_symbol(seconds)), ["0.174\u{202f}ms", "166\u{202f}ms"]);
        assert_eq!(TimeUnit::of([]).with_symbol(2.0), "2\u{202f}s");
    }

    #[test]
    fn values_have_six_digits() {
        assert_eq!([1.4285714285, 1.391, -0.05, 123_456.7].map(value), ["1.42857", "1.391", "−0.05", "123457"]);
        assert_eq!([1_234_567.0, 999_999.9, 1.5e-9].map(value), ["1.23457×10⁶", "1×10⁶", "1.5×10⁻⁹"]);
        assert_eq!([0.0, f64::NAN].map(value), ["0", "not a number"]);
        assert_eq!(["m/s", "1"].map(|unit| with_unit(2.0, unit)), ["2\u{202f}m/s", "2"]);
    }

    #[test]
    fn errors_have_two_digits() {
        let errors = [Some(-0.0263), Some(0.02), Some(3.14e-12), Some(0.0), None];
        assert_eq!(errors.map(error), ["−2.6\u{202f}%", "+2\u{202f}%", "+3.1×10⁻¹²", "0", "—"]);
        assert_eq!([1.2, 0.000_999, 5e4].map(fraction), ["120\u{202f}%", "0.1\u{202f}%", "5.0×10⁴"]);
    }

    #[test]
    fn counts_and_times_read_easily() {
        assert_eq!([1_234_567, 999].map(count), ["1\u{202f}234\u{202f}567", "999"]);
        assert_eq!([counted(1, "task"), counted(20, "task")], ["1 task", "20 tasks"]);
        assert_eq!([0.000_4, 2.13, 0.0].map(seconds), ["400\u{202f}µs", "2.13\u{202f}s", "0\u{202f}s"]);
    }
}
