//! Parsers of option values, and the options that set the time step.

use grainbench::solver::resolution::Resolution;
use std::fmt::Display;
use std::str::FromStr;
use std::time::Duration;

/// Reads `PATH=VALUE`, a key of a scene and its value.
pub(crate) fn path_and_value(text: &str) -> Result<(String, String), String> {
    let (path, value) = text.split_once('=').ok_or("expected path=value, found no `=`")?;
    Ok((path.trim().to_owned(), value.trim().to_owned()))
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// Reads a duration: a number with the unit `s`, `m`, `min` or `h`. A number alone is in seconds.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let number = text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
    let factor = match text[number.len()..].trim() {
        "" | "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => f64::NAN,
    };
    match number.trim().parse::<f64>().map(|value| value * factor) {
        Ok(seconds) if (1.0..=1e7).contains(&seconds) => Ok(Duration::from_secs_f64(seconds)),
        _ => Err("expected a duration of at least a second, such as `90s`, `2m` or `1h`".to_owned()),
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

/// Reads a time interval `FROM..TO` (s).
pub(crate) fn window(text: &str) -> Result<(f64, f64), String> {
    let expected = || format!("expected two times in seconds with `..` between them, such as `.2..1`, found `{text}`");
    let (from, to) = text.split_once("..").ok_or_else(expected)?;
    let read = |part: &str, open: f64| {
        let part = part.trim();
        if part.is_empty() {
            Ok(open)
        } else {
            part.parse::<f64>().ok().filter(|time| time.is_finite()).ok_or_else(expected)
        }
    };
    let (from, to) = (read(from, f64::NEG_INFINITY)?, read(to, f64::INFINITY)?);
    if from <= to { Ok((from, to)) } else { Err(format!("expected a later time after `..`, found `{text}`")) }
}

/// Time step, as a fraction of the critical one or in seconds.
#[derive(clap::Args)]
pub(crate) struct Step {
    /// Time step as a fraction of the critical one, 2√(m_min/k_max).
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = Resolution::FRACTION,
        value_parser = positive,
        allow_hyphen_values = true,
        conflicts_with = "time_step"
    )]
    time_step_fraction: f64,
    /// Time step in seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    time_step: Option<f64>,
}

impl Step {
    /// Returns true if the time step is the default fraction of the critical one.
    pub(crate) fn is_usual(&self) -> bool {
        self.resolution() == Resolution::CriticalFraction(Resolution::FRACTION)
    }

    /// Returns the time step as a resolution.
    pub(crate) fn resolution(&self) -> Resolution {
        self.time_step.map_or(Resolution::CriticalFraction(self.time_step_fraction), Resolution::TimeStep)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_units() {
        let seconds = |text: &str| duration(text).map(|duration| duration.as_secs_f64()).ok();
        let texts = ["90", "90s", "1.5m", "2 min", "1h", "0.5s", "soon", "2d", "-3s", "nan"];
        let found = [Some(90.0), Some(90.0), Some(90.0), Some(120.0), Some(3600.0), None, None, None, None, None];
        assert_eq!(texts.map(seconds), found);
    }
}
