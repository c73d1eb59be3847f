//! Closed sides for grains on springs.
//!
//! A side of the slab consists of cut grains with pores between them, through which other grains are pushed out. The
//! grid of the paper ends at the sides, so nothing passes there. Here, frictionless walls replace the end of the grid.
//! The cut grains at the sides overlap these walls from the start. They are therefore given copies of the materials
//! without a contact law with the walls.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::motion::Motion;
use grainbench_scene::scene::{Scene, Wall, WallShape};
use nalgebra::Vector3;

/// Adds walls at both sides, for all grains except those with prescribed motion.
pub(super) fn close(scene: &mut Scene) {
    let Some(domain) = scene.domain else { return };
    let count = scene.materials.len() as u16;
    // Materials: the original ones, one copy of each for grains with prescribed motion, and one for the walls.
    let side = 2 * count;
    let wrapped = |material: u16| material % count;
    let law = |a: u16, b: u16| -> Option<ContactLaw> {
        match (a == side, b == side) {
            (false, false) => scene.law(wrapped(a), wrapped(b)).copied(),
            (true, true) => None,
            _ => {
                let grain = a.min(b);
                let smooth = |law: &ContactLaw| ContactLaw { friction: 0.0, cohesion: 0.0, ..*law };
                (grain < count).then(|| scene.law(grain, grain).map(smooth)).flatten()
            }
        }
    };
    scene.laws = (0..=side).flat_map(|a| (0..=side).map(move |b| (a, b))).map(|(a, b)| law(a, b)).collect();
    scene.deformable = [&scene.deformable[..], &scene.deformable[..], &[None]].concat();
    let driven: Vec<String> = scene.materials.iter().map(|name| format!("{name}, driven")).collect();
    scene.materials.extend(driven);
    scene.materials.push("side".to_owned());
    for &grain in scene.driven.iter().flat_map(|driven| &driven.grains) {
        scene.grains[grain].material += count;
    }
    for (name, x, out) in [("left side", domain.low.x, 1.0), ("right side", domain.high.x, -1.0)] {
        scene.walls.push(Wall {
            piston: None,
            until: None,
            name: name.to_owned(),
            material: side,
            shape: WallShape::Plane { point: Vector3::new(x, 0.0, 0.0), normal: Vector3::new(out, 0.0, 0.0) },
            motion: Motion::default(),
        });
    }
}
