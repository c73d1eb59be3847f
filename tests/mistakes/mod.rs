//! Scenes with random mistakes.

use grainbench::scene::error::SceneError;
use grainbench::scene::resolve::FileGrain;
use proptest::prelude::*;
use std::path::Path;

/// A scene in two dimensions with all features.
pub(crate) const PLANE: &str = include_str!("../scenes/plane.toml");

/// A scene in three dimensions with all features.
pub(crate) const SPACE: &str = include_str!("../scenes/space.toml");

/// Values that replace other values of a scene.
pub(crate) const STRANGE: &[&str] = &[
    "1e308",
    "-1e308",
    "1e-308",
    "-1",
    "0",
    "nan",
    "inf",
    "\"\"",
    "[]",
    "{}",
    "true",
    "[[]]",
    "\"rock\"",
    "[nan, inf]",
    "[1e308, 1e308]",
    "[-1e308, 1e308, 1e308]",
    "4294967295",
    "-9223372036854775808",
    "1979-05-27",
    "[1e-200, 0.0]",
];

/// A mistake in a text. Its numbers select positions, modulo the number of possible positions.
#[derive(Clone, Debug)]
pub(crate) enum Mistake {
    FlipBit(usize, u8),
    Cut(usize, usize),
    DropLine(usize),
    RepeatLine(usize, usize),
    StrangeValue(usize, usize),
    SwapValues(usize, usize),
    /// A number multiplied by a power of ten.
    Scale(usize, i32),
}

pub(crate) fn mistake() -> impl Strategy<Value = Mistake> {
    let place = || any::<usize>();
    prop_oneof![
        (place(), 0..7_u8).prop_map(|(at, bit)| Mistake::FlipBit(at, bit)),
        (place(), 1..40_usize).prop_map(|(at, length)| Mistake::Cut(at, length)),
        place().prop_map(Mistake::DropLine),
        (place(), place()).prop_map(|(from, to)| Mistake::RepeatLine(from, to)),
        (place(), place()).prop_map(|(at, value)| Mistake::StrangeValue(at, value)),
        (place(), place()).prop_map(|(a, b)| Mistake::SwapValues(a, b)),
        (place(), -12..13_i32).prop_map(|(at, power)| Mistake::Scale(at, power)),
        (place(), -320..320_i32).prop_map(|(at, power)| Mistake::Scale(at, power)),
    ]
}

/// Returns a text with a mistake in it.
pub(crate) fn make(text: &str, mistake: &Mistake) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    // Position of each value: line, start and end. Values within braces are included.
    let values: Vec<(usize, usize, usize)> = lines
        .iter()
        .enumerate()
        .flat_map(|(number, line)| {
            line.match_indices(" = ").map(move |(at, _)| {
                let start = at + 3;
                let rest = &line[start..];
                let mut depth = 0_i32;
                let end = rest.find(|letter: char| {
                    depth += i32::from(matches!(letter, '[' | '{')) - i32::from(matches!(letter, ']' | '}'));
                    depth < 0 || (depth == 0 && letter == ',')
                });
                (number, start, start + end.unwrap_or(rest.len()))
            })
        })
        .collect();
    match *mistake {
        Mistake::FlipBit(at, bit) if !text.is_empty() => {
            let mut bytes = text.as_bytes().to_vec();
            let at = at % bytes.len();
            bytes[at] ^= 1 << bit;
            return String::from_utf8_lossy(&bytes).into_owned();
        }
        Mistake::Cut(at, length) if !text.is_empty() => {
            let mut bytes = text.as_bytes().to_vec();
            let at = at % bytes.len();
            bytes.drain(at..(at + length).min(text.len()));
            return String::from_utf8_lossy(&bytes).into_owned();
        }
        Mistake::DropLine(at) if !lines.is_empty() => {
            let at = at % lines.len();
            lines.remove(at);
        }
        Mistake::RepeatLine(from, to) if !lines.is_empty() => {
            let line = lines[from % lines.len()].clone();
            let to = to % lines.len();
            lines.insert(to, line);
        }
        Mistake::StrangeValue(at, value) if !values.is_empty() => {
            let (line, start, end) = values[at % values.len()];
            lines[line].replace_range(start..end, STRANGE[value % STRANGE.len()]);
        }
        Mistake::Scale(at, power) if !values.is_empty() => {
            let (line, start, end) = values[at % values.len()];
            let text = &lines[line][start..end];
            // The first number of the value, which may be a list of numbers.
            let digits = |letter: char| letter.is_ascii_digit() || "+-.eE_".contains(letter);
            if let Some(begin) = text.find(|letter: char| letter.is_ascii_digit()) {
                let rest = &text[begin..];
                let stop = rest.find(|letter| !digits(letter)).unwrap_or(rest.len());
                if let Ok(number) = rest[..stop].replace('_', "").parse::<f64>() {
                    let is_whole = !rest[..stop].contains(['.', 'e', 'E']);
                    let scaled = number * 10_f64.powi(power);
                    let scaled = if is_whole { format!("{:.0}", scaled.min(9e18)) } else { format!("{scaled:e}") };
                    lines[line].replace_range(start + begin..start + begin + stop, &scaled);
                }
            }
        }
        Mistake::SwapValues(a, b) if !values.is_empty() => {
            let (a, b) = (values[a % values.len()], values[b % values.len()]);
            let text_of = |(line, start, end): (usize, usize, usize)| lines[line][start..end].to_owned();
            let (of_a, of_b) = (text_of(a), text_of(b));
            // Two values on the same line may contain each other, so only one of them is replaced.
            lines[a.0].replace_range(a.1..a.2, &of_b);
            if a.0 != b.0 {
                lines[b.0].replace_range(b.1..b.2, &of_a);
            }
        }
        _ => {}
    }
    lines.join("\n") + "\n"
}

/// Returns the content of a data file: two grains.
pub(crate) fn two_grains(_: &Path) -> Result<Vec<FileGrain>, SceneError> {
    let grain = |x: f64| FileGrain {
        type_number: 1,
        radius: 0.1,
        mass: 1.0,
        position: [x, 3.0, 0.0].into(),
        velocity: [0.0; 3].into(),
        spin: [0.0; 3].into(),
    };
    Ok(vec![grain(1.0), grain(3.0)])
}
