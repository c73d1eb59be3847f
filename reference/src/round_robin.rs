//! Round robin of bulk processes (Dosta et al. 2024): numbers that are derived from its published time series, and
//! readers of its shared initial states.
//!
//! The time series are third-party data and are not distributed. The folder `reference/literature/dosta-2024` contains
//! only numbers that its script `derive.py` computes from them: means of codes, and standard deviations between codes
//! and beds.

use crate::read::lines::Lines;
use crate::read::read_error::{ReadError, quoted};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Period of steady flow out of the silo (s).
pub const STEADY: [f64; 2] = [0.5, 3.5];
/// Period shortly after the flow has started (s).
pub const EARLY: [f64; 2] = [0.2, 0.8];

/// Height of the ball over time for 25 thousand grains. The columns are t (s), mean over the codes, standard deviation
/// between codes, and standard deviation between beds (heights in mm).
pub const IMPACT: &str = include_str!("../literature/dosta-2024/impact-25k.csv");

/// Number of grains in the silo over time, for the large orifice. The columns are t (s), mean of LIGGGHTS and MUSEN,
/// and half the difference of the two codes.
pub const SILO: &str = include_str!("../literature/dosta-2024/silo-large.csv");

/// Number of grains of material M1 in zone 2 of the drum over time. The columns are t (s), mean of LIGGGHTS and MUSEN,
/// and half the difference of the two codes.
pub const DRUM: &str = include_str!("../literature/dosta-2024/drum-zone-2.csv");

/// Scene that starts from the shared initial state of the drum. It reads `drum-m1.data` and `drum-m2.data`, which are
/// derived from this state.
pub const DRUM_SCENE: &str = include_str!("../literature/dosta-2024/drum.toml");

/// Reads a table of time (s), mean, and half the difference of two codes.
#[must_use]
pub fn course(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| -> Option<[f64; 3]> {
        let numbers: Option<Vec<f64>> = line.split(',').map(|field| field.parse().ok()).collect();
        numbers?.try_into().ok()
    };
    text.lines().skip(1).filter_map(row).collect()
}

/// Statistics of a quantity over all codes and beds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean over all codes. The value of a code is the mean over its beds.
    pub mean: f64,
    /// Standard deviation of the codes' means.
    pub code: f64,
    /// Pooled standard deviation of the beds about the mean of their code.
    pub bed: f64,
}

impl Spread {
    /// Returns the largest accepted difference between the mean of another code and the mean of the published codes.
    /// The other code has m = `own` beds, and each published code has n = `published` beds.
    ///
    /// The difference is 2 √(s_code² + s_bed² (1/m + 1/n)), with the standard deviations s_code between codes and s_bed
    /// between beds.
    #[must_use]
    pub fn allowed(&self, own: usize, published: usize) -> f64 {
        2.0 * self.deviation(own, published)
    }

    /// Returns the standard deviation √(s_code² + s_bed² (1/m + 1/n)) with m = `own` and n = `published`.
    #[must_use]
    pub fn deviation(&self, own: usize, published: usize) -> f64 {
        let beds = 1.0 / own as f64 + 1.0 / published as f64;
        (self.code * self.code + self.bed * self.bed * beds).sqrt()
    }
}

/// Density of the material M1 (kg/m³).
const DENSITY_M1: f64 = 2500.0;
/// Half the edge length of the written box (m). The box contains all grains: coordinates in the files are below 1 m,
/// and the centre of the drum is at most 0.102 m from the origin along each axis.
const HALF: f64 = 2.0;

/// Returns the numbers of a line, or `None` if a field is not a number with a magnitude below 1.
fn coordinates<'l>(fields: impl Iterator<Item = &'l str>) -> Option<Vec<f64>> {
    fields.map(|field| field.parse().ok().filter(|number: &f64| number.abs() < 1.0)).collect()
}

/// Returns the data file of grains with given centres (m), equal diameters (m) and equal densities (kg/m³).
fn atoms(centres: &[[f64; 3]], diameter: f64, density: f64) -> String {
    let mut text = format!("grains\n\n{} atoms\n1 atom types\n\n", centres.len());
    for axis in ["x", "y", "z"] {
        let _ = writeln!(text, "-{HALF} {HALF} {axis}lo {axis}hi");
    }
    text += "\nAtoms # sphere\n\n";
    for (number, [x, y, z]) in centres.iter().enumerate() {
        let _ = writeln!(text, "{} 1 {diameter} {density} {x} {y} {z}", number + 1);
    }
    text
}

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

/// Centre of the drum in the coordinates of the file (m).
const MIDDLE: [f64; 3] = [0.102, 0.032, 0.102];
/// Maximum number of grains in a file.
const MOST: usize = 1_000_000;

/// Centres of grains relative to the centre of the drum (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Centres of grains of material M2 (type 0) and M1 (type 1).
    pub kinds: [Vec<[f64; 3]>; 2],
}

/// Returns the file of the shared initial state in a folder: the first file in alphabetical order whose name ends in
/// `.xyz`, or `None` if there is none.
///
/// # Errors
/// If the folder cannot be read.
pub fn start_in(folder: &Path) -> std::io::Result<Option<PathBuf>> {
    let entries: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    Ok(entries.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "xyz")).min())
}

/// Reads the initial state. The first line is the number of grains, and the second line is the box. Each further line
/// has the type of a grain, 0 or 1, and its coordinates (m).
///
/// # Errors
/// If the file cannot be read or a line is not valid.
pub fn read_start(path: &Path) -> Result<Start, ReadError> {
    let file = path.to_string_lossy();
    let mut lines = Lines::open(path)?;
    let first = lines.next_text()?.map_or("", |line| line.text.trim()).to_owned();
    let count = first.parse().ok().filter(|count| (1..=MOST).contains(count));
    let count =
        count.ok_or_else(|| ReadError::at(&file, 1, format!("a number of grains up to {MOST}"), quoted(&first)))?;
    lines.next_text()?;
    let mut start = Start::default();
    for row in 0..count {
        let expected = || format!("type (0 or 1), x, y and z, for grain {} of {count}", row + 1);
        let place = row as u64 + 3;
        let line = lines.next_text()?.ok_or_else(|| ReadError::at(&file, place, expected(), "the end of the file"))?;
        let mut fields = line.text.split_whitespace();
        let kind = fields.next().and_then(|kind| ["0", "1"].iter().position(|known| *known == kind));
        let numbers = coordinates(fields);
        match (kind, numbers.as_deref()) {
            (Some(kind), Some(&[x, y, z])) => {
                start.kinds[kind].push([x - MIDDLE[0], y - MIDDLE[1], z - MIDDLE[2]].map(rounded));
            }
            _ => return Err(line.error(expected(), quoted(line.text.trim()))),
        }
    }
    Ok(start)
}

/// Rounds a coordinate to 1e-9 m, which is finer than the file, to remove the rounding error of the subtraction.
fn rounded(at: f64) -> f64 {
    (at * 1e9).round() / 1e9
}

impl Start {
    /// Returns the data files of both types of grains for the scene of the drum, by name and text.
    #[must_use]
    pub fn files(&self) -> [(&'static str, String); 2] {
        let kind_atoms = |kind: usize, diameter, density| atoms(&self.kinds[kind], diameter, density);
        [("drum-m2.data", kind_atoms(0, 0.004, 2000.0)), ("drum-m1.data", kind_atoms(1, 0.002, DENSITY_M1))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    fn read<T>(name: &str, text: &str, read: fn(&Path) -> Result<T, ReadError>) -> Result<T, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    fn bed(text: &str) -> Result<Bed, String> {
        read(&bed_names(1)[0], text, |path| {
            let folder = path.parent().unwrap();
            assert_eq!((bed_in(folder, 1).as_deref(), bed_in(folder, 2)), (Some(path), None));
            read_bed(path, 1)
        })
    }

    fn start(text: &str) -> Result<Start, String> {
        read("start.xyz", text, read_start)
    }

    /// Returns the text of an initial state with `grains` grains in rows of 40, between the titles and the text `end`.
    fn text(titles: &str, grains: usize, end: &str) -> String {
        let grain = |number: usize| {
            format!("0.001\t{}\t{:.3}\t-.0\n", 0.002 * (number % 40) as f64, 0.002 * (number / 40) as f64)
        };
        titles.to_owned() + &(0..grains).map(grain).collect::<String>() + end
    }

    const TITLES: &str = "R\tX\tY\tZ\n";
    const BALL: &str = "0.01\t0\t0\t0.06\n";

    #[test]
    fn reads_grains_and_the_ball() {
        let bed = bed(&text(TITLES, 1000, BALL)).unwrap();
        assert_eq!((bed.ball, bed.grains.len()), ([0.0, 0.0, 0.06], 1000));
        assert!(bed.data().contains("\n42 1 0.002 2500 0.002 0.002 -0\n"), "{}", bed.data());
    }

    #[test]
    fn refuses_what_is_no_bed() {
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
            let error = bed(&text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn reads_both_kinds() {
        let start = start("2\nbox\n0 0.102 0.032 0.002\n1 0.202 0.032 0.102\n").unwrap();
        assert_eq!(start.kinds[0].len(), 1);
        assert!((start.kinds[1][0][0] - 0.1).abs() < 1e-12);
        let [_, (_, text)] = start.files();
        assert!(text.contains("\n1 1 0.002 2500 0.1 0 0\n"), "{text}");
    }

    #[test]
    fn refuses_what_is_no_start() {
        for (text, place) in [
            ("", "start.xyz:1:"),
            ("-3\n", "start.xyz:1:"),
            ("99999999999\n", "start.xyz:1:"),
            ("1\nbox\n", "start.xyz:3:"),
            ("1\nbox\n2 0 0 0\n", "start.xyz:3:"),
            ("1\nbox\n1 0 0\n", "start.xyz:3:"),
            ("1\nbox\n1 0 nan 0\n", "start.xyz:3:"),
            ("2\nbox\n1 0 0 0\n1 0 1e9 0\n", "start.xyz:4:"),
        ] {
            let error = start(text).unwrap_err();
            assert!(error.contains(place), "{error}");
        }
    }

    /// With the variances 2 between codes and 2 between beds, the variance of a difference of single beds is 2 + 2 · 2.
    #[test]
    fn tells_codes_from_beds() {
        let spread = Spread { mean: 2.0, code: 2.0_f64.sqrt(), bed: 2.0_f64.sqrt() };
        assert!((spread.allowed(1, 1) - 2.0 * 6.0_f64.sqrt()).abs() < 1e-14);
    }

    /// The Python test applies the script to synthetic tables. Changed tables are negative controls.
    #[test]
    fn the_script_derives_numbers_of_synthetic_tables() {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("literature/dosta-2024/derive_test.py");
        match Command::new("python3").arg("-B").arg(script).output() {
            Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
            Err(error) => assert!(std::env::var_os("CI").is_none(), "python3: {error}"),
        }
    }
}
