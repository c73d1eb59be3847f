//! Grains that are moved as walls are: groups of their own, which `fix move` moves.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

use super::outline::is_flat;

/// The lines that move driven grains of the group of `grains`, and the name of the group of the others.
pub(crate) fn driven(scene: &Scene, grains: &'static str) -> (Vec<String>, &'static str) {
    if scene.driven.is_empty() {
        return (Vec::new(), grains);
    }
    let mut lines = Vec::new();
    let mut groups = String::new();
    for (number, driven) in (1..).zip(&scene.driven) {
        let ids: String = driven.grains.iter().map(|grain| format!(" {}", grain + 1)).collect();
        let velocity = driven.velocity;
        // In the plane the programs want nothing said of the third axis.
        let across = if is_flat(scene) { "NULL".to_owned() } else { format!("{:?}", velocity.z) };
        lines.push(format!("group driven{number} id{ids}"));
        lines.push(format!("fix drive{number} driven{number} move linear {:?} {:?} {across}", velocity.x, velocity.y));
        groups.push_str(&format!(" driven{number}"));
    }
    lines.push(format!("group free subtract {grains}{groups}"));
    if scene.laws.iter().flatten().any(ContactLaw::has_damping) {
        // What is frozen is as heavy as a wall to dashpots; `fix move` moves it all the same.
        lines.push(format!("group heavy union{groups}"));
        lines.push("fix heavy heavy freeze".to_owned());
    }
    (lines, "free")
}
