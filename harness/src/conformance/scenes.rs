//! Scenes of the conformance suite, written as scene files.

use grainbench_scene::dimension::Dimension;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use std::path::Path;

/// Scene with a name for its results.
pub(super) struct NamedScene {
    pub(super) name: &'static str,
    pub(super) scene: Scene,
    /// True if the grains have friction and exert torques on each other.
    pub(super) frictional: bool,
}

/// Scene in which one disc collides with four nearby discs. About six oblique contacts open and close during the run.
///
/// Masses are about 1 kg and k = 1e4 N/m, so a contact lasts about 20 ms and overlaps are about 0.01 of the radius. The
/// moduli of deformable grains are about 1e4 Pa.
const COLLISION_2D: &str = r#"
title = "A disc runs into four"
dimension = 2
duration = 0.3
output.snapshots = 29
[materials.m]
density = 0.3183098861837907
bulk_modulus = 1.0e4
shear_modulus = 6.0e3
[grains.runner]
material = "m"
radius = 1.0
position = [-2.10, 0.35]
velocity = [1.5, 0.1]
spin = 2.0
[grains.near]
material = "m"
radius = 1.1
position = [0.0, 0.0]
velocity = [-0.2, 0.05]
spin = -0.5
[grains.high]
material = "m"
radius = 0.9
position = [1.43, 1.42]
velocity = [0.0, -0.1]
[grains.low]
material = "m"
radius = 0.8
position = [1.36, -1.36]
velocity = [0.05, 0.0]
spin = 1.0
[grains.far]
material = "m"
radius = 1.0
position = [2.90, 0.05]
velocity = [-0.3, 0.02]
"#;

/// Scene of [`COLLISION_2D`] with spheres in three dimensions.
const COLLISION_3D: &str = r#"
title = "A sphere runs into four"
dimension = 3
duration = 0.3
output.snapshots = 29
[materials.m]
density = 0.238732414637843
bulk_modulus = 1.0e4
shear_modulus = 6.0e3
[grains.runner]
material = "m"
radius = 1.0
position = [-2.08, 0.35, -0.2]
velocity = [1.5, 0.1, 0.05]
spin = [0.5, -1.0, 2.0]
[grains.near]
material = "m"
radius = 1.1
position = [0.0, 0.0, 0.0]
velocity = [-0.2, 0.05, -0.05]
spin = [0.3, 0.2, -0.5]
[grains.high]
material = "m"
radius = 0.9
position = [1.41, 1.40, 0.3]
velocity = [0.0, -0.1, 0.0]
spin = [0.1, 0.0, 0.4]
[grains.low]
material = "m"
radius = 0.8
position = [1.34, -1.34, -0.3]
velocity = [0.05, 0.0, 0.1]
spin = [-0.7, 0.2, 1.0]
[grains.far]
material = "m"
radius = 1.0
position = [2.88, 0.05, 0.1]
velocity = [-0.3, 0.02, 0.0]
spin = [0.2, 0.6, 0.1]
"#;

const SPRINGS: &str = "\n[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e4\n";
const FRICTION: &str =
    "tangential_stiffness = 5.0e3\nfriction = 0.4\nnormal_damping = 10.0\ntangential_damping = 5.0\n";

/// Scene of two grains that never come into contact. Their stiffness determines the critical time step.
const FLIGHT_2D: &str = "title = 'Two discs fly apart'\ndimension = 2\nduration = 1.0\n\
  materials.m = { density = 0.3183098861837907, bulk_modulus = 1e4, shear_modulus = 6e3 }\n\
    [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [-2.0, 0.3]\nvelocity = [-1.7, 0.9]\nspin = 3.1\n\
    [grains.b]\nmaterial = 'm'\nradius = 0.7\nposition = [2.0, -0.4]\nvelocity = [1.1, 0.3]\nspin = -1.3\n";
const FLIGHT_3D: &str = "title = 'Two spheres fly apart'\ndimension = 3\nduration = 1.0\n\
  materials.m = { density = 0.238732414637843, bulk_modulus = 1e4, shear_modulus = 6e3 }\n\
    [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [-2.0, 0.3, 0.1]\nvelocity = [-1.7, 0.9, 0.4]\n\
      spin = [1.1, 0.3, 3.1]\n\
    [grains.b]\nmaterial = 'm'\nradius = 0.7\nposition = [2.0, -0.4, 0.2]\nvelocity = [1.1, 0.3, -0.6]\n\
      spin = [0.0, 0.5, -1.3]\n";

/// Scene of a grain compressed between two planes. The grain oscillates, also in rotation, and never loses contact.
const HELD_2D: &str = "title = 'A disc held by two walls'\ndimension = 2\nduration = 0.2\n\
  materials.m = { density = 0.3183098861837907, bulk_modulus = 1e4, shear_modulus = 6e3 }\n\
    [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.99]\nvelocity = [0.3, 0.4]\nspin = 0.5\n\
    [walls.low]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
    [walls.high]\nmaterial = 'm'\nplane = { point = [0.0, 1.98], normal = [0.0, -1.0] }\n";
const HELD_3D: &str = "title = 'A sphere held by two walls'\ndimension = 3\nduration = 0.2\n\
  materials.m = { density = 0.238732414637843, bulk_modulus = 1e4, shear_modulus = 6e3 }\n\
    [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0, 0.99]\nvelocity = [0.3, -0.2, 0.4]\n\
      spin = [0.1, 0.5, 0.0]\n\
    [walls.low]\nmaterial = 'm'\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
    [walls.high]\nmaterial = 'm'\nplane = { point = [0.0, 0.0, 1.98], normal = [0.0, 0.0, -1.0] }\n";
/// Contact with friction so high that it never slips. There are no dashpots: their force lags by half a time step in every
/// code we know, which is an error of first order.
const ROUGH: &str = "tangential_stiffness = 5.0e3\nfriction = 100.0\n";

/// Builds a scene from the parts of a scene file. `frictional` states that grains exert torques on each other.
pub(super) fn scene_of(name: &'static str, parts: &[&str], frictional: bool) -> Result<NamedScene, SceneError> {
    let source = SceneSource::from_text(&format!("conformance/{name}"), Path::new(""), &parts.concat());
    Ok(NamedScene { name, scene: source.scene(&grainbench_scene::resolve::no_data_file)?, frictional })
}

/// Returns collisions in free space in two and three dimensions, without friction or with friction and dashpots.
pub(super) fn collisions() -> Result<Vec<NamedScene>, SceneError> {
    Ok(vec![
        scene_of("2d", &[COLLISION_2D, SPRINGS], false)?,
        scene_of("2d-friction", &[COLLISION_2D, SPRINGS, FRICTION], true)?,
        scene_of("3d", &[COLLISION_3D, SPRINGS], false)?,
        scene_of("3d-friction", &[COLLISION_3D, SPRINGS, FRICTION], true)?,
    ])
}

/// Returns scenes of free flight with and without gravity. Two have friction, so that solvers integrate the spin.
pub(super) fn flights() -> Result<Vec<NamedScene>, SceneError> {
    let mut all = vec![
        scene_of("2d", &[FLIGHT_2D, SPRINGS], false)?,
        scene_of("3d-friction", &[FLIGHT_3D, SPRINGS, FRICTION], true)?,
        scene_of("2d-friction-gravity", &[FLIGHT_2D, SPRINGS, FRICTION], true)?,
        scene_of("3d-gravity", &[FLIGHT_3D, SPRINGS], false)?,
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
    let mut all = vec![
        scene_of("held-2d", &[HELD_2D, SPRINGS], false)?,
        scene_of("held-2d-friction", &[HELD_2D, SPRINGS, ROUGH], true)?,
        scene_of("held-3d", &[HELD_3D, SPRINGS], false)?,
        scene_of("held-3d-friction", &[HELD_3D, SPRINGS, ROUGH], true)?,
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

/// Returns true for a two-dimensional scene.
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
