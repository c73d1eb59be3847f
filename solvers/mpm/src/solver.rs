//! Material point method as a solver, with named settings, the time step, and the record of a run.

use crate::grid::lattice::Lattice;
use crate::limits;
use crate::options::{Contact, Setting};
use crate::simulation::Simulation;
use grainbench_scene::body::{BlockShape, Hold};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::memory;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::Solver;
use grainbench_solver::checkpoint::Checkpoint;
use grainbench_solver::drive::Course;
use grainbench_solver::failure::RunError;
use grainbench_solver::limits::{beyond_run, beyond_steps};
use grainbench_solver::observer::Observer;
use grainbench_solver::record::{Provenance, Record};
use grainbench_solver::resolution::Resolution;
use grainbench_solver::space::{Plane, Solid, Space};
use std::f64::consts::PI;

/// The material point method with one setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mpm {
    /// Name, such as `mpm:gap`.
    pub name: &'static str,
    /// Parameters of the method.
    pub setting: Setting,
}

impl Mpm {
    /// Best known setting, used for all scenes.
    pub const BEST: Self = Self { name: "mpm", setting: Setting::BEST };
    /// All named settings.
    pub const ALL: [Self; 6] = [
        Self::BEST,
        Self { name: "mpm:2000", setting: Setting::classic(Contact::Kinematic) },
        Self { name: "mpm:2001", setting: Setting::classic(Contact::Traction) },
        Self { name: "mpm:gap", setting: Setting::classic(Contact::Gap) },
        Self { name: "mpm:penalty", setting: Setting::classic(Contact::Penalty) },
        Self { name: "mpm:no-slip", setting: Setting::classic(Contact::NoSlip) },
    ];

    /// Returns the setting with the given name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mpm| mpm.name == name)
    }

    /// Returns the method with a changed setting under the same name. A case that uses it must give the reason.
    #[must_use]
    pub fn with(self, change: impl FnOnce(&mut Setting)) -> Self {
        let mut changed = self;
        change(&mut changed.setting);
        changed
    }

    /// Returns the grid and steps of a run, for example to estimate its cost.
    ///
    /// # Errors
    /// Returns an error if the scene is not supported or the resolution is invalid.
    pub fn plan(&self, scene: &Scene, resolution: &Resolution) -> Result<Plan, RunError> {
        if let Some(reason) = limits::reason(scene) {
            return Err(self.unsupported(reason));
        }
        plan(&self.setting, scene, resolution).map_err(|reason| self.resolution_error(reason))
    }

    fn run_in<S: Space>(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        let Plan { lattice, points, time_step, steps, critical } = self.plan(scene, resolution)?;
        let times = [time_step, critical];
        let threads = observer.options().threads;
        let mut simulation = Simulation::<S>::new(scene, self.setting, lattice, points, times, threads);
        let solver = format!("{} at {resolution} ({})", self.name(), self.setting.words().join(", "));
        let provenance = Provenance {
            critical_time_step: Some(critical),
            ..Provenance::new(scene, self.name(), resolution, time_step, self.setting.words())
        };
        let course = Course { solver, scene, steps, from, between_progress: STEPS_BETWEEN_PROGRESS, provenance };
        course.drive(&mut simulation, observer)
    }
}

/// Maximum number of steps between two progress reports.
const STEPS_BETWEEN_PROGRESS: u64 = 500;

/// Smallest distance of a body from its own periodic image, in cells. With fewer cells, both act on the same nodes and stick
/// together: the basis functions of a point reach at most one and a half cells. A body that spans the period is continuous.
const FROM_IMAGE: f64 = 3.0;

/// Returns the first grain or body that is too near to its own periodic image, with the distance in words.
fn near_own_image(scene: &Scene, lattice: &Lattice) -> Option<String> {
    let domain = scene.domain?;
    let grains = scene.grains.iter().zip(1..).map(|(grain, id)| (format!("grain {id}"), [2.0 * grain.radius; 3]));
    let bodies = scene.bodies.iter().map(|body| {
        let (low, high) = body.shape.corners();
        (format!("`{}`", body.name), [0, 1, 2].map(|axis| high[axis] - low[axis]))
    });
    grains.chain(bodies).find_map(|(name, size)| {
        (0..scene.dimension.count()).filter(|&axis| domain.periodic[axis]).find_map(|axis| {
            let gap = (domain.high - domain.low)[axis] - size[axis];
            // The tolerance covers rounding errors of lengths.
            let is_near = gap > 1e-9 * size[axis] && gap < FROM_IMAGE * lattice.cell[axis];
            is_near.then(|| format!("{name} with {:.3} along {}", gap / lattice.cell[axis], ["x", "y", "z"][axis]))
        })
    })
}

/// Memory of a material point, including tracers and springs per point (bytes).
const BYTES_OF_A_POINT: f64 = 600.0;
/// Memory of a node (bytes). A node is stored once for each body that uses it.
const BYTES_OF_A_NODE: f64 = 150.0;

/// Returns the reason for rejection if the points and nodes of a scene need too much memory. `cell` contains the cell
/// lengths (m).
fn beyond_memory(scene: &Scene, cell: [f64; 3], points: u32) -> Option<String> {
    let dimensions = scene.dimension.count();
    let in_cells = |volume: f64| cell[..dimensions].iter().fold(volume, |count, cell| count / cell);
    let boxed = |length: f64| cell[..dimensions].iter().map(|cell| length / cell + 4.0).product::<f64>();
    let of_bodies = scene.bodies.iter().map(|body| {
        let nodes = match body.shape {
            BlockShape::Box { .. } => in_cells(body.shape.volume(dimensions)),
            BlockShape::Annulus { outer, .. } => boxed(2.0 * outer),
        };
        (in_cells(body.shape.volume(dimensions)), nodes)
    });
    let of_grains = scene.grains.iter().map(|grain| {
        let volume = match dimensions {
            2 => PI * grain.radius.powi(2),
            _ => 4.0 / 3.0 * PI * grain.radius.powi(3),
        };
        (in_cells(volume), boxed(2.0 * grain.radius))
    });
    let (filled, nodes) = of_bodies.chain(of_grains).fold((0.0, 0.0), |sum, size| (sum.0 + size.0, sum.1 + size.1));
    let in_cell = f64::from(points).powi(dimensions as i32);
    memory::beyond(filled * in_cell, "points", BYTES_OF_A_POINT)
        .or_else(|| memory::beyond(nodes, "nodes", BYTES_OF_A_NODE))
}

/// Minimum radius of a grain and minimum width of a block, in cells. A smaller body has no gradient on the grid.
const SMALLEST: f64 = 0.5;

/// Minimum number of cells between two fixed or symmetry boundaries.
///
/// With one cell, the energy grew by a factor of 2e7 in 60 periods. With 1.5 cells it is constant within .2 %.
const BETWEEN_SIDES: f64 = 1.5;

/// Grid and steps of a run.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    pub(crate) lattice: Lattice,
    pub(crate) points: u32,
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Time in which the fastest wave crosses a cell (s).
    pub critical: f64,
}

/// Returns the grid and steps of a run of a scene that the method supports. The error is the reason why the resolution is
/// not valid.
fn plan(setting: &Setting, scene: &Scene, resolution: &Resolution) -> Result<Plan, String> {
    let Resolution::Grid { cells, points, courant } = *resolution else {
        return Err(format!("expected cells per length, points per cell and a Courant number, found {resolution}"));
    };
    let positive = |value: f64| value.is_finite() && value > 0.0;
    if !(positive(cells) && positive(courant) && (1..=64).contains(&points)) {
        return Err(format!("expected positive numbers, found {resolution}"));
    }
    let dimensions = scene.dimension.count();
    let cell = scene.reference_length / cells;
    let cells_of = |axis: usize| scene.domain.map_or(0.0, |domain| (domain.high[axis] - domain.low[axis]) / cell);
    if let Some(axis) = (0..dimensions).find(|&axis| cells_of(axis) >= f64::from(i32::MAX)) {
        return Err(format!("expected a domain of fewer than 2^31 cells along an axis, found {:e}", cells_of(axis)));
    }
    let lattice = lattice(scene, setting, cell);
    if let Some(found) = beyond_memory(scene, lattice.cell, points) {
        return Err(format!("expected points and nodes that fit into memory, found {found}"));
    }
    let cell = lattice.shortest(dimensions);
    let smallest = scene.grains.iter().enumerate().min_by(|(_, a), (_, b)| a.radius.total_cmp(&b.radius));
    if let Some((at, grain)) = smallest.filter(|(_, grain)| grain.radius < SMALLEST * cell) {
        return Err(format!(
            "expected a radius of at least {SMALLEST} cells, found grain {} with {:.3}: {} cells are enough for it",
            at + 1,
            grain.radius / cell,
            (SMALLEST * scene.reference_length / grain.radius).ceil()
        ));
    }
    for body in &scene.bodies {
        let length = body.shape.length(dimensions);
        if length < SMALLEST * cell {
            return Err(format!(
                "expected a body at least {SMALLEST} cells wide, found `{}` with {:.3}: {} cells are enough for it",
                body.name,
                length / cell,
                (SMALLEST * scene.reference_length / length).ceil()
            ));
        }
    }
    if let Some(found) = near_own_image(scene, &lattice) {
        return Err(format!(
            "expected at least {FROM_IMAGE} cells between a body and its own periodic image, found {found}"
        ));
    }
    for (body, axis) in scene.bodies.iter().flat_map(|body| (0..dimensions).map(move |axis| (body, axis))) {
        let BlockShape::Box { low, high } = body.shape else { continue };
        let between = (high[axis] - low[axis]) / lattice.cell[axis];
        if body.sides[axis].iter().all(|side| *side != Hold::Free) && between < BETWEEN_SIDES {
            return Err(format!(
                "expected at least {BETWEEN_SIDES} cells between two constrained sides of `{}`, found {between:.3}: with \
                 fewer cells both sides act on the same nodes, which adds energy",
                body.name
            ));
        }
    }
    let critical = scene.crossing_time(cell);
    let Duration::Seconds(time) = scene.duration else {
        return Err("expected a duration in seconds".to_owned());
    };
    // The number of steps is whole; the tolerance prevents rounding from adding a step.
    let steps = (time / (courant * critical) * (1.0 - 1e-12)).ceil().max(1.0);
    let time_step = time / steps;
    let damped = scene.global_damping * time / steps;
    if damped >= 2.0 {
        return Err(format!("expected damping times time step below 2, found {damped}"));
    }
    let settling = scene.start.settle.map_or(0.0, |settle| settle.duration / time_step);
    match beyond_run(scene, time_step, steps).or_else(|| beyond_steps(settling)) {
        Some(refusal) => Err(refusal),
        None => Ok(Plan { lattice, points, time_step, steps: steps as u64, critical }),
    }
}

/// Returns a lattice with cells of about `cell` (m). Along periodic axes, the number of cells is whole.
///
/// Along periodic axes, nodes are on the faces of the domain. Along other axes, nodes are on the first fixed or
/// symmetry boundary, or at zero if there is none. The phase of the setting then shifts all nodes.
fn lattice(scene: &Scene, setting: &Setting, cell: f64) -> Lattice {
    let mut lattice = Lattice { cell: [cell; 3], inverse: [1.0 / cell; 3], origin: [0.0; 3], period: [None; 3] };
    for axis in 0..scene.dimension.count() {
        let held = scene.bodies.iter().find_map(|body| match body.shape {
            BlockShape::Box { low, .. } if body.sides[axis][0] != Hold::Free => Some(low[axis]),
            BlockShape::Box { high, .. } if body.sides[axis][1] != Hold::Free => Some(high[axis]),
            _ => None,
        });
        lattice.origin[axis] = held.unwrap_or(0.0);
        if let Some(domain) = scene.domain.filter(|domain| domain.periodic[axis]) {
            let length = domain.high[axis] - domain.low[axis];
            let count = (length / cell).round().max(4.0);
            (lattice.cell[axis], lattice.inverse[axis]) = (length / count, count / length);
            lattice.period[axis] = Some(count as i32);
            lattice.origin[axis] = domain.low[axis];
        }
        lattice.origin[axis] += setting.phase[axis] * lattice.cell[axis];
    }
    lattice
}

impl Solver for Mpm {
    fn name(&self) -> String {
        self.name.to_owned()
    }

    fn has_springs(&self) -> bool {
        false
    }

    fn deforms(&self) -> bool {
        true
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        self.run_from(scene, resolution, None, observer)
    }

    fn run_from(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        match scene.dimension {
            Dimension::Two => self.run_in::<Plane>(scene, resolution, from, observer),
            Dimension::Three => self.run_in::<Solid>(scene, resolution, from, observer),
        }
    }
}
