//! Means over the cells of a grid as pictures: the same definition for grains and for material points, side by side.

use crate::coarse::{Element, Grid, elements};
use grainbench_harness::figure::{Field, Panel, Shades};
use grainbench_harness::raster::{Raster, level};
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::Scene;
use nalgebra::Vector3;

/// Pixels across a cell.
const PIXELS: u32 = 24;

/// What of a cell is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mean {
    /// Pressure (Pa).
    Pressure,
    /// Rate of shear (1/s).
    ShearRate,
    /// Packing fraction.
    PackingFraction,
}

impl Mean {
    const fn label(self) -> (&'static str, &'static str) {
        match self {
            Self::Pressure => ("pressure", "Pa"),
            Self::ShearRate => ("rate of shear |D₀|", "1/s"),
            Self::PackingFraction => ("packing fraction", "1"),
        }
    }

    /// Not a number where too little is in the cell.
    fn of(self, element: &Element) -> f64 {
        match self {
            Self::Pressure => element.pressure(),
            Self::ShearRate => element.shear_rate().unwrap_or(f64::NAN),
            Self::PackingFraction => element.packing_fraction,
        }
    }
}

/// A panel: its title, what it shows, and the scene that this is a snapshot of.
pub type Shot<'a> = (String, &'a Snapshot, &'a Scene);

/// Panels of a mean over cells of about `size` (m), on one scale from `range` of values.
#[must_use]
pub fn pictures(mean: Mean, shots: &[Shot<'_>], size: f64, range: (f64, f64)) -> Field {
    let mut pixel = size / f64::from(PIXELS);
    let panels = shots.iter().map(|(title, snapshot, scene)| {
        let grid = Grid::over(snapshot, Vector3::new(size, size, 1.0));
        pixel = grid.cell.x / f64::from(PIXELS);
        let cells = elements(snapshot, scene, &grid);
        Panel { title: title.clone(), frames: vec![raster(&grid, |place| level(mean.of(&cells[place]), range))] }
    });
    let panels = panels.collect();
    let (label, unit) = mean.label();
    Field {
        label: label.to_owned(),
        unit: unit.to_owned(),
        range,
        shades: Shades::Amount,
        pixel,
        panels,
        clock: String::new(),
        times: vec![0.0],
    }
}

/// Cells as squares, rows from the top.
fn raster(grid: &Grid, level: impl Fn(usize) -> u8) -> Raster {
    let [across, up, _] = grid.count.map(|count| count as u32);
    let (width, height) = (across * PIXELS, up * PIXELS);
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column / PIXELS, up - 1 - row / PIXELS)));
    Raster { width, height, levels: pixels.map(|(x, y)| level(grid.place([x as usize, y as usize, 0]))).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_of_cells_is_at_the_foot() {
        let grid = Grid { low: Vector3::zeros(), cell: Vector3::new(1.0, 1.0, 1.0), count: [2, 3, 1] };
        let raster = raster(&grid, |place| 1 + place as u8);
        let at = |column: u32, row: u32| raster.levels[(row * raster.width + column) as usize];
        assert_eq!((raster.width, raster.height), (2 * PIXELS, 3 * PIXELS));
        assert_eq!([at(0, 0), at(2 * PIXELS - 1, 0), at(0, 3 * PIXELS - 1), at(PIXELS, 3 * PIXELS - 1)], [5, 6, 1, 2]);
    }
}
