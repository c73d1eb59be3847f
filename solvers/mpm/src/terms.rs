//! Conformance properties of the method for each setting. Their limits are weaker than the limits for solvers without a
//! grid.

use crate::options::Contact;
use crate::solver::Mpm;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::terms::{Limitation, Terms};

const ANGULAR: &str = "mass is lumped at the nodes, so the momentum of a point acts at nodes and not at the point: \
                       angular momentum is conserved to second order in the cell size";
const GRID_AT_REST: &str = "the grid is at rest, so a moving body has other positions relative to its cells; here the \
                            resolution is two cells per radius";
const GRID_HAS_AXES: &str = "the grid has axes, so a rotated body has another orientation relative to its cells; here \
                             the resolution is two cells per radius";
const SPINNING: &str = "the stresses that hold a spinning body together vibrate, and its points cross cells as it \
                        rotates; here the resolution is two cells per radius";
const NO_AFFINE_PART: &str = "points transfer a velocity and no spin to the grid, so the rotation within a cell is \
                              lost: a seventh of the spin at two cells per radius";
const KINK: &str = "hat functions have a kink at nodes: a point on the face between two cells gets the slope of one \
                    side, and its mirror image gets the slope of the opposite side";
const OWN_NORMALS: &str = "each body is stopped along its own normal, so the impulses of two bodies are not opposite: \
                           the contact of the papers loses momentum if more than two bodies meet or surfaces are \
                           coarse";

const OPPOSED: &str = "each body is stopped along its own normal before surfaces touch: impulses that are not opposite \
                       add energy if several bodies meet";

/// Limits for points with spin and quadratic splines.
const BEST: &[Limitation] = &[
    Limitation::new("momentum", "angular", 1e-3, ANGULAR),
    Limitation::new("galilean-invariance", "", 0.1, GRID_AT_REST),
    Limitation::new("rotation-invariance", "", 0.05, GRID_HAS_AXES),
    Limitation::new("free-flight", "", 1e-3, SPINNING),
];

/// Limits for hat functions.
const HATS: &[Limitation] = &[
    Limitation::new("momentum", "angular", 0.1, ANGULAR),
    Limitation::new("galilean-invariance", "", 0.8, GRID_AT_REST),
    Limitation::new("mirror-invariance", "", 0.01, KINK),
    Limitation::new("rotation-invariance", "", 0.8, GRID_HAS_AXES),
    Limitation::new("free-flight", "", 0.2, NO_AFFINE_PART),
    Limitation::new("objectivity", "size", 2e-3, NO_AFFINE_PART),
    Limitation::new("objectivity", "spin", 0.5, NO_AFFINE_PART),
];

/// Limits for hat functions with the contacts of the original papers.
const PAPERS: &[Limitation] = &[
    Limitation::new("momentum", "momentum", 0.6, OWN_NORMALS),
    Limitation::new("momentum", "angular", 1.0, OWN_NORMALS),
    Limitation::new("galilean-invariance", "", 0.8, GRID_AT_REST),
    Limitation::new("mirror-invariance", "", 0.3, KINK),
    Limitation::new("rotation-invariance", "", 0.8, GRID_HAS_AXES),
    Limitation::new("free-flight", "", 0.2, NO_AFFINE_PART),
    Limitation::new("objectivity", "size", 2e-3, NO_AFFINE_PART),
    Limitation::new("objectivity", "spin", 0.5, NO_AFFINE_PART),
    Limitation::new("passivity", "energy gained, largest of the run", 1.5, OPPOSED),
];

impl Mpm {
    /// Returns the conformance properties at two cells per radius.
    ///
    /// They contain no order of convergence in the time step, because the error of the grid is larger.
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
