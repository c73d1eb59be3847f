//! Grains of one kind as a data file of LAMMPS.

use std::fmt::Write as _;

/// Density of M1 (kg/m³).
pub(super) const DENSITY_M1: f64 = 2500.0;
/// Half the edge of the box that is written (m): grains within 1 m are read, which the drum's middle shifts.
const HALF: f64 = 2.0;

/// Grains by their centres (m), of one diameter (m) and one density (kg/m³).
pub(super) fn atoms(centres: &[[f64; 3]], diameter: f64, density: f64) -> String {
    let mut text = format!("grains\n\n{} atoms\n1 atom types\n\n", centres.len());
    for axis in ["x", "y", "z"] {
        let _ = writeln!(text, "-{HALF} {HALF} {axis}lo {axis}hi");
    }
    text += "\nAtoms # sphere\n\n";
    for (number, [x, y, z]) in centres.iter().enumerate() {
        let _ = writeln!(text, "{} 1 {diameter} {density} {x} {y} {z}", number + 1);
    }
    text
}
