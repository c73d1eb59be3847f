//! Granular elements as VTK image data (XML, ASCII) for ParaView and VisIt, with one value per cell.

use crate::export::vtk;
use grainbench_fields::column::COLUMNS;
use grainbench_fields::course::{Course, Frame};
use std::io::{self, Write};

/// Writes the elements of a frame. Unknown values are NaN. The array `masked` is 1 for a cell that is left out of averages.
pub(super) fn write(course: &Course, frame: &Frame, mut out: impl Write) -> io::Result<()> {
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
