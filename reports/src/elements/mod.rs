//! Granular elements as files: tables, image data for ParaView, a summary and figures.

mod summary;
mod tables;

pub use summary::{ElementMean, Summary};

use crate::export::vtk;
use crate::number;
use crate::pictures::write_page;
use crate::store::SaveError;
use grainbench_fields::column::COLUMNS;
use grainbench_fields::course::{Course, Frame};
use grainbench_fields::element_picture::film;
use grainbench_harness::figure::Figure;
use grainbench_store::StagedDir;
use std::io::{self, Write};
use std::path::Path;

/// Names of the tables, the summary and the page.
pub const FILES: [&str; 8] = [
    "index.html",
    "summary.json",
    "elements.csv",
    "means.csv",
    "tracers.csv",
    "elements.parquet",
    "means.parquet",
    "tracers.parquet",
];
/// Column names of the plotted quantities.
const DRAWN: [&str; 4] = ["speed", "sine_of_friction", "packing_fraction", "shear_rate"];

/// Writes all files of the elements to a directory, or no file if an error occurs.
///
/// - `elements.csv`: one row per element and frame.
/// - `means.csv`: one row per cell.
/// - `tracers.csv`: one row per tracer and frame, if there are tracers.
/// - The same tables as Parquet, if `parquet` is true.
/// - `summary.json`.
/// - `elements/`: image data of each frame, and a collection of these files.
/// - `index.html` with pictures or films, if the grid has a single layer of cells.
///
/// # Errors
/// When a file cannot be written or a figure cannot be drawn.
pub fn write_elements(dir: &Path, course: &Course, summary: &Summary, parquet: bool) -> Result<(), SaveError> {
    let mut out = StagedDir::new(dir)?;
    let tables = || {
        let trails = course.trails.as_ref().map(|trails| tables::trails(course, trails));
        [tables::elements(course), tables::means(course, summary.blocks)].into_iter().chain(trails)
    };
    for table in tables() {
        out.write_with(format!("{}.csv", table.name), |file| table.csv(file))?;
    }
    for table in tables().filter(|_| parquet) {
        out.write_with(format!("{}.parquet", table.name), |file| table.parquet(file))?;
    }
    let text = serde_json::to_string_pretty(summary).map_err(SaveError::encode("summary.json"))?;
    out.write("summary.json", text + "\n")?;
    let mut files = Vec::new();
    for (number, frame) in course.frames.iter().enumerate() {
        let name = format!("elements-{number:06}.vti");
        out.write_with(format!("elements/{name}"), |file| write_image(course, frame, file))?;
        files.push((frame.clock(), name));
    }
    out.write("elements/elements.pvd", vtk::collection(&files))?;
    if let Some(field) = film(course, &DRAWN) {
        let caption = format!(
            "Velocity, friction, packing fraction and rate of shear, {}. Cells with too few grains are blank. Values \
             outside a colour scale have the colour of its nearest end.",
            summary.velocity
        );
        let [x, y, z] = summary.cell.map(|size| number::significant(size, 3));
        let title = format!("Granular elements, cells of {x} × {y} × {z} m");
        let figure = Figure::field("elements", &title, &caption, field);
        write_page(&mut out, &summary.source, &[summary.words()], &[figure])?;
    }
    Ok(out.commit()?)
}

/// Writes the elements of a frame as VTK image data (XML, ASCII) for ParaView and VisIt, with one value per cell.
/// Unknown values are NaN. The array `masked` is 1 for a cell that is left out of averages.
fn write_image(course: &Course, frame: &Frame, mut out: impl Write) -> io::Result<()> {
    let grid = &course.grid;
    let [across, deep, up] = grid.count;
    let extent = format!("0 {across} 0 {deep} 0 {up}");
    let vector = |components: [f64; 3]| format!("{:?} {:?} {:?}", components[0], components[1], components[2]);
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(out, "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">")?;
    let (origin, spacing) = (vector(grid.low.into()), vector(grid.cell.into()));
    writeln!(out, "<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\">")?;
    writeln!(
        out,
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
    )?;
    writeln!(out, "{:?}\n</DataArray>\n</FieldData>", frame.clock())?;
    writeln!(out, "<Piece Extent=\"{extent}\">\n<CellData Scalars=\"packing_fraction\">")?;
    for column in &COLUMNS {
        writeln!(out, "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">", column.name)?;
        for cell in 0..grid.cells() {
            match course.value(column, frame, cell) {
                Some(value) => writeln!(out, "{value:?}")?,
                None => writeln!(out, "nan")?,
            }
        }
        writeln!(out, "</DataArray>")?;
    }
    vtk::whole(&mut out, "UInt8", "masked", frame.masked.iter().map(|masked| i64::from(masked.any())))?;
    writeln!(out, "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>")
}
