//! Boundaries with prescribed motion: walls, fixed or symmetry boundaries, and driven bodies.

pub(crate) mod driven;
pub(crate) mod held;
pub(crate) mod walls;

use crate::boundary::driven::DrivenGroups;
use crate::boundary::held::FixedBoundaries;
use crate::boundary::walls::RigidPlane;
use crate::grid::lattice::Lattice;
use crate::grid::nodes::Grid;
use crate::points::body::Body;
use crate::points::state::State;
use grainbench_scene::scene::Scene;
use grainbench_solver::space::Space;

/// Walls, fixed or symmetry boundaries of bodies, and driven bodies.
#[derive(Clone, Debug)]
pub(crate) struct Boundary<S: Space> {
    pub(crate) walls: Vec<RigidPlane<S>>,
    pub(crate) held: FixedBoundaries,
    pub(crate) driven: DrivenGroups<S>,
}

impl<S: Space> Boundary<S> {
    pub(crate) fn new(scene: &Scene, bodies: &[Body], lattice: &Lattice) -> Self {
        Self {
            walls: scene.walls.iter().filter_map(RigidPlane::new).collect(),
            held: FixedBoundaries::new(bodies, lattice),
            driven: DrivenGroups::new(scene),
        }
    }

    /// Moves walls to their positions at `time` (s). During relaxation the walls rest at their initial positions.
    pub(crate) fn move_walls(&mut self, time: f64, time_step: f64, settling: bool) {
        for wall in &mut self.walls {
            wall.force = S::ORIGIN;
            wall.move_to(if settling { 0.0 } else { time }, time_step);
            if settling {
                wall.stop();
            }
        }
    }

    /// Converts projected momenta to velocities that satisfy the boundary conditions.
    pub(crate) fn hold_projected(&self, state: &State<S>, grid: &mut Grid<S>) {
        self.held.fold_projected::<S>(&state.bodies, &mut grid.projected);
        grid.divide_projected(state);
        self.held.hold_projected::<S>(&state.bodies, &mut grid.projected);
        self.driven.hold_projected(&mut grid.projected, &grid.nodes);
    }
}
