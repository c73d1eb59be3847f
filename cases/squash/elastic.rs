//! Two elastic discs: force at the walls, frequency of free vibration and apparent spring stiffness.
//!
//! The walls move in by d = 0.01 R and stop. By symmetry, the plane between the discs acts as another wall, and the
//! diameter of each disc is shortened by d. A rigid disc on springs k_n has the wall force F = (2/3) k_n d and ω² = 3
//! k_n/m. An elastic disc has F(d) in closed form. During vibration, the force at one contact increases by as much as
//! it decreases at the opposite contact. The disc's mean moves by x, where ΔF (u + v)/(πE') = x. Hence ω² = 2πE'/(m (u
//! + v)), reduced by the added mass of the deformation.

use crate::rows::elastic::{DiscDisplacements, PressedDisc};
use crate::rows::ringing::{FreeVibration, VibrationParameters};
use grainbench_harness::prelude::*;

/// Discs of E' = 16 Pa, ν = 1/4, with the mass of the example and a period of vibration of about 1.6 s.
pub(super) const DISCS: FreeVibration = FreeVibration {
    variant: PLAIN,
    column: "A.normal_force",
    moduli: [10.0, 6.0],
    squeeze: 0.01,
    ramp: 1.2,
    time: 17.2,
    sample: 0.02,
    cells: 8.0,
    fine: 32.0,
    exact: |scene, squeeze| {
        let disc = PressedDisc::from_scene(scene, 2)?;
        let force = disc.force(squeeze);
        let DiscDisplacements { u, v, .. } = disc.gives(force);
        let restoring = 2.0 * PI * disc.modulus / (u + v);
        // Each disc has half of the springs between the discs. With equal forces at both contacts, the relative
        // increase of the compliance is (1 + 1/2)/2², divided by (u + v)/2.
        let stirred = disc.stirred([1.0, -1.0, 0.0, 0.0]) / (u + v).powi(2);
        Some(VibrationParameters { force, restoring, stirred, patch: disc.patch(force), share: 0.75 / (u + v) })
    },
    springs: 3.0,
    share: 2.0 / 3.0,
    source: "Johnson, Contact Mechanics, §5.6: a cylinder between two flats (derivation)",
    allowed: 0.15,
    because: "contact areas .8 of a cell wide, with springs as soft as .4 cells of material",
};

pub(super) fn figure(runner: &Runner) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for (name, run) in [("mpm, elastic discs", DISCS.discs(DISCS.cells)), ("dem, k_n = 3F/2d", DISCS.rigid())] {
        let done = runner.run(&run)?;
        let unit = DISCS.exact(&done).map_or(1.0, |rung| rung.force);
        let force = samples(&done, DISCS.column).unwrap_or_default().into_iter();
        let points = force.map(|(time, force)| (time, force / unit)).collect();
        curves.push(Curve::new(name, Stroke::Line, points));
    }
    Ok(Figure::graph(
        "elastic",
        "Force at the wall: elastic discs and rigid discs on springs",
        "The walls move inwards by d = 0.01 R and stop. The spring k_n = 3F/2d gives the static force F of elastic \
         discs, which is known in closed form. Elastic discs vibrate faster than rigid discs on springs.",
        [Axis::linear("time t (s)"), Axis::linear("force / F")],
        curves,
    ))
}
