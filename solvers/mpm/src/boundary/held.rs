//! Fixed or symmetry boundaries of boxes. Beyond such a side the body continues as its mirror image, so the side keeps
//! its position to the order of the basis functions. The side is moved to the nearest nodes.

use crate::grid::lattice::{Lattice, Node, Window};
use crate::points::body::Body;
use grainbench_scene::body::Hold;
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Side of a box that is a fixed or symmetry boundary.
#[derive(Clone, Copy, Debug)]
struct Side {
    body: usize,
    axis: usize,
    /// Index along the axis of the nodes on the side.
    node: i32,
    /// +1 if the body is on the upper side of the boundary along the axis, otherwise −1.
    inward: i32,
    /// True if tangential motion is fixed too.
    fixed: bool,
}

/// Fixed or symmetry boundaries of all bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct FixedBoundaries {
    sides: Vec<Side>,
}

impl FixedBoundaries {
    pub(crate) fn new(bodies: &[Body], lattice: &Lattice) -> Self {
        let mut sides = Vec::new();
        for (body, held) in bodies.iter().enumerate().filter_map(|(at, body)| Some((at, body.held?))) {
            let (holds, corners) = held;
            for axis in 0..3 {
                for end in 0..2 {
                    if holds[axis][end] != Hold::Free {
                        let node = ((corners[end][axis] - lattice.origin[axis]) / lattice.cell[axis]).round() as i32;
                        let inward = if end == 0 { 1 } else { -1 };
                        sides.push(Side { body, axis, node, inward, fixed: holds[axis][end] == Hold::Fixed });
                    }
                }
            }
        }
        Self { sides }
    }

    /// Adds the contribution of the mirror image to the inner nodes, before velocities are computed.
    ///
    /// The mirror image of gravity (m/s²) has the opposite direction along the normal. A mass m that is folded back
    /// from beyond a side needs the force m times mirrored gravity. Later, gravity acts on the full mass of the nodes,
    /// so the difference is added here.
    pub(crate) fn fold<S: Space>(&self, bodies: &[Body], nodes: &mut [Node<S>], gravity: S::Vector) {
        for side in &self.sides {
            let pull = side.mirrored::<S>(gravity) - gravity;
            side.each_beyond(&bodies[side.body].window, |beyond, inside| {
                let from = nodes[beyond];
                let to = &mut nodes[inside];
                to.mass += from.mass;
                to.velocity += side.mirrored::<S>(from.velocity);
                to.change += side.mirrored::<S>(from.change) + pull * from.mass;
                // If the node has mass, it gets the mass of its mirror image, so that points use its velocity.
                nodes[beyond].mass = if from.mass > 0.0 { nodes[inside].mass } else { 0.0 };
            });
        }
    }

    /// Adds the contribution of the mirror image to projected momenta.
    pub(crate) fn fold_projected<S: Space>(&self, bodies: &[Body], projected: &mut [S::Vector]) {
        for side in &self.sides {
            side.each_beyond(&bodies[side.body].window, |beyond, inside| {
                let from = side.mirrored::<S>(projected[beyond]);
                projected[inside] += from;
            });
        }
    }

    /// Sets the velocities of nodes on the sides and beyond them.
    pub(crate) fn hold<S: Space>(&self, bodies: &[Body], nodes: &mut [Node<S>]) {
        for side in &self.sides {
            let window = &bodies[side.body].window;
            side.each_on(window, |slot| {
                nodes[slot].velocity = side.kept::<S>(nodes[slot].velocity);
                nodes[slot].change = side.kept::<S>(nodes[slot].change);
            });
            side.each_beyond(window, |beyond, inside| {
                nodes[beyond].velocity = side.mirrored::<S>(nodes[inside].velocity);
                nodes[beyond].change = side.mirrored::<S>(nodes[inside].change);
            });
        }
    }

    /// Sets the projected velocities of nodes on the sides and beyond them.
    pub(crate) fn hold_projected<S: Space>(&self, bodies: &[Body], projected: &mut [S::Vector]) {
        for side in &self.sides {
            let window = &bodies[side.body].window;
            side.each_on(window, |slot| projected[slot] = side.kept::<S>(projected[slot]));
            side.each_beyond(window, |beyond, inside| projected[beyond] = side.mirrored::<S>(projected[inside]));
        }
    }
}

impl Side {
    /// Returns the mirror image of a vector. On a fixed side the tangential components are reversed too.
    fn mirrored<S: Space>(&self, vector: S::Vector) -> S::Vector {
        if self.fixed {
            return -vector;
        }
        let mut mirrored = S::embed(vector);
        mirrored[self.axis] = -mirrored[self.axis];
        S::restrict(mirrored)
    }

    /// Returns the unconstrained part of a velocity on the side.
    fn kept<S: Space>(&self, vector: S::Vector) -> S::Vector {
        if self.fixed {
            return S::ORIGIN;
        }
        let mut kept: Vector3<f64> = S::embed(vector);
        kept[self.axis] = 0.0;
        S::restrict(kept)
    }

    fn each_on(&self, window: &Window, visit: impl FnMut(usize)) {
        let on = self.node - window.low[self.axis];
        self.each_between(window, on, on + 1, visit);
    }

    /// Visits the nodes beyond the side with their mirror images, if both are in the window.
    fn each_beyond(&self, window: &Window, mut visit: impl FnMut(usize, usize)) {
        let (on, size) = (self.node - window.low[self.axis], window.size[self.axis]);
        let (from, to) = if self.inward > 0 { (0, on) } else { (on + 1, size) };
        // The mirror image must be in the window too.
        let (from, to) = (from.max(2 * on + 1 - size), to.min(2 * on + 1));
        self.each_between(window, from, to, |beyond| {
            let mut image = window.node(beyond - window.start);
            image[self.axis] = 2 * self.node - image[self.axis];
            visit(beyond, window.slot(image));
        });
    }

    /// Visits the nodes of a window in order, for indices `from..to` along the axis of the side.
    fn each_between(&self, window: &Window, from: i32, to: i32, mut visit: impl FnMut(usize)) {
        let [mut low, mut high] = [[0; 3], window.size];
        (low[self.axis], high[self.axis]) = (from.max(0), to.min(window.size[self.axis]));
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                for x in low[0]..high[0] {
                    visit(window.start + ((z * window.size[1] + y) * window.size[0] + x) as usize);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::options::{Basis, Setting, Transfer};
    use crate::simulation::Simulation;
    use crate::trial::prepared;
    use grainbench_solver::drive::Stepper;
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;

    /// Returns the first step of a box of 2 kg/m² on cells of 1 m. Its side on nodes is constrained.
    fn held(kind: &str, velocity: &str) -> Simulation<Plane> {
        let setting = Setting { basis: Basis::Quadratic, transfer: Transfer::Flip { pic: 0.0 }, ..Setting::BEST };
        let text = format!(
            "dimension = 2\nduration = 0.1\nreference_length = 1.0\n\
             materials.m = {{ density = 2.0, young_modulus = 1.0, poisson_ratio = 0.0 }}\n\
             [bodies.b]\nmaterial = 'm'\nbox = {{ low = [0.0, 0.0], high = [6.0, 8.0] }}\n{kind} = ['x-low']\n\
             velocity = {velocity}\n"
        );
        let (mut simulation, _) = prepared(setting, &text, 1.0, 2);
        simulation.begin().expect("it starts");
        simulation
    }

    /// Returns the simulation with the masses and momenta of its points on the nodes.
    fn scattered(kind: &str, velocity: &str) -> Simulation<Plane> {
        let mut simulation = held(kind, velocity);
        simulation.place_windows().expect("it fits");
        simulation.scatter();
        simulation
    }

    /// A box of 2 kg/m² on cells of 1 m moves at (3, 5) m/s before its side on nodes is constrained. Points are at
    /// quarters of cells, where the quadratic function of a node has the values N(¼) = 11/16, N(¾) = 9/32 and N(1¼) =
    /// 1/32.
    ///
    /// An inner node has the 2 kg of its cell. The node next to the side lacks ½ · 1/32 of this mass, which is at the
    /// node beyond the side. After folding, the node next to the side has the full mass and also the momentum of the
    /// mirror image. Its momentum along x is (1 − 1/32) of 2 · 3 kg m/s. Along y it is 2 · 5 kg m/s on a sliding side
    /// and (1 − 1/32) of this value on a fixed side.
    #[test]
    fn a_held_side_gives_nodes_the_mass_of_the_mirror_image() {
        for (kind, along) in [("sliding", 5.0), ("fixed", 5.0 * (1.0 - 1.0 / 32.0))] {
            let mut simulation = held(kind, "[3.0, 5.0]");
            simulation.cycle(false).expect("it holds together");
            let (lattice, window) = (simulation.grid.lattice, simulation.state.bodies[0].window);
            assert!(lattice.cell[0] == 1.0 && lattice.origin == [0.0; 3], "{lattice:?}");
            let node = |x: i32| simulation.grid.nodes[window.slot([x, 4, 0])];
            let on_side = if kind == "sliding" { Vector2::new(0.0, 5.0) } else { Vector2::zeros() };
            let beside = Vector2::new(3.0 * (1.0 - 1.0 / 32.0), along);
            let mirrored = if kind == "sliding" { Vector2::new(-beside.x, beside.y) } else { -beside };
            for (x, mass, velocity) in
                [(-1, 2.0, mirrored), (0, 1.0, on_side), (1, 2.0, beside), (2, 2.0, Vector2::new(3.0, 5.0))]
            {
                let found = node(x);
                assert!((found.mass - mass).abs() < 1e-13, "{kind}, node {x}: {} kg for {mass}", found.mass);
                assert!((found.velocity - velocity).norm() < 1e-13, "{kind}, node {x}: {:?}", found.velocity);
            }
        }
    }

    /// Projected momenta are folded before they are divided by the mass, which is folded already. The velocities equal
    /// those from folded momenta and masses.
    #[test]
    fn a_held_side_folds_momenta_before_they_are_divided() {
        for kind in ["sliding", "fixed"] {
            let mut simulation = scattered(kind, "[3.0, 5.0]");
            let Simulation { state, grid, boundary, .. } = &mut simulation;
            grid.project(state);
            boundary.held.fold(&state.bodies, &mut grid.nodes, Vector2::zeros());
            boundary.hold_projected(state, grid);
            let window = state.bodies[0].window;
            for x in 1..6 {
                let slot = window.slot([x, 4, 0]);
                let expected = grid.nodes[slot].velocity / grid.nodes[slot].mass;
                assert!((grid.projected[slot] - expected).norm() < 1e-14, "{kind}, {x}: {}", grid.projected[slot]);
            }
            let beside = grid.projected[window.slot([1, 4, 0])];
            assert!((beside.x - 3.0 * (1.0 - 1.0 / 32.0)).abs() < 1e-13, "{kind}: {beside}");
        }
    }

    /// The mirror image of gravity has the opposite direction. The node next to a side has 2 kg, of which 1/32 of half
    /// a cell is folded back from beyond the side. The force normal to the side is the weight of the remaining mass
    /// minus the weight of the folded mass. Along a sliding side the full weight acts.
    #[test]
    fn a_held_side_mirrors_gravity() {
        for (kind, along) in [("sliding", 7.0), ("fixed", 7.0 * (1.0 - 1.0 / 32.0))] {
            let mut simulation = scattered(kind, "[0.0, 0.0]");
            let Simulation { state, grid, boundary, .. } = &mut simulation;
            let gravity = Vector2::new(3.0, 7.0);
            boundary.held.fold(&state.bodies, &mut grid.nodes, gravity);
            let node = grid.nodes[state.bodies[0].window.slot([1, 4, 0])];
            let found = node.change / node.mass + gravity;
            let expected = Vector2::new(3.0 * (1.0 - 1.0 / 32.0), along);
            assert!((found - expected).norm() < 1e-13, "{kind}: {found}");
        }
    }
}
