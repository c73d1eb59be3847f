//! Commands for grains with a prescribed velocity. They are groups that `fix move` moves.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

use super::outline::is_flat;

/// Returns the commands that move the driven grains of the group `grains`, and the name of the group of the other
/// grains.
pub(crate) fn driven(scene: &Scene, grains: &'static str) -> (Vec<String>, &'static str) {
    if scene.driven.is_empty() {
        return (Vec::new(), grains);
    }
    let mut lines = Vec::new();
    let mut groups = String::new();
    for (number, driven) in (1..).zip(&scene.driven) {
        let ids: String = driven.grains.iter().map(|grain| format!(" {}", grain + 1)).collect();
        let velocity = driven.velocity;
        // In two dimensions the programs require `NULL` for the third axis.
        let across = if is_flat(scene) { "NULL".to_owned() } else { format!("{:?}", velocity.z) };
        lines.push(format!("group driven{number} id{ids}"));
        lines.push(format!("fix drive{number} driven{number} move linear {:?} {:?} {across}", velocity.x, velocity.y));
        groups.push_str(&format!(" driven{number}"));
    }
    lines.push(format!("group free subtract {grains}{groups}"));
    if scene.laws.iter().flatten().any(ContactLaw::has_damping) {
        // For dashpots, a frozen grain has infinite mass like a wall. `fix move` moves the grain nevertheless.
        lines.push(format!("group heavy union{groups}"));
        lines.push("fix heavy heavy freeze".to_owned());
    }
    (lines, "free")
}
