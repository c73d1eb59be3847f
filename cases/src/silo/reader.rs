//! Evaluation of the snapshots of a silo in granular elements of edge 2.5 d, in blocks of edge 5 d, and along tracers.

use super::flow::{ELEMENT, Flow, INERTIA, STEADY};
use super::instant;
use grainbench_fields::column::COLUMNS;
use grainbench_fields::course::Course;
use grainbench_fields::element::{Element, elements};
use grainbench_fields::grid::Grid;
use grainbench_fields::mask::Masks;
use grainbench_fields::motion::{motion, movers_between};
use grainbench_fields::tensor::{deviator, principal};
use grainbench_fields::trails::Trails;
use grainbench_harness::prelude::*;
use grainbench_scene::dimension::Dimension;
use nalgebra::Matrix3;

/// Evaluation of the snapshots of every silo.
pub(crate) const ELEMENTS: Reading = Reading { name: "granular elements", begin };

/// Number of frames whose stresses and motions are averaged in a window.
const WINDOW: usize = 20;
/// Largest number of stored rows of elements, and of blocks in single frames. Larger runs skip frames.
const MOST_ROWS: usize = 30_000;
/// Plane in which rotations of axes are measured: x and z.
const PLANE: [usize; 2] = [0, 2];
/// Conditions for excluding elements. An element needs at least eight grains. It is at the surface if its packing
/// fraction, or that of the element above, is less than 0.4.
const MASKS: Masks = Masks {
    fewest: 8,
    surface: 0.4,
    up: (2, true),
    periodic: [false, true, false],
    dimension: 3,
    orifice: None,
    flowing: None,
};

fn begin(scene: &Scene) -> Box<dyn Reader> {
    let width = scene.domain.as_ref().map_or([-0.5, 0.5], |domain| [domain.low.x, domain.high.x]);
    let depth = scene.domain.as_ref().map_or([-0.5, 0.5], |domain| [domain.low.y, domain.high.y]);
    let top = scene.grains.iter().map(|grain| grain.position.z + grain.radius).fold(0.0, f64::max);
    // The height is a whole number of blocks above the floor, each two elements high. The extra block on top gives each
    // surface cell a cell above it.
    let height = ((top / (2.0 * ELEMENT)).ceil() + 1.0) * 2.0 * ELEMENT;
    let corners = (Vector3::new(width[0], depth[0], 0.0), Vector3::new(width[1], depth[1], height));
    let grid_of_size = |size: f64| Grid::filling(corners, Vector3::new(size, depth[1] - depth[0], size));
    let blocks = grid_of_size(2.0 * ELEMENT);
    let frames = scene.snapshots as usize + 2;
    let mut course = Course::new(grid_of_size(ELEMENT), Dimension::Three, PLANE, MASKS, false);
    course.trails = Some(Trails::new(grid_of_size(2.0 * ELEMENT)));
    Box::new(Silo {
        course,
        every_blocks: (blocks.cells() * frames).div_ceil(MOST_ROWS).max(1),
        blocks,
        flow: Flow::from_scene(scene),
        before: None,
        rates: Vec::new(),
        window: Vec::new(),
        of_blocks: Table::new("blocks", &BLOCKS),
        whole: Table::new("whole", &WHOLE),
        axes: Table::new("axes", &instant::AXES),
    })
}

/// First columns of the table of elements; [`QUANTITIES`] follow. `side` is 1 at the walls in x, not at the floor.
const PLACED: [&str; 5] = ["time", "x", "z", "side", "surface"];
/// Quantities of elements, by their names in [`COLUMNS`].
const QUANTITIES: [&str; 8] = [
    "packing_fraction",
    "sine_of_friction",
    "drucker_prager",
    "shear_rate",
    "inertial_number",
    "pressure",
    "velocity_x",
    "velocity_z",
];
/// Columns of the table `rates`. This table covers all frames, but only moving elements away from sides and surface.
const RATES: [&str; 6] = ["time", "side", "surface", "shear_rate", "inertial_number", "packing_fraction"];
/// Columns of the table of blocks with edge 5 d (d: grain diameter). `frames` is the number of averaged frames.
/// `largest` and `smallest` are angles between the principal axes of the stress T and of the strain rate D.
/// `largest_elsewhere` is a negative control: it uses the stress of a distant block.
const BLOCKS: [&str; 13] = [
    "time",
    "frames",
    "x",
    "z",
    "side",
    "surface",
    "shear_rate",
    "largest",
    "largest_elsewhere",
    "smallest",
    "turn",
    "axis_of_stress",
    "shear_stress",
];
/// Columns of the table of the whole silo. `grains` is the number of centres above the floor. `packing_fraction` is the
/// mean over elements away from sides and surface. `shear_over_pressure` is the sum of the shear stress over all
/// elements below the surface, divided by the sum of their pressure. `right_over_left` is the pressure for x > 0
/// divided by the pressure for x < 0.
const WHOLE: [&str; 5] = ["time", "grains", "packing_fraction", "shear_over_pressure", "right_over_left"];

struct Silo {
    course: Course,
    blocks: Grid,
    /// Interval in frames at which blocks of single frames are stored.
    every_blocks: usize,
    flow: Flow,
    before: Option<Snapshot>,
    /// |D₀| of each element in each frame, from displacements since the previous frame.
    rates: Vec<Vec<Option<f64>>>,
    /// All blocks, with stress and velocity gradient L, in each frame of the present window.
    window: Vec<Vec<Element>>,
    of_blocks: Table,
    whole: Table,
    /// Axes of the blocks of the last frame.
    axes: Table,
}

impl Reader for Silo {
    fn see(&mut self, snapshot: Snapshot) {
        let between = self.before.as_ref().map(|before| {
            let moved = motion(&movers_between(before, &snapshot), 3, &self.course.grid);
            let rate = |motion| Element { packing_fraction: 0.0, stress: None, motion, dimension: 3 }.shear_rate();
            moved.into_iter().map(rate).collect()
        });
        self.rates.push(between.unwrap_or_default());
        self.see_blocks(&snapshot);
        self.before = Some(snapshot.clone());
        self.course.add(snapshot);
        self.see_whole();
    }

    fn end(self: Box<Self>) -> Vec<Table> {
        let forces = self.before.as_ref().map(|last| instant::forces(last, instant::part(self.flow)));
        let all = [self.elements(), self.tracers()].into_iter().chain(self.rates());
        all.chain(forces).chain([self.of_blocks, self.whole, self.axes]).collect()
    }
}

impl Silo {
    /// Adds the blocks of a snapshot. If a window ends with this snapshot, adds the means over the window.
    fn see_blocks(&mut self, snapshot: &Snapshot) {
        let blocks = elements(snapshot, Dimension::Three, &self.blocks);
        if self.course.frames.len().is_multiple_of(self.every_blocks) {
            add_blocks(&mut self.of_blocks, &self.blocks, snapshot.time, 1, &blocks);
        }
        self.axes = instant::axes(&blocks, &MASKS.apply(&blocks, &self.blocks), &self.blocks);
        if snapshot.time < STEADY - 1e-9 {
            return;
        }
        self.window.push(blocks);
        if self.window.len() == WINDOW {
            let means: Vec<Element> = (0..self.blocks.cells()).map(|cell| mean(&self.window, cell)).collect();
            add_blocks(&mut self.of_blocks, &self.blocks, snapshot.time, WINDOW, &means);
            self.window.clear();
        }
    }

    /// Adds the row of the whole silo in the last frame.
    fn see_whole(&mut self) {
        let (Some(frame), Some(snapshot)) = (self.course.frames.last(), &self.before) else { return };
        let above = snapshot.grains.iter().filter(|grain| grain.position.z >= 0.0).count();
        let (mut shear, mut pressures, mut filled, mut bulk) = (0.0, [0.0; 2], 0.0, 0.0);
        for (cell, element) in frame.elements.iter().enumerate() {
            let masked = frame.masked[cell];
            if masked.few || masked.surface {
                continue;
            }
            if let (Some(stress), Some(pressure)) = (element.stress, element.pressure()) {
                shear += 0.5 * (stress[(0, 2)] + stress[(2, 0)]);
                pressures[usize::from(self.course.grid.middle(cell).x > 0.0)] += pressure;
            }
            if !masked.wall {
                (filled, bulk) = (filled + element.packing_fraction, bulk + 1.0);
            }
        }
        let [left, right] = pressures;
        let is_known = left + right > 0.0;
        self.whole.push(&[
            Some(frame.time),
            Some(above as f64),
            (bulk > 0.0).then(|| filled / bulk),
            is_known.then(|| shear / (left + right)),
            is_known.then(|| right / left),
        ]);
    }

    /// Returns the table of elements with at least eight grains, in the stored frames.
    fn elements(&self) -> Table {
        let columns = [&PLACED[..], &QUANTITIES, &["shear_rate_between"]].concat();
        let mut table = Table::new("elements", &columns);
        for (frame, between) in self.course.frames.iter().zip(&self.rates).step_by(self.every()) {
            for (cell, masked) in frame.masked.iter().enumerate().filter(|(_, masked)| !masked.few) {
                let middle = self.course.grid.middle(cell);
                let side = is_side(&self.course.grid, cell);
                let flags = [side, masked.surface].map(|flag| Some(f64::from(u8::from(flag))));
                let mut row = vec![Some(frame.time), Some(middle.x), Some(middle.z), flags[0], flags[1]];
                let quantity = |name: &&str| {
                    let column = COLUMNS.iter().find(|column| column.name == *name)?;
                    self.course.value(column, frame, cell)
                };
                row.extend(QUANTITIES.iter().map(quantity));
                row.push(between.get(cell).copied().flatten());
                table.push(&row);
            }
        }
        table
    }

    /// Returns the interval in frames at which elements are stored.
    fn every(&self) -> usize {
        (self.course.grid.cells() * self.course.frames.len()).div_ceil(MOST_ROWS).max(1)
    }

    /// Returns the table `rates`, with φ and |I₀| in all frames; `None` if the table of elements has all frames. All
    /// frames are needed, because few elements reach the inertial numbers above the slit.
    fn rates(&self) -> Option<Table> {
        let mut table = Table::new("rates", &RATES);
        let columns = RATES[3..].iter().filter_map(|name| COLUMNS.iter().find(|column| column.name == *name));
        let columns: Vec<_> = columns.collect();
        for frame in &self.course.frames {
            for (cell, _) in frame.masked.iter().enumerate().filter(|(_, masked)| !masked.few && !masked.surface) {
                let values: Vec<_> = columns.iter().map(|column| self.course.value(column, frame, cell)).collect();
                let is_moving = values[1].is_some_and(|rate| rate >= INERTIA[0][0]);
                if is_moving && !is_side(&self.course.grid, cell) {
                    table.push(&[&[Some(frame.time), Some(0.0), Some(0.0)][..], &values].concat());
                }
            }
        }
        (self.every() > 1).then_some(table)
    }

    /// Returns the table of tracers away from the surface: position, strain, packing fraction and sin φ.
    fn tracers(&self) -> Table {
        let names = ["packing_fraction", "sine_of_friction"];
        let mut table = Table::new("tracers", &["time", "tracer", "x", "z", "strain", names[0], names[1]]);
        for stop in self.course.trails.iter().flat_map(|trails| &trails.stops) {
            let frame = &self.course.frames[stop.frame];
            let is_bulk = |cell: usize| !frame.masked[cell].surface && !frame.masked[cell].few;
            // At the boundary between the bulk and its surface, interpolation would mix values of both.
            let over = stop.position + Vector3::new(0.0, 0.0, 0.5 * ELEMENT);
            if ![stop.position, over].iter().all(|place| self.course.grid.find(*place).is_some_and(is_bulk)) {
                continue;
            }
            let around = names.map(|name| {
                let column = COLUMNS.iter().find(|column| column.name == name)?;
                self.course.value_at(column, frame, stop.position)
            });
            let place = [frame.time, stop.tracer as f64, stop.position.x, stop.position.z].map(Some);
            table.push(&[&place[..], &[stop.strain], &around].concat());
        }
        table
    }
}

/// Returns true if a cell is in the first or last column.
fn is_side(grid: &Grid, cell: usize) -> bool {
    let [column, ..] = grid.at(cell);
    column == 0 || column + 1 == grid.count[0]
}

/// Returns the element with mean stress and velocity gradient, if the block has them in all of these frames.
fn mean(frames: &[Vec<Element>], cell: usize) -> Element {
    let all: Vec<&Element> = frames.iter().map(|frame| &frame[cell]).collect();
    let count = all.len() as f64;
    let sum = |matrix: &dyn Fn(&Element) -> Option<Matrix3<f64>>| -> Option<Matrix3<f64>> {
        all.iter().try_fold(Matrix3::zeros(), |sum, element| Some(sum + matrix(element)? / count))
    };
    let mut motion = all[0].motion;
    motion.gradient = sum(&|element| element.motion.gradient);
    motion.members = all.iter().map(|element| element.motion.members).min().unwrap_or_default();
    let packing_fraction = all.iter().map(|element| element.packing_fraction).sum::<f64>() / count;
    Element { packing_fraction, stress: sum(&|element| element.stress), motion, dimension: 3 }
}

fn add_blocks(table: &mut Table, grid: &Grid, time: f64, frames: usize, blocks: &[Element]) {
    let masked = MASKS.apply(blocks, grid);
    for (cell, element) in blocks.iter().enumerate().filter(|(cell, _)| !masked[*cell].few) {
        let middle = grid.middle(cell);
        let flag = |is: bool| Some(f64::from(u8::from(is)));
        let angles = element.coaxiality(PLANE);
        let elsewhere = Element { stress: blocks[(cell + blocks.len() / 2 + 1) % blocks.len()].stress, ..*element };
        table.push(&[
            Some(time),
            Some(frames as f64),
            Some(middle.x),
            Some(middle.z),
            flag(is_side(grid, cell)),
            flag(masked[cell].surface),
            element.shear_rate(),
            angles.map(|angles| angles.largest),
            elsewhere.coaxiality(PLANE).map(|angles| angles.largest),
            angles.map(|angles| angles.smallest),
            angles.and_then(|angles| angles.in_plane),
            element.stress.map(|stress| axis(&stress)),
            element.stress.map(|stress| deviator(&stress, 3).norm()),
        ]);
    }
}

/// Returns the angle from x towards z of the axis of the largest principal stress (degrees, −90 to 90).
fn axis(stress: &Matrix3<f64>) -> f64 {
    let all = principal(stress, 3);
    let largest = all.axes[all.axes.len() - 1];
    let angle = largest.z.atan2(largest.x).to_degrees();
    angle - 180.0 * (angle / 180.0).round()
}
