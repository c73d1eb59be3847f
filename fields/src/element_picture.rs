//! Granular elements as pictures: the same definition for grains and for material points, side by side or as a film.

use crate::column::{COLUMNS, Column, Grains};
use crate::course::{Course, Frame};
use crate::element::elements;
use crate::grid::Grid;
use crate::picture::two_digits;
use grainbench_harness::figure::{Field, Panel, Shades};
use grainbench_harness::raster::{Raster, level};
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::Scene;
use nalgebra::Vector3;

/// Pixels across a cell of a picture.
const PIXELS: u32 = 24;
/// Pixels along the longer side of a panel of a film.
const LONGEST: u32 = 320;
/// A film has at most this many frames.
const FRAMES: usize = 60;

/// A panel: its title, what it shows, and the scene that this is a snapshot of.
pub type Shot<'a> = (String, &'a Snapshot, &'a Scene);

/// Panels of a quantity, by its column's name, over cells of about `size` (m) of plane scenes, on one scale from `range` of
/// values.
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

/// What lengths and times are counted in.
#[derive(Clone, Copy)]
pub struct Units {
    /// Lengths.
    pub length: &'static str,
    /// Times.
    pub time: &'static str,
}

impl Units {
    /// Metres and seconds.
    pub const SI: Self = Self { length: "m", time: "s" };

    /// The unit of a kinematic column in these.
    fn of(self, si: &str) -> String {
        match si {
            "m/s" => format!("{}/{}", self.length, self.time),
            "1/s" => format!("1/{}", self.time),
            other => other.to_owned(),
        }
    }
}

/// Quantities over a sheet of cells, one cell deep, at some times.
pub struct Sheet {
    /// The cells.
    pub grid: Grid,
    /// What its lengths and times are counted in.
    pub units: Units,
    /// What tells the times apart, such as `time t (s)`.
    pub clock: String,
    /// The times.
    pub times: Vec<f64>,
    /// What is shown, each in every cell at every time: the name of its column, and values; no number where nothing is shown.
    pub shown: Vec<(&'static str, Vec<Vec<f64>>)>,
}

/// A film of quantities over the sheet of cells of a course, or a picture where it has one frame. None where the grid is no
/// sheet of one cell's depth, or no element has any of the quantities. Cells that hold too little are left blank.
#[must_use]
pub fn film(course: &Course, names: &[&str]) -> Option<Field> {
    let count = course.frames.len().min(FRAMES);
    let last = course.frames.len().checked_sub(1)?;
    let frames: Vec<&Frame> = (0..count).map(|frame| &course.frames[frame * last / (count - 1).max(1)]).collect();
    let of = |name: &&str| {
        let column = named(name);
        let value = |frame: &Frame, cell: usize| course.value(column, frame, cell).filter(|_| !frame.masked[cell].few);
        let of_frame =
            |frame: &&Frame| (0..course.grid.cells()).map(|cell| value(frame, cell).unwrap_or(f64::NAN)).collect();
        (column.name, frames.iter().map(of_frame).collect())
    };
    let words = if frames.iter().all(|frame| frame.time.is_finite()) { "time t (s)" } else { "step" };
    let times = frames.iter().map(|frame| frame.clock()).collect();
    Sheet { grid: course.grid, units: Units::SI, clock: words.to_owned(), times, shown: names.iter().map(of).collect() }
        .film()
}

impl Sheet {
    /// The quantities side by side, each on a scale of its own, which runs from zero, that of packing fractions from what a
    /// fiftieth of the elements is below, to what a fiftieth is above.
    #[must_use]
    pub fn film(&self) -> Option<Field> {
        let [across, up] = sheet(&self.grid)?;
        let pixels = (LONGEST / self.grid.count[across].max(self.grid.count[up]) as u32).clamp(1, PIXELS);
        let panel = |(name, frames): &(&'static str, Vec<Vec<f64>>)| {
            let column = named(name);
            let mut values: Vec<f64> = frames.iter().flatten().copied().filter(|value| value.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            let at = |fiftieths: usize| values.get(values.len().checked_sub(1)? * fiftieths / 50).copied();
            let range = (lowest(name, at(1)?), two_digits(at(49)?));
            let of = |frame: &Vec<f64>| {
                raster(&self.grid, [across, up], pixels, |cell| {
                    level(frame.get(cell).copied().unwrap_or(f64::NAN), range)
                })
            };
            let own = Some((range, self.units.of(column.unit)));
            Some(Panel { title: column.words.to_owned(), frames: frames.iter().map(of).collect(), own })
        };
        let panels: Vec<Panel> = self.shown.iter().filter_map(panel).collect();
        let pixel = self.grid.cell[across] / f64::from(pixels);
        let clock = (self.clock.clone(), self.times.clone());
        (!panels.is_empty()).then(|| field(&COLUMNS[0], self.units, (0.0, 1.0), pixel, panels, clock))
    }
}

/// Where the range of a quantity begins whose lowest fiftieth ends at a value: packing fractions of a bulk differ by little.
fn lowest(name: &str, value: f64) -> f64 {
    if name == "packing_fraction" { ((value * 20.0).floor() / 20.0).max(0.0) } else { 0.0 }
}

/// The two axes along which a sheet of cells lies, one cell deep along the third; x or y first.
fn sheet(grid: &Grid) -> Option<[usize; 2]> {
    [[0, 1], [0, 2], [1, 2]].into_iter().find(|axes| grid.count[3 - axes[0] - axes[1]] == 1)
}

/// The column of a name, the first where there is none.
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
    let (label, unit, length) = (column.words.to_owned(), units.of(column.unit), units.length.to_owned());
    Field { label, unit, range, shades: Shades::Amount, pixel, length, panels, clock, times }
}

/// Cells of a sheet as rectangles, rows from the top, so many pixels across.
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
        // Lying in x and z, with cells twice as high as wide.
        let grid = Grid { count: [2, 1, 3], ..grid };
        let all = raster(&grid, [0, 2], PIXELS, |place| 1 + place as u8);
        assert_eq!((all.width, all.height, sheet(&grid)), (2 * PIXELS, 6 * PIXELS, Some([0, 2])));
        assert_eq!(all.levels[0], 5);
        assert_eq!(sheet(&Grid { count: [2, 2, 2], ..grid }), None);
    }
}
