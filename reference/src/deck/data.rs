//! Data file with the initial state of the grains.

use std::fmt::Write as _;

use grainbench_scene::scene::Scene;
use grainbench_solver::record::GrainState;
use grainbench_solver::record::bounds;
use nalgebra::Vector3;

use super::outline::is_flat;
use super::script::heading;

/// Returns the lower and upper corner of the simulation box (m). Periodic axes have the bounds of the scene. Along
/// other axes, a margin of four radii of the largest grain surrounds the grains.
///
/// The programs enlarge the box if grains reach its sides. They do not make it smaller, because neighbour lists need
/// some room.
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

/// Returns true for each axis that is periodic in the deck. In two dimensions the programs require that z is periodic.
fn periodic(scene: &Scene) -> [bool; 3] {
    let [x, y, z] = scene.domain.map_or([false; 3], |domain| domain.periodic);
    [x, y, z || is_flat(scene)]
}

/// Returns the data file with `types` atom types. `density` computes a density (kg/m³) from mass (kg) and radius (m),
/// such that the program obtains the mass of the grain.
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

/// Returns the density (kg/m³) of a sphere with a given mass (kg) and radius (m).
pub(crate) fn of_sphere(mass: f64, radius: f64) -> f64 {
    mass / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3))
}

/// Returns the density (kg/m³) of a disc with a given mass (kg) and radius (m) and a depth of 1 m.
pub(crate) fn of_disc(mass: f64, radius: f64) -> f64 {
    mass / (std::f64::consts::PI * radius * radius)
}

/// Returns the skin of the neighbour lists (m), a tenth of the largest diameter.
pub(crate) fn skin(scene: &Scene) -> f64 {
    0.2 * largest_radius(scene)
}

/// Returns the `boundary` command. `otherwise` is the style of axes that are not periodic.
pub(crate) fn boundary(scene: &Scene, otherwise: &str) -> String {
    let words = periodic(scene).map(|periodic| if periodic { "p" } else { otherwise });
    format!("boundary {}", words.join(" "))
}

/// Boundary style: the box grows to hold all grains.
pub(crate) const GROWING: &str = "m";
