//! Scenes of the conformance suite, written as scene files.

use grainbench_scene::dimension::Dimension;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;

/// Scene with a name for its results.
pub(super) struct NamedScene {
    pub(super) name: &'static str,
    pub(super) scene: Scene,
    /// True if the grains have friction and exert torques on each other.
    pub(super) frictional: bool,
}

/// Grain of a scene: name, radius (m), position (m), velocity (m/s) and spin (rad/s).
type Row = (&'static str, f64, &'static [f64], &'static [f64], &'static [f64]);

/// One disc that collides with four nearby discs. About six oblique contacts open and close during the run.
///
/// Masses are about 1 kg and k = 1e4 N/m, so a contact lasts about 20 ms and overlaps are about 0.01 of the radius. The
/// moduli of deformable grains are about 1e4 Pa.
const COLLIDING_DISCS: [Row; 5] = [
    ("runner", 1.0, &[-2.10, 0.35], &[1.5, 0.1], &[2.0]),
    ("near", 1.1, &[0.0, 0.0], &[-0.2, 0.05], &[-0.5]),
    ("high", 0.9, &[1.43, 1.42], &[0.0, -0.1], &[0.0]),
    ("low", 0.8, &[1.36, -1.36], &[0.05, 0.0], &[1.0]),
    ("far", 1.0, &[2.90, 0.05], &[-0.3, 0.02], &[0.0]),
];

/// Grains as in [`COLLIDING_DISCS`], in three dimensions.
const COLLIDING_SPHERES: [Row; 5] = [
    ("runner", 1.0, &[-2.08, 0.35, -0.2], &[1.5, 0.1, 0.05], &[0.5, -1.0, 2.0]),
    ("near", 1.1, &[0.0, 0.0, 0.0], &[-0.2, 0.05, -0.05], &[0.3, 0.2, -0.5]),
    ("high", 0.9, &[1.41, 1.40, 0.3], &[0.0, -0.1, 0.0], &[0.1, 0.0, 0.4]),
    ("low", 0.8, &[1.34, -1.34, -0.3], &[0.05, 0.0, 0.1], &[-0.7, 0.2, 1.0]),
    ("far", 1.0, &[2.88, 0.05, 0.1], &[-0.3, 0.02, 0.0], &[0.2, 0.6, 0.1]),
];

/// Two grains that never come into contact. Their stiffness determines the critical time step.
const FLYING_DISCS: [Row; 2] =
    [("a", 1.0, &[-2.0, 0.3], &[-1.7, 0.9], &[3.1]), ("b", 0.7, &[2.0, -0.4], &[1.1, 0.3], &[-1.3])];
const FLYING_SPHERES: [Row; 2] = [
    ("a", 1.0, &[-2.0, 0.3, 0.1], &[-1.7, 0.9, 0.4], &[1.1, 0.3, 3.1]),
    ("b", 0.7, &[2.0, -0.4, 0.2], &[1.1, 0.3, -0.6], &[0.0, 0.5, -1.3]),
];

/// A grain compressed between two planes. The grain oscillates, also in rotation, and never loses contact.
const HELD_DISC: [Row; 1] = [("a", 1.0, &[0.0, 0.99], &[0.3, 0.4], &[0.5])];
const HELD_SPHERE: [Row; 1] = [("a", 1.0, &[0.0, 0.0, 0.99], &[0.3, -0.2, 0.4], &[0.1, 0.5, 0.0])];
const PLANES_2D: &str = "walls.low = { material = 'm', plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }\n\
    walls.high = { material = 'm', plane = { point = [0.0, 1.98], normal = [0.0, -1.0] } }\n";
const PLANES_3D: &str = "walls.low = { material = 'm', plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } }\n\
    walls.high = { material = 'm', plane = { point = [0.0, 0.0, 1.98], normal = [0.0, 0.0, -1.0] } }\n";

const SPRINGS: &str = "[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e4\n";
const FRICTION: &str =
    "tangential_stiffness = 5.0e3\nfriction = 0.4\nnormal_damping = 10.0\ntangential_damping = 5.0\n";
/// Contact with friction so high that it never slips. There are no dashpots: their force lags by half a time step in every
/// code we know, which is an error of first order.
const ROUGH: &str = "tangential_stiffness = 5.0e3\nfriction = 100.0\n";

/// Returns the first part of a scene file: grains of one material, with masses of about 1 kg.
fn grains(title: &str, duration: f64, rows: &[Row]) -> String {
    let dimension = rows[0].2.len();
    let density = if dimension == 2 { 1.0 } else { 0.75 } / std::f64::consts::PI;
    let mut text = format!(
        "title = '{title}'\ndimension = {dimension}\nduration = {duration:?}\n\
         materials.m = {{ density = {density:?}, bulk_modulus = 1e4, shear_modulus = 6e3 }}\n"
    );
    for (name, radius, position, velocity, spin) in rows {
        let spin = if let [rate] = spin { format!("{rate:?}") } else { format!("{spin:?}") };
        text += &format!(
            "grains.{name} = {{ material = 'm', radius = {radius:?}, position = {position:?}, velocity = {velocity:?}, \
             spin = {spin} }}\n"
        );
    }
    text
}

/// Builds a scene from the parts of a scene file. `frictional` states that grains exert torques on each other.
pub(super) fn scene_of(name: &'static str, parts: &[&str], frictional: bool) -> Result<NamedScene, SceneError> {
    Ok(NamedScene { name, scene: Scene::from_text(&format!("conformance/{name}"), &parts.concat())?, frictional })
}

/// Returns collisions in free space in two and three dimensions, without friction or with friction and dashpots.
pub(super) fn collisions() -> Result<Vec<NamedScene>, SceneError> {
    let discs = grains("A disc runs into four", 0.3, &COLLIDING_DISCS) + "output.snapshots = 29\n";
    let spheres = grains("A sphere runs into four", 0.3, &COLLIDING_SPHERES) + "output.snapshots = 29\n";
    Ok(vec![
        scene_of("2d", &[&discs, SPRINGS], false)?,
        scene_of("2d-friction", &[&discs, SPRINGS, FRICTION], true)?,
        scene_of("3d", &[&spheres, SPRINGS], false)?,
        scene_of("3d-friction", &[&spheres, SPRINGS, FRICTION], true)?,
    ])
}

/// Returns scenes of free flight with and without gravity. Two have friction, so that solvers integrate the spin.
pub(super) fn flights() -> Result<Vec<NamedScene>, SceneError> {
    let discs = grains("Two discs fly apart", 1.0, &FLYING_DISCS);
    let spheres = grains("Two spheres fly apart", 1.0, &FLYING_SPHERES);
    let mut all = vec![
        scene_of("2d", &[&discs, SPRINGS], false)?,
        scene_of("3d-friction", &[&spheres, SPRINGS, FRICTION], true)?,
        scene_of("2d-friction-gravity", &[&discs, SPRINGS, FRICTION], true)?,
        scene_of("3d-gravity", &[&spheres, SPRINGS], false)?,
    ];
    for named in &mut all[2..] {
        named.scene.gravity[named.scene.dimension.count() - 1] = -9.8;
    }
    Ok(all)
}

/// Returns scenes of smooth motion during ten critical time steps. A grain between two walls vibrates along the normal without
/// friction, or moves along the tangent with friction.
///
/// Friction and vibration together would reduce the order of convergence of a solver with the lever arm R − overlap/2. It
/// combines velocities at mid-step with lever arms at the end of the step, while the overlap changes. The resulting error is of
/// first order in the time step, and its coefficient is proportional to the overlap.
pub(super) fn held() -> Result<Vec<NamedScene>, SceneError> {
    let disc = grains("A disc held by two walls", 0.2, &HELD_DISC) + PLANES_2D;
    let sphere = grains("A sphere held by two walls", 0.2, &HELD_SPHERE) + PLANES_3D;
    let mut all = vec![
        scene_of("held-2d", &[&disc, SPRINGS], false)?,
        scene_of("held-2d-friction", &[&disc, SPRINGS, ROUGH], true)?,
        scene_of("held-3d", &[&sphere, SPRINGS], false)?,
        scene_of("held-3d-friction", &[&sphere, SPRINGS, ROUGH], true)?,
    ];
    for named in &mut all {
        if named.frictional {
            let normal = named.scene.dimension.count() - 1;
            named.scene.grains[0].velocity[normal] = 0.0;
        }
        named.scene.duration = grainbench_scene::scene::Duration::Seconds(10.0 * named.scene.critical_time_step());
    }
    Ok(all)
}

pub(super) fn flat(scene: &Scene) -> bool {
    scene.dimension == Dimension::Two
}

#[cfg(test)]
mod tests {
    /// Users never load these scenes, so a test must check them.
    #[test]
    fn every_scene_is_right() {
        for scenes in [super::collisions(), super::flights(), super::held()] {
            assert_eq!(scenes.unwrap().len(), 4);
        }
    }
}
