//! `grainbench reference import`: derives numbers and curves from the user's copy of third-party data. The data itself
//! is not copied.

use super::exit::{Fault, Outcome, check_writable, print};
use grainbench::harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench::reference::round_robin::{
    Course, DRUM_SCENE, Drum, Impact, Kind, PublishedTable, Quantity, STEADY, Silo, Spread, Start, of_all, pairs, read,
    read_start, start_in, table_of,
};
use grainbench::reports::StagedDir;
use grainbench::reports::plot::draw;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Import {
    /// Publication: `dosta-2024`, the round robin of bulk processes.
    #[arg(value_name = "WORK", value_parser = ["dosta-2024"])]
    work: String,
    /// Directory of CSV or Parquet tables. Columns: `t,CODE_ICn,…` for the ball height (m) by code and bed; `t,z` for
    /// one run; `t,z1_m1,z1_m2,z2_m1,z2_m2` for the grains in the zones of the drum; `t,count` for the remaining grains
    /// in the silo. The initial state of the drum is an `xyz` file.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Directory for numbers and curves.
    #[arg(long, value_name = "DIR", default_value = "grainbench-import")]
    out: PathBuf,
}

/// File extensions of tables.
const ENDINGS: [&str; 4] = [".csv", ".csv.gz", ".csv.zst", ".parquet"];
/// Codes and beds that are not comparable with the others. Yade is an outlier, which the authors exclude too, and no
/// other code has bed 1 of MUSEN. In bed 10 of LIGGGHTS, the ball was released at rest.
const LEFT_OUT: [(&str, Option<usize>); 3] = [("Yade", None), ("MUSEN", Some(1)), ("LIGGGHTS", Some(10))];
/// Times at which heights are derived (ms).
const TIMES: [u32; 7] = [25, 28, 30, 32, 35, 40, 50];
/// Times at which heights are derived from files with a single run (ms): after the first impact, and at rest in a deep
/// bed.
const TIMES_ALONE: [u32; 2] = [30, 60];
/// Time interval of the rebound (s).
const REBOUND: [f64; 2] = [0.038, 0.050];

pub(crate) fn import(arguments: &Import) -> Outcome {
    let tables = tables(&arguments.directory)?;
    let start = start(&arguments.directory)?;
    check_writable(&arguments.out)?;
    let mut out = StagedDir::new(&arguments.out).map_err(Fault::writing)?;
    let mut findings = String::new();
    let mut derived =
        format!("# Derived by `grainbench reference import {}` from tables of the user's own.\n", arguments.work);
    for PublishedTable { name, kind } in &tables {
        let figure = match kind {
            Kind::Impact(impact) => {
                if impact.courses.len() > 1 {
                    derived += &values(impact);
                    out.write(format!("{name}-derived.csv"), course(impact).as_bytes()).map_err(Fault::writing)?;
                } else {
                    derived += &alone(name, impact);
                }
                heights(name, impact)
            }
            Kind::Drum(drum) => zones(name, drum),
            Kind::Silo(silo) => {
                findings += &leaving(name, silo);
                left(name, silo)
            }
        };
        let svg = draw(&figure).map_err(Fault::input)?;
        out.write(format!("{name}.svg"), svg.as_bytes()).map_err(Fault::writing)?;
    }
    let rows = of_all(&tables);
    rows.iter().for_each(|row| findings += &format!("{row}\n"));
    out.write("said.md", table_of(&rows).as_bytes()).map_err(Fault::writing)?;
    let pairs = pairs(&tables);
    derived += &numbers(&pairs);
    for name in ["silo-large", "drum-zone-2"] {
        let course = over_time(&pairs, name);
        if !course.is_empty() {
            out.write(format!("{name}-derived.csv"), format!("t,mean,half\n{course}").as_bytes())
                .map_err(Fault::writing)?;
        }
    }
    if let Some(start) = &start {
        for (name, text) in start.files() {
            out.write(name, text.as_bytes()).map_err(Fault::writing)?;
        }
        out.write("drum.toml", DRUM_SCENE.as_bytes()).map_err(Fault::writing)?;
    }
    out.write("derived.toml", derived.as_bytes()).map_err(Fault::writing)?;
    out.write("said.txt", findings.as_bytes()).map_err(Fault::writing)?;
    out.commit().map_err(Fault::writing)?;
    print(&format!("{findings}\n{}\n", arguments.out.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// Reads the tables of a directory, in the order of their names; other files are skipped.
fn tables(directory: &Path) -> Result<Vec<PublishedTable>, Fault> {
    let shown = directory.display();
    let unreadable =
        |error: std::io::Error| Fault::input(format!("{shown}: expected a directory of tables, found {error}"));
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if path.is_file() && ENDINGS.iter().any(|ending| name.ends_with(ending)) {
            paths.push(path);
        }
    }
    paths.sort();
    let mut tables = Vec::new();
    for path in &paths {
        tables.extend(read(path).map_err(Fault::input)?);
    }
    if tables.is_empty() {
        return Err(Fault::input(format!("{shown}: expected tables of the round robin, found none")));
    }
    Ok(tables)
}

/// Reads the initial state of the drum; `None` if the directory has no such file.
fn start(directory: &Path) -> Result<Option<Start>, Fault> {
    let path = start_in(directory).map_err(|error| Fault::input(format!("{}: {error}", directory.display())))?;
    path.map(|path| read_start(&path).map_err(Fault::input)).transpose()
}

fn is_kept(course: &Course) -> bool {
    !LEFT_OUT.iter().any(|(code, bed)| course.code == *code && bed.is_none_or(|bed| bed == course.bed))
}

/// Returns the derived numbers of the impact in the format of the provenance file.
fn values(impact: &Impact) -> String {
    let mut lines = String::new();
    let mut add = |key: &str, what: &str, unit: &str, spread: Option<Spread>| {
        let Some(Spread { mean, code, bed }) = spread else { return };
        for (suffix, statistic, value) in [
            ("", "mean between codes", mean),
            ("_code", "standard deviation between codes", code),
            ("_bed", "standard deviation between beds, pooled over codes", bed),
        ] {
            let _ = write!(
                lines,
                "\n[[value]]\nkey = \"{key}{suffix}\"\nwhat = \"{what}: {statistic} ({unit})\"\nvalue = {value:.4}\n"
            );
        }
    };
    for time in TIMES {
        let height_at = |impact: &Impact, course: &Course| Some(impact.height(course, f64::from(time) * 1e-3)? * 1e3);
        add(
            &format!("height_{time}"),
            &format!("height of the ball at {time} ms, 25 thousand grains"),
            "mm",
            impact.spread(is_kept, height_at),
        );
    }
    let deepest = impact.spread(is_kept, |_, course| Some(Impact::deepest(course) * 1e3));
    add("deepest", "deepest point of the ball, 25 thousand grains", "mm", deepest);
    let speed = impact.spread(is_kept, |impact, course| impact.velocity(course, REBOUND));
    add("rebound", "mean velocity of the ball from 38 to 50 ms, 25 thousand grains", "m/s", speed);
    lines
}

/// Returns the derived numbers of silo and drum in the format of the provenance file.
fn numbers(pairs: &[Quantity]) -> String {
    let mut lines = String::new();
    for Quantity { key, what, pair, .. } in pairs.iter().filter(|quantity| quantity.time.is_none()) {
        let basis = if pair.half.is_some() { "mean of LIGGGHTS and MUSEN" } else { "MUSEN alone" };
        let _ = write!(lines, "\n[[value]]\nkey = \"{key}\"\nwhat = \"{what}: {basis}\"\nvalue = {:.4}\n", pair.mean);
        if let Some(half) = pair.half {
            let _ = write!(
                lines,
                "\n[[value]]\nkey = \"{key}_half\"\nwhat = \"{what}: half the difference of LIGGGHTS and MUSEN\"\n\
                 value = {half:.4}\n"
            );
        }
    }
    lines
}

/// Returns a time series of silo or drum as CSV lines: mean and half the difference.
fn over_time(pairs: &[Quantity], name: &str) -> String {
    let series = pairs.iter().filter(|quantity| quantity.key == name);
    series
        .filter_map(|quantity| Some(format!("{:.1},{},{}\n", quantity.time?, quantity.pair.mean, quantity.pair.half?)))
        .collect()
}

/// Returns mean and standard deviations of the height over time as CSV.
fn course(impact: &Impact) -> String {
    let mut lines = "t,mean,code,bed\n".to_owned();
    for &time in &impact.times {
        let height_spread = impact.spread(is_kept, |impact, course| Some(impact.height(course, time)? * 1e3));
        if let Some(Spread { mean, code, bed }) = height_spread {
            let _ = writeln!(lines, "{time},{mean:.4},{code:.4},{bed:.4}");
        }
    }
    lines
}

/// Plots the mean height over the beds for each code.
fn heights(name: &str, impact: &Impact) -> Figure {
    let mut codes: Vec<&str> = Vec::new();
    for course in &impact.courses {
        if !codes.contains(&course.code.as_str()) {
            codes.push(&course.code);
        }
    }
    let curve = |code: &&str| {
        let courses: Vec<&Course> = impact.courses.iter().filter(|course| course.code == **code).collect();
        let mean =
            |row: usize| courses.iter().map(|course| course.heights[row] * 1e3).sum::<f64>() / courses.len() as f64;
        let points = impact.times.iter().enumerate().map(|(row, time)| (time * 1e3, mean(row)));
        Curve::new(*code, Stroke::Line, points.collect())
    };
    let axes = [Axis::linear("time (ms)"), Axis::linear("height of the ball (mm)")];
    Figure::graph(name, "Impact of a ball", "", axes, codes.iter().map(curve).collect())
}

fn zones(name: &str, drum: &Drum) -> Figure {
    let names = ["M1, zone 1", "M2, zone 1", "M1, zone 2", "M2, zone 2"];
    let curve = |(label, counts): (&str, &Vec<f64>)| {
        Curve::new(label, Stroke::Line, drum.times.iter().copied().zip(counts.iter().copied()).collect())
    };
    let axes = [Axis::linear("time (s)"), Axis::linear("grains")];
    Figure::graph(name, "Zones of the drum", "", axes, names.into_iter().zip(&drum.zones).map(curve).collect())
}

fn left(name: &str, silo: &Silo) -> Figure {
    let points = silo.times.iter().copied().zip(silo.left.iter().copied()).collect();
    let axes = [Axis::linear("time (s)"), Axis::linear("grains left")];
    Figure::graph(name, "Silo", "", axes, vec![Curve::new(name, Stroke::Line, points)])
}

fn leaving(name: &str, silo: &Silo) -> String {
    silo.rate(STEADY).map_or_else(String::new, |rate| {
        format!("{name}: from .5 to 3.5 s {:.2} thousand grains leave in a second\n", rate / 1e3)
    })
}

/// Returns the heights of a single run. Its times are corrected by the fall of the ball before the first sample.
fn alone(name: &str, impact: &Impact) -> String {
    let [course] = &impact.courses[..] else { return String::new() };
    let key = name.replace('-', "_");
    let height_value = |time: u32| {
        let height = impact.height(course, f64::from(time) * 1e-3 - impact.ahead(course))? * 1e3;
        Some(format!(
            "\n[[value]]\nkey = \"{key}_height_{time}\"\nwhat = \"height of the ball at {time} ms, {name} (mm)\"\n\
             value = {height:.4}\n"
        ))
    };
    TIMES_ALONE.into_iter().filter_map(height_value).collect()
}
