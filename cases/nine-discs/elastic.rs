//! The discs as elastic bodies: contact force at rest, the frequency at which they ring, and the spring that they show.
//!
//! Without friction. The walls move in by d = .01 R and stop; a row of three diameters is shortened by 2d, with as much
//! across. Rigid discs on springs k_n have the force k_n d/2 everywhere and ring with ω² = 2 k_n/m. Elastic ones have
//! F(2d/3) in closed form; half of a diameter's compliance lies at each of its contacts, a whole one between two discs,
//! so that ω² = 3 (dF/dδ)/m.

use crate::rows::elastic::Pressed;
use crate::rows::ringing::Ringing;

/// Discs of E' = 1.6 GPa, ν = 1/4, whose ringing has periods of some .5 s.
pub(super) const DISCS: Ringing = Ringing {
    variant: "kappa-0",
    column: "wall-edge.normal_force",
    moduli: [1.0e9, 0.6e9],
    squeeze: 0.5,
    ramp: 0.4,
    time: 5.4,
    sample: 0.01,
    cells: 6.0,
    exact: |scene, squeeze| {
        let force = Pressed::of(scene, 4)?.force(2.0 / 3.0 * squeeze);
        // A disc that rings between two others is pressed on by one as much as it is let go by the other, and does not
        // widen.
        Some((force, Pressed::of(scene, 2)?.stiffness(force)))
    },
    diameters: 3.0,
    springs: 2.0,
    share: 0.5,
    source: "Johnson, Contact Mechanics, §5.6: a cylinder between two flats, with the pair across (derivation)",
    allowed: [0.15, 0.05],
    because: "patches of a quarter of a cell, on springs as soft as .4 cells of material",
};
