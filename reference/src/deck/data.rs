//! The data file: the grains at the start.

use std::fmt::Write as _;

use grainbench_scene::record::GrainState;
use grainbench_scene::record::bounds;
use grainbench_scene::scene::Scene;
use nalgebra::Vector3;

use super::heading;
use super::outline::is_flat;

/// Lower and upper corner of the box (m): the scene's along periodic axes, wide around its grains along others. It is
/// never made smaller than that, for neighbour lists need some room; it grows with the grains.
pub(crate) fn box_of(scene: &Scene) -> (Vector3<f64>, Vector3<f64>) {
    let states: Vec<GrainState> = (1..).zip(&scene.grains).map(|(id, grain)| GrainState::start(id, grain)).collect();
    let (mut low, mut high) = bounds(scene, &states);
    for state in &states {
        (low, high) = (low.inf(&state.position), high.sup(&state.position));
    }
    let periodic = periodic(scene);
    let room = 4.0 * largest_radius(scene);
    for axis in (0..3).filter(|&axis| !periodic[axis]) {
        low[axis] -= room;
        high[axis] += room;
    }
    (low, high)
}

fn largest_radius(scene: &Scene) -> f64 {
    scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max)
}

/// Which axes are periodic for the programs: z is so in the plane.
fn periodic(scene: &Scene) -> [bool; 3] {
    let [x, y, z] = scene.domain.map_or([false; 3], |domain| domain.periodic);
    [x, y, z || is_flat(scene)]
}

/// The data file, `types` types of atoms; `density` is what makes a grain's mass there.
pub(crate) fn data_file(
    scene: &Scene,
    types: usize,
    (low, high): (Vector3<f64>, Vector3<f64>),
    density: impl Fn(f64, f64) -> f64,
) -> String {
    let mut text = format!("{}\n\n{} atoms\n{types} atom types\n\n", heading(scene), scene.grains.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let _ = writeln!(text, "{:?} {:?} {name}lo {name}hi", low[axis], high[axis]);
    }
    text.push_str("\nAtoms\n\n");
    for (id, grain) in (1..).zip(&scene.grains) {
        let [x, y, z] = grain.position.into();
        let density = density(grain.mass, grain.radius);
        let (kind, diameter) = (grain.material + 1, 2.0 * grain.radius);
        let _ = writeln!(text, "{id} {kind} {diameter:?} {density:?} {x:?} {y:?} {z:?}");
    }
    text.push_str("\nVelocities\n\n");
    for (id, grain) in (1..).zip(&scene.grains) {
        let ([x, y, z], [wx, wy, wz]) = (<[f64; 3]>::from(grain.velocity), <[f64; 3]>::from(grain.spin));
        let _ = writeln!(text, "{id} {x:?} {y:?} {z:?} {wx:?} {wy:?} {wz:?}");
    }
    text
}

/// Density of a sphere (kg/m³).
pub(crate) fn of_sphere(mass: f64, radius: f64) -> f64 {
    mass / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3))
}

/// Density of a disc one metre deep (kg/m³).
pub(crate) fn of_disc(mass: f64, radius: f64) -> f64 {
    mass / (std::f64::consts::PI * radius * radius)
}

/// Skin of the neighbour lists (m): a tenth of the largest diameter.
pub(crate) fn skin(scene: &Scene) -> f64 {
    0.2 * largest_radius(scene)
}

/// The boundary of each axis: periodic, or another one.
pub(crate) fn boundary(scene: &Scene, otherwise: &str) -> String {
    let words = periodic(scene).map(|periodic| if periodic { "p" } else { otherwise });
    format!("boundary {}", words.join(" "))
}

/// A boundary that grows with the grains.
pub(crate) const GROWING: &str = "m";
