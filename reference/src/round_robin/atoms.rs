//! LAMMPS data file with grains of one type.

use std::fmt::Write as _;

/// Density of the material M1 (kg/m³).
pub(super) const DENSITY_M1: f64 = 2500.0;
/// Half the edge length of the written box (m). The box contains all grains: coordinates in the files are below 1 m,
/// and the centre of the drum is at most 0.102 m from the origin along each axis.
const HALF: f64 = 2.0;

/// Returns the numbers of a line, or `None` if a field is not a number with a magnitude below 1.
pub(super) fn coordinates<'l>(fields: impl Iterator<Item = &'l str>) -> Option<Vec<f64>> {
    fields.map(|field| field.parse().ok().filter(|number: &f64| number.abs() < 1.0)).collect()
}

/// Returns the data file of grains with given centres (m), equal diameters (m) and equal densities (kg/m³).
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
