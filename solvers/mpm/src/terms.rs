//! Conformance properties of the method for each setting. Their limits are weaker than those of solvers without a grid.

use crate::options::Contact;
use crate::solver::Mpm;
use grainbench_scene::solver::Resolution;
use grainbench_scene::terms::{Limitation, Terms};

const ANGULAR: &str = "mass is lumped at nodes, and what a point hands on is at its node and not where the point is: angular \
                       momentum is kept to second order in the cell";
const GRID_AT_REST: &str = "the grid rests: a body that moves through it meets its cells otherwise, and is resolved by two \
                            cells a radius here";
const GRID_HAS_AXES: &str = "the grid has axes: a body that is turned stands otherwise on its cells, of which two make a radius \
                             here";
const SPINNING: &str = "a spinning body is held together by stresses, which swing; at two cells a radius, and as it turns its \
                        points pass from cell to cell";
const NO_AFFINE_PART: &str = "points hand on a velocity and no spin: what turns within a cell is lost to the grid, a seventh \
                              of it at two cells a radius";
const KINK: &str = "hat functions have a kink at nodes: a point on the face between two cells is given the slope of one side, \
                    and its mirror image that of the other";
const OWN_NORMALS: &str = "each body is stopped along a normal of its own, so that what two bodies give each other is not \
                           opposite: the papers' contact loses momentum where more than two meet or surfaces are coarse";

const OPPOSED: &str = "each body is stopped along a normal of its own, before it touches: impulses that are not opposite add \
                       energy where several bodies meet";

const fn less(property: &'static str, quantity: &'static str, at_most: f64, because: &'static str) -> Limitation {
    Limitation { property, quantity, at_most, because }
}

/// Limits with spins of points and quadratic splines.
const BEST: &[Limitation] = &[
    less("momentum", "angular", 1e-3, ANGULAR),
    less("galilean-invariance", "", 0.1, GRID_AT_REST),
    less("rotation-invariance", "", 0.05, GRID_HAS_AXES),
    less("free-flight", "", 1e-3, SPINNING),
];

/// Limits with hat functions.
const HATS: &[Limitation] = &[
    less("momentum", "angular", 0.1, ANGULAR),
    less("galilean-invariance", "", 0.8, GRID_AT_REST),
    less("mirror-invariance", "", 0.01, KINK),
    less("rotation-invariance", "", 0.8, GRID_HAS_AXES),
    less("free-flight", "", 0.2, NO_AFFINE_PART),
    less("objectivity", "size", 2e-3, NO_AFFINE_PART),
    less("objectivity", "spin", 0.5, NO_AFFINE_PART),
];

/// Limits with hat functions and the contacts of the original papers.
const PAPERS: &[Limitation] = &[
    less("momentum", "momentum", 0.6, OWN_NORMALS),
    less("momentum", "angular", 1.0, OWN_NORMALS),
    less("galilean-invariance", "", 0.8, GRID_AT_REST),
    less("mirror-invariance", "", 0.3, KINK),
    less("rotation-invariance", "", 0.8, GRID_HAS_AXES),
    less("free-flight", "", 0.2, NO_AFFINE_PART),
    less("objectivity", "size", 2e-3, NO_AFFINE_PART),
    less("objectivity", "spin", 0.5, NO_AFFINE_PART),
    less("passivity", "energy gained, largest of the run", 1.5, OPPOSED),
];

impl Mpm {
    /// Returns the conformance properties at two cells per radius.
    ///
    /// There is no order in the time step, because the error of the grid is larger.
    #[must_use]
    pub fn terms(&self) -> Terms {
        let less = match self.setting.contact {
            _ if *self == Self::BEST => BEST,
            Contact::Kinematic | Contact::Traction => PAPERS,
            _ => HATS,
        };
        Terms::at(Resolution::grid(2.0, 2)).owing_less(less)
    }
}
