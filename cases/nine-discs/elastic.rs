//! Nine elastic discs: contact force at rest, frequency of free vibration, and apparent spring stiffness.
//!
//! There is no friction. The walls move in by d = 0.01 R and stop: a row of three diameters is shortened by 2d in both
//! directions. Rigid discs on springs k_n have the force k_n d/2 at all contacts and ω² = 2 k_n/m. Elastic discs have
//! the force F(2d/3) in closed form. Their means vibrate against a wall and against a neighbour (derivation): ω² =
//! 3πE'/(m (2u + v − w²/(2(u − v)))), reduced by the added mass of their deformation.

use crate::rows::elastic::{DiscDisplacements, PressedDisc};
use crate::rows::ringing::{FreeVibration, VibrationParameters};
use std::f64::consts::PI;

/// Discs of E' = 1.6 GPa, ν = 1/4, with a period of vibration of about 0.5 s.
pub(super) const DISCS: FreeVibration = FreeVibration {
    variant: "kappa-0",
    column: "wall-edge.normal_force",
    moduli: [1.0e9, 0.6e9],
    squeeze: 0.5,
    ramp: 0.4,
    time: 5.4,
    sample: 0.01,
    cells: 12.0,
    fine: 24.0,
    exact: |scene, squeeze| {
        let disc = PressedDisc::from_scene(scene, 4)?;
        let force = disc.force(2.0 / 3.0 * squeeze);
        let DiscDisplacements { u, v, w } = disc.gives(force);
        let compliance = 2.0 * u + v - w * w / (2.0 * (u - v));
        let restoring = 3.0 * PI * disc.modulus / compliance;
        // A unit net force displaces a disc by x. `outer` and `middle` are the forces at wall and neighbour, in outer
        // rows and in middle rows.
        let x = compliance / 3.0;
        let inner = (x - (u - 0.5 * w)) / (u - v - w);
        let differs = -w / (2.0 * (u - v));
        let (outer, middle) = ([inner + 1.0, inner], [inner + 1.0 + differs, inner + differs]);
        let edge = disc.stirred([middle[0], middle[1], outer[1], outer[1]]);
        let corner = disc.stirred([outer[0], outer[1], outer[0], outer[1]]);
        let centre = disc.stirred([middle[1]; 4]);
        // Four edge discs move along one axis, four corner discs along both.
        let stirred = (4.0 * (edge + corner) + centre) / (12.0 * x * x);
        // The force at the neighbour is half of the force at the wall. With these forces f, the relative increase of
        // the compliance is Σf²/(Σf)² = (1 + 1/4)/(3/2)², divided by compliance/3.
        Some(VibrationParameters { force, restoring, stirred, patch: disc.patch(force), share: 5.0 / 3.0 / compliance })
    },
    springs: 2.0,
    share: 0.5,
    source: "Johnson, Contact Mechanics, §5.6: a cylinder between two flats, with the transverse pair of forces \
             (derivation)",
    allowed: 0.15,
    because: "contact areas one cell wide, with springs as soft as .4 cells of material",
};
