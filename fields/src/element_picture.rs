//! Figures and films of granular elements, with the same definition for grains and for material points.

use crate::column::{COLUMNS, Column, Grains};
use crate::course::{Course, Frame};
use crate::element::elements;
use crate::grid::Grid;
use crate::picture::two_digits;
use grainbench_harness::figure::{Field, Panel, Shades};
use grainbench_harness::raster::{Raster, level};
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;

/// Width of a cell in a figure, and largest width of a cell in a film (pixels).
const PIXELS: u32 = 24;
/// Pixels along the longer side of a film panel.
const LONGEST: u32 = 320;
/// Maximum number of frames of a film.
const FRAMES: usize = 60;

/// A panel: title, snapshot, and the scene of the snapshot.
pub type Shot<'a> = (String, &'a Snapshot, &'a Scene);

/// Returns panels of the quantity with the column name `name`, for two-dimensional scenes, with cells of about `size`
/// (m).
///
/// All panels have the same scale, from the lower to the upper end of `range`.
#[must_use]
pub fn pictures(name: &str, shots: &[Shot<'_>], size: f64, range: (f64, f64)) -> Field {
    let column = named(name);
    let mut pixel = size / f64::from(PIXELS);
    let panels = shots.iter().map(|(title, snapshot, scene)| {
        let grid = Grid::filling(snapshot.bounds, Vector3::new(size, size, 1.0));
        pixel = grid.cell.x / f64::from(PIXELS);
        let cells = elements(snapshot, scene.dimension, &grid);
        let grains = Grains { mean: None, plane: [0, 1] };
        let value = |place: usize| (column.of)(&cells[place], &grains).unwrap_or(f64::NAN);
        let frame = raster(&grid, [0, 1], PIXELS, |place| level(value(place), range));
        Panel { title: title.clone(), frames: vec![frame], own: None }
    });
    let panels = panels.collect();
    field(column, Units::SI, range, pixel, panels, (String::new(), vec![0.0]))
}

/// Units of lengths and times.
#[derive(Clone, Copy)]
pub struct Units {
    /// Unit of length on scale bars, such as `m`.
    pub length: &'static str,
    /// Unit of time on time axes, such as `s`.
    pub time: &'static str,
}

impl Units {
    /// Metres and seconds.
    const SI: Self = Self { length: "m", time: "s" };

    /// Converts the SI unit of a column to these units. Only units of speed and rate change.
    fn unit(self, si: &str) -> String {
        match si {
            "m/s" => format!("{}/{}", self.length, self.time),
            "1/s" => format!("1/{}", self.time),
            other => other.to_owned(),
        }
    }
}

/// Quantities in a sheet of cells, one cell deep, at several times.
pub struct Sheet {
    /// Grid of cells.
    pub grid: Grid,
    /// Units of lengths and times.
    pub units: Units,
    /// Label of the times, such as `time t (s)`.
    pub clock: String,
    /// Times of the frames, in the unit that `clock` states.
    pub times: Vec<f64>,
    /// Plotted quantities. Each has a column name and values by time and cell, with NaN for blank cells.
    pub shown: Vec<(&'static str, Vec<Vec<f64>>)>,
}

/// Returns a film of quantities with at most 60 frames of a series, or a figure if the series has one frame.
///
/// Returns `None` if there are no frames, if the grid is not one cell deep, or if no cell has a value. Cells with too
/// few members are blank.
#[must_use]
pub fn film(course: &Course, names: &[&str]) -> Option<Field> {
    let count = course.frames.len().min(FRAMES);
    let last = course.frames.len().checked_sub(1)?;
    let frames: Vec<&Frame> = (0..count).map(|frame| &course.frames[frame * last / (count - 1).max(1)]).collect();
    let panel_values = |name: &&str| {
        let column = named(name);
        let value = |frame: &Frame, cell: usize| course.value(column, frame, cell).filter(|_| !frame.masked[cell].few);
        let of_frame =
            |frame: &&Frame| (0..course.grid.cells()).map(|cell| value(frame, cell).unwrap_or(f64::NAN)).collect();
        (column.name, frames.iter().map(of_frame).collect())
    };
    let words = if frames.iter().all(|frame| frame.time.is_finite()) { "time t (s)" } else { "step" };
    let times = frames.iter().map(|frame| frame.clock()).collect();
    Sheet {
        grid: course.grid,
        units: Units::SI,
        clock: words.to_owned(),
        times,
        shown: names.iter().map(panel_values).collect(),
    }
    .film()
}

impl Sheet {
    /// Returns the quantities side by side. Each has its own scale, from zero to the 98th percentile of its values.
    ///
    /// The scale of packing fractions starts near the 2nd percentile.
    #[must_use]
    pub fn film(&self) -> Option<Field> {
        let [across, up] = sheet(&self.grid)?;
        let pixels = (LONGEST / self.grid.count[across].max(self.grid.count[up]) as u32).clamp(1, PIXELS);
        let panel = |(name, frames): &(&'static str, Vec<Vec<f64>>)| {
            let column = named(name);
            let mut values: Vec<f64> = frames.iter().flatten().copied().filter(|value| value.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            let at = |fiftieths: usize| values.get(values.len().checked_sub(1)? * fiftieths / 50).copied();
            // Packing fractions vary little, so their scale starts at a multiple of 0.05 below the 2nd percentile.
            let lowest = ((at(1)? * 20.0).floor() / 20.0).max(0.0);
            let range = (if *name == "packing_fraction" { lowest } else { 0.0 }, two_digits(at(49)?));
            let raster_of = |frame: &Vec<f64>| {
                raster(&self.grid, [across, up], pixels, |cell| {
                    level(frame.get(cell).copied().unwrap_or(f64::NAN), range)
                })
            };
            let own = Some((range, self.units.unit(column.unit)));
            Some(Panel { title: column.words.to_owned(), frames: frames.iter().map(raster_of).collect(), own })
        };
        let panels: Vec<Panel> = self.shown.iter().filter_map(panel).collect();
        let pixel = self.grid.cell[across] / f64::from(pixels);
        let clock = (self.clock.clone(), self.times.clone());
        (!panels.is_empty()).then(|| field(&COLUMNS[0], self.units, (0.0, 1.0), pixel, panels, clock))
    }
}

/// Returns the two axes of the plane of a grid that is one cell deep along the third axis; `None` for other grids.
fn sheet(grid: &Grid) -> Option<[usize; 2]> {
    [[0, 1], [0, 2], [1, 2]].into_iter().find(|axes| grid.count[3 - axes[0] - axes[1]] == 1)
}

/// Returns the column with a name, or the first column if there is none.
fn named(name: &str) -> &'static Column {
    COLUMNS.iter().find(|column| column.name == name).unwrap_or(&COLUMNS[0])
}

fn field(
    column: &Column,
    units: Units,
    range: (f64, f64),
    pixel: f64,
    panels: Vec<Panel>,
    (clock, times): (String, Vec<f64>),
) -> Field {
    let (label, unit, length) = (column.words.to_owned(), units.unit(column.unit), units.length.to_owned());
    Field { label, unit, range, shades: Shades::Amount, pixel, length, panels, clock, times }
}

/// Draws the cells of a sheet as rectangles that are `pixels` wide. The first row of pixels is the top row.
fn raster(grid: &Grid, [across, up]: [usize; 2], pixels: u32, level: impl Fn(usize) -> u8) -> Raster {
    let tall = (f64::from(pixels) * grid.cell[up] / grid.cell[across]).round().clamp(1.0, 4096.0) as u32;
    let (columns, rows) = (grid.count[across] as u32, grid.count[up] as u32);
    let (width, height) = (columns * pixels, rows * tall);
    let cell = |(x, y): (u32, u32)| {
        let mut at = [0; 3];
        (at[across], at[up]) = (x as usize, y as usize);
        level(grid.place(at))
    };
    let all = (0..height).flat_map(|row| (0..width).map(move |column| (column / pixels, rows - 1 - row / tall)));
    Raster { width, height, levels: all.map(cell).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_of_cells_is_at_the_foot() {
        let grid = Grid { low: Vector3::zeros(), cell: Vector3::new(1.0, 1.0, 2.0), count: [2, 3, 1] };
        let all = raster(&grid, [0, 1], PIXELS, |place| 1 + place as u8);
        let at = |column: u32, row: u32| all.levels[(row * all.width + column) as usize];
        assert_eq!((all.width, all.height, sheet(&grid)), (2 * PIXELS, 3 * PIXELS, Some([0, 1])));
        assert_eq!([at(0, 0), at(2 * PIXELS - 1, 0), at(0, 3 * PIXELS - 1), at(PIXELS, 3 * PIXELS - 1)], [5, 6, 1, 2]);
        // A sheet in the plane of x and z, with cells twice as high as wide.
        let grid = Grid { count: [2, 1, 3], ..grid };
        let all = raster(&grid, [0, 2], PIXELS, |place| 1 + place as u8);
        assert_eq!((all.width, all.height, sheet(&grid)), (2 * PIXELS, 6 * PIXELS, Some([0, 2])));
        assert_eq!(all.levels[0], 5);
        assert_eq!(sheet(&Grid { count: [2, 2, 2], ..grid }), None);
    }
}
