//! Masks: cells that are excluded from means, with the reasons, and elements with their masks.

use crate::element::Element;
use crate::grid::Grid;
use nalgebra::Vector3;

/// Reasons for the exclusion of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaskReasons {
    /// The cell contains too few grains or points.
    pub few: bool,
    /// The cell is at the free surface: the packing fraction of the cell, or of the cell above, is below the limit for
    /// the bulk.
    pub surface: bool,
    /// The cell is at a non-periodic side of the grid. Its top counts only if contacts with a lid may be missing.
    pub wall: bool,
    /// The cell is near an orifice.
    pub orifice: bool,
    /// The shear rate of the cell is unknown, or below the limit for flow.
    pub still: bool,
}

impl MaskReasons {
    /// Returns true if the cell is excluded for any reason.
    #[must_use]
    pub const fn any(self) -> bool {
        self.few || self.surface || self.wall || self.orifice || self.still
    }

    /// Returns the reasons, joined by `+`; empty if there are none.
    #[must_use]
    pub fn words(self) -> String {
        let reasons = [
            (self.few, "few"),
            (self.surface, "surface"),
            (self.wall, "wall"),
            (self.orifice, "orifice"),
            (self.still, "still"),
        ];
        let named: Vec<&str> = reasons.into_iter().filter_map(|(is, word)| is.then_some(word)).collect();
        named.join("+")
    }
}

/// Parameters of the masks.
#[derive(Clone, Debug, PartialEq)]
pub struct Masks {
    /// Minimum number of grains or points in a cell.
    pub fewest: usize,
    /// Packing fraction below which a cell is not part of the bulk.
    pub surface: f64,
    /// Index of the vertical axis, and true if its positive direction is up.
    pub up: (usize, bool),
    /// True for each periodic axis.
    pub periodic: [bool; 3],
    /// Dimension of space, 2 or 3.
    pub dimension: usize,
    /// Orifice near which cells are excluded; none if there is no orifice.
    pub orifice: Option<Orifice>,
    /// Minimum shear rate |D₀| (1/s) of a flowing cell; `None` to include cells at rest.
    pub flowing: Option<f64>,
}

/// Position of an orifice, and the radius around it in which cells are excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orifice {
    /// Centre along each axis (m); `None` along the length of a slit.
    pub middle: [Option<f64>; 3],
    /// Radius around the orifice (m). Cells with a centre inside this radius are excluded.
    pub reach: f64,
}

impl Orifice {
    /// Returns the distance of a position from the orifice (m).
    fn distance(&self, place: Vector3<f64>) -> f64 {
        let along = |axis: usize| self.middle[axis].map_or(0.0, |middle| place[axis] - middle);
        Vector3::from_fn(|axis, _| along(axis)).norm()
    }
}

impl Masks {
    /// Returns the reasons for the exclusion of each cell, in the order of `elements`. The stress must include the contacts
    /// with walls.
    #[must_use]
    pub fn apply(&self, elements: &[Element], grid: &Grid) -> Vec<MaskReasons> {
        self.apply_with(elements, grid, false)
    }

    /// Returns the reasons as [`Self::apply`]. If `lacks_walls`, the top of the grid counts as a wall.
    pub(crate) fn apply_with(&self, elements: &[Element], grid: &Grid, lacks_walls: bool) -> Vec<MaskReasons> {
        let (up, high) = self.up;
        let bulk = |cell: usize| elements[cell].packing_fraction >= self.surface;
        let above = |at: [usize; 3]| {
            let mut over = at;
            over[up] = if high { at[up] + 1 } else { at[up].wrapping_sub(1) };
            (over[up] < grid.count[up]).then(|| grid.place(over))
        };
        let reasons = |cell: usize| {
            let at = grid.at(cell);
            let at_side = |axis: usize| at[axis] == 0 || at[axis] + 1 == grid.count[axis];
            let top = if high { at[up] + 1 == grid.count[up] } else { at[up] == 0 };
            MaskReasons {
                few: elements[cell].motion.members < self.fewest,
                surface: !bulk(cell) || above(at).is_some_and(|over| !bulk(over)),
                // The upper end of the grid is a free surface, or a lid whose contacts are part of the stress.
                wall: (0..self.dimension)
                    .any(|axis| !self.periodic[axis] && at_side(axis) && (lacks_walls || !(axis == up && top))),
                still: self.flowing.is_some_and(|least| elements[cell].shear_rate().is_none_or(|rate| rate < least)),
                orifice: self.orifice.is_some_and(|orifice| orifice.distance(grid.middle(cell)) < orifice.reach),
            }
        };
        (0..grid.cells()).map(reasons).collect()
    }

    /// Returns a description of the masks.
    #[must_use]
    pub fn words(&self) -> String {
        let mut words = format!(
            "without cells that have fewer than {} members, are at the surface (packing fraction below {} in the cell \
             or above it) or at the sides",
            self.fewest, self.surface
        );
        if let Some(orifice) = self.orifice {
            words += &format!(", or within {} m of the orifice", orifice.reach);
        }
        if let Some(least) = self.flowing {
            words += &format!(", or where |D₀| is below {least}/s");
        }
        words
    }
}

/// Elements of one snapshot.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Step number of the frame.
    pub step: u64,
    /// Time (s); NaN if unknown.
    pub time: f64,
    /// Elements in the order of [`Grid::place`].
    pub elements: Vec<Element>,
    /// For each element, the reasons for its exclusion from means, if any.
    pub masked: Vec<MaskReasons>,
    /// Number of grains or points whose centre is in no cell.
    pub outside: usize,
}

impl Frame {
    /// Returns the time (s), or the step if the time is unknown.
    #[must_use]
    pub fn clock(&self) -> f64 {
        if self.time.is_finite() { self.time } else { self.step as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;

    #[test]
    fn each_reason_is_told_apart() {
        let grid = Grid { low: Vector3::zeros(), cell: Vector3::new(1.0, 1.0, 1.0), count: [5, 1, 5] };
        let motion = Motion { members: 4, velocity: None, gradient: None, residual: None };
        let filled = |packing_fraction: f64| Element { packing_fraction, stress: None, motion, dimension: 3 };
        let mut elements = vec![filled(0.6); 25];
        for x in 0..5 {
            elements[grid.place([x, 0, 4])] = filled(0.1);
        }
        elements[grid.place([2, 0, 2])].motion.members = 1;
        let orifice = Orifice { middle: [Some(2.5), None, Some(0.0)], reach: 2.0 };
        let masks = Masks {
            fewest: 2,
            surface: 0.4,
            up: (2, true),
            periodic: [false, true, false],
            dimension: 3,
            orifice: Some(orifice),
            flowing: None,
        };
        let masked = masks.apply(&elements, &grid);
        let words = |x: usize, z: usize| masked[grid.place([x, 0, z])].words();
        assert_eq!(words(1, 2), "");
        assert_eq!([words(2, 2), words(1, 3), words(0, 2)], ["few", "surface", "wall"]);
        assert_eq!([words(2, 0), words(2, 1), words(2, 4)], ["wall+orifice", "orifice", "surface"]);
        // A cell counts as at rest if it does not shear or if its shear rate is unknown.
        let still = Masks { flowing: Some(0.1), ..masks.clone() }.apply(&elements, &grid);
        assert_eq!(still[grid.place([1, 0, 2])].words(), "still");
        // If the vertical axis points down, the surface is at the opposite end of the grid.
        let masks = Masks { up: (2, false), orifice: None, ..masks };
        let masked = masks.apply(&elements, &grid);
        assert_eq!(masked[grid.place([2, 0, 0])].words(), "");
        assert_eq!(masked[grid.place([2, 0, 4])].words(), "surface+wall");
    }
}
