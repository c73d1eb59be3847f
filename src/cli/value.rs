//! Parsers of option values.

use std::fmt::Display;
use std::str::FromStr;

/// Reads `PATH=VALUE`, a key of a scene and its value.
pub(crate) fn path_and_value(text: &str) -> Result<(String, String), String> {
    let (path, value) = text.split_once('=').ok_or("expected path=value, found no `=`")?;
    Ok((path.trim().to_owned(), value.trim().to_owned()))
}

/// Reads a positive number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// Returns a parser of whole numbers from `low` to `high`.
pub(crate) fn whole<T>(low: T, high: T) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Copy + Send + Sync + 'static,
{
    move |text| {
        let read = text.parse().ok().filter(|value| (low..=high).contains(value));
        read.ok_or_else(|| format!("expected a whole number from {low} to {high}"))
    }
}
