//! Shared initial states of the impact case: tables of spheres, namely the grains of a bed and one ball.

use super::atoms::{DENSITY_M1, atoms, coordinates};
use crate::read::lines::Lines;
use crate::read::read_error::{ReadError, quoted};
use std::path::{Path, PathBuf};

/// Radius of the grains of the bed and radius of the ball (m).
const RADII: [f64; 2] = [0.001, 0.01];
/// Largest accepted difference between a radius in a file and the nominal radius (m).
const ROUNDED: f64 = 1e-6;

/// Centres of the ball and of the grains in the bed (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bed {
    /// Centre of the ball (m).
    pub ball: [f64; 3],
    /// Centres of the grains (m), in the order of the file.
    pub grains: Vec<[f64; 3]>,
}

/// Returns the two possible file names of the initial state with `thousands` · 1000 grains: the name that the authors
/// use, then the name that Yade uses.
#[must_use]
pub fn bed_names(thousands: usize) -> [String; 2] {
    [format!("{thousands}KParticles.txt"), format!("Case3_PenetrationTest_{thousands}000_Particles.txt")]
}

/// Returns the file of the initial state with `thousands` · 1000 grains in a folder, or `None` if there is none.
#[must_use]
pub fn bed_in(folder: &Path, thousands: usize) -> Option<PathBuf> {
    bed_names(thousands).map(|name| folder.join(name)).into_iter().find(|path| path.is_file())
}

/// Reads an initial state. A line of titles is followed by one line per sphere with its radius and coordinates (m). The
/// ball is identified by its radius.
///
/// # Errors
/// If the file cannot be read, a line is not valid, or the file does not have one ball and `thousands` · 1000 grains.
pub fn read_bed(path: &Path, thousands: usize) -> Result<Bed, ReadError> {
    let file = path.to_string_lossy();
    let count = thousands * 1000;
    let mut lines = Lines::open(path)?;
    let titles = lines.next_text()?.map_or("", |line| line.text.trim()).to_owned();
    if titles.is_empty() || titles.split_whitespace().all(|title| title.parse::<f64>().is_ok()) {
        return Err(ReadError::at(&file, 1, "a line of titles", quoted(&titles)));
    }
    let mut balls = Vec::new();
    let mut grains = Vec::new();
    while let Some(line) = lines.next_text()? {
        if line.text.trim().is_empty() {
            continue;
        }
        let numbers = coordinates(line.text.split_whitespace());
        let is = |radius: f64, kind: usize| (radius - RADII[kind]).abs() < ROUNDED;
        match numbers.as_deref() {
            Some(&[radius, x, y, z]) if is(radius, 0) && grains.len() < count => grains.push([x, y, z]),
            Some(&[radius, x, y, z]) if is(radius, 1) && balls.is_empty() => balls.push([x, y, z]),
            _ => {
                let expected = format!(
                    "a radius of {} for {count} grains or {} for one ball, and three coordinates (m)",
                    RADII[0], RADII[1]
                );
                return Err(line.error(expected, quoted(line.text.trim())));
            }
        }
    }
    match balls[..] {
        [ball] if grains.len() == count => Ok(Bed { ball, grains }),
        _ => {
            let ball = if balls.is_empty() { "no ball" } else { "one ball" };
            let found = format!("{} grains and {ball} at the end of the file", grains.len());
            Err(lines.error(format!("{count} grains and one ball"), found))
        }
    }
}

impl Bed {
    /// Returns the grains of the bed as a LAMMPS data file.
    #[must_use]
    pub fn data(&self) -> String {
        atoms(&self.grains, 2.0 * RADII[0], DENSITY_M1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the text of an initial state with `grains` grains in rows of 40, between the titles and the text `end`.
    fn text(titles: &str, grains: usize, end: &str) -> String {
        let grain = |number: usize| {
            format!("0.001\t{}\t{:.3}\t-.0\n", 0.002 * (number % 40) as f64, 0.002 * (number / 40) as f64)
        };
        titles.to_owned() + &(0..grains).map(grain).collect::<String>() + end
    }

    fn read(text: &str) -> Result<Bed, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(&bed_names(1)[0]);
        std::fs::write(&path, text).unwrap();
        assert_eq!(bed_in(folder.path(), 1).as_ref(), Some(&path));
        assert_eq!(bed_in(folder.path(), 2), None);
        read_bed(&path, 1).map_err(|error| error.to_string())
    }

    const TITLES: &str = "R\tX\tY\tZ\n";
    const BALL: &str = "0.01\t0\t0\t0.06\n";

    #[test]
    fn reads_grains_and_the_ball() {
        let bed = read(&text(TITLES, 1000, BALL)).unwrap();
        assert_eq!((bed.ball, bed.grains.len()), ([0.0, 0.0, 0.06], 1000));
        assert!(bed.data().contains("\n42 1 0.002 2500 0.002 0.002 -0\n"), "{}", bed.data());
    }

    #[test]
    fn refuses_what_is_no_start() {
        for (text, words) in [
            (String::new(), ":1: expected a line of titles"),
            (text("", 1000, BALL), ":1: expected a line of titles"),
            (text(TITLES, 999, BALL), ":1001: expected 1000 grains and one ball, found 999 grains and one ball"),
            (text(TITLES, 1000, ""), ":1001: expected 1000 grains and one ball, found 1000 grains and no ball"),
            (text(TITLES, 1001, BALL), ":1002: expected a radius"),
            (text(TITLES, 1000, &BALL.repeat(2)), ":1003: expected a radius"),
            (text(TITLES, 3, "0.001 0 0\n"), ":5: expected a radius"),
            (text(TITLES, 3, "0.002 0 0 0\n"), ":5: expected a radius"),
            (text(TITLES, 3, "0.001 nan 0 0\n"), ":5: expected a radius"),
            (text(TITLES, 3, "0.001 0 0 60\n"), ":5: expected a radius"),
        ] {
            let error = read(&text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
