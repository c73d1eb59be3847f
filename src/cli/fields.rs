//! `grainbench fields`: computes continuum fields from grains or material points, cell by cell.

use super::exit::{FIELDS, Fault, Outcome, check_output, print, print_json, refuse, refuse_inputs, say};
use super::value::{path_and_value, positive, whole};
use grainbench::fields::column::COLUMNS;
use grainbench::fields::contact_stress::Stress;
use grainbench::fields::course::Course;
use grainbench::fields::grid::Grid;
use grainbench::fields::mask::{Masks, Orifice};
use grainbench::fields::trails::Trails;
use grainbench::reference::grain_dump::{DumpOptions, GrainDump};
use grainbench::reference::observer::Names;
use grainbench::reports::elements::{self, ElementMean, Summary, write_elements};
use grainbench::reports::table::{Column, Format, Table};
use grainbench::reports::{each_snapshot, number, row};
use grainbench::scene::dimension::Dimension;
use grainbench::scene::nalgebra::Vector3;
use grainbench::solver::record::Snapshot;
use grainbench::store::refuse_mixed;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Directory written by `simulate`, or a LAMMPS or LIGGGHTS dump of grains.
    #[arg(value_name = "DIR|DUMP")]
    source: PathBuf,
    /// Cell size in metres: one number for all axes, or one for each axis. The size is adjusted so that whole cells fill the box.
    #[arg(long, value_name = "X[,Y,Z]", value_delimiter = ',', value_parser = positive, required = true)]
    cell: Vec<f64>,
    /// Dump of the contacts (`dump local`) at the steps of the grain dump. It lists no walls, so the stress of cells at walls
    /// is too small.
    #[arg(long, value_name = "FILE")]
    contacts: Option<PathBuf>,
    /// Column names in the files, such as `x=xu`. Our contact columns are `id1`, `id2`, `force_x` (on the first grain) and,
    /// optionally, `tangential_x`.
    #[arg(long, value_name = "OURS=THEIRS,…", value_delimiter = ',', value_parser = path_and_value)]
    map: Vec<(String, String)>,
    /// Radius of all grains in metres, for a dump without radii.
    #[arg(long, value_name = "METRES", value_parser = positive)]
    radius: Option<f64>,
    /// Density of all grains in kg/m³ (discs: kg/m²), for a dump without mass and density.
    #[arg(long, value_name = "DENSITY", value_parser = positive)]
    density: Option<f64>,
    /// Time step in seconds, for a dump without times.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    time_step: Option<f64>,
    /// Use the complete frames of a truncated dump, and report the truncation.
    #[arg(long)]
    partial: bool,
    /// Dimension: 2 for discs in the plane z = 0, 3 for spheres. Default: the dimension of the stored run, or 3 for a dump.
    #[arg(long, value_name = "2|3", value_parser = whole::<u8>(2, 3))]
    dimension: Option<u8>,
    /// Lower corner of the cells in metres. Default: the lower corner of the box.
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    low: Vec<f64>,
    /// Upper corner of the cells in metres. Default: the upper corner of the box.
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    high: Vec<f64>,
    /// First time of the analysis in seconds. Default: the first snapshot.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    from: Option<f64>,
    /// Last time of the analysis in seconds. Default: the last snapshot.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    to: Option<f64>,
    /// Compute velocities from displacements since the previous frame, instead of using instantaneous velocities.
    #[arg(long)]
    between: bool,
    /// Stress of grains: `instant`, or `mean` for the mean since the previous frame. Default: `mean` if the run
    /// contains `mean-virial`, otherwise `instant`.
    #[arg(long, value_name = "WHICH", value_parser = ["instant", "mean"])]
    stress: Option<String>,
    /// Track elements that move with the flow. They start as boxes of this size in metres: one number for all axes, or
    /// one for each.
    #[arg(long, value_name = "X[,Y,Z]", value_delimiter = ',', value_parser = positive)]
    tracers: Vec<f64>,
    /// Upward direction, towards the free surface. Default: y in two dimensions, z in three.
    #[arg(long, value_name = "AXIS", value_parser = ["x", "y", "z", "-x", "-y", "-z"], allow_hyphen_values = true)]
    up: Option<String>,
    /// Packing fraction that marks the free surface. Cells with a smaller packing fraction, and the cells directly
    /// under them, are left out of averages.
    #[arg(long, value_name = "FRACTION", value_parser = positive, default_value_t = 0.4)]
    surface: f64,
    /// Leave cells with fewer grains or points than this number out of averages.
    #[arg(long, value_name = "NUMBER", default_value_t = 8)]
    fewest: usize,
    /// Leave cells out of averages if their centre is within `r` metres of an orifice, such as `x=0,z=0,r=7.5` for a
    /// slit along y.
    #[arg(long, value_name = "x=…,z=…,r=…", allow_hyphen_values = true)]
    orifice: Option<String>,
    /// Leave cells out of averages if their shear rate |D₀| is below this value in 1/s.
    #[arg(long, value_name = "RATE", value_parser = positive)]
    flowing: Option<f64>,
    /// Number of blocks of frames, from which the confidence intervals are computed.
    #[arg(long, value_name = "NUMBER", default_value_t = 8, value_parser = whole(2, u16::MAX))]
    blocks: u16,
    /// Directory of the tables, image data and figures.
    #[arg(long, value_name = "DIR", default_value = "grainbench-fields")]
    out: PathBuf,
    /// Also write the tables as Parquet.
    #[arg(long)]
    parquet: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

/// Largest accepted number of cells of a grid.
const MOST_CELLS: f64 = 1e6;
/// Largest accepted number of cells of all frames together.
const MOST_ELEMENTS: usize = 20_000_000;

/// Reads the snapshots, computes the fields in all cells, and writes them.
pub(crate) fn fields(arguments: &Arguments) -> Outcome {
    check_output(&arguments.out, &FIELDS, &elements::FILES)?;
    refuse_inputs(&arguments.out, std::iter::once(&arguments.source).chain(&arguments.contacts))?;
    let mut course: Option<Course> = None;
    let mut take = |snapshot: Snapshot| -> Result<(), Fault> {
        let (from, to) = (arguments.from.unwrap_or(f64::NEG_INFINITY), arguments.to.unwrap_or(f64::INFINITY));
        if snapshot.time < from || snapshot.time > to {
            return Ok(());
        }
        let course = match &mut course {
            Some(course) => course,
            none => none.insert(begin(&snapshot, arguments)?),
        };
        let needs_time = if arguments.between { Some("--between") } else { None };
        let needs_time = needs_time.or((!arguments.tracers.is_empty()).then_some("--tracers"));
        if let Some(flag) = needs_time.filter(|_| !snapshot.time.is_finite()) {
            refuse!("{flag}: expected a dump with times, or the option `--time-step`");
        }
        if let Some(flag) = needs_time.filter(|_| !snapshot.points.is_empty()) {
            refuse!("{flag}: expected grains with ids, found material points, which have no ids");
        }
        course.add(snapshot);
        if course.grid.cells() * course.frames.len() > MOST_ELEMENTS {
            refuse!(
                "expected at most {} elements in all frames, found more; use larger cells or fewer frames (--from, \
                 --to)",
                number::count(MOST_ELEMENTS as u64)
            );
        }
        Ok(())
    };
    if arguments.source.is_dir() {
        of_directory(&arguments.source, arguments, &mut take)?;
    } else {
        of_dump(&arguments.source, arguments, &mut take)?;
    }
    let there = arguments.source.display();
    let Some(course) = course.filter(|course| !course.frames.is_empty()) else {
        let what = if arguments.between { "two snapshots or more" } else { "a snapshot" };
        let hint = if arguments.source.is_dir() {
            " (`simulate --write parquet` stores the snapshots of a large run)"
        } else {
            ""
        };
        refuse!("{there}: expected {what} in the selected time interval, found fewer{hint}");
    };
    let summary = Summary::new(&course, there.to_string(), usize::from(arguments.blocks));
    write_elements(&arguments.out, &course, &summary, arguments.parquet)?;
    if arguments.json { print_json(&summary) } else { print(&summary_text(&summary, &arguments.out)) }
}

/// Reads the snapshots of a directory that `simulate` wrote.
fn of_directory(
    dir: &Path,
    arguments: &Arguments,
    take: &mut impl FnMut(Snapshot) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let beside_a_dump = [
        (arguments.contacts.is_some(), "--contacts"),
        (!arguments.map.is_empty(), "--map"),
        (arguments.radius.is_some(), "--radius"),
        (arguments.density.is_some(), "--density"),
        (arguments.time_step.is_some(), "--time-step"),
    ];
    if let Some((_, flag)) = beside_a_dump.into_iter().find(|(given, _)| *given) {
        refuse!("{flag}: expected a dump with this option, found the directory {}", dir.display());
    }
    refuse_mixed(dir).map_err(Fault::input)?;
    each_snapshot(dir, Fault::input, take)
}

/// Reads the snapshots of a dump of grains.
fn of_dump(
    path: &Path,
    arguments: &Arguments,
    take: &mut impl FnMut(Snapshot) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let beside = DumpOptions {
        names: Names(arguments.map.clone()),
        radius: arguments.radius,
        density: arguments.density,
        time_step: arguments.time_step,
        plane: arguments.dimension == Some(2),
        partial: arguments.partial,
    };
    if (arguments.from.is_some() || arguments.to.is_some()) && arguments.time_step.is_none() {
        // If the dump has no times, `--from` and `--to` would select nothing without any message.
        let mut first = GrainDump::open(path, None, beside.clone())?;
        if first.read()?.is_some_and(|snapshot| !snapshot.time.is_finite()) {
            refuse!("--from, --to: expected a dump with times, or the option `--time-step`");
        }
    }
    let mut dump = GrainDump::open(path, arguments.contacts.as_deref(), beside)?;
    while let Some(snapshot) = dump.read().map_err(Fault::reading)? {
        take(snapshot)?;
    }
    if let Some(cut) = &dump.cut {
        say("warning", &format!("only the complete frames are read (--partial): {cut}"));
    }
    Ok(())
}

/// Returns true if a snapshot of our solvers is two-dimensional: all positions have z = 0, and the box extends from −½
/// to ½ along z.
fn is_plane(snapshot: &Snapshot) -> bool {
    let grains = snapshot.grains.iter().map(|grain| grain.position.z);
    let mut heights = grains.chain(snapshot.points.iter().map(|point| point.position.z));
    (snapshot.bounds.0.z, snapshot.bounds.1.z) == (-0.5, 0.5) && heights.all(|height| height == 0.0)
}

/// Creates the grid in the box of the first snapshot, and the masks that leave cells out of averages.
fn begin(snapshot: &Snapshot, arguments: &Arguments) -> Result<Course, Fault> {
    let space = match arguments.dimension {
        Some(2) => Dimension::Two,
        None if arguments.source.is_dir() && is_plane(snapshot) => Dimension::Two,
        _ => Dimension::Three,
    };
    let dimension = space.count();
    let corner = |given: &[f64], of_box: Vector3<f64>, flag: &str| match given {
        [] => Ok(of_box),
        [x, y] if dimension == 2 => Ok(Vector3::new(*x, *y, of_box.z)),
        [x, y, z] if dimension == 3 => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(Fault::input(format!("{flag}: expected {dimension} numbers, found {}", given.len()))),
    };
    let low = corner(&arguments.low, snapshot.bounds.0, "--low")?;
    let high = corner(&arguments.high, snapshot.bounds.1, "--high")?;
    let size = size_of(&arguments.cell, "--cell", [low, high], dimension)?;
    let cells: f64 = (0..dimension).map(|axis| ((high[axis] - low[axis]) / size[axis]).round().max(1.0)).product();
    if cells > MOST_CELLS {
        refuse!("--cell: expected at most {MOST_CELLS} cells, found {cells}; use larger cells");
    }
    let up = match arguments.up.as_deref() {
        None => (dimension - 1, true),
        Some(word) => (usize::from(word.as_bytes()[word.len() - 1] - b'x'), !word.starts_with('-')),
    };
    if up.0 >= dimension {
        refuse!("--up: expected x or y in two dimensions, found z");
    }
    let masks = Masks {
        fewest: arguments.fewest.max(1),
        surface: arguments.surface,
        up,
        periodic: snapshot.periodic,
        dimension,
        orifice: arguments.orifice.as_deref().map(orifice).transpose()?,
        flowing: arguments.flowing,
    };
    let grid = Grid::filling((low, high), size);
    let plane = if up.0 == 0 { [1, 0] } else { [0, up.0] };
    let mut course = Course::new(grid, space, plane, masks, arguments.between);
    course.stress =
        arguments.stress.as_deref().map(|which| if which == "mean" { Stress::Interval } else { Stress::Instant });
    if !arguments.tracers.is_empty() {
        let size = size_of(&arguments.tracers, "--tracers", [low, high], dimension)?;
        course.trails = Some(Trails::new(Grid::filling((low, high), size)));
    }
    Ok(course)
}

/// Returns the cell size (m) along each axis, if the box from `low` to `high` (m) is large enough.
fn size_of(given: &[f64], flag: &str, [low, high]: [Vector3<f64>; 2], dimension: usize) -> Result<Vector3<f64>, Fault> {
    let size = match *given {
        [all] => Vector3::repeat(all),
        [x, y] if dimension == 2 => Vector3::new(x, y, 1.0),
        [x, y, z] if dimension == 3 => Vector3::new(x, y, z),
        _ => refuse!("{flag}: expected a number or {dimension}, found {}", given.len()),
    };
    let size = if dimension == 2 { Vector3::new(size.x, size.y, high.z - low.z) } else { size };
    for axis in 0..dimension {
        let length = high[axis] - low[axis];
        let name = ["x", "y", "z"][axis];
        if !(length > 0.0 && length.is_finite()) {
            refuse!(
                "expected a box with a width above zero along {name}, found {length} m from {} to {}; set --low and \
                 --high",
                low[axis],
                high[axis]
            );
        }
        if size[axis] > length * (1.0 + 1e-9) {
            refuse!("{flag}: expected at most {length} m, the width of the box along {name}, found {}", size[axis]);
        }
    }
    Ok(size)
}

/// Reads the centre and the radius of an orifice (m), such as `x=0,z=0,r=7.5`.
fn orifice(text: &str) -> Result<Orifice, Fault> {
    let fault =
        || Fault::input(format!("--orifice: expected coordinates and a radius such as x=0,z=0,r=7.5, found `{text}`"));
    let (mut middle, mut reach) = ([None; 3], None);
    for part in text.split(',') {
        let (name, value) = part.split_once('=').ok_or_else(fault)?;
        let value: f64 = value.trim().parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(fault)?;
        match name.trim() {
            "x" => middle[0] = Some(value),
            "y" => middle[1] = Some(value),
            "z" => middle[2] = Some(value),
            "r" if value > 0.0 => reach = Some(value),
            _ => return Err(fault()),
        }
    }
    let reach = reach.filter(|_| middle.iter().any(Option::is_some)).ok_or_else(fault)?;
    Ok(Orifice { middle, reach })
}

/// Number of columns, from the start of [`COLUMNS`], that the printed summary can contain.
const PRINTED: usize = 11;

/// Returns the summary of the fields for the terminal.
fn summary_text(summary: &Summary, out: &Path) -> String {
    let [x, y, z] = summary.cell.map(|size| number::significant(size, 4));
    let mut text = format!("{}\ncells of {x} × {y} × {z} m\n\n", summary.words());
    let is_printed = |over: &&ElementMean| COLUMNS[..PRINTED].iter().any(|column| column.name == over.quantity);
    let columns = [
        Column::text("mean"),
        Column::new("value", Format::Digits(4)),
        Column::new(format!("± ({:.0} %)", 100.0 * summary.confidence), Format::Digits(2)),
        Column::text("unit"),
        Column::new("blocks", Format::Count),
        Column::new("elements", Format::Count),
    ];
    let row = |over: &ElementMean| {
        let blocks = over.mean.half_width.map(|_| over.mean.blocks);
        row![over.words, over.mean.value, over.mean.half_width, over.unit, blocks, over.elements]
    };
    text += &Table::new("", columns, summary.means.iter().filter(is_printed).map(row)).text();
    format!("{text}\n{}\n", out.display())
}
