//! Quantities of a granular element as columns. Tables, image data, means and figures use the same list of columns.

use crate::element::Element;

/// Parameters that some quantities need in addition to the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grains {
    /// Mean diameter d (m) and mean density ρ (kg/m³) of the grains, if known.
    pub mean: Option<(f64, f64)>,
    /// Two axes (0 is x) of the plane for the angle between the principal axes of stress and strain rate.
    pub plane: [usize; 2],
}

/// A quantity of an element.
pub struct Column {
    /// Name in tables.
    pub name: &'static str,
    /// Description of the quantity, for summaries and figures.
    pub words: &'static str,
    /// SI unit in three dimensions; `1` for a dimensionless quantity.
    pub unit: &'static str,
    /// Function that returns the value; `None` if the value is unknown.
    pub of: fn(&Element, &Grains) -> Option<f64>,
}

fn velocity<const AXIS: usize>(element: &Element, _: &Grains) -> Option<f64> {
    Some(element.motion.velocity?[AXIS])
}

fn gradient<const ROW: usize, const COLUMN: usize>(element: &Element, _: &Grains) -> Option<f64> {
    Some(element.motion.gradient?[(ROW, COLUMN)])
}

/// Returns a component of the symmetric part of the stress.
fn stress<const ROW: usize, const COLUMN: usize>(element: &Element, _: &Grains) -> Option<f64> {
    element.stress.map(|stress| 0.5 * (stress[(ROW, COLUMN)] + stress[(COLUMN, ROW)]))
}

const fn column(
    name: &'static str,
    words: &'static str,
    unit: &'static str,
    value: fn(&Element, &Grains) -> Option<f64>,
) -> Column {
    Column { name, words, unit, of: value }
}

/// All quantities of an element.
pub const COLUMNS: [Column; 30] = [
    column("packing_fraction", "packing fraction φ", "1", |element, _| Some(element.packing_fraction)),
    column("sine_of_friction", "sine of friction angle", "1", |element, _| element.sine_of_friction()),
    column("drucker_prager", "Drucker and Prager's |T₀|/(√2 p)", "1", |element, _| element.drucker_prager()),
    column("shear_rate", "rate of shear |D₀|", "1/s", |element, _| element.shear_rate()),
    column("inertial_number", "inertial number |I₀|", "1", |element, grains| {
        let (diameter, density) = grains.mean?;
        element.inertial_number(diameter, density)
    }),
    column("pressure", "pressure p", "Pa", |element, _| element.pressure()),
    column("speed", "speed |v⁰|", "m/s", |element, _| element.motion.velocity.map(|velocity| velocity.norm())),
    column("residual_velocity", "velocity |v′| beside the fit", "m/s", |element, _| element.motion.residual),
    column("angle_of_largest", "angle between the axes of largest T and D", "deg", |element, grains| {
        element.coaxiality(grains.plane).map(|angles| angles.largest)
    }),
    column("angle_of_smallest", "angle between the axes of smallest T and D", "deg", |element, grains| {
        element.coaxiality(grains.plane).map(|angles| angles.smallest)
    }),
    column("turn_in_plane", "turn from T to D in the plane", "deg", |element, grains| {
        element.coaxiality(grains.plane)?.in_plane
    }),
    column("velocity_x", "mean velocity along x", "m/s", velocity::<0>),
    column("velocity_y", "mean velocity along y", "m/s", velocity::<1>),
    column("velocity_z", "mean velocity along z", "m/s", velocity::<2>),
    column("stress_xx", "stress T_xx", "Pa", stress::<0, 0>),
    column("stress_yy", "stress T_yy", "Pa", stress::<1, 1>),
    column("stress_zz", "stress T_zz", "Pa", stress::<2, 2>),
    column("stress_xy", "stress T_xy, symmetric part", "Pa", stress::<0, 1>),
    column("stress_yz", "stress T_yz, symmetric part", "Pa", stress::<1, 2>),
    column("stress_xz", "stress T_xz, symmetric part", "Pa", stress::<0, 2>),
    column("gradient_xx", "∂v_x/∂x", "1/s", gradient::<0, 0>),
    column("gradient_xy", "∂v_x/∂y", "1/s", gradient::<0, 1>),
    column("gradient_xz", "∂v_x/∂z", "1/s", gradient::<0, 2>),
    column("gradient_yx", "∂v_y/∂x", "1/s", gradient::<1, 0>),
    column("gradient_yy", "∂v_y/∂y", "1/s", gradient::<1, 1>),
    column("gradient_yz", "∂v_y/∂z", "1/s", gradient::<1, 2>),
    column("gradient_zx", "∂v_z/∂x", "1/s", gradient::<2, 0>),
    column("gradient_zy", "∂v_z/∂y", "1/s", gradient::<2, 1>),
    column("gradient_zz", "∂v_z/∂z", "1/s", gradient::<2, 2>),
    column("members", "grains or points whose centre is there", "1", |element, _| Some(element.motion.members as f64)),
];
